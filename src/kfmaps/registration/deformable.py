"""Deformable meshes, closest-point queries and data terms, for registrations of whole shapes and parts."""

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
LANDMARK_PULL = (10.0, 0.045)
"""Weight of a landmark over the stiffness of a level, and distance in √area from which its pull fades. Landmarks that
are 2 % of √area off do no harm."""


@dataclass(frozen=True, eq=False)
class ClosestPointQuery:
    """A search for the closest points of a surface with similar normals; made by :func:`closest_point_query`."""

    vertices: np.ndarray
    faces: np.ndarray
    normals: np.ndarray
    around: VertexRings
    tree: KDTree

    def __call__(self, points: np.ndarray, normals: np.ndarray) -> tuple[ClosestPoints, np.ndarray, np.ndarray]:
        """Return the closest points, their normals (q, 3), and how well these agree with those given, 0 to 1, (q,).

        ``points (q, 3)`` and ``normals (q, 3)``: the queries.
        """
        nearest = self.tree.query(np.hstack([points, NORMALS * normals]))[1]
        closest = closest_among(points, self.vertices, self.faces, *self.around.around(nearest))
        closest_normals = unit_rows(np.einsum("qi,qij->qj", closest.weights, self.normals[self.faces[closest.faces]]))
        cosine = np.einsum("qi,qi->q", closest_normals, normals)
        least = 0.3  # cosine of the normals of two closest points from which the pair counts; fully at 1
        return closest, closest_normals, np.clip((cosine - least) / (1 - least), 0.0, 1.0)


def closest_point_query(
    mesh: Mesh, normals: np.ndarray | None = None, around: VertexRings | None = None
) -> ClosestPointQuery:
    """Return the query of a mesh; ``normals (n, 3)`` and ``around``: its normals and rings, if they are known."""
    normals = vertex_normals(mesh) if normals is None else normals
    around = vertex_rings(mesh.faces, len(mesh.vertices)) if around is None else around
    return ClosestPointQuery(
        mesh.vertices, mesh.faces, normals, around, KDTree(np.hstack([mesh.vertices, NORMALS * normals]))
    )


@dataclass(frozen=True, eq=False)
class DataTerm:
    """``Σ_q weights_q (r_qᵀ P_q r_q)`` with residuals ``r = rows x − places`` and ``P = 0.03 I + 0.97 n nᵀ``."""

    weights: np.ndarray  # (q,)
    places: np.ndarray  # (q, 3)
    rows: SparseMatrix = None  # (q, n_s): ``None`` is the identity
    normals: np.ndarray | None = None  # (q, 3): ``n``; without them ``P`` is the identity

    def at(self, x: np.ndarray) -> np.ndarray:
        """Return the matrix of the term times ``x (n_s, 3)``."""
        weighted = self._weighted(x if self.rows is None else self.rows @ x)
        return weighted if self.rows is None else self._columns @ weighted

    def right(self) -> np.ndarray:
        """Return the right-hand side, (n_s, 3)."""
        weighted = self._weighted(self.places)
        return weighted if self.rows is None else self._columns @ weighted

    @cached_property
    def _columns(self) -> SparseMatrix:
        return self.rows.T

    def _weighted(self, z: np.ndarray) -> np.ndarray:
        """Return ``weights P z`` of ``z (q, 3)``."""
        if self.normals is None:
            return self.weights[:, None] * z
        normal_parts = np.einsum("qi,qi->q", self.normals, z)
        along = 0.03  # weight of squared distances along the surface, against 1 along its normal
        return self.weights[:, None] * (along * z + ((1 - along) * normal_parts)[:, None] * self.normals)


@dataclass(frozen=True, eq=False)
class DeformableMesh:
    """A mesh at rest with what its deformations share; made by :func:`deformable_mesh`."""

    mesh: Mesh
    energy: ArapEnergy
    areas: np.ndarray  # (n,): of the vertices
    around: VertexRings
    solvers: dict[tuple[float, float], Solve] | None = None  # cache of :meth:`solver`; ``None``: none, to save memory

    def solver(self, stiffness: float, data: float) -> Solve:
        """Return the function that solves with ``stiffness L + data A``, the preconditioner of a level."""
        cache, key = self.solvers, (stiffness, data)
        if cache is not None and key in cache:
            return cache[key]
        solve = self.energy.factorize(stiffness, data * self.areas)
        if cache is not None:
            cache[key] = solve
        return solve


def deformable_mesh(mesh: Mesh, solvers: dict[tuple[float, float], Solve] | None = None) -> DeformableMesh:
    """Return ``mesh`` prepared for deformations; ``solvers``: an empty dictionary caches its factors."""
    return DeformableMesh(
        mesh, build_arap(mesh), vertex_areas(mesh), vertex_rings(mesh.faces, len(mesh.vertices)), solvers
    )


def initial_deformation(
    body: DeformableMesh, points: np.ndarray, places: np.ndarray, normals: np.ndarray, weights: np.ndarray
) -> np.ndarray:
    """Return the initial vertices (n, 3) of a registration, at given positions except where these fold the surface.

    Each vertex goes to the weighted mean of its positions, those between smoothly. Where the normals of that shape
    disagree with the given ones, the positions are folded or twisted. There they count less, and rotations are diffused
    from the surroundings.

    ``points (q,)``: vertices, repeated as need be; ``places (q, 3)`` and ``normals (q, 3)``: for them; ``weights
    (q,)``.
    """
    n, energy = len(body.areas), body.energy
    selection = csr_array((np.ones(len(points)), points, np.arange(len(points) + 1)), shape=(len(points), n))
    sums = selection.T @ np.hstack([weights[:, None] * places, weights[:, None] * normals])
    total = selection.T @ weights
    # All positions of a vertex pull like their mean with the sum of their weights.
    data_weights, means = total.copy(), sums[:, :3] / np.where(total > 0, total, 1.0)[:, None]
    _move_components_along(body.mesh, total, sums)
    smooth = energy.factorize(1e-4, total)(sums)
    x, smooth_normals = np.ascontiguousarray(smooth[:, :3]), unit_rows(smooth[:, 3:])
    initial_stiffness = 1e-3
    solve = body.solver(initial_stiffness, 1.0)
    for round in range(3):
        agreement = np.einsum("ij,ij->i", vertex_normals(Mesh(x, body.mesh.faces)), smooth_normals)
        trust = np.clip(agreement, 0.0, 1.0)
        mass = body.areas * (trust + 1e-3)
        diffuse = energy.factorize(2.5e-3 * 0.5**round, mass)
        R = nearest_rotations(diffuse(mass[:, None] * rotations(energy, x).reshape(n, 9)).reshape(n, 3, 3))
        terms = [DataTerm(trust * data_weights, means)]
        x = descend(energy, initial_stiffness, solve, terms, x, R, 8)
        x = descend(energy, initial_stiffness, solve, terms, x, rotations(energy, x), 8)
    return x


def descend(
    energy: ArapEnergy,
    stiffness: float,
    solve: Callable[[np.ndarray], np.ndarray],
    terms: list[DataTerm],
    x: np.ndarray,
    R: np.ndarray,
    steps: int = 3,
) -> np.ndarray:
    """Return ``x (n, 3)`` after a few steps of conjugate gradients on the energy for fixed transforms and terms.

    The energy is ``stiffness`` (in units of area) times the as-rigid-as-possible energy, with the transforms ``R (n, 3,
    3)`` of the vertices' surroundings, plus the terms. ``solve``: the preconditioner.
    """

    def apply(z: np.ndarray) -> np.ndarray:
        return stiffness * (energy.laplacian @ z) + sum(term.at(z) for term in terms)

    r = stiffness * arap_rhs(energy, R) + sum(term.right() for term in terms) - apply(x)
    p = z = solve(r)
    rz = float(np.sum(r * z))
    for step in range(steps):
        if not rz > 0:
            break
        q = apply(p)
        alpha = rz / float(np.sum(p * q))
        x = x + alpha * p
        if step == steps - 1:
            break
        r = r - alpha * q
        z = solve(r)
        previous, rz = rz, float(np.sum(r * z))
        p = z + rz / previous * p
    return x


def descend_levels(
    body: DeformableMesh,
    x: np.ndarray,
    levels: Sequence[float],
    steps: int,
    data: float,
    terms: Callable[[np.ndarray, float], list[DataTerm]],
    transforms: Callable[[np.ndarray], np.ndarray],
    progress: Callable[[float], None],
) -> np.ndarray:
    """Return the deformed vertices (n, 3) after non-rigid ICP, each level less stiff than the one before.

    ``x (n, 3)``: initial vertices; ``levels``: stiffness of each level, in units of area; ``steps``: searches for
    closest points at each level; ``data``: weight of the data terms beside that stiffness in the preconditioner;
    ``terms``: data terms at ``x`` and a stiffness; ``transforms``: of the vertices' surroundings (n, 3, 3) at ``x``;
    ``progress``: called with how much is done, from 0 to 1.
    """
    for i, stiffness in enumerate(levels):
        solve = body.solver(stiffness, data)
        for step in range(steps):
            data_terms = terms(x, stiffness)
            x = descend(body.energy, stiffness, solve, data_terms, x, transforms(x))
            progress((i * steps + step + 1) / (len(levels) * steps))
    return x


@dataclass(frozen=True, eq=False)
class LandmarkPull:
    """Landmarks that pull a surface softly; made by :func:`landmark_pull`."""

    vertices: np.ndarray  # (l,): of the surface
    places: np.ndarray  # (l, 3): their targets
    discs: np.ndarray  # (n, l): a smooth disc around each landmark, integrated at the vertices, with sum 1
    weight: float  # over the stiffness of a level
    fading: float  # distance from which the pull fades

    def terms(self, x: np.ndarray, stiffness: float) -> list[DataTerm]:
        """Return a term, or none without landmarks, that moves discs to their targets, far ones with less weight."""
        if len(self.vertices) == 0:
            return []
        offsets = self.places - x[self.vertices]
        weights = self.weight * stiffness * self.discs / (1 + (offsets**2).sum(axis=1) / self.fading**2) ** 2
        total = weights.sum(axis=1)
        return [DataTerm(total, x + weights @ offsets / np.maximum(total, 1e-300)[:, None])]


def landmark_pull(
    body: DeformableMesh, vertices: np.ndarray, places: np.ndarray, pull: tuple[float, float] = LANDMARK_PULL
) -> LandmarkPull:
    """Return the pull of landmarks, ``vertices (l,)`` of a surface, towards ``places (l, 3)``."""
    points = np.zeros((len(body.areas), len(vertices)))
    points[vertices, np.arange(len(vertices))] = 1.0
    discs = body.areas[:, None] * body.solver(1e-3, 1.0)(points).reshape(points.shape) if len(vertices) else points
    return LandmarkPull(vertices, places, discs, *pull)


def _move_components_along(mesh: Mesh, total: np.ndarray, sums: np.ndarray) -> None:
    """Move components without positions along with the nearest vertex that has one, by filling in the arguments.

    Nothing else determines them. ``total (n,)`` and ``sums (n, 6)``: weights, and weighted positions and normals.
    """
    n = len(mesh.vertices)
    label = component_labels(n, mesh.faces[:, :2].ravel(), mesh.faces[:, 1:].ravel())[1]
    free = np.flatnonzero((np.bincount(label, total) == 0)[label])
    placed = np.flatnonzero(total > 0)
    if len(free) == 0 or len(placed) == 0:
        return
    nearest = placed[KDTree(mesh.vertices[placed]).query(mesh.vertices[free])[1]]
    shifts = sums[nearest, :3] / total[nearest, None] - mesh.vertices[nearest]
    sums[free] = np.hstack([mesh.vertices[free] + shifts, vertex_normals(mesh)[free]])
    total[free] = 1.0
