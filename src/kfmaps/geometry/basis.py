"""The Laplace-Beltrami basis of a shape, which functional maps are written in."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import robust_laplacian
from scipy.sparse import coo_array, csc_array

from kfmaps._arrays import Array, MissingDependency, check_count, refuse, to_numpy
from kfmaps._records import short_repr
from kfmaps.geometry.clean import clean_mesh
from kfmaps.geometry.connectivity import proper_faces
from kfmaps.geometry.eigen.eigensolver import EXACT, smallest_eigenpairs
from kfmaps.geometry.eigen.factorization import SparseMatrix
from kfmaps.geometry.mesh import Mesh, check_is_mesh, vertex_areas
from kfmaps.geometry.point_cloud import cloud_laplacian

_MIN_ANGLE = 1e-6  # angle below which a face is mollified, and by how much of its longest edge all become longer


@dataclass(frozen=True, eq=False)
class Basis:
    """The first eigenfunctions of a shape's Laplacian, orthonormal in its area.

    The arrays may be of any array-API library; all three share library, dtype and device.

    Attributes
    ----------
    eigenvalues : (k,)
        Ascending, none below zero, in inverse squared units of the shape.
    functions : (n, k)
        One eigenfunction a column: ``functionsᵀ diag(mass) functions = I``.
    mass : (n,)
        Area around each vertex (lumped). Zero at a vertex that no face uses, and at one that is welded to another.

    Examples
    --------
    >>> basis = kfmaps.laplace_basis(kfmaps.datasets.sphere(500), 10)
    >>> np.allclose(basis.project(basis.functions), np.eye(10))  # orthonormal
    True
    """

    eigenvalues: Array
    functions: Array
    mass: Array

    __repr__ = short_repr

    def project(self, f: Array) -> Array:
        """Return the coefficients (k, d) of the functions ``f`` (n, d): ``Φᵀ A f``."""
        return self.functions.T @ (self.mass[:, None] * f)

    def reconstruct(self, c: Array) -> Array:
        """Return the functions (n, d) that have the coefficients ``c`` (k, d): ``Φ c``."""
        return self.functions @ c

    def truncate(self, k: int) -> Basis:
        """Return the basis of the first ``k`` functions, of the same kind.

        Raises
        ------
        InvalidInput
            When there are fewer.
        """
        check_count(k, "k", 1, self.functions.shape[1])
        return replace(self, eigenvalues=self.eigenvalues[:k], functions=self.functions[:, :k])

    def to(self, device: str) -> Basis:
        """Return the basis, of the same class, as PyTorch tensors on ``device``.

        ``"torch"`` is PyTorch on the CPU; ``"cpu"`` and ``"numpy"`` give NumPy arrays.

        Raises
        ------
        MissingDependency
            When ``device`` is another one and PyTorch is not installed.
        InvalidInput
            When PyTorch does not have the device.
        """
        arrays = [to_numpy(a) for a in (self.eigenvalues, self.functions, self.mass)]
        if device in ("cpu", "numpy"):
            return type(self)(*arrays)
        try:
            import torch
        except ImportError as error:
            raise MissingDependency(
                f"device {device!r} needs PyTorch. Install it with: pip install 'kfmaps[gpu]'."
            ) from error
        try:
            where = "cpu" if device == "torch" else device
            return type(self)(*(torch.asarray(a, device=where) for a in arrays))
        except (RuntimeError, AssertionError, TypeError) as error:
            reason = str(error).splitlines()[0]
            raise refuse("device", "a device that PyTorch can use", f"{device!r} ({reason})", "use cpu") from error


def eigenvalue_tolerance(basis: Basis) -> float:
    """Return the eigenvalue below which one counts as zero: a millionth of ``4π / area``.

    That is Weyl's estimate of the distance between eigenvalues. Rounding makes zeros as large as 1e-12.
    """
    return 4e-6 * np.pi / float(to_numpy(basis.mass).sum())


def cotangent_laplacian(mesh: Mesh) -> csc_array:
    """Return the weak cotangent Laplacian (n, n), symmetric and positive semi-definite; rows sum to zero.

    The entry of an edge is minus half the sum of the cotangents of the angles opposite it (Pinkall and Polthier,
    Computing discrete minimal surfaces, 1993). Faces with an angle below 1e-6, or so close to π, are mollified (Sharp
    and Crane 2020): all their edges count as longer by 1e-6 of the longest, so that faces without area give large
    numbers rather than infinite ones. Faces with two equal corners are left out.
    """
    n = len(mesh.vertices)
    faces = mesh.faces[proper_faces(mesh.faces)]
    half_cotangents, is_thin = [], np.zeros(len(faces), dtype=bool)
    for corner in range(3):
        tip, i, j = (faces[:, (corner + step) % 3] for step in range(3))
        a, b = mesh.vertices[i] - mesh.vertices[tip], mesh.vertices[j] - mesh.vertices[tip]
        dot = (a * b).sum(axis=1)
        sine = np.linalg.norm(np.cross(a, b), axis=1)
        is_wide = sine > _MIN_ANGLE * np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
        half_cotangents.append(np.divide(dot, sine, out=np.zeros_like(dot), where=is_wide) / 2)
        is_thin |= ~is_wide
    if is_thin.any():
        for half, mollified in zip(half_cotangents, _mollify(mesh.vertices[faces[is_thin]]), strict=True):
            half[is_thin] = mollified
    entries, rows, columns = [], [], []
    for corner, half in enumerate(half_cotangents):
        _, i, j = (faces[:, (corner + step) % 3] for step in range(3))
        entries += [-half, -half, half, half]
        rows += [i, j, i, j]
        columns += [j, i, i, j]
    indices = (np.concatenate(rows), np.concatenate(columns))
    return coo_array((np.concatenate(entries), indices), shape=(n, n)).tocsc()


def _mollify(corners: np.ndarray) -> np.ndarray:
    """Return half the cotangents at the ``corners`` (f, 3, 3) of mollified faces, (3, f)."""
    opposite = np.linalg.norm(np.roll(corners, -1, axis=1) - np.roll(corners, 1, axis=1), axis=2)
    longest = opposite.max(axis=1, keepdims=True)
    order = -np.sort(-(opposite + _MIN_ANGLE * longest), axis=1).T  # Kahan's area of a triangle needs a ≥ b ≥ c
    a, b, c = order
    area = 0.25 * np.sqrt(np.maximum((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)), 0))
    squares = (opposite + _MIN_ANGLE * longest).T ** 2
    numerator = np.roll(squares, 1, axis=0) + np.roll(squares, -1, axis=0) - squares
    return np.divide(numerator, 8 * area, out=np.zeros_like(numerator), where=area > 0)


def laplace_operators(mesh: Mesh, laplacian: str, k: int) -> tuple[SparseMatrix, np.ndarray]:
    """Return the weak Laplacian (n, n) and lumped mass (n,) of a cleaned mesh or cloud of more than ``k`` vertices.

    ``laplacian``: "robust" or "cotangent", as for :func:`laplace_basis`.
    """
    if len(mesh.vertices) <= k:
        wanted = f"fewer eigenfunctions than the {len(mesh.vertices)} vertices in use"
        raise refuse("k", wanted, str(k), "ask for fewer, or refine the mesh")
    if laplacian not in ("robust", "cotangent"):
        raise refuse("laplacian", "'robust' or 'cotangent'", repr(laplacian), "choose one of them")
    if len(mesh.faces) == 0:
        return cloud_laplacian(mesh.vertices)
    if laplacian == "cotangent":
        return cotangent_laplacian(mesh), vertex_areas(mesh)
    stiffness, mass = robust_laplacian.mesh_laplacian(mesh.vertices, mesh.faces)
    return stiffness, mass.diagonal()


def laplace_basis(
    mesh: Mesh,
    k: int,
    laplacian: str = "robust",
    rng: int | np.random.Generator = 0,
    progress: Callable[[float], None] | None = None,
    tolerance: float = EXACT,
) -> Basis:
    """Return the first ``k`` eigenfunctions of the Laplacian of a mesh or point cloud.

    Any triangles will do: boundaries (with natural, Neumann conditions), several components (one eigenvalue zero for
    each), faces without area, edges with more than two faces. Seams and coincident points of a cloud are welded
    (:func:`kfmaps.geometry.weld.weld_vertices`): one vertex has the mass, the others its functions. A vertex that no
    face uses has no mass and the functions of the used vertex nearest in space.

    Parameters
    ----------
    mesh : Mesh
        In any unit ``u``; shapes to be matched should have unit area (:func:`~kfmaps.geometry.mesh.unit_area`). The
        eigenvalues come in ``1/u²``, the mass in ``u²``, the functions in ``1/u``. Without faces it is a cloud, whose
        areas are estimated (:func:`kfmaps.geometry.point_cloud.cloud_laplacian`).
    k : int
        From 1 to one less than the number of vertices in use.
    laplacian : {"robust", "cotangent"}
        ``"robust"``: the intrinsic Delaunay Laplacian of the tufted cover, whose weights are never negative, on
        triangles however bad (Sharp and Crane, A Laplacian for nonmanifold triangle meshes, 2020). ``"cotangent"``:
        :func:`cotangent_laplacian` with barycentric areas. Clouds always take the robust one.
    rng : int or numpy.random.Generator
        Start vectors of the eigensolver. The same input gives the same basis. Each function's entry of largest
        magnitude is positive. Signs, and bases of repeated eigenvalues, are arbitrary.
    progress : callable, optional
        Called with about how much is done, from 0 to 1.
    tolerance : float
        Of the eigensolver; from 1e-6 on it is another one, see
        :func:`~kfmaps.geometry.eigen.eigensolver.smallest_eigenpairs`.

    Returns
    -------
    Basis

    Raises
    ------
    InvalidInput
        When the mesh has too few vertices in use, the points of a cloud lie on no surface, or the Laplacian's name is
        unknown.
    NotConverged
        When a residual is above the tolerance; see :func:`~kfmaps.geometry.eigen.eigensolver.smallest_eigenpairs`.

    Examples
    --------
    >>> basis = kfmaps.laplace_basis(kfmaps.datasets.sphere(2000), 5)
    >>> basis.eigenvalues.round(1) + 0.0  # of the unit sphere: 0, 2, 2, 2, 6, ...
    array([0., 2., 2., 2., 6.])
    """
    check_is_mesh(mesh)
    cleaned = clean_mesh(mesh)
    stiffness, area = laplace_operators(cleaned.mesh, laplacian, check_count(k, "k"))
    pairs = smallest_eigenpairs(stiffness, area, k, tolerance=tolerance, rng=rng, progress=progress)
    if cleaned.whole:
        return Basis(pairs.values, pairs.vectors, area)
    mass = np.bincount(cleaned.to_original, area, minlength=len(mesh.vertices))
    return Basis(pairs.values, pairs.vectors[cleaned.to_clean], mass)
