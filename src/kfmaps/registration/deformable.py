"""A surface that is bent, and one on which closest points are sought: what whole shapes and parts are bent with."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial import KDTree

from kfmaps.geometry.arap import ArapEnergy, arap_rhs, build_arap, nearest_rotations, rotations
from kfmaps.geometry.closest_points import ClosestPoints, closest_among
from kfmaps.geometry.connectivity import VertexRings, component_labels, vertex_rings
from kfmaps.geometry.eigen.factorization import Solve, SparseMatrix
from kfmaps.geometry.mesh import Mesh, unit_rows, vertex_areas, vertex_normals

NORMALS = 0.02
"""Distance in space, at unit area, that counts as much as normals that differ by 1."""
_MIN_COSINE = 0.3  # cosine between two normals from which a pair of closest points counts; fully at 1
_ALONG = 0.03  # weight of squared distances along the surface, against 1 along its normal
LANDMARK_PULL = (10.0, 0.045)
"""Weight of a landmark over the stiffness of a level, and distance in √area from which its pull fades: one that is 2 %
of √area off does no harm."""


@dataclass(frozen=True, eq=False)
class ClosestPointQuery:
    """A surface in which closest points with like normals are sought."""

    vertices: np.ndarray
    faces: np.ndarray
    normals: np.ndarray
    around: VertexRings
    tree: KDTree

    def __call__(self, points: np.ndarray, normals: np.ndarray) -> tuple[ClosestPoints, np.ndarray, np.ndarray]:
        """Find the closest points of the surface with like normals.

        ``points (q, 3)`` and ``normals (q, 3)``. Returns ``found``; ``normals (q, 3)``: of the surface there;
        ``agreement (q,)``: of the normals, 0 to 1.
        """
        near = self.tree.query(np.hstack([points, NORMALS * normals]))[1]
        found = closest_among(points, self.vertices, self.faces, *self.around.around(near))
        there = unit_rows(np.einsum("qi,qij->qj", found.weights, self.normals[self.faces[found.faces]]))
        cosine = np.einsum("qi,qi->q", there, normals)
        return found, there, np.clip((cosine - _MIN_COSINE) / (1 - _MIN_COSINE), 0.0, 1.0)


def closest_point_query(
    mesh: Mesh, normals: np.ndarray | None = None, around: VertexRings | None = None
) -> ClosestPointQuery:
    """Return a mesh ready to search for closest points with like normals.

    ``normals (n, 3)``: of its vertices, where they are known; ``around``: its rings, where they are known.
    """
    normals = vertex_normals(mesh) if normals is None else normals
    around = vertex_rings(mesh.faces, len(mesh.vertices)) if around is None else around
    return ClosestPointQuery(
        mesh.vertices, mesh.faces, normals, around, KDTree(np.hstack([mesh.vertices, NORMALS * normals]))
    )


@dataclass(frozen=True, eq=False)
class DataTerm:
    """``Σ_q weights_q ‖P_q((rows x)_q − places_q)‖²``, ``P`` shortened to 0.03 across ``normals``.

    ``rows`` is sparse ``(q, n_s)``, ``None`` for the vertices themselves; without normals ``P`` is the identity.
    """

    weights: np.ndarray
    places: np.ndarray
    rows: SparseMatrix = None
    normals: np.ndarray | None = None

    def at(self, x: np.ndarray) -> np.ndarray:
        """Return the matrix of the term times ``x (n_s, 3)``."""
        inside = self._shortened(x if self.rows is None else self.rows @ x)
        return inside if self.rows is None else self._columns @ inside

    def right(self) -> np.ndarray:
        """Return the right-hand side, (n_s, 3)."""
        inside = self._shortened(self.places)
        return inside if self.rows is None else self._columns @ inside

    @cached_property
    def _columns(self) -> SparseMatrix:
        return self.rows.T

    def _shortened(self, z: np.ndarray) -> np.ndarray:
        if self.normals is None:
            return self.weights[:, None] * z
        along = np.einsum("qi,qi->q", self.normals, z)
        return self.weights[:, None] * (_ALONG * z + ((1 - _ALONG) * along)[:, None] * self.normals)


@dataclass(frozen=True, eq=False)
class DeformableMesh:
    """A surface at rest, and what stays the same while it is bent; made by :func:`deformable_mesh`."""

    mesh: Mesh
    energy: ArapEnergy
    areas: np.ndarray  # (n,): of the vertices
    around: VertexRings
    # What :meth:`solver` has made, to be found again; ``None`` keeps nothing, since the factors of a large mesh are
    # large.
    solvers: dict[tuple[float, float], Solve] | None = None

    def solver(self, stiffness: float, data: float) -> Solve:
        """Return what solves with ``stiffness L + data A``: a preconditioner, factorised once for a level."""
        kept, key = self.solvers, (stiffness, data)
        if kept is not None and key in kept:
            return kept[key]
        solve = self.energy.factorize(stiffness, data * self.areas)
        if kept is not None:
            kept[key] = solve
        return solve


def deformable_mesh(mesh: Mesh, solvers: dict[tuple[float, float], Solve] | None = None) -> DeformableMesh:
    """Return ``mesh`` as a surface at rest; a dictionary of ``solvers`` keeps their factors."""
    return DeformableMesh(
        mesh, build_arap(mesh), vertex_areas(mesh), vertex_rings(mesh.faces, len(mesh.vertices)), solvers
    )


def initial_deformation(
    body: DeformableMesh, points: np.ndarray, places: np.ndarray, normals: np.ndarray, weights: np.ndarray
) -> np.ndarray:
    """Return where the vertices begin, (n, 3): at given places, or where the surroundings go if those fold it.

    Each vertex goes to the weighted mean of the places that are its own, and the vertices between them smoothly. Where
    the normals of that shape disagree with those given the placing is folded or twisted: there the vertices do not
    count, and rotations are carried over from the surroundings by diffusion.

    ``points (q,)``: vertices that have places; ``places (q, 3)`` and ``normals (q, 3)``; ``weights (q,)``.
    """
    n, energy = len(body.areas), body.energy
    rows = csr_array((np.ones(len(points)), points, np.arange(len(points) + 1)), shape=(len(points), n))
    gathered = rows.T @ np.hstack([weights[:, None] * places, weights[:, None] * normals])
    share = rows.T @ weights
    # The places of a vertex pull as one with their sum of weights does at their mean.
    own, mean = share.copy(), gathered[:, :3] / np.where(share > 0, share, 1.0)[:, None]
    _take_along(body.mesh, share, gathered)
    smooth = energy.factorize(1e-4, share)(gathered)
    x, wanted = np.ascontiguousarray(smooth[:, :3]), unit_rows(smooth[:, 3:])
    initial_stiffness = 1e-3  # stiffness of the first shape, which follows the map
    solve = body.solver(initial_stiffness, 1.0)
    for round in range(3):
        agreement = np.einsum("ij,ij->i", vertex_normals(Mesh(x, body.mesh.faces)), wanted)
        trust = np.clip(agreement, 0.0, 1.0)
        held = body.areas * (trust + 1e-3)
        turns = rotations(energy, x).reshape(n, 9)
        diffusion = energy.factorize(2.5e-3 * 0.5**round, held)
        turns = nearest_rotations(diffusion(held[:, None] * turns).reshape(n, 3, 3))
        terms = [DataTerm(trust * own, mean)]
        x = descend(energy, initial_stiffness, solve, terms, x, turns, 8)
        x = descend(energy, initial_stiffness, solve, terms, x, rotations(energy, x), 8)
    return x


def descend(
    energy: ArapEnergy,
    stiffness: float,
    solve: Callable[[np.ndarray], np.ndarray],
    terms: list[DataTerm],
    x: np.ndarray,
    turns: np.ndarray,
    steps: int = 3,
) -> np.ndarray:
    """Return ``x`` after a few steps of conjugate gradients on the quadratic energy for fixed rotations and terms.

    Every step lowers that energy, so that none needs to be exact.

    ``stiffness``: its weight, in units of area; ``solve``: the preconditioner; ``x (n, 3)``; ``turns (n, 3, 3)``:
    matrices that turn the rest shape of each vertex's surroundings.
    """

    def apply(z: np.ndarray) -> np.ndarray:
        return stiffness * (energy.laplacian @ z) + sum(term.at(z) for term in terms)

    residual = stiffness * arap_rhs(energy, turns) + sum(term.right() for term in terms) - apply(x)
    direction = towards = solve(residual)
    size = float(np.sum(residual * towards))
    for step in range(steps):
        if not size > 0:
            break
        image = apply(direction)
        length = size / float(np.sum(direction * image))
        x = x + length * direction
        if step == steps - 1:
            break
        residual = residual - length * image
        towards = solve(residual)
        before, size = size, float(np.sum(residual * towards))
        direction = towards + size / before * direction
    return x


def descend_levels(
    body: DeformableMesh,
    x: np.ndarray,
    levels: Sequence[float],
    steps: int,
    data: float,
    terms: Callable[[np.ndarray, float], list[DataTerm]],
    turns: Callable[[np.ndarray], np.ndarray],
    progress: Callable[[float], None],
) -> np.ndarray:
    """Return the deformed vertices (n, 3) after non-rigid ICP, each level less stiff than the one before.

    ``x (n, 3)``: where the vertices begin; ``levels``: stiffness of each level, in units of area; ``steps``: searches
    for closest points at each level; ``data``: weight of the data terms beside that stiffness in the preconditioner;
    ``terms``: data terms at ``x`` and a stiffness; ``turns``: matrices (n, 3, 3) that turn the rest shape of each
    vertex's surroundings at ``x``; ``progress``: told how much is done, from 0 to 1.
    """
    for i, stiffness in enumerate(levels):
        solve = body.solver(stiffness, data)
        for step in range(steps):
            found = terms(x, stiffness)
            x = descend(body.energy, stiffness, solve, found, x, turns(x))
            progress((i * steps + step + 1) / (len(levels) * steps))
    return x


@dataclass(frozen=True, eq=False)
class LandmarkPull:
    """Landmarks that pull a surface softly; made by :func:`landmark_pull`."""

    vertices: np.ndarray  # (l,): of the surface
    places: np.ndarray  # (l, 3): where these belong
    discs: np.ndarray  # (n, l): how much of each vertex's area belongs to each landmark; columns have sum 1
    weight: float  # over the stiffness of a level
    fading: float  # distance from which the pull fades

    def terms(self, x: np.ndarray, stiffness: float) -> list[DataTerm]:
        """Return one term or none: each landmark takes its disc along, those far off with less weight."""
        if len(self.vertices) == 0:
            return []
        missing = self.places - x[self.vertices]
        shares = self.weight * stiffness * self.discs / (1 + (missing**2).sum(axis=1) / self.fading**2) ** 2
        held = shares.sum(axis=1)
        return [DataTerm(held, x + shares @ missing / np.maximum(held, 1e-300)[:, None])]


def landmark_pull(
    body: DeformableMesh, vertices: np.ndarray, places: np.ndarray, pull: tuple[float, float] = LANDMARK_PULL
) -> LandmarkPull:
    """Return how landmarks pull a surface: its ``vertices (l,)`` belong at ``places (l, 3)``."""
    points = np.zeros((len(body.areas), len(vertices)))
    points[vertices, np.arange(len(vertices))] = 1.0
    discs = body.areas[:, None] * body.solver(1e-3, 1.0)(points).reshape(points.shape) if len(vertices) else points
    return LandmarkPull(vertices, places, discs, *pull)


def _take_along(mesh: Mesh, share: np.ndarray, gathered: np.ndarray) -> None:
    """Let a component without any place go with the nearest vertex that has one; fills in ``gathered (n, 6)``.

    Nothing would hold it, and with its ``share (n,)`` of 0 the linear system would be singular.
    """
    n = len(mesh.vertices)
    ends = mesh.faces[:, :2].ravel(), mesh.faces[:, 1:].ravel()
    label = component_labels(n, *ends)[1]
    lost = np.flatnonzero((np.bincount(label, share) == 0)[label])
    held = np.flatnonzero(share > 0)
    if len(lost) == 0 or len(held) == 0:
        return
    beside = held[KDTree(mesh.vertices[held]).query(mesh.vertices[lost])[1]]
    moved = gathered[beside, :3] / share[beside, None] - mesh.vertices[beside]
    gathered[lost] = np.hstack([mesh.vertices[lost] + moved, vertex_normals(mesh)[lost]])
    share[lost] = 1.0
