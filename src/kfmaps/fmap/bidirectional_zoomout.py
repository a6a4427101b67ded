"""Refining the maps of both directions at once, so that each stays close to the other's inverse.

ZoomOut (Melzi et al. 2019) with both point maps: of each of them comes a functional map, and the adjoint of the one
back is a second opinion on the one forth. Their mean is the next map, and its adjoint the next one back. So points that
the two maps disagree on pull both towards a compromise (Ren et al., Continuous and orientation-preserving
correspondences via functional maps, 2018, couple the two likewise; the mean is ours).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import Array, refuse
from kfmaps._progress import Done
from kfmaps.fmap.convert import to_points
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance
from kfmaps.fmap.refine import Refined, ZoomOut, fit_functional_map, sample_candidates
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.sampling import stratified_samples


@dataclass(frozen=True, eq=False)
class _Side:
    """Points of one shape: those that are mapped, those that may be mapped to, and the vertices that they are."""

    mapped: Basis
    choice: Basis
    mapped_rows: np.ndarray | None = None
    choice_rows: np.ndarray | None = None


def bidirectional_zoomout(
    zoom: ZoomOut,
    C: Array,
    D: Array,
    source: Basis,
    target: Basis,
    progress: Done | None = None,
    threads: int | None = None,
    guide: DescriptorGuidance | None = None,
) -> tuple[Refined, Refined]:
    """ZoomOut of ``C (k_t, k_s)`` and ``D (k_s, k_t)`` together: the refined maps forth and back.

    Swapping the shapes, and with them ``C`` and ``D``, swaps the answers. Numbers are those of ``zoom``.

    Raises
    ------
    InvalidInput
        When there are fewer eigenfunctions than ``zoom.stop``, or ``D`` does not go the way back.
    """
    available = min(source.functions.shape[1], target.functions.shape[1])
    if zoom.stop > available:
        remedy = "compute more eigenfunctions or lower stop"
        raise refuse("ZoomOut stop", f"at most the {available} eigenfunctions at hand", str(zoom.stop), remedy)
    if tuple(D.shape) != (C.shape[1], C.shape[0]):
        wanted = f"shape {(C.shape[1], C.shape[0])}"
        raise refuse("map back", wanted, f"shape {tuple(D.shape)}", "give the map from target to source")
    guide = guide if zoom.descriptor_weight else None
    first = min(zoom.start, *C.shape)
    C = 0.5 * (C[:first, :first] + D[:first, :first].T)
    sizes = [*range(first, zoom.stop, zoom.step), zoom.stop]
    on_s, on_t = _side(source, zoom), _side(target, zoom)
    for i, larger in enumerate(sizes[1:]):
        found = _points(C, on_s, on_t, zoom, guide, threads)
        forth = fit_functional_map(found, on_s.choice, on_t.mapped, larger)
        found = _points(C.T, on_t, on_s, zoom, _turned(guide), threads)
        back = fit_functional_map(found, on_t.choice, on_s.mapped, larger)
        C = 0.5 * (forth + back.T)
        if progress is not None:
            progress((i + 1) / len(sizes))
    all_s, all_t = _Side(source, source), _Side(target, target)
    points = _points(C, all_s, all_t, zoom, guide, threads)
    points_back = _points(C.T, all_t, all_s, zoom, _turned(guide), threads)
    if progress is not None:
        progress(1.0)
    return Refined(C, points, tuple(sizes)), Refined(C.T, points_back, tuple(sizes))


def _side(basis: Basis, zoom: ZoomOut) -> _Side:
    n = basis.functions.shape[0]
    mapped, mapped_rows, choice, choice_rows = basis, None, basis, None
    if zoom.samples is not None and zoom.samples < n:
        samples = stratified_samples(basis, zoom.samples, zoom.seed)
        mapped, mapped_rows = samples.basis, samples.vertices
        if n > sample_candidates(zoom.samples):
            samples = stratified_samples(basis, sample_candidates(zoom.samples), zoom.seed)
            choice, choice_rows = samples.basis, samples.vertices
    return _Side(mapped, choice, mapped_rows, choice_rows)


def _points(
    C: Array, source: _Side, target: _Side, zoom: ZoomOut, guide: DescriptorGuidance | None, threads: int | None
) -> np.ndarray:
    """A point of ``source.choice`` for each of ``target.mapped``."""
    beside = None
    if guide is not None:
        few = guide.at(source.choice_rows, target.mapped_rows)
        beside = few.embedding_columns(zoom.descriptor_weight, source.choice, target.mapped)
    return to_points(C, source.choice, target.mapped, threads, beside)


def _turned(guide: DescriptorGuidance | None) -> DescriptorGuidance | None:
    return None if guide is None else DescriptorGuidance(guide.target, guide.source)
