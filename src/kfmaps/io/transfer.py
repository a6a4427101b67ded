"""Points and values of one shape's vertices carried over a map to the other, with what maps of parts leave out."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import KDTree

from kfmaps._arrays import check, refuse
from kfmaps.config import BasisConfig, Config, DescriptorConfig
from kfmaps.fmap.precise import PointMap, check_point_map_precise, invert_precise_map, point_positions, vertex_point_map
from kfmaps.fmap.transfer import transfer_functions
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.mapcontent import check_map
from kfmaps.matching.partial.match_partial import COMMON
from kfmaps.matching.reindexing import reindexing
from kfmaps.matching.result import Match
from kfmaps.shape import prepare

_N_FUNCTIONS = 100  # size of the functional map where the file has none

LOST_GREY = 160 / 255
"""Grey of vertices without a counterpart, in files, figures and (web/src/link.js) pages."""


def precise_points(found: np.ndarray | Match, source: Mesh) -> PointMap | None:
    """Return the points inside triangles of a map file, checked; ``None`` where it has none."""
    if not isinstance(found, Match) or found.precise_map is None:
        return None
    return check_point_map_precise(found.precise_map, source, len(found.target_to_source))


def point_map(found: np.ndarray | Match, source: Mesh, target_to_source: np.ndarray) -> PointMap:
    """Return a point inside a triangle of a surface for each target vertex, at vertices where ``found`` has no others.

    ``target_to_source (n_t,)``: its vertices. A vertex of no face counts as the nearest that one has; without a
    counterpart (−1) any is taken.
    """
    place = precise_points(found, source)
    if place is not None:
        return place
    used = np.unique(source.faces)
    moved = np.arange(len(source.vertices))
    bare = np.setdiff1d(moved, used)
    if len(bare):
        moved[bare] = used[KDTree(source.vertices[used]).query(source.vertices[bare])[1]]
    return vertex_point_map(moved[np.where(target_to_source < 0, target_to_source.max(), target_to_source)], source)


@dataclass(frozen=True, eq=False)
class Counterparts:
    """A map of points in both directions as far as there are any."""

    file: Match
    meshes: tuple[Mesh, Mesh]  # source and target
    place: PointMap  # on the source, for each target vertex; means nothing where there is no counterpart
    target: np.ndarray  # (n_t,): which vertices have one

    @cached_property
    def back(self) -> PointMap:
        """On the target, for each source vertex: the nearest that is mapped to where it has no counterpart."""
        return invert_precise_map(self.place, *self.meshes, None if self.target.all() else self.target)

    @cached_property
    def source(self) -> np.ndarray:
        """Which source vertices have one, (n_s,)."""
        source, target = self.meshes
        overlap = self.file.partial.overlap_source
        if overlap is not None and np.shape(overlap) == (len(source.vertices),):
            return np.asarray(overlap) > COMMON
        if self.target.all():
            return np.ones(len(source.vertices), dtype=bool)
        corners = point_positions(self.place, source)[target.faces[self.back.faces]]
        near = np.einsum("ti,tij->tj", self.back.weights, corners)
        half = 0.5 * np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean(axis=1)
        return np.linalg.norm(near - source.vertices, axis=1) <= half


def find_counterparts(found: Match, source: Mesh, target: Mesh, name: str = "map") -> Counterparts:
    """Find which vertices of two surfaces have a counterpart by a map file.

    A source vertex has a counterpart where ``overlap_source`` of the file says so. Of a file that does not tell it has
    one within half an edge of what the target's faces are mapped to; of one without −1 every vertex has.
    """
    points = check_map(found, len(source.vertices), len(target.vertices), name, lost=True)
    return Counterparts(found, (source, target), point_map(found, source, points), points >= 0)


def transfer(
    values_s: ArrayLike,
    target_to_source: ArrayLike | Match,
    faces_s: np.ndarray | None = None,
    lost: ArrayLike | None = None,
) -> np.ndarray:
    """Carry values from the vertices of the source to those of the target, as :func:`kfmaps.transfer` does.

    ``values_s (n_s, ...)``; ``target_to_source``: (n_t,) or a Match; ``faces_s (f_s, 3)``: the source's, with which
    floating numbers are mixed between the corners of the points inside triangles that a match has; ``lost``: what
    vertices without a counterpart get.
    """
    values = np.asarray(values_s)
    if values.ndim == 0:
        raise refuse("values", "a row for each source vertex", "a single value", "give an array")
    match = target_to_source if isinstance(target_to_source, Match) else None
    if match is not None and match.n_source not in (None, len(values)):
        wanted = f"{match.n_source} rows, one per source vertex"
        raise refuse("values", wanted, str(len(values)), "check that they are the source's")
    points = check_map(target_to_source, n_s=len(values), lost=True)
    nearest, precise = np.maximum(points, 0), None if match is None else match.precise_map
    return _fill_lost(_interpolate(values, precise, faces_s, nearest), points < 0, lost)


def _interpolate(values: np.ndarray, at: PointMap | None, faces: np.ndarray | None, nearest: np.ndarray) -> np.ndarray:
    """Functions mixed between the corners of the triangles that points lie in; of all else that of the nearest vertex.

    A corner without a finite value makes none of the mean, whose nearest vertex counts; one of weight 0 does not count.
    """
    if at is None or faces is None or values.dtype.kind != "f":
        return values[nearest]
    corners = values[faces[at.faces]]
    finite = np.isfinite(corners)
    mixed = np.einsum("ti,ti...->t...", at.weights, np.where(finite, corners, 0.0))
    counted = (at.weights > 0).reshape(*at.weights.shape, *[1] * (values.ndim - 1))
    return np.where((~finite & counted).any(axis=1), values[nearest], mixed).astype(values.dtype)


def _fill_lost(values: np.ndarray, gone: np.ndarray, lost: ArrayLike | None) -> np.ndarray:
    """Put ``lost``, by default that of :func:`transfer`, into the rows ``gone (n,)`` of ``values (n, ...)``."""
    if not gone.any():
        return values
    if lost is None:
        lost = {"f": np.nan, "c": np.nan, "U": "", "i": -1}.get(values.dtype.kind)
    if lost is None or (values.dtype.kind in "ui" and not np.can_cast(np.min_scalar_type(lost), values.dtype)):
        got = f"{values.dtype}, and {gone.sum()} vertices without a counterpart"
        raise refuse("values", "a kind with a value for vertices without counterpart", got, "give the value: lost=")
    values[gone] = lost
    return values


def transfer_back(values_t: np.ndarray, ways: Counterparts, lost: ArrayLike | None = None) -> np.ndarray:
    """Carry values from the vertices of the target to those of the source, (n_t, ...) to (n_s, ...).

    Each source vertex takes those of its own place on the target. ``lost`` is as for :func:`transfer`.
    """
    target = ways.meshes[1]
    if values_t.ndim == 0 or len(values_t) != len(target.vertices):
        got = f"{len(values_t)}" if values_t.ndim else "a single value"
        raise refuse("values", f"{len(target.vertices)} rows, one per target vertex", got, "are they the target's?")
    nearest = target.faces[ways.back.faces, ways.back.weights.argmax(axis=1)]
    return _fill_lost(_interpolate(values_t, ways.back, target.faces, nearest), ~ways.source, lost)


def transfer_by_functions(values: np.ndarray, found: Match, source: Mesh, target: Mesh, products: int) -> np.ndarray:
    """Carry functions ``values (n_s, ...)`` by the functional map and products of eigenfunctions, (n_t, ...) float64.

    See :func:`kfmaps.fmap.transfer.transfer_functions`. Eigenfunctions are found anew and ``C = Φ_tᵀ A_t Φ_s[map]``
    from the map's points, since their signs may be others than when the map was made. It has the size of the file's
    map.
    """
    if values.dtype.kind not in "fiu":
        raise refuse("values", "numbers", str(values.dtype), "leave --products out: labels go by points")
    if (found.target_to_source < 0).any():
        got = "one of a part, with vertices without counterpart"
        raise refuse("--products", "a map of the whole target", got, "leave it out: values then go by points")
    check_map(found, len(source.vertices), len(target.vertices), "the map")
    tail = (None,) * (values.ndim - 1)
    check(values, "values", shape=(len(source.vertices), *tail), remedy="give one row per source vertex")
    k_t, k_s = found.functional_map.shape if hasattr(found, "functional_map") else (_N_FUNCTIONS, _N_FUNCTIONS)
    if products > k_s:
        raise refuse("--products", f"at most the {k_s} functions that the map carries", str(products), "lower it")
    k = min(max(k_s, k_t), len(source.vertices) - 1, len(target.vertices) - 1)
    plain = replace(Config.single_fit(), basis=BasisConfig(k), refinement=None, registration=None)
    plain = replace(plain, descriptors=DescriptorConfig(signature="none", landmark_descriptor="none", shot=False))
    across = reindexing(prepare(source, plain, name="source"), prepare(target, plain, name="target"))
    points = across.part_s.to_clean[found.target_to_source[across.part_t.to_original]]
    bases = across.source.basis.truncate(k_s), across.target.basis.truncate(k_t)
    C = bases[1].project(bases[0].functions[points])
    flat = values[across.part_s.to_original].reshape(len(across.part_s.to_original), -1).astype(np.float64)
    images = transfer_functions(flat, C, *bases, products)
    return images.reshape(len(images), *values.shape[1:])[across.part_t.to_clean]
