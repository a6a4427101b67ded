"""A map of geomfum with landmarks, for compare.py: as its documentation makes one, refined by ZoomOut.

100 wave kernel signatures and landmarks' maps, 100 functions, and ZoomOut to 150, as in by_pyfm.py. Its energy has no
orientation term here. SciPy minimises it, as geomfum's own wrapper does, which needs geomstats. Needs geomfum:
``pip install geomfum==1.0.0``.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np
from by_pyfm import STEP, STOP, K
from scipy.optimize import minimize

import kfmaps
from kfmaps.geometry.mesh import unit_area

spectral, pipeline = (import_module(f"geomfum.descriptor.{name}") for name in ("spectral", "pipeline"))
energies, refine, convert = (import_module(f"geomfum.{name}") for name in ("functional_map", "refine", "convert"))
TriangleMesh = import_module("geomfum.shape").TriangleMesh


def points(source: kfmaps.Mesh, target: kfmaps.Mesh, landmarks: np.ndarray) -> np.ndarray:
    """A source vertex for each target vertex ``(n_t,)``, from ``landmarks (l, 2)``."""
    meshes: list[Any] = []
    for mesh, marks in zip((source, target), landmarks.T, strict=True):
        meshes.append(TriangleMesh(unit_area(mesh).vertices, mesh.faces))
        meshes[-1].laplacian.find_spectrum(spectrum_size=200, set_as_basis=True)
        meshes[-1].set_landmarks(marks)
    steps = [
        spectral.WaveKernelSignature.from_registry(n_domain=100),
        spectral.LandmarkWaveKernelSignature.from_registry(n_domain=100),
        pipeline.ArangeSubsampler(subsample_step=1 + len(landmarks)),
        pipeline.L2InnerNormalizer(),
    ]
    descriptors = [pipeline.DescriptorPipeline(steps).apply(mesh) for mesh in meshes]
    bases = [mesh.basis for mesh in meshes]
    for basis in bases:
        basis.use_k = K
    projected = [basis.project(values) for basis, values in zip(bases, descriptors, strict=True)]
    both = (bases[0], descriptors[0], bases[1], descriptors[1])
    energy = energies.FactorSum(
        [
            energies.SpectralDescriptorPreservation(*projected, weight=1.0),
            energies.LBCommutativityEnforcing.from_bases(*bases, weight=1e-2),
            energies.OperatorCommutativityEnforcing.from_multiplication(*both, weight=1e-1),
        ]
    )

    def value(C: np.ndarray) -> float:
        return float(energy(C.reshape(K, K)))

    def gradient(C: np.ndarray) -> np.ndarray:
        return np.asarray(energy.gradient(C.reshape(K, K))).ravel()

    C = minimize(value, np.zeros(K * K), jac=gradient, method="L-BFGS-B").x.reshape(K, K)
    refined = refine.ZoomOut(nit=(STOP - K) // STEP, step=STEP)(C, *bases)
    for basis in bases:
        basis.use_k = STOP
    return np.asarray(convert.P2pFromFmConverter()(refined, *bases))
