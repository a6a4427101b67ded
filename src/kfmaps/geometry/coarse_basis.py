"""Eigenfunctions of large meshes, as linear combinations of hat functions on a coarse proxy.

The eigenproblem of the mesh is restricted to functions that are linear between the vertices of the proxy (Galerkin's
method). So all of the mesh's surface counts, also where the proxy has lost the faces of a thin bridge. Nasikun, Brandt
and Hildebrandt, Fast approximation of Laplace-Beltrami eigenproblems (2018), restrict it to other local functions.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csr_array, diags_array

from kfmaps._arrays import blocks
from kfmaps.geometry.basis import Basis, laplace_basis, laplace_operators
from kfmaps.geometry.closest_points import barycentric_matrix, closest_among
from kfmaps.geometry.coarsen import CoarseProxy, coarse_proxy, spread_vertices
from kfmaps.geometry.eigen.eigensolver import smallest_eigenpairs, turn_peaks_up
from kfmaps.geometry.mesh import Mesh

MIN_PROXY_VERTICES, VERTICES_PER_FUNCTION = 30_000, 300
"""Vertices of the proxy: so many at least, and for each eigenfunction."""


def n_proxy_vertices(k: int) -> int:
    """Return the number of vertices of the proxy for ``k`` eigenfunctions."""
    return max(MIN_PROXY_VERTICES, VERTICES_PER_FUNCTION * k)


def coarse_basis(
    mesh: Mesh, k: int, laplacian: str, tolerance: float, progress: Callable[[float], None] | None = None
) -> Basis:
    """Return about the first ``k`` eigenfunctions of a cleaned mesh, orthonormal in its area, and Ritz values.

    The values are upper bounds of the eigenvalues, 2 % above them at most for bodies, and 11 % for skulls, whose walls
    are thin (research/speed.md). Those of the mesh itself are returned where its proxy loses most vertices, as that of
    loose triangles does.

    ``k``, ``laplacian``, ``tolerance`` and ``progress``: as for :func:`kfmaps.geometry.basis.laplace_basis`.
    """
    proxy = coarse_proxy(mesh, spread_vertices(mesh, n_proxy_vertices(k)))
    if len(proxy.vertices) < n_proxy_vertices(k) / 2:
        return laplace_basis(mesh, k, laplacian, progress=progress, tolerance=tolerance)
    stiffness, mass = laplace_operators(mesh, laplacian, k)
    hats = _hat_functions(mesh, proxy)
    coarse = csr_array(hats.T @ csr_array(stiffness @ hats))
    vectors = smallest_eigenpairs(coarse, hats.T @ mass, k, tolerance=tolerance, progress=progress).vectors
    # The solver takes a diagonal mass, so its functions are corrected within their span.
    coarse_mass = hats.T @ (diags_array(mass) @ hats)
    values, rotation = eigh(vectors.T @ (coarse @ vectors), vectors.T @ (coarse_mass @ vectors))
    vectors = turn_peaks_up(vectors @ rotation)
    functions = np.empty((len(mass), k), order="F")
    for columns in blocks(k, 16):  # little more memory than the result has
        functions[:, columns] = hats @ vectors[:, columns]
    return Basis(np.maximum(values, 0.0), functions, mass)


def _hat_functions(mesh: Mesh, proxy: CoarseProxy) -> csr_array:
    """Return the hat functions of the proxy's vertices at the vertices of the mesh, (n, q); rows sum to 1.

    Each vertex lies on the closest of the faces around the proxy's vertex that is nearest along the surface, so that no
    function leaps from one wall to another. A hat function that is zero everywhere, as of a vertex of a degenerate
    face, is left out.
    """
    faces, n = proxy.mesh.faces, len(mesh.vertices)
    corners = np.ones(faces.size), (faces.ravel(), np.repeat(np.arange(len(faces)), 3))
    around = csr_array(corners, shape=(len(proxy.vertices), len(faces)))[proxy.owner]
    owner = np.repeat(np.arange(n), np.diff(around.indptr))
    places = closest_among(mesh.vertices, proxy.mesh.vertices, faces, around.indices.astype(np.int64), owner)
    hats = barycentric_matrix(places.faces, places.weights, faces, len(proxy.vertices))
    hats.eliminate_zeros()
    return hats[:, np.unique(hats.indices)]
