"""Heat and wave kernel signatures, landmark maps, and normalisations that treat both shapes alike.

All are spectral, so they need a :class:`~kfmaps.geometry.basis.Basis` alone, of a shape of unit area. There Weyl's law
puts the j-th eigenvalue near 4πj whatever the shape. Times and energies are chosen from that law and from the *upper*
part of the spectrum, never from the first nonzero eigenvalue, which a floating speck or a thin bridge can make as small
as it likes.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, get_args

import numpy as np

from kfmaps._arrays import Array, check, check_count, check_positive, like, namespace, refuse, take, to_numpy
from kfmaps.geometry.basis import Basis

Normalisation = Literal["none", "norm", "max", "row", "variance"]


_ZERO = 1e-3  # eigenvalue, at unit area, up to which a function counts as the constant of a component


def _spectral_range(*bases: Basis) -> tuple[float, float]:
    """Return the eigenvalues (low, high) between which times and energies are spread, common to all ``bases``.

    ``high`` is the smallest of the last eigenvalues. ``low`` is the largest of the second ones, but never outside [¼,
    1] times ``4π``, Weyl's estimate of it on a unit area: a tiny second eigenvalue, from a speck or a long thin shape,
    cannot stretch the range.
    """
    high = max(min(float(to_numpy(b.eigenvalues)[-1]) for b in bases), 4 * _ZERO)
    second = max(float(to_numpy(b.eigenvalues)[min(1, len(to_numpy(b.eigenvalues)) - 1)]) for b in bases)
    low = float(np.clip(second, np.pi, 4 * np.pi))
    return min(low, high / 4), high


def heat_times(count: int, *bases: Basis) -> np.ndarray:
    """Return ``count`` diffusion times, (count,), common to all ``bases`` (Sun et al. 2009).

    They are spread logarithmically from ``4 ln 10 / λ_high`` to ``4 ln 10 / λ_low``.
    """
    check_count(count, "number of times")
    low, high = _spectral_range(*bases)
    ends = 4 * np.log(10) / np.array([high, low])
    return np.geomspace(ends[0], ends[1], count) if count > 1 else np.array([np.sqrt(ends[0] * ends[1])])


def wave_energies(count: int, *bases: Basis) -> tuple[np.ndarray, float]:
    """Return logarithms of energies, (count,), and their width σ, common to all ``bases`` (Aubry et al. 2011).

    They are equally spaced in log λ. σ is seven spacings of a grid of ``count``, but at most a fifteenth of the range,
    so that few energies still tell bands apart. Both ends are moved in by 2σ as the authors do.
    """
    check_count(count, "number of energies")
    low, high = np.log(_spectral_range(*bases))
    sigma = max(7 * (high - low) / max(count, 105), 1e-12)
    inside = np.linspace(low + 2 * sigma, high - 2 * sigma, count) if count > 1 else np.array([(low + high) / 2])
    return inside, float(sigma)


def _heat_weights(basis: Basis, times: Array) -> Array:
    """``(k, t)`` values ``exp(-λ t)``."""
    xp = namespace(basis.functions)
    times = check(like(times, basis.functions), "times", shape=(None,))
    return xp.exp(-basis.eigenvalues[:, None] * times[None, :])


def _wave_weights(basis: Basis, energies: Array, sigma: float) -> Array:
    """``(k, e)`` values ``exp(-(log λ - e)² / 2σ²)``, zero for the constants (λ = 0), which carry no wave."""
    xp = namespace(basis.functions)
    check_positive(sigma, "sigma")
    energies = check(like(energies, basis.functions), "energies", shape=(None,))
    positive = basis.eigenvalues > _ZERO
    logs = xp.log(xp.where(positive, basis.eigenvalues, xp.ones_like(basis.eigenvalues)))
    weights = xp.exp(-((logs[:, None] - energies[None, :]) ** 2) / (2 * sigma**2))
    return xp.where(positive[:, None], weights, xp.zeros_like(weights))


def _signature(basis: Basis, weights: Array) -> Array:
    return (basis.functions * basis.functions) @ weights


def _landmark_map(basis: Basis, landmarks: Sequence[int] | np.ndarray, weights: Array) -> Array:
    xp = namespace(basis.functions)
    n = basis.functions.shape[0]
    rows = check_landmarks(landmarks, n)
    peaks = take(basis.functions, rows)
    columns = [basis.functions @ (peaks[j, :][:, None] * weights) for j in range(len(rows))]
    return xp.concat(columns, axis=1)


def heat_signature(basis: Basis, times: Array) -> Array:
    """Return the heat kernel signature ``Σ_j exp(-λ_j t) φ_j(x)²`` (Sun, Ovsjanikov and Guibas 2009).

    Parameters
    ----------
    basis : Basis
    times : (t,)
        In units of the shape's area.

    Returns
    -------
    (n, t)
        Of the array library of the basis.
    """
    return _signature(basis, _heat_weights(basis, times))


def log_heat_signature(basis: Basis) -> np.ndarray:
    """Return the logarithm of the heat kernel signature (n, 8), by which shapes and points of them are compared.

    ``basis``: at unit area. The times are the same for all shapes: from a fiftieth of the surface reached to most of
    it.
    """
    return np.log(np.maximum(to_numpy(heat_signature(basis, np.geomspace(0.005, 0.3, 8))), 1e-12))


def wave_signature(basis: Basis, energies: Array, sigma: float) -> Array:
    """Return the wave kernel signature ``Σ_j exp(-(log λ_j - e)²/2σ²) φ_j(x)²`` (Aubry, Schlickewei and Cremers 2011).

    It is not divided by the sum of its weights, as in the framework of Nogneng and Ovsjanikov (2017).

    Parameters
    ----------
    basis : Basis
    energies : (e,)
        Logarithms of eigenvalues; see :func:`wave_energies`.
    sigma : float
        Width in the logarithm.

    Returns
    -------
    (n, e)
        Of the array library of the basis.
    """
    return _signature(basis, _wave_weights(basis, energies, sigma))


def heat_map(basis: Basis, landmarks: Sequence[int] | np.ndarray, times: Array) -> Array:
    """Return the heat kernel from each landmark p, ``Σ_j exp(-λ_j t) φ_j(p) φ_j(x)``.

    Parameters
    ----------
    basis : Basis
    landmarks : (l,) int
        Vertices.
    times : (t,)

    Returns
    -------
    (n, l·t)
        Landmark by landmark.
    """
    return _landmark_map(basis, landmarks, _heat_weights(basis, times))


def wave_map(basis: Basis, landmarks: Sequence[int] | np.ndarray, energies: Array, sigma: float) -> Array:
    """Return the wave kernel map of each landmark p, ``Σ_j exp(-(log λ_j - e)²/2σ²) φ_j(p) φ_j(x)``.

    Parameters
    ----------
    basis : Basis
    landmarks : (l,) int
        Vertices.
    energies : (e,)
    sigma : float

    Returns
    -------
    (n, l·e)
        Landmark by landmark.
    """
    return _landmark_map(basis, landmarks, _wave_weights(basis, energies, sigma))


def check_landmarks(landmarks: Sequence[int] | np.ndarray, n: int, name: str = "landmarks") -> np.ndarray:
    """Return ``landmarks`` as (l,) int64; refuse them unless they are distinct vertices of a shape with ``n``."""
    rows = np.asarray(landmarks)
    if rows.ndim != 1 or (rows.size and not np.issubdtype(rows.dtype, np.integer)):
        raise refuse(name, "a list of whole numbers", f"{rows.dtype} of shape {rows.shape}", "give vertex numbers")
    rows = rows.astype(np.int64)
    if rows.size and (rows.min() < 0 or rows.max() >= n):
        bad = int(rows[(rows < 0) | (rows >= n)][0])
        remedy = "count from 0 (the command's --one-based is for files that count from 1)"
        raise refuse(name, f"vertex numbers from 0 to {n - 1}", str(bad), remedy)
    values, counts = np.unique(rows, return_counts=True)
    if np.any(counts > 1):
        raise refuse(name, "each vertex once", f"{int(values[counts > 1][0])} repeated", "remove the repetition")
    return rows


def normalize(
    D_s: Array, D_t: Array, normalisation: Normalisation, mass_s: Array, mass_t: Array
) -> tuple[Array, Array]:
    """Scale descriptors by the same numbers on both shapes.

    Parameters
    ----------
    D_s, D_t : (n_s, d), (n_t, d)
    normalisation : str
        ``"none"``; ``"norm"``: each descriptor by its A-norm, the root of the mean of both shapes' squares (NO17, made
        symmetric); ``"max"``: each by its largest absolute value on both; ``"row"``: all by one number, the largest row
        norm on both, so that every vertex lies in the unit ball; ``"variance"``: each first centred by its mean over
        both shapes and divided by its standard deviation, then all by the square root of their number, so that typical
        squared distances between vertices are 2.
    mass_s, mass_t : (n_s,), (n_t,)
        Vertex areas, for the norms and means.

    Returns
    -------
    (n_s, d), (n_t, d)
    """
    xp = namespace(D_s, D_t)
    if normalisation not in get_args(Normalisation):
        raise refuse(
            "normalisation", "one of " + ", ".join(get_args(Normalisation)), repr(normalisation), "choose one of them"
        )
    check(D_s, "source descriptors", shape=(mass_s.shape[0], None), remedy="give one row per source vertex")
    check(D_t, "target descriptors", shape=(mass_t.shape[0], D_s.shape[1]), remedy="give the same descriptors on both")
    if normalisation == "none":
        return D_s, D_t
    w_s, w_t = (0.5 * m[:, None] / xp.sum(m) for m in (mass_s, mass_t))
    size = xp.maximum(xp.max(xp.abs(D_s), axis=0), xp.max(xp.abs(D_t), axis=0))
    if normalisation == "variance":
        mean = xp.sum(w_s * D_s, axis=0, keepdims=True) + xp.sum(w_t * D_t, axis=0, keepdims=True)
        D_s, D_t = D_s - mean, D_t - mean
    if normalisation in ("norm", "variance"):
        scale = xp.sqrt(xp.sum(w_s * D_s * D_s, axis=0) + xp.sum(w_t * D_t * D_t, axis=0))
    elif normalisation == "max":
        scale = size
    else:
        longest = xp.sqrt(xp.maximum(xp.max(xp.sum(D_s * D_s, axis=1)), xp.max(xp.sum(D_t * D_t, axis=1))))
        scale = xp.broadcast_to(longest, (D_s.shape[1],))
    # What is left of a constant without its mean is rounding, and must not be scaled up.
    scale = xp.where(scale > 1e-12 * size, scale, xp.ones_like(scale))[None, :]
    if normalisation == "variance":
        scale = scale * D_s.shape[1] ** 0.5
    return D_s / scale, D_t / scale
