"""Non-rigid ICP of the source onto the target, the last step of a match.

A refined functional map is right up to a smooth sliding of points, which its basis hardly sees, and here and there a
limb is twisted or folded. So the source is deformed onto the target as rigidly as possible (Sorkine and Alexa 2007) by
a non-rigid ICP (Amberg et al. 2007) that begins with the map. It takes closest points in both directions, compared with
their normals, and weighs distances mostly along the normals, so that points may slide to where the source is deformed
least. Rotations are smoothed (Levi and Gotsman 2015), since they vary more over twisted limbs than at the true map,
while the energies of the two hardly differ. Landmarks pull softly. Then each target vertex takes the closest point of
the registered source, inside a triangle; where parts of a body touch, of the right part
(:mod:`kfmaps.registration.contact_projection`).

It comes last, since a refinement after it would undo it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any, TypeVar

import numpy as np
from scipy.sparse import csr_array

from kfmaps._arrays import refuse
from kfmaps._records import setting, settings_record
from kfmaps.fmap.convert import check_point_map
from kfmaps.geometry.arap import arap_energy, nearest_rotations, rotations
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

_Cached = TypeVar("_Cached")

_PROXY_FROM, _PROXY_VERTICES = 15_000, 5_000
"""Vertices above which a registration begins with coarse proxies, and vertices of a proxy. These are 1.4 % of √area
apart, less than the size of details that the first levels follow."""
_FINE_PROXY_FROM, _FINE_PROXY_VERTICES = 50_000, 40_000
"""Vertices above which the last level is of finer proxies, and vertices of these: factorisations of all take too much
time and memory (research/speed.md)."""
_SCALED_LANDMARK_PULL = (30.0, 0.1)
"""The pull of landmarks with local scaling, between shapes of different proportions, whose maps are less exact than
clicks."""


@dataclass(frozen=True, eq=False)
class Registration:
    """A source registered onto a target, both at unit area."""

    vertices: np.ndarray  # (n_s, 3): of the source, on the target
    faces: np.ndarray  # (n_t,): the source face of each target vertex
    weights: np.ndarray  # (n_t, 3): and its barycentric coordinates there
    bending: float  # as-rigid-as-possible energy per area: 0 for a rigid motion
    gap: float  # root mean square distance of the two surfaces, in both directions, in √area


@settings_record
class NonRigid:
    """Settings of the non-rigid fit; callable as ``(source, target, target_to_source) -> Registration``.

    Details smaller than the root of ``stiffness`` follow the target at the first level. Smoothing of rotations, unless
    it is 0, keeps limbs from being twisted. See also :mod:`kfmaps.registration.local_scaling`.

    Examples
    --------
    >>> kfmaps.Config(registration=kfmaps.NonRigid(steps=3)).registration
    NonRigid(steps=3)
    """

    stiffness: float = setting(2e-4, "stiffness of the first level, in units of area", above=0)
    n_levels: int = setting(3, "levels, each a third (10^-1/2) as stiff as the one before", low=1)
    steps: int = setting(5, "searches for closest points at each level", low=1)
    rotation_smoothing: float = setting(1e-3, "area over which rotations are averaged", low=0)
    local_scaling: float = setting(0.0, "area over which sizes may change evenly, for different proportions", low=0)

    def __call__(
        self,
        source: Mesh,
        target: Mesh,
        target_to_source: np.ndarray,
        progress: Callable[[float], None] | None = None,
        landmarks: np.ndarray | None = None,
        pinned: np.ndarray | None = None,
    ) -> Registration:
        """Register a source onto a target, beginning with a map.

        Parameters
        ----------
        source, target : Mesh
            At unit area.
        target_to_source : (n_t,) int64
        progress : callable, optional
            Called with how much is done, from 0 to 1.
        landmarks : (l, 2) int64, optional
            Pairs "source vertex, target vertex", which are pulled together softly.
        pinned : (n_t,) float64, optional
            From 0 to 1, how strongly each target vertex is pinned to its image in the map.

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
        landmarks = np.zeros((0, 2), dtype=np.int64) if landmarks is None else np.asarray(landmarks)
        n_most, x = max(len(source.vertices), len(target.vertices)), None
        proxies = partial(self._register_proxies, source, target, points, landmarks, pinned)
        if n_most > _PROXY_FROM:
            x, _ = proxies(_PROXY_VERTICES, lambda done: report(0.3 * done))
        body, normals_t = deformable_mesh(source), vertex_normals(target)
        if n_most > _FINE_PROXY_FROM:
            x, gap = proxies(_FINE_PROXY_VERTICES, report, x)
        else:
            pair = mesh_pair(body, target, closest_point_query(target, normals_t))
            x, gap = self.register_vertices(pair, points, x, report, landmarks, pinned)
        projected = project_with_contact(target_to_source, body, x, target, normals_t)
        energy = arap_energy(body.energy, x) / float(body.areas.sum())
        return Registration(x, projected.faces, projected.weights, energy, gap)

    def _register_proxies(
        self,
        source: Mesh,
        target: Mesh,
        points: np.ndarray,
        landmarks: np.ndarray,
        pinned: np.ndarray | None,
        count: int,
        report: Callable[[float], None],
        x: np.ndarray | None = None,
    ) -> tuple[np.ndarray, float]:
        """Register proxies of ``count`` vertices; return the source's vertices (n_s, 3) that follow, and the gap.

        ``x (n_s, 3)``: a nearly registered source; the other parameters are those of :meth:`__call__`.
        """
        a = coarse_proxy(source, spread_vertices(source, count, landmarks[:, 0]))
        b = coarse_proxy(target, spread_vertices(target, count, landmarks[:, 1]))
        body = deformable_mesh(a.mesh)
        x, gap = self.register_vertices(
            mesh_pair(body, b.mesh),
            a.owner[points[b.vertices]],
            None if x is None else x[a.vertices],
            report,
            np.stack([a.owner[landmarks[:, 0]], b.owner[landmarks[:, 1]]], axis=1),
            None if pinned is None else pinned[b.vertices],
        )
        return embedded_deformation(a, source, x, rotations(body.energy, x)), gap

    def register_vertices(
        self,
        pair: MeshPair,
        points: np.ndarray,
        x: np.ndarray | None = None,
        report: Callable[[float], None] = lambda _done: None,
        landmarks: np.ndarray | None = None,
        pinned: np.ndarray | None = None,
    ) -> tuple[np.ndarray, float]:
        """Return the registered vertices (n_s, 3) of a prepared pair, and the gap.

        With ``x (n_s, 3)``, a nearly registered source, only the last level is done. The other parameters are those of
        :meth:`__call__`.
        """
        levels, steps, done_before = range(self.n_levels), self.steps, 0.2
        if x is not None:
            levels, steps, done_before = range(self.n_levels)[-1:], min(self.steps, 2), 0.3
        else:
            places = pair.target.vertices, pair.normals_t, pair.areas_t
            x = pair.once(points.tobytes(), lambda: initial_deformation(pair.body, points, *places))
            report(done_before)
        smooth = _rotation_smoothing(pair, self.rotation_smoothing)
        area = self.local_scaling
        scale = pair.once(("sizes", area), lambda: local_scaling(pair.body.energy, pair.body.areas, area))
        landmarks = np.zeros((0, 2), dtype=np.int64) if landmarks is None else landmarks
        strength = _SCALED_LANDMARK_PULL if self.local_scaling else LANDMARK_PULL
        pull = landmark_pull(pair.body, landmarks[:, 0], pair.target.vertices[landmarks[:, 1]], strength)
        pins = [] if pinned is None or not pinned.any() else [_pin_term(pair, points, pinned)]
        gap = 0.0

        def terms(x: np.ndarray, stiffness: float) -> list[DataTerm]:
            nonlocal gap
            closest, gap = _closest_terms(pair, x)
            return [*closest, *pins, *pull.terms(x, stiffness)]

        def transforms(x: np.ndarray) -> np.ndarray:
            return scale(x, smooth(rotations(pair.body.energy, x)))

        def progress(done: float) -> None:
            report(done_before + (1 - done_before) * done)

        stiffness = [self.stiffness * 10 ** (-0.5 * level) for level in levels]
        return descend_levels(pair.body, x, stiffness, steps, 2.0, terms, transforms, progress), gap


@dataclass(frozen=True, eq=False)
class MeshPair:
    """A source and a target with what several registrations of them share; made by :func:`mesh_pair`."""

    body: DeformableMesh  # the source
    target: Mesh
    areas_t: np.ndarray  # (n_t,): of the target's vertices
    query_t: ClosestPointQuery
    cache: dict[object, Any] = field(default_factory=dict)  # of :meth:`once`

    def once(self, key: object, make: Callable[[], _Cached]) -> _Cached:
        """Return the cached result of ``make`` for a ``key``; several registrations begin alike or are repeated."""
        if key not in self.cache:
            self.cache[key] = make()
        return self.cache[key]

    @property
    def normals_t(self) -> np.ndarray:
        """The normals of the target's vertices, (n_t, 3)."""
        return self.query_t.normals


def mesh_pair(body: DeformableMesh, target: Mesh, query_t: ClosestPointQuery | None = None) -> MeshPair:
    """Return a pair to register; ``query_t``: of the target, if it exists already."""
    return MeshPair(body, target, vertex_areas(target), closest_point_query(target) if query_t is None else query_t)


def _rotation_smoothing(pair: MeshPair, area: float) -> Callable[[np.ndarray], np.ndarray]:
    """Return a function that smooths rotations ``R (n_s, 3, 3)`` by one step of implicit diffusion over ``area``."""
    if area == 0:
        return lambda R: R
    diffuse = pair.body.solver(area, 1.0)
    return lambda R: nearest_rotations(diffuse(pair.body.areas[:, None] * R.reshape(len(R), 9)).reshape(R.shape))


def _pin_term(pair: MeshPair, points: np.ndarray, pinned: np.ndarray) -> DataTerm:
    """Return the term that holds target vertices at their images in the map, with weights ``pinned (n_t,)``."""
    rows = np.flatnonzero(pinned)
    shape = len(rows), len(pair.body.areas)
    selection = csr_array((np.ones(len(rows)), points[rows], np.arange(len(rows) + 1)), shape=shape)
    return DataTerm(pinned[rows] * pair.areas_t[rows], pair.target.vertices[rows], selection)


def _closest_terms(pair: MeshPair, x: np.ndarray) -> tuple[list[DataTerm], float]:
    """Return terms of the closest points in both directions, and the root mean square distance."""
    deformed = Mesh(x, pair.body.mesh.faces)
    normals = vertex_normals(deformed)
    forth, normals_forth, agreement_s = pair.query_t(x, normals)
    query_s = closest_point_query(deformed, normals, pair.body.around)
    back, _, agreement_t = query_s(pair.target.vertices, pair.normals_t)
    rows = barycentric_matrix(back.faces, back.weights, deformed.faces, len(x))
    terms = [
        DataTerm(pair.body.areas * agreement_s, forth.points, None, normals_forth),
        DataTerm(pair.areas_t * agreement_t, pair.target.vertices, rows, pair.normals_t),
    ]
    squares = [
        np.average(forth.distances**2, weights=pair.body.areas),
        np.average(back.distances**2, weights=pair.areas_t),
    ]
    return terms, float(np.sqrt(np.mean(squares)))
