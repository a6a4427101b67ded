"""The whole kernel matrix of one shape's wave kernel signature, its spectrum, and how well samples stand for it."""

from __future__ import annotations

import numpy as np
import scipy.linalg

from kfmaps.descriptors.spectral import wave_energies, wave_signature
from kfmaps.geometry.geodesics import farthest_geodesic
from kfmaps.geometry.mesh import Mesh
from kfmaps.kernels.kernels import Gaussian, gram
from kfmaps.kernels.landmark_selection import farthest, pivoted_cholesky, uniform
from kfmaps.kernels.nystrom import nystrom
from kfmaps.shape import Shape
from options import Setting
from pair_errors import prepared

GAMMAS = (0.01, 0.1, 1.0, 10.0)
"""Of the paper's section 7.1."""

ENERGIES = 100
EIGENFUNCTIONS = 200
RTOL = 1e-12


def specimen_signature(setting: Setting) -> tuple[Shape, np.ndarray]:
    """The shape of the experiment and its signature ``(n, 100)``, each function divided by its largest value.

    That reading of "normalised to have a maximum value of 1" is the one under which the paper's errors come out.
    """
    collection, pair = setting.specimen()
    shape = prepared(collection, pair.source, EIGENFUNCTIONS, "robust")
    energies, sigma = wave_energies(ENERGIES, shape.basis)
    values = wave_signature(shape.basis, energies, sigma)
    return shape, values / np.abs(values).max(axis=0)


def spectrum(K: np.ndarray) -> np.ndarray:
    """Eigenvalues of a kernel matrix, largest first, (n,)."""
    return scipy.linalg.eigvalsh(K, check_finite=False)[::-1]


def best_errors(eigenvalues: np.ndarray) -> np.ndarray:
    """Relative Frobenius error of the best approximation of each rank 0, 1, ..., n: (n + 1,).

    Square roots of summed squares of the eigenvalues that are left out (Eckart, Young 1936).
    """
    squares = np.sort(eigenvalues**2)
    left_out = np.concatenate([[0.0], np.cumsum(squares)])[::-1]
    return np.sqrt(left_out / left_out[0])


def nystrom_error(K: np.ndarray, X: np.ndarray, samples: np.ndarray, gamma: float, block: int = 1024) -> float:
    """``‖K − W Wᵀ‖ / ‖K‖`` (Frobenius) for the Nyström features of rows ``samples`` of ``X``."""
    W = nystrom(Gaussian(gamma), X[samples], RTOL).features(X)
    total = sum(float(np.linalg.norm(K[a : a + block] - W[a : a + block] @ W.T) ** 2) for a in range(0, len(X), block))
    return float(np.sqrt(total) / np.linalg.norm(K))


def gaussian_matrix(X: np.ndarray, gamma: float) -> np.ndarray:
    """``(n, n)`` values of the Gaussian kernel, exactly symmetric."""
    K = gram(Gaussian(gamma), X, X)
    return (K + K.T) / 2


def samples(how: str, mesh: Mesh, X: np.ndarray, gamma: float, count: int, rng: int) -> np.ndarray:
    """``count`` rows of ``X``, chosen in the way that :data:`kfmaps.experiments.style.SAMPLINGS` calls ``how``.

    A smaller choice with the same ``rng`` is the beginning of a larger one, except for a uniform choice.
    """
    if how == "uniform":
        return uniform(len(X), count, rng)
    if how == "geodesic farthest":
        return farthest_geodesic(mesh, count, rng)
    if how == "descriptor farthest":
        return farthest(X, count, rng)
    power = 2.0 if how.endswith("squared") else 1.0
    return pivoted_cholesky(Gaussian(gamma), X, count, randomised=how.startswith("randomly"), power=power, rng=rng)
