"""The kernel matrix of one shape's wave kernel signature, its spectrum, and errors of Nyström approximations."""

from __future__ import annotations

import numpy as np
import scipy.linalg

from data_sets import DataSet
from experiment import Options
from kfmaps.descriptors.spectral import wave_energies, wave_signature
from kfmaps.geometry.geodesics import farthest_geodesic
from kfmaps.geometry.mesh import Mesh
from kfmaps.kernels.kernels import Gaussian, kernel_matrix
from kfmaps.kernels.landmark_selection import farthest_descriptors, pivoted_cholesky, uniform
from kfmaps.kernels.nystrom import nystrom
from kfmaps.shape import Shape
from pair_errors import prepared

GAMMAS = (0.01, 0.1, 1.0, 10.0)
"""Widths of the paper's section 7.1."""

ENERGIES = 100
EIGENFUNCTIONS = 200
RTOL = 1e-12


def signature(data_set: DataSet, name: str) -> tuple[Shape, np.ndarray]:
    """Return a shape and its wave kernel signature (n, 100), each function divided by its largest value.

    That reading of "normalised to have a maximum value of 1" is the one under which the paper's errors come out.
    """
    shape = prepared(data_set, name, EIGENFUNCTIONS, "robust")
    energies, sigma = wave_energies(ENERGIES, shape.basis)
    values = wave_signature(shape.basis, energies, sigma)
    return shape, values / np.abs(values).max(axis=0)


def kernel_spectra(options: Options) -> dict[float, np.ndarray]:
    """Return all eigenvalues of the kernel matrix of the specimen for each γ, largest first."""
    data_set, (name, _) = options.specimen()
    spectra = options.map(kernel_spectrum, {gamma: (data_set, name, gamma) for gamma in GAMMAS})
    return {gamma: np.asarray(values) for gamma, values in spectra.items()}


def kernel_spectrum(data_set: DataSet, name: str, gamma: float) -> list[float]:
    """Return the eigenvalues for one γ, largest first."""
    K = gaussian_matrix(signature(data_set, name)[1], gamma)
    return scipy.linalg.eigvalsh(K, check_finite=False)[::-1].tolist()


def best_errors(eigenvalues: np.ndarray) -> np.ndarray:
    """Return the relative Frobenius error of the best approximation of each rank 0, 1, ..., n: (n + 1,).

    Square roots of summed squares of the eigenvalues that are left out (Eckart, Young 1936).
    """
    squares = np.sort(eigenvalues**2)
    left_out = np.concatenate([[0.0], np.cumsum(squares)])[::-1]
    return np.sqrt(left_out / left_out[0])


def nystrom_error(K: np.ndarray, X: np.ndarray, samples: np.ndarray, gamma: float, block: int = 1024) -> float:
    """Return ``‖K − W Wᵀ‖ / ‖K‖`` (Frobenius) for the Nyström features of rows ``samples`` of ``X``."""
    W = nystrom(Gaussian(gamma), X[samples], RTOL).features(X)
    total = sum(float(np.linalg.norm(K[a : a + block] - W[a : a + block] @ W.T) ** 2) for a in range(0, len(X), block))
    return float(np.sqrt(total) / np.linalg.norm(K))


def gaussian_matrix(X: np.ndarray, gamma: float) -> np.ndarray:
    """Return the values of the Gaussian kernel, (n, n), exactly symmetric."""
    K = kernel_matrix(Gaussian(gamma), X, X)
    return (K + K.T) / 2


def samples(method: str, mesh: Mesh, X: np.ndarray, gamma: float, count: int, rng: int) -> np.ndarray:
    """Return ``count`` rows of ``X``, chosen by a method of :data:`style.SAMPLINGS`.

    A smaller choice with the same ``rng`` is the beginning of a larger one, except for a uniform choice.
    """
    if method == "uniform":
        return uniform(len(X), count, rng)
    if method == "geodesic farthest":
        return farthest_geodesic(mesh, count, rng)
    if method == "descriptor farthest":
        return farthest_descriptors(X, count, rng)
    power = 2.0 if method.endswith("squared") else 1.0
    return pivoted_cholesky(Gaussian(gamma), X, count, randomised=method.startswith("randomly"), power=power, rng=rng)
