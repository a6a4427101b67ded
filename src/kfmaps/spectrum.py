"""The Laplace-Beltrami basis of a shape: the functions that every map is written in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import robust_laplacian
from scipy.sparse import coo_array
from scipy.spatial import cKDTree

from kfmaps._arrays import Array, MissingDependency, check_count, refuse, to_numpy
from kfmaps.eigensolver import smallest_eigenpairs
from kfmaps.mesh import Mesh, vertex_areas


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
        Area around each vertex (lumped). Zero at a vertex that no face uses.
    """

    eigenvalues: Array
    functions: Array
    mass: Array

    def project(self, f: Array) -> Array:
        """Coefficients (k, d) of the functions ``f`` (n, d): ``Φᵀ A f``."""
        return self.functions.T @ (self.mass[:, None] * f)

    def lift(self, c: Array) -> Array:
        """Functions (n, d) that have the coefficients ``c`` (k, d): ``Φ c``."""
        return self.functions @ c

    def truncated(self, k: int) -> Basis:
        """The basis of the first ``k`` functions.

        Raises
        ------
        InvalidInput
            When there are fewer.
        """
        check_count(k, "k", 1, self.functions.shape[1])
        return Basis(self.eigenvalues[:k], self.functions[:, :k], self.mass)

    def to(self, device: str) -> Basis:
        """The basis as PyTorch tensors on ``device``, or as NumPy arrays for ``"cpu"`` and ``"numpy"``.

        Raises
        ------
        MissingDependency
            When ``device`` is another one and PyTorch is not installed.
        """
        arrays = [self.eigenvalues, self.functions, self.mass]
        if device in ("cpu", "numpy"):
            return Basis(*(to_numpy(a) for a in arrays))
        try:
            import torch
        except ImportError as error:
            raise MissingDependency(
                f"device {device!r} needs PyTorch; install it with: pip install 'kfmaps[gpu]'"
            ) from error
        return Basis(*(torch.asarray(a).to(device) for a in arrays))


def cotangent_laplacian(mesh: Mesh) -> coo_array:
    """Weak cotangent Laplacian (n, n), positive semi-definite up to obtuse pairs of angles."""
    v, f = mesh.vertices, mesh.faces
    n = len(v)
    rows, cols, data = [], [], []
    for c in range(3):
        k, i, j = f[:, c], f[:, (c + 1) % 3], f[:, (c + 2) % 3]
        a, b = v[i] - v[k], v[j] - v[k]
        sine = np.linalg.norm(np.cross(a, b), axis=1)
        cot = np.divide((a * b).sum(1), sine, out=np.zeros_like(sine), where=sine > 0) / 2
        rows += [i, j, i, j]
        cols += [j, i, i, j]
        data += [-cot, -cot, cot, cot]
    entries = (np.concatenate(data), (np.concatenate(rows), np.concatenate(cols)))
    return coo_array(entries, shape=(n, n)).tocsc()


def laplace_basis(
    mesh: Mesh, k: int, laplacian: str = "robust", rng: int = 0, threads: int | None = None
) -> Basis:
    """The first ``k`` eigenfunctions of the Laplacian of ``mesh``."""
    n = len(mesh.vertices)
    cloud = len(mesh.faces) == 0
    used = np.arange(n) if cloud else np.unique(mesh.faces)
    if len(used) <= k:
        raise refuse("k", f"fewer eigenfunctions than the {len(used)} vertices", str(k), "ask for fewer")
    number = np.zeros(n, dtype=np.int64)
    number[used] = np.arange(len(used))
    part = Mesh(mesh.vertices[used], number[mesh.faces])
    if cloud:
        stiffness, mass = robust_laplacian.point_cloud_laplacian(part.vertices)
        mass = mass.diagonal()
        mass = mass / mass.sum()
    elif laplacian == "robust":
        stiffness, mass = robust_laplacian.mesh_laplacian(part.vertices, part.faces)
        mass = mass.diagonal()
    elif laplacian == "cotangent":
        stiffness, mass = cotangent_laplacian(part), vertex_areas(part)
    else:
        raise refuse("laplacian", "'robust' or 'cotangent'", repr(laplacian), "choose one of them")
    pairs = smallest_eigenpairs(stiffness, mass, k, rng=rng, threads=threads)
    functions, weights = pairs.vectors, mass
    if len(used) < n:
        near = cKDTree(part.vertices).query(mesh.vertices)[1]
        near[used] = np.arange(len(used))
        functions = functions[near]
        weights = np.zeros(n)
        weights[used] = mass
    return Basis(pairs.values, functions, weights)
