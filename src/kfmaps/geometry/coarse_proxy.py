"""A mesh that follows a coarse copy of itself, so that the slow part of bending it need not grow with its size."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial import KDTree

from kfmaps.geometry.arap import build_arap, rotations
from kfmaps.geometry.coarsen import coarsen, voronoi_regions
from kfmaps.geometry.mesh import Mesh, vertex_areas
from kfmaps.geometry.sampling import stratified

PROXY_FROM_VERTICES = 15_000
"""Vertices above which a mesh is bent with a copy first."""
PROXY_VERTICES = 5_000
"""Vertices of the copy: 1.4 % of √area apart, finer than what the first levels' stiffness lets bend. The last level has
all vertices. Of 20,000 two poses ended alike, at 0.76 to 0.77, with copies of 4,000 to 8,000."""


@dataclass(frozen=True, eq=False)
class CoarseProxy:
    """A coarse copy of a mesh; made by :func:`coarse_proxy`.

    Attributes
    ----------
    mesh : Mesh
        With q vertices, each in some face.
    vertices : (q,) int64
        Where they are among the n of the fine mesh.
    owner : (n,) int64
        For each vertex of the fine mesh the nearest one of the copy.
    """

    mesh: Mesh
    vertices: np.ndarray
    owner: np.ndarray


def coarse_proxy(mesh: Mesh, count: int, kept: np.ndarray) -> CoarseProxy:
    """A copy of ``mesh`` with about ``count`` vertices, ``kept (l,)`` among them; itself where it has no more."""
    if len(mesh.vertices) <= count:
        every = np.arange(len(mesh.vertices))
        return CoarseProxy(mesh, every, every)
    areas = vertex_areas(mesh)
    used = np.flatnonzero(areas > 0)
    chosen = used[stratified(mesh.vertices[used], areas[used], count, rng=0)]
    vertices = np.union1d(chosen, kept)
    owner = voronoi_regions(mesh, vertices)
    faces = coarsen(mesh, vertices, owner).faces
    # Thin parts may lose their faces, and a point that no face uses bends with nothing.
    whole = np.unique(faces)
    number = np.full(len(vertices), -1, dtype=np.int64)
    number[whole] = np.arange(len(whole))
    vertices = vertices[whole]
    owner = np.where(owner < 0, -1, number[owner])
    lost = np.flatnonzero(owner < 0)
    if len(lost):
        owner[lost] = KDTree(mesh.vertices[vertices]).query(mesh.vertices[lost])[1]
    return CoarseProxy(Mesh(mesh.vertices[vertices], number[faces]), vertices, owner)


def embedded_deformation(copy: CoarseProxy, mesh: Mesh, bent: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """``mesh``'s vertices ``(n, 3)`` where its copy has been bent to ``bent (q, 3)``, turned by ``turns (q, 3, 3)``.

    Each moves with the vertices of the copy around it, by the motion of each, blended by weights that fall to zero
    where the surroundings end (embedded deformation, Sumner, Schmid and Pauly 2007). A motion of the copy is that of
    the mesh.
    """
    q, n = len(copy.vertices), len(mesh.vertices)
    corners = copy.mesh.faces
    i = np.concatenate([corners.ravel(), np.roll(corners, 1, axis=1).ravel(), np.arange(q)])
    j = np.concatenate([np.roll(corners, 1, axis=1).ravel(), corners.ravel(), np.arange(q)])
    near = csr_array((np.ones(len(i)), (i, j)), shape=(q, q))
    of = near[copy.owner].tocoo()
    fine, node = of.row, of.col
    rest = mesh.vertices[fine] - copy.mesh.vertices[node]
    away = np.linalg.norm(rest, axis=1)
    reach = np.zeros(n)
    np.maximum.at(reach, fine, away)
    weights = (1 - away / np.maximum(1.1 * reach[fine], 1e-300)) ** 2
    places = bent[node] + np.einsum("eij,ej->ei", turns[node], rest)
    total = np.bincount(fine, weights, minlength=n)
    return np.stack([np.bincount(fine, weights * places[:, k], minlength=n) / total for k in range(3)], axis=1)


def register_proxy(
    fit: Callable[..., np.ndarray],
    source: Mesh,
    target: Mesh,
    target_to_source: np.ndarray,
    progress: Callable[[float], None],
    landmarks: np.ndarray,
    held: np.ndarray | None,
) -> np.ndarray:
    """The source's vertices ``(n_s, 3)`` after the ``fit`` of coarse copies of both, called as
    :meth:`kfmaps.registration.nonrigid_icp.NonRigid.vertices` is."""
    a, b = (coarse_proxy(mesh, PROXY_VERTICES, landmarks[:, side]) for side, mesh in enumerate((source, target)))
    progress(0.1)
    marks = np.stack([a.owner[landmarks[:, 0]], b.owner[landmarks[:, 1]]], axis=1)
    bent = fit(
        a.mesh,
        b.mesh,
        a.owner[target_to_source[b.vertices]],
        lambda done: progress(0.1 + 0.9 * done),
        landmarks=marks,
        held=None if held is None else held[b.vertices],
    )
    return embedded_deformation(a, source, bent, rotations(build_arap(a.mesh), bent))
