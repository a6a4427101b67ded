"""The source bent onto the target as the last step of a match, which brings back points that slid along the surface.

A refined functional map is right up to a smooth sliding of points, which its basis hardly sees, and here and there a
limb is twisted or folded. So the source's mesh is bent onto the target as rigidly as possible (Sorkine and Alexa 2007)
by a non-rigid ICP (Amberg et al. 2007) that begins with the map: closest points in both directions, compared with
normals, and distances mostly along the normal, so that points may slide to where they bend the source least.
Neighbouring rotations are kept alike (Levi and Gotsman 2015): their differences are less at the true correspondence
than at a map whose limbs are twisted, where bending alone hardly tells the two apart. Landmarks hold softly. Then each
target vertex takes the closest point on the bent source, inside a triangle; where parts of a body touch, of the right
one (:mod:`kfmaps.registration.contact_projection`).

It comes last: a refinement after it would go back to where it was.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np
from scipy.sparse import csr_array

from kfmaps._arrays import refuse
from kfmaps._records import setting, settings_record
from kfmaps.fmap.convert import check_point_map
from kfmaps.geometry.arap import arap_energy, build_arap, nearest_rotations, rotations
from kfmaps.geometry.closest_points import barycentric_matrix
from kfmaps.geometry.coarsen import coarse_proxy, embedded_deformation, spread_vertices
from kfmaps.geometry.mesh import Mesh, vertex_areas, vertex_normals
from kfmaps.registration.contact_projection import project_with_contact
from kfmaps.registration.deformable import (
    LANDMARK_PULL,
    ClosestPointQuery,
    DataTerm,
    DeformableMesh,
    closest_point_query,
    deformable_mesh,
    descend_levels,
    initial_deformation,
    landmark_pull,
)
from kfmaps.registration.local_scaling import local_scaling

_Kept = TypeVar("_Kept")

_PROXY_FROM, _PROXY_VERTICES = 15_000, 5_000
"""Vertices above which the fit begins with coarse copies, and vertices of a copy: 1.4 % of √area apart, finer than what
the first levels' stiffness lets bend."""
_SCALED_LANDMARK_PULL = (30.0, 0.1)
"""The pull of landmarks where sizes may change, as between shapes of other proportions: maps are farther off than a
click."""


@dataclass(frozen=True, eq=False)
class Registration:
    """A source bent onto a target, both at unit area."""

    vertices: np.ndarray  # (n_s, 3): the source's, where they lie on the target
    faces: np.ndarray  # (n_t,): the source face that each target vertex lies on
    # (n_t, 3): the barycentric coordinates of its place there
    # (:func:`kfmaps.registration.contact_projection.project_with_contact`).
    weights: np.ndarray
    bending: float  # as-rigid-as-possible energy per area (:func:`kfmaps.geometry.arap.arap_energy`): 0 for a motion
    gap: float  # root of the mean squared distance of the two surfaces, in both directions, in units of √area


@settings_record
class NonRigid:
    """Settings of the non-rigid fit; callable as ``(source, target, target_to_source) -> Registration``.

    Details smaller than the root of ``stiffness`` follow the target at the first level. Smoothing keeps limbs from
    being twisted; 0 leaves each vertex its own rotation. See also :mod:`kfmaps.registration.local_scaling`.
    """

    stiffness: float = setting(2e-4, "stiffness of the first level, in units of area", above=0)
    n_levels: int = setting(3, "levels, each a third (10^-1/2) as stiff as the one before", low=1)
    steps: int = setting(5, "searches for closest points at each level", low=1)
    rotation_smoothing: float = setting(1e-3, "area over which rotations are averaged", low=0)
    local_scaling: float = setting(0.0, "area over which sizes may change evenly, for other proportions", low=0)

    def __call__(
        self,
        source: Mesh,
        target: Mesh,
        target_to_source: np.ndarray,
        progress: Callable[[float], None] | None = None,
        landmarks: np.ndarray | None = None,
        held: np.ndarray | None = None,
    ) -> Registration:
        """Bend a source onto a target, beginning with a map.

        Parameters
        ----------
        source, target : Mesh
            At unit area.
        target_to_source : (n_t,) int64
        progress : callable, optional
            Told how much is done, from 0 to 1.
        landmarks : (l, 2) int64, optional
            Pairs "source vertex, target vertex", which are pulled together softly.
        held : (n_t,) float64, optional
            From 0 to 1, how much each target vertex shall stay with its image in the map.

        Raises
        ------
        InvalidInput
            When one of them is a point cloud, or the map does not fit.
        """
        for mesh, name in ((source, "source"), (target, "target")):
            if len(mesh.faces) == 0:
                raise refuse(name, "a surface with faces", "a point cloud", "leave out the non-rigid fit")
        report = progress or (lambda _done: None)
        points = check_point_map(target_to_source, len(source.vertices), len(target.vertices))
        marks = np.zeros((0, 2), dtype=np.int64) if landmarks is None else np.asarray(landmarks)
        x = None
        if max(len(source.vertices), len(target.vertices)) > _PROXY_FROM:
            x = self._of_copies(source, target, points, lambda done: report(0.3 * done), marks, held)
        pair = mesh_pair(deformable_mesh(source), target)
        x, gap = self.bent(pair, points, x, report, marks, held)
        found = project_with_contact(target_to_source, pair.body, x, target, pair.normals_t)
        energy = arap_energy(pair.body.energy, x) / float(pair.body.areas.sum())
        return Registration(x, found.faces, found.weights, energy, gap)

    def _of_copies(
        self,
        source: Mesh,
        target: Mesh,
        points: np.ndarray,
        report: Callable[[float], None],
        marks: np.ndarray,
        held: np.ndarray | None,
    ) -> np.ndarray:
        """The source's vertices (n_s, 3) as they follow the fit of coarse copies of both."""
        a, b = (
            coarse_proxy(mesh, spread_vertices(mesh, _PROXY_VERTICES, marks[:, side]))
            for side, mesh in enumerate((source, target))
        )
        report(0.1)
        bent, _ = self.bent(
            mesh_pair(deformable_mesh(a.mesh), b.mesh),
            a.owner[points[b.vertices]],
            report=lambda done: report(0.1 + 0.9 * done),
            marks=np.stack([a.owner[marks[:, 0]], b.owner[marks[:, 1]]], axis=1),
            held=None if held is None else held[b.vertices],
        )
        return embedded_deformation(a, source, bent, rotations(build_arap(a.mesh), bent))

    def bent(
        self,
        pair: MeshPair,
        points: np.ndarray,
        x: np.ndarray | None = None,
        report: Callable[[float], None] = lambda _done: None,
        marks: np.ndarray | None = None,
        held: np.ndarray | None = None,
    ) -> tuple[np.ndarray, float]:
        """Return the source's vertices (n_s, 3) on the target, and the gap, of two surfaces that are ready for it.

        With ``x (n_s, 3)``, where the source lies nearly, only the last level is done. The other parameters are those
        of :meth:`__call__`.
        """
        levels, steps, begun = range(self.n_levels), self.steps, 0.2
        if x is not None:
            levels, steps, begun = range(self.n_levels)[-1:], min(self.steps, 2), 0.3
        else:
            places = pair.target.vertices, pair.normals_t, pair.areas_t
            x = pair.once(points.tobytes(), lambda: initial_deformation(pair.body, points, *places))
            report(begun)
        even = _evened(pair, self.rotation_smoothing)
        area = self.local_scaling
        stretched = pair.once(("sizes", area), lambda: local_scaling(pair.body.energy, pair.body.areas, area))
        marks = np.zeros((0, 2), dtype=np.int64) if marks is None else marks
        strength = _SCALED_LANDMARK_PULL if self.local_scaling else LANDMARK_PULL
        pull = landmark_pull(pair.body, marks[:, 0], pair.target.vertices[marks[:, 1]], strength)
        stays = [] if held is None or not held.any() else [_stays(pair, points, held)]
        gap = 0.0

        def terms(x: np.ndarray, stiffness: float) -> list[DataTerm]:
            nonlocal gap
            found, gap = _closest_terms(pair, x)
            return [*found, *stays, *pull.terms(x, stiffness)]

        def turns(x: np.ndarray) -> np.ndarray:
            return stretched(x, even(rotations(pair.body.energy, x)))

        stiffness = [self.stiffness * 10 ** (-0.5 * level) for level in levels]
        x = descend_levels(
            pair.body, x, stiffness, steps, 2.0, terms, turns, lambda done: report(begun + (1 - begun) * done)
        )
        return x, gap


@dataclass(frozen=True, eq=False)
class MeshPair:
    """Two surfaces and what stays the same while the first is bent onto the second; made by :func:`mesh_pair`."""

    body: DeformableMesh
    target: Mesh
    areas_t: np.ndarray
    look_t: ClosestPointQuery
    kept: dict[object, Any] = field(default_factory=dict)  # what :meth:`once` has made

    def once(self, key: object, make: Callable[[], _Kept]) -> _Kept:
        """Return what ``make`` returns, made once for each ``key``: several fits begin alike, and some are repeated."""
        if key not in self.kept:
            self.kept[key] = make()
        return self.kept[key]

    @property
    def normals_t(self) -> np.ndarray:
        """Of the target's vertices, (n_t, 3)."""
        return self.look_t.normals


def mesh_pair(body: DeformableMesh, target: Mesh, look_t: ClosestPointQuery | None = None) -> MeshPair:
    """Return a surface at rest and the one to bend it onto; ``look_t``: the target's query, where it exists already."""
    return MeshPair(body, target, vertex_areas(target), closest_point_query(target) if look_t is None else look_t)


def _evened(pair: MeshPair, area: float) -> Callable[[np.ndarray], np.ndarray]:
    """Averages rotations ``(n_s, 3, 3)`` with those around: one step of implicit diffusion over ``area``."""
    if area == 0:
        return lambda turns: turns
    diffuse = pair.body.solver(area, 1.0)
    return lambda turns: nearest_rotations(
        diffuse(pair.body.areas[:, None] * turns.reshape(len(turns), 9)).reshape(turns.shape)
    )


def _stays(pair: MeshPair, points: np.ndarray, held: np.ndarray) -> DataTerm:
    """The map itself as a term, with weights ``held (n_t,)``."""
    some = np.flatnonzero(held)
    rows = csr_array(
        (np.ones(len(some)), points[some], np.arange(len(some) + 1)), shape=(len(some), len(pair.body.areas))
    )
    return DataTerm(held[some] * pair.areas_t[some], pair.target.vertices[some], rows)


def _closest_terms(pair: MeshPair, x: np.ndarray) -> tuple[list[DataTerm], float]:
    """Closest points in both directions as terms, and how far the surfaces are apart (root mean square)."""
    bent = Mesh(x, pair.body.mesh.faces)
    normals = vertex_normals(bent)
    forth, there, agree_s = pair.look_t(x, normals)
    back, _, agree_t = closest_point_query(bent, normals, pair.body.around)(pair.target.vertices, pair.normals_t)
    rows = barycentric_matrix(back.faces, back.weights, bent.faces, len(x))
    terms = [
        DataTerm(pair.body.areas * agree_s, forth.points, None, there),
        DataTerm(pair.areas_t * agree_t, pair.target.vertices, rows, pair.normals_t),
    ]
    squares = [
        np.average(places.distances**2, weights=areas)
        for places, areas in ((forth, pair.body.areas), (back, pair.areas_t))
    ]
    return terms, float(np.sqrt(np.mean(squares)))
