"""A map of pyFM with landmarks, for the curve of automatic.py: as its documentation makes one, refined by ZoomOut.

As many descriptors as this library takes, 100 of signatures and landmarks' maps, 100 functions, and ZoomOut to 150, as
in compare.py. Needs pyFM: ``pip install 'kfmaps[bench]'``.
"""

from __future__ import annotations

from importlib import import_module

import numpy as np

import kfmaps

FunctionalMapping = import_module("pyFM.functional").FunctionalMapping
TriMesh = import_module("pyFM.mesh").TriMesh

K, STOP, STEP = 100, 150, 5


def points(source: kfmaps.Mesh, target: kfmaps.Mesh, landmarks: np.ndarray) -> np.ndarray:
    """A source vertex for each target vertex ``(n_t,)``, from ``landmarks (l, 2)``."""
    meshes = [TriMesh(mesh.vertices, mesh.faces, area_normalize=True) for mesh in (source, target)]
    for mesh in meshes:
        mesh.process(200)
    model = FunctionalMapping(*meshes)
    model.compute_spectral_descriptors(100, "WKS", 128, landmarks, subsample_step=1 + len(landmarks))
    model.fit(K=(K, K))
    found: np.ndarray = model.get_p2p(model.zoomout_refine(nit=(STOP - K) // STEP, step=STEP))
    return found
