"""How far a map can be trusted at each vertex, judged without the truth: are distances to the surroundings kept?

Going to the source and back with the nearest neighbours of one functional map tells next to nothing once the map is
refined: right or wrong, nine vertices in ten come back to within an edge or two. What a wrong part of a map does change
is distances. The comparison is in research/local-confidence.md, made by ``benchmarks/confidence.py``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from kfmaps._arrays import blocks
from kfmaps.fmap.convert import check_point_map
from kfmaps.geometry.clean import CleanedMesh, clean_mesh
from kfmaps.geometry.closest_points import barycentric_matrix, closest_among
from kfmaps.geometry.coarsen import CoarseProxy, coarse_proxy, spread_vertices
from kfmaps.geometry.connectivity import VertexRings, vertex_rings
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh, unit_area, vertex_areas
from kfmaps.geometry.sampling import stratified

_RADIUS = 0.2
"""How far a sample may be from a vertex to count as its surroundings, in √area: some twenty samples are that near."""
_BLOCK = 64  # samples worked on together, which bounds the memory
_LARGE, _COPY_VERTICES = 10_000, 6_000
"""Vertices above which distances are found on a coarse copy, and vertices of the copy. Of 20,000 vertices confidences
made of both differ by 0.009 on average."""


def local_confidence(
    source: Mesh, target: Mesh, target_to_source: np.ndarray, samples: np.ndarray | None = None, *, sized: bool = False
) -> np.ndarray:
    """Return how well a map keeps each target vertex's distances to its surroundings, (n_t,), from 0 to 1.

    With ``d_s``, ``d_t`` distances along edges of the shapes at unit area, ``T`` the map, and the sum over the samples
    ``j`` with ``d_t(i, j) ≤ R = 0.2``, the confidence of vertex ``i`` is ``max(0, 1 − Σ |min(d_s(T(i), T(j)), 2R) −
    d_t(i, j)| / Σ d_t(i, j))``.

    An isometry has 1; distances along edges make 0.9 of it where the triangulations differ. It sees local errors and
    torn parts. It cannot see that a whole shape, or most of a limb, is mapped to its mirror image: that is for the
    verdict and the alternatives to say.

    Parameters
    ----------
    source, target : Mesh
        In any units; point clouds too, along the graph of their nearest neighbours.
    target_to_source : (n_t,) int
        −1 where a vertex has no counterpart: nothing can be told there.
    samples : (q,) int, optional
        Target vertices; by default 200, one from each of as many compact regions of equal area.
    sized : bool
        Whether lengths of both can be compared as they are, in units of √area of the larger: of a part and a whole.

    Returns
    -------
    (n_t,) float64
        0 where nothing can be told: at vertices that no face uses, on specks
        (:func:`kfmaps.geometry.clean.clean_mesh`), and where no sample is in the surroundings.

    Raises
    ------
    InvalidInput
        When the map does not fit the two shapes, or one of them has no area.
    """
    return build_local_distortion(source, target, samples, sized=sized)(target_to_source)


@dataclass(frozen=True, eq=False)
class LocalDistortion:
    """What is the same for all maps between two shapes; made by :func:`build_local_distortion`."""

    part_s: CleanedMesh
    part_t: CleanedMesh
    reach_s: Callable[..., np.ndarray]  # distances on the cleaned source
    samples: np.ndarray  # (q,): vertices of the cleaned target
    # For each 64 samples, which of them is how far from which vertex of the target, where it is near.
    near: tuple[tuple[np.ndarray, np.ndarray, np.ndarray], ...]

    def __call__(self, target_to_source: np.ndarray) -> np.ndarray:
        """:func:`local_confidence` of a map (n_t,)."""
        part_s, part_t = self.part_s, self.part_t
        points = np.asarray(target_to_source)
        lost = points < 0
        points = check_point_map(np.where(points == -1, 0, points), len(part_s.to_clean), len(part_t.to_clean))
        points, lost = part_s.to_clean[points][part_t.to_original], lost[part_t.to_original]
        n = len(points)
        change, whole = np.zeros(n), np.zeros(n)
        for part, near in zip(blocks(len(self.samples), _BLOCK), self.near, strict=True):
            there = self.reach_s(indices=points[self.samples[part]], limit=2 * _RADIUS)
            rows, columns, here = near
            if lost.any():
                kept = ~(lost[self.samples[part]][rows] | lost[columns])
                rows, columns, here = rows[kept], columns[kept], here[kept]
            moved = np.abs(np.minimum(there[rows, points[columns]], 2 * _RADIUS) - here)
            change += np.bincount(columns, moved, minlength=n)
            whole += np.bincount(columns, here, minlength=n)
        # Vertices in one place are surroundings of no size.
        trust = 1 - np.divide(change, whole, out=np.ones(n), where=whole > 1e-9)
        return np.where(part_t.unreferenced, 0.0, np.maximum(trust, 0.0)[part_t.to_clean])


def build_local_distortion(
    source: Mesh, target: Mesh, samples: np.ndarray | None = None, *, sized: bool = False
) -> LocalDistortion:
    """Return what :func:`local_confidence` needs of two shapes, whatever the map.

    The parameters and errors are those of :func:`local_confidence`.
    """
    part_s, part_t = clean_mesh(source, specks=True), clean_mesh(target, specks=True)
    if samples is not None and not part_t.whole:
        samples = np.unique(part_t.to_clean[samples[~part_t.unreferenced[samples]]])
    source, target = part_s.mesh, part_t.mesh
    if not sized:
        source, target = unit_area(source), unit_area(target)
    if samples is None:
        areas = vertex_areas(target)
        used = np.flatnonzero(areas > 0)
        samples = used[stratified(target.vertices[used], areas[used], 200, rng=0)]
    reach_t, near = approximate_geodesics(target), []
    for part in blocks(len(samples), _BLOCK):
        here = reach_t(indices=samples[part], limit=_RADIUS)
        rows, columns = np.nonzero(here <= _RADIUS)
        near.append((rows, columns, here[rows, columns]))
    return LocalDistortion(part_s, part_t, approximate_geodesics(source), samples, tuple(near))


@dataclass(frozen=True, eq=False)
class _CoarseDistances:
    """Distances on a large surface, ``vertices (n, 3)``, found along the edges of a coarse copy."""

    vertices: np.ndarray
    copy: CoarseProxy
    around: VertexRings  # of the copy
    graph: csr_array  # of the copy's edges
    weights: csr_array  # (n, m): take values from the copy's vertices

    def __call__(self, indices: np.ndarray, limit: float) -> np.ndarray:
        """Return distances (q, n), each source a further vertex of the copy, joined to the triangles it lies at."""
        m, q, graph = len(self.copy.vertices), len(indices), self.graph
        faces, source = self.around.around(self.copy.owner[indices])
        ends = np.unique(np.repeat(source, 3) * m + self.copy.mesh.faces[faces].ravel())
        source, corner = np.divmod(ends, m)
        lengths = np.linalg.norm(self.vertices[indices[source]] - self.copy.mesh.vertices[corner], axis=1)
        starts = np.concatenate([graph.indptr, graph.indptr[-1] + np.cumsum(np.bincount(source, minlength=q))])
        data = np.concatenate([graph.data, np.maximum(lengths, np.finfo(float).tiny)])
        joined = csr_array((data, np.concatenate([graph.indices, corner]), starts), shape=(m + q, m + q))
        # A little farther, so that all corners of the last triangles are reached.
        found = np.asarray(dijkstra(joined, indices=m + np.arange(q), limit=limit + 0.03))[:, :m]
        found[np.isinf(found)] = 10 * limit  # infinite ones would make NaN of what they have no weight in
        return np.asarray(self.weights @ np.ascontiguousarray(found.T)).T


def approximate_geodesics(mesh: Mesh) -> Callable[..., np.ndarray]:
    """Return ``distances(indices=, limit=)`` along the edges of ``mesh``, a surface of any size or a point cloud.

    It returns distances (q, n) from the vertices ``indices (q,)``; infinite, or at least larger than ``limit``, beyond
    that.
    """
    n = len(mesh.vertices)
    if n <= _LARGE or len(mesh.faces) == 0:
        return partial(dijkstra, geodesic_graph(mesh, 0))
    copy = coarse_proxy(mesh, spread_vertices(mesh, _COPY_VERTICES))
    few = copy.mesh
    around = vertex_rings(few.faces, len(few.vertices))
    places = closest_among(mesh.vertices, few.vertices, few.faces, *around.around(copy.owner))
    weights = barycentric_matrix(places.faces, places.weights, few.faces, len(few.vertices))
    return _CoarseDistances(mesh.vertices, copy, around, geodesic_graph(few, 0), weights)
