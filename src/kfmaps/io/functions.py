"""Functions carried by the functional map of a map's file, whose shapes must be read again."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from kfmaps._arrays import check, refuse
from kfmaps.config import BasisConfig, Config, DescriptorConfig
from kfmaps.fmap.transfer import transfer_functions
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.mapfile import MapFile, check_map
from kfmaps.matching.reindexing import reindexing
from kfmaps.shape import prepare

FUNCTIONS = 100
"""Size of the functional map where the file has none."""


def carried_functions(
    values: np.ndarray, found: MapFile, source: Mesh, target: Mesh, products: int, threads: int | None = None
) -> np.ndarray:
    """``values (n_s, ...)`` on the source as functions on the target, (n_t, ...) float64.

    See :func:`kfmaps.fmap.transfer.transfer_functions`. Eigenfunctions are found anew and ``C = Φ_tᵀ A_t Φ_s[map]``
    from the
    map's points, since their signs may be others than when the map was made. It has the size of the file's map.

    Raises
    ------
    InvalidInput
        When values are no numbers, or do not belong to the source, or the map to the shapes.
    """
    if values.dtype.kind not in "fiu":
        raise refuse("values", "numbers", str(values.dtype), "leave --products out: labels go by points")
    if (found.target_to_source < 0).any():
        got = "one of a part, with vertices without counterpart"
        raise refuse("--products", "a map of the whole target", got, "leave it out: values then go by points")
    check_map(found, len(source.vertices), len(target.vertices), "the map")
    tail = (None,) * (values.ndim - 1)
    check(values, "values", shape=(len(source.vertices), *tail), remedy="give one row per source vertex")
    k_t, k_s = (FUNCTIONS, FUNCTIONS) if found.functional_map is None else found.functional_map.shape
    if products > k_s:
        raise refuse("--products", f"at most the {k_s} functions that the map carries", str(products), "lower it")
    k = min(max(k_s, k_t), len(source.vertices) - 1, len(target.vertices) - 1)
    plain = replace(Config.single_fit(), basis=BasisConfig(k), refinement=None, finish=None, threads=threads)
    plain = replace(plain, descriptors=DescriptorConfig(signature="none", landmark_map="none", shot=False))
    across = reindexing(prepare(source, plain, name="source"), prepare(target, plain, name="target"))
    points = across.part_s.to_clean[found.target_to_source[across.part_t.to_original]]
    bases = across.source.basis.truncate(k_s), across.target.basis.truncate(k_t)
    C = bases[1].project(bases[0].functions[points])
    flat = values[across.part_s.to_original].reshape(len(across.part_s.to_original), -1).astype(np.float64)
    images = transfer_functions(flat, C, *bases, products)
    return images.reshape(len(images), *values.shape[1:])[across.part_t.to_clean]
