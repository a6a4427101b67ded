"""The source bent onto the target, as the last step of a match: where points slide along the surface it finds back.

A refined functional map is right up to a smooth sliding of points, which its basis hardly sees, and here and there a
limb is twisted or folded. So the source's mesh is bent onto the target as rigidly as possible (Sorkine and Alexa 2007)
by a non-rigid ICP (Amberg et al. 2007) that begins with the map: closest points in both directions, compared with
normals, and distances mostly along the normal, so that points may slide to where they bend the source least.
Neighbouring rotations are kept alike (Levi and Gotsman 2015): their differences are less at the true correspondence
than at a map whose limbs are twisted, where bending alone hardly tells the two apart. Landmarks hold softly. Then each
target vertex takes the closest point on the bent source, inside a triangle.

It comes last: a refinement after it would go back to where it was.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.spatial import KDTree

from kfmaps._arrays import check_count, check_positive, refuse
from kfmaps.functional.points import check_point_map
from kfmaps.functional.pulls import Term, descended
from kfmaps.surface.closest import Places, Rings, closest_of, places_on, rings
from kfmaps.surface.eigen.factor import factorise
from kfmaps.surface.mesh import Mesh, vertex_areas, vertex_normals
from kfmaps.surface.rigidity import Rigidity, bending, nearest_rotations, rigidity, rotations

DECLINE = 10**-0.5
"""Stiffness of a level over that of the one before."""
NORMALS = 0.02
"""Distance in space, at unit area, that counts as much as normals that differ by 1."""
AGREEMENT = 0.3
"""Cosine between two normals from which a pair of closest points counts; fully at 1."""
START = 1e-3
"""Stiffness of the first shape, which follows the map."""
DIFFUSION = 2.5e-3
"""Area over which rotations of the first shape are averaged, halved in each of ..."""
UNFOLDINGS = 3
"""... so many rounds."""
SMOOTH = 1e-4
"""Area over which the map's images are averaged before anything is known of rotations."""
HOLD = 6.0
"""Weight of a landmark over the stiffness of a level: softly enough that those 3 % of √area off do no harm."""
DISC = 1e-3
"""Area around a landmark that goes with it."""
SLOPPY = 0.03
"""Distance from a landmark, in √area, from which its pull fades: a click that is off does no harm."""


@dataclass(frozen=True, eq=False)
class Registered:
    """A source bent onto a target, both at unit area.

    Attributes
    ----------
    vertices : (n_s, 3) float64
        The source's, where they lie on the target.
    faces : (n_t,) int64
        The source face that is closest to each target vertex, ...
    weights : (n_t, 3) float64
        ... and the barycentric coordinates of the closest point in it.
    bending : float
        As-rigid-as-possible energy per area (:func:`kfmaps.surface.rigidity.bending`): 0 for a motion.
    gap : float
        Root of the mean squared distance of the two surfaces, in both directions, in units of √area.
    """

    vertices: np.ndarray
    faces: np.ndarray
    weights: np.ndarray
    bending: float
    gap: float


@dataclass(frozen=True)
class NonRigid:
    """Settings of the non-rigid fit; callable as ``(source, target, target_to_source) -> Registered``.

    Parameters
    ----------
    stiffness : float
        Of the first level, in units of the area: details smaller than its root follow the target.
    levels : int
        Each has a third (``10^-½``) of the stiffness of the one before.
    steps : int
        Searches for closest points at each level.
    evenness : float
        Area over which rotations are averaged, so that limbs are not twisted; 0 leaves each vertex its own.
    """

    stiffness: float = 2e-4
    levels: int = 3
    steps: int = 5
    evenness: float = 1e-3

    def __post_init__(self) -> None:
        check_positive(self.stiffness, "stiffness of the non-rigid fit")
        check_count(self.levels, "levels of the non-rigid fit")
        check_count(self.steps, "steps of the non-rigid fit")
        if self.evenness != 0:
            check_positive(self.evenness, "evenness of the non-rigid fit", "give 0 or a number above it")

    def __call__(
        self,
        source: Mesh,
        target: Mesh,
        target_to_source: np.ndarray,
        progress: Callable[[float], None] | None = None,
        landmarks: np.ndarray | None = None,
        held: np.ndarray | None = None,
    ) -> Registered:
        """Bend ``source`` onto ``target``, beginning with the map ``target_to_source (n_t,)``.

        ``landmarks (l, 2)``, pairs "source vertex, target vertex", are pulled together softly; so is each target
        vertex with its image in the map, where ``held (n_t,)``, from 0 to 1, says that it shall stay.

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
        pair = _pair(source, target)
        x = unfolded(pair, points)
        report(0.2)
        even = _evened(pair, self.evenness)
        marks = np.zeros((0, 2), dtype=np.int64) if landmarks is None else np.asarray(landmarks)
        discs = _discs(pair, marks)
        stays = [] if held is None or not held.any() else [_stays(pair, points, held)]
        gap = 0.0
        for level in range(self.levels):
            stiffness = self.stiffness * DECLINE**level
            solve = _solver(pair, stiffness, 2.0)
            for step in range(self.steps):
                terms, gap = _closest_terms(pair, x)
                terms += stays
                if len(marks):
                    terms.append(_marked(pair, marks, discs, x, HOLD * stiffness))
                x = descended(pair.energy, stiffness, solve, terms, x, even(rotations(pair.energy, x)))
                report(0.2 + 0.8 * (level * self.steps + step + 1) / (self.levels * self.steps))
        found = places_on(target.vertices, x, source.faces)
        energy = bending(pair.energy, x) / float(pair.areas_s.sum())
        return Registered(x, found.faces, found.weights, energy, gap)


@dataclass(frozen=True, eq=False)
class _Pair:
    """Two surfaces and what stays the same while one is bent."""

    source: Mesh
    target: Mesh
    energy: Rigidity
    areas_s: np.ndarray
    areas_t: np.ndarray
    rings_s: Rings
    normals_t: np.ndarray
    look_t: _Look


@dataclass(frozen=True, eq=False)
class _Look:
    """A surface in which closest points with like normals are sought."""

    vertices: np.ndarray
    faces: np.ndarray
    normals: np.ndarray
    around: Rings
    tree: KDTree

    def __call__(self, points: np.ndarray, normals: np.ndarray) -> tuple[Places, np.ndarray, np.ndarray]:
        """Places of ``points (q, 3)`` with ``normals``, the normals there, and how well they agree, 0 to 1."""
        near = self.tree.query(np.hstack([points, NORMALS * normals]))[1]
        found = closest_of(points, self.vertices, self.faces, *self.around.around(near))
        there = _unit(np.einsum("qi,qij->qj", found.weights, self.normals[self.faces[found.faces]]))
        cosine = np.einsum("qi,qi->q", there, normals)
        return found, there, np.clip((cosine - AGREEMENT) / (1 - AGREEMENT), 0.0, 1.0)


def _pair(source: Mesh, target: Mesh) -> _Pair:
    normals = vertex_normals(target)
    return _Pair(
        source,
        target,
        rigidity(source),
        vertex_areas(source),
        vertex_areas(target),
        rings(source.faces, len(source.vertices)),
        normals,
        _look(target, normals, rings(target.faces, len(target.vertices))),
    )


def _look(mesh: Mesh, normals: np.ndarray, around: Rings) -> _Look:
    return _Look(mesh.vertices, mesh.faces, normals, around, KDTree(np.hstack([mesh.vertices, NORMALS * normals])))


def _unit(rows: np.ndarray) -> np.ndarray:
    return rows / np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), 1e-12)


def _solver(pair: _Pair, stiffness: float, data: float) -> Callable[[np.ndarray], np.ndarray]:
    """Solves with ``stiffness L + data A``: the preconditioner of one level, factorised once for all its steps."""
    return factorise(stiffness * pair.energy.laplacian + diags_array(data * pair.areas_s), ordered=False)


def _evened(pair: _Pair, area: float) -> Callable[[np.ndarray], np.ndarray]:
    """Averages rotations ``(n_s, 3, 3)`` with those around: one step of implicit diffusion over ``area``."""
    if area == 0:
        return lambda turns: turns
    diffuse = factorise(area * pair.energy.laplacian + diags_array(pair.areas_s), ordered=False)
    return lambda turns: nearest_rotations(
        diffuse(pair.areas_s[:, None] * turns.reshape(len(turns), 9)).reshape(turns.shape)
    )


def _stays(pair: _Pair, points: np.ndarray, held: np.ndarray) -> Term:
    """The map itself as a term, with weights ``held (n_t,)``."""
    some = np.flatnonzero(held)
    rows = csr_array((np.ones(len(some)), points[some], np.arange(len(some) + 1)), shape=(len(some), len(pair.areas_s)))
    return Term(held[some] * pair.areas_t[some], pair.target.vertices[some], rows)


def _discs(pair: _Pair, landmarks: np.ndarray) -> np.ndarray:
    """How much of each source vertex belongs to each landmark of ``(l, 2)``: columns (n_s, l) with sum 1."""
    n, count = len(pair.areas_s), len(landmarks)
    if count == 0:
        return np.zeros((n, 0))
    points = np.zeros((n, count))
    points[landmarks[:, 0], np.arange(count)] = 1.0
    diffuse = factorise(DISC * pair.energy.laplacian + diags_array(pair.areas_s), ordered=False)
    return pair.areas_s[:, None] * np.asarray(diffuse(points)).reshape(n, count)


def _marked(pair: _Pair, landmarks: np.ndarray, discs: np.ndarray, x: np.ndarray, weight: float) -> Term:
    """Landmarks ``(l, 2)`` as a term: each takes its disc along, those that are far off with less weight."""
    missing = pair.target.vertices[landmarks[:, 1]] - x[landmarks[:, 0]]
    shares = weight * discs / (1 + (missing**2).sum(axis=1) / SLOPPY**2) ** 2
    held = shares.sum(axis=1)
    return Term(held, x + shares @ missing / np.maximum(held, 1e-300)[:, None])


def _closest_terms(pair: _Pair, x: np.ndarray) -> tuple[list[Term], float]:
    """Closest points in both directions as terms, and how far the surfaces are apart (root mean square)."""
    bent = Mesh(x, pair.source.faces)
    normals = vertex_normals(bent)
    forth, there, agree_s = pair.look_t(x, normals)
    back, _, agree_t = _look(bent, normals, pair.rings_s)(pair.target.vertices, pair.normals_t)
    terms = [
        Term(pair.areas_s * agree_s, forth.points, None, there),
        Term(pair.areas_t * agree_t, pair.target.vertices, _rows(pair, back), pair.normals_t),
    ]
    squares = [
        np.average(places.distances**2, weights=areas)
        for places, areas in ((forth, pair.areas_s), (back, pair.areas_t))
    ]
    return terms, float(np.sqrt(np.mean(squares)))


def _rows(pair: _Pair, places: Places) -> Any:
    """Sparse ``(q, n_s)``: what takes the source's vertices to ``places`` on it."""
    q = len(places.faces)
    corners = pair.source.faces[places.faces].ravel()
    return csr_array((places.weights.ravel(), corners, 3 * np.arange(q + 1)), shape=(q, len(pair.source.vertices)))


def unfolded(pair: _Pair, points: np.ndarray) -> np.ndarray:
    """The first shape of the source, ``(n_s, 3)``: where the map says, but where the map folds, as the surroundings do.

    Each source vertex goes to the mean of the target vertices that it is the image of, and between them smoothly.
    Where the normals of that shape disagree with those of the target the map is folded or twisted: there vertices
    have no say, and rotations are carried over from the surroundings by diffusion.
    """
    n = len(pair.source.vertices)
    rows = csr_array((np.ones(len(points)), points, np.arange(len(points) + 1)), shape=(len(points), n))
    gathered = rows.T @ np.hstack(
        [pair.areas_t[:, None] * pair.target.vertices, pair.areas_t[:, None] * pair.normals_t]
    )
    smooth = factorise(SMOOTH * pair.energy.laplacian + diags_array(rows.T @ pair.areas_t), ordered=False)(gathered)
    x, wanted = np.ascontiguousarray(smooth[:, :3]), _unit(smooth[:, 3:])
    solve = _solver(pair, START, 1.0)
    for round in range(UNFOLDINGS):
        normals = vertex_normals(Mesh(x, pair.source.faces))
        trust = np.clip(np.einsum("ij,ij->i", normals, wanted), 0.0, 1.0)
        held = pair.areas_s * (trust + 1e-3)
        turns = rotations(pair.energy, x).reshape(n, 9)
        diffusion = factorise(DIFFUSION * 0.5**round * pair.energy.laplacian + diags_array(held), ordered=False)
        turns = nearest_rotations(diffusion(held[:, None] * turns).reshape(n, 3, 3))
        terms = [Term(pair.areas_t * trust[points], pair.target.vertices, rows)]
        x = descended(pair.energy, START, solve, terms, x, turns, 8)
        x = descended(pair.energy, START, solve, terms, x, rotations(pair.energy, x), 8)
    return x
