"""Transfer values between the vertices of two shapes by a map, also where vertices have no counterpart."""

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

_N_FUNCTIONS = 100  # size of the functional map where the match has none

LOST_GREY = 160 / 255
"""Grey of vertices without a counterpart, in files, figures and (web/src/link.js) pages."""


def precise_points(map: np.ndarray | Match, source: Mesh) -> PointMap | None:
    """Return the points inside triangles of a match, checked; ``None`` where it has none."""
    if not isinstance(map, Match) or map.precise_map is None:
        return None
    return check_point_map_precise(map.precise_map, source, len(map.target_to_source))


def point_map(map: np.ndarray | Match, source: Mesh, target_to_source: np.ndarray) -> PointMap:
    """Return the point on the source's surface of each target vertex: the map's points inside triangles, else vertices.

    ``target_to_source (n_t,)``: the map's vertices. A vertex without faces is replaced by the nearest one with a face,
    a missing counterpart (−1) by any.
    """
    points = precise_points(map, source)
    if points is not None:
        return points
    in_faces = np.unique(source.faces)
    replacement = np.arange(len(source.vertices))
    faceless = np.setdiff1d(replacement, in_faces)
    if len(faceless):
        replacement[faceless] = in_faces[KDTree(source.vertices[in_faces]).query(source.vertices[faceless])[1]]
    return vertex_point_map(
        replacement[np.where(target_to_source < 0, target_to_source.max(), target_to_source)], source
    )


@dataclass(frozen=True, eq=False)
class Counterparts:
    """A point map in both directions, and which vertices have a counterpart."""

    match: Match
    meshes: tuple[Mesh, Mesh]  # source and target
    place: PointMap  # on the source, for each target vertex; means nothing where there is no counterpart
    target: np.ndarray  # (n_t,): whether each target vertex has a counterpart

    @cached_property
    def back(self) -> PointMap:
        """The inverse: a point on the target for each source vertex, the nearest image where it has no counterpart."""
        return invert_precise_map(self.place, *self.meshes, None if self.target.all() else self.target)

    @cached_property
    def source(self) -> np.ndarray:
        """Whether each source vertex has a counterpart, (n_s,)."""
        source, target = self.meshes
        overlap = self.match.partial.overlap_source
        if overlap is not None and np.shape(overlap) == (len(source.vertices),):
            return np.asarray(overlap) > COMMON
        if self.target.all():
            return np.ones(len(source.vertices), dtype=bool)
        corners = point_positions(self.place, source)[target.faces[self.back.faces]]
        nearest_points = np.einsum("ti,tij->tj", self.back.weights, corners)
        half_edge = 0.5 * np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean(axis=1)
        return np.linalg.norm(nearest_points - source.vertices, axis=1) <= half_edge


def find_counterparts(match: Match, source: Mesh, target: Mesh, name: str = "map") -> Counterparts:
    """Find which vertices of two surfaces have a counterpart in a match.

    A source vertex has a counterpart where ``overlap_source`` says so. In a match without that field it has one within
    half an edge of the image of the target, and everywhere where no target vertex lacks one.
    """
    points = check_map(match, len(source.vertices), len(target.vertices), name, partial=True)
    return Counterparts(match, (source, target), point_map(match, source, points), points >= 0)


def transfer(
    values_s: ArrayLike,
    target_to_source: ArrayLike | Match,
    faces_s: np.ndarray | None = None,
    lost: ArrayLike | None = None,
) -> np.ndarray:
    """Transfer values from the vertices of the source to those of the target, as :func:`kfmaps.transfer` does.

    ``values_s (n_s, ...)``; ``target_to_source``: (n_t,) or a Match; ``faces_s (f_s, 3)``: the source's, with which
    floating numbers are interpolated where a match has points inside triangles; ``lost``: the value of vertices without
    a counterpart.
    """
    values = np.asarray(values_s)
    if values.ndim == 0:
        raise refuse("values", "a row for each source vertex", "a single value", "give an array")
    match = target_to_source if isinstance(target_to_source, Match) else None
    if match is not None and match.n_source not in (None, len(values)):
        expected = f"{match.n_source} rows, one per source vertex"
        raise refuse("values", expected, str(len(values)), "check that they are the source's")
    points = check_map(target_to_source, n_s=len(values), partial=True)
    nearest, precise = np.maximum(points, 0), None if match is None else match.precise_map
    return _fill_lost(_interpolate(values, precise, faces_s, nearest), points < 0, lost)


def _interpolate(
    values: np.ndarray, points: PointMap | None, faces: np.ndarray | None, nearest: np.ndarray
) -> np.ndarray:
    """Return floating values interpolated inside triangles; all others, and where a corner is not finite, at vertices.

    A corner with weight 0 may have any value.
    """
    if points is None or faces is None or values.dtype.kind != "f":
        return values[nearest]
    corners = values[faces[points.faces]]
    finite = np.isfinite(corners)
    mixed = np.einsum("ti,ti...->t...", points.weights, np.where(finite, corners, 0.0))
    has_weight = (points.weights > 0).reshape(*points.weights.shape, *[1] * (values.ndim - 1))
    return np.where((~finite & has_weight).any(axis=1), values[nearest], mixed).astype(values.dtype)


def _fill_lost(values: np.ndarray, unmatched: np.ndarray, lost: ArrayLike | None) -> np.ndarray:
    """Set the rows ``unmatched (n,)`` of ``values (n, ...)`` to ``lost``, by default as :func:`transfer` says."""
    if not unmatched.any():
        return values
    if lost is None:
        lost = {"f": np.nan, "c": np.nan, "U": "", "i": -1}.get(values.dtype.kind)
    if lost is None or (values.dtype.kind in "ui" and not np.can_cast(np.min_scalar_type(lost), values.dtype)):
        got = f"{values.dtype}, and {unmatched.sum()} vertices without a counterpart"
        raise refuse("values", "values that can mark vertices without a counterpart", got, "give their value, lost=")
    values[unmatched] = lost
    return values


def transfer_back(values_t: np.ndarray, counterparts: Counterparts, lost: ArrayLike | None = None) -> np.ndarray:
    """Transfer values from the vertices of the target to those of the source, (n_t, ...) to (n_s, ...).

    ``lost`` is as for :func:`transfer`.
    """
    target = counterparts.meshes[1]
    if values_t.ndim == 0 or len(values_t) != len(target.vertices):
        got = f"{len(values_t)}" if values_t.ndim else "a single value"
        raise refuse(
            "values", f"{len(target.vertices)} rows, one per target vertex", got, "check that they are the target's"
        )
    nearest = target.faces[counterparts.back.faces, counterparts.back.weights.argmax(axis=1)]
    return _fill_lost(_interpolate(values_t, counterparts.back, target.faces, nearest), ~counterparts.source, lost)


def transfer_by_functions(values: np.ndarray, match: Match, source: Mesh, target: Mesh, products: int) -> np.ndarray:
    """Transfer ``values (n_s, ...)`` by the functional map and products of eigenfunctions, (n_t, ...) float64.

    See :func:`kfmaps.fmap.transfer.transfer_functions`. Eigenfunctions are computed again, and their signs may differ.
    So ``C = Φ_tᵀ A_t Φ_s[map]`` comes from the map's points, with the size of the match's functional map.
    """
    if values.dtype.kind not in "fiu":
        raise refuse("values", "numbers", str(values.dtype), "leave --products out to transfer labels")
    if (match.target_to_source < 0).any():
        got = "one with vertices without a counterpart"
        raise refuse("--products", "a map of the whole target", got, "leave it out")
    check_map(match, len(source.vertices), len(target.vertices), "the map")
    tail = (None,) * (values.ndim - 1)
    check(values, "values", shape=(len(source.vertices), *tail), remedy="give one row per source vertex")
    k_t, k_s = match.functional_map.shape if hasattr(match, "functional_map") else (_N_FUNCTIONS, _N_FUNCTIONS)
    if products > k_s:
        raise refuse("--products", f"at most {k_s}, the functions of the map", str(products), "lower it")
    k = min(max(k_s, k_t), len(source.vertices) - 1, len(target.vertices) - 1)
    config = replace(Config.single_fit(), basis=BasisConfig(k), refinement=None, registration=None)
    config = replace(config, descriptors=DescriptorConfig(signature="none", landmark_descriptor="none", shot=False))
    reindexed = reindexing(prepare(source, config, name="source"), prepare(target, config, name="target"))
    points = reindexed.clean_points(match.target_to_source)
    bases = reindexed.source.basis.truncate(k_s), reindexed.target.basis.truncate(k_t)
    C = bases[1].project(bases[0].functions[points])
    columns = values[reindexed.clean_s.to_original].reshape(len(reindexed.clean_s.to_original), -1).astype(np.float64)
    images = transfer_functions(columns, C, *bases, products)
    return images.reshape(len(images), *values.shape[1:])[reindexed.clean_t.to_clean]
