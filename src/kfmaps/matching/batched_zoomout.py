"""ZoomOut of many maps at once on samples: what a search spends most of its time on.

The same alternation as :class:`kfmaps.fmap.refine.ZoomOut` on samples, in single precision and without its
checks: a few hundred points are too few for one map to be worth the trouble of a call, a hundred maps are not.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from kfmaps._arrays import to_numpy
from kfmaps._threads import parallel
from kfmaps.geometry.sampling import SampledBasis

RIDGE = 0.1
"""Damping of the least squares, as in :func:`kfmaps.fmap.refine.fit_functional_map`."""
PAIRS = 1_000_000
"""Pairs of points worked on together: score matrices that stay in the cache."""


def batched_zoomout(
    maps: np.ndarray,
    source: SampledBasis,
    target: SampledBasis,
    sizes: tuple[int, ...],
    against: np.ndarray | None = None,
    threads: int | None = None,
    solvers: Callable[[int], np.ndarray] | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Refine ``maps (m, k, k)`` through the basis ``sizes``, the first of which is at most k.

    Parameters
    ----------
    maps : (m, k, k)
        Only their leading blocks of the first size count.
    source, target : SampledBasis
        Of q_s and q_t points, the total area 1.
    sizes : tuple of int
        Growing; the last is the size of the result.
    against : (q_t, q_s) or (m, q_t, q_s), optional
        Half the squared differences of descriptors, up to a constant for each target point, for all maps or for each:
        what speaks against a pair besides the functions; see :func:`kfmaps.matching.sample_pair.descriptor_cost`.
    threads : int, optional
    solvers : callable, optional
        :func:`pseudo_inverse` of the target for k functions, where many refinements share them.

    Returns
    -------
    maps : (m, k, k) float64, k the last size
    points : (m, q_t) int64
        A source sample for each target sample, by the map returned.
    """
    phi_s = np.asarray(to_numpy(source.functions)[:, : sizes[-1]], dtype=np.float32)
    phi_t = np.asarray(to_numpy(target.functions)[:, : sizes[-1]], dtype=np.float32)
    found_by = solvers or (lambda k: pseudo_inverse(target, k))
    steps = [(k, found_by(k)) for k in sizes[1:]]
    count = max(1, PAIRS // (len(phi_s) * len(phi_t)))

    def through(first: int) -> tuple[np.ndarray, np.ndarray]:
        some = slice(first, first + count)
        says = against[some] if against is not None and against.ndim == 3 else against
        C = np.asarray(maps[some, : sizes[0], : sizes[0]], dtype=np.float32)
        for larger, solver in steps:
            C = solver @ phi_s[:, :larger][nearest_samples(C, phi_s, phi_t, says)]
        return np.asarray(C, dtype=np.float64), nearest_samples(C, phi_s, phi_t, says)

    found = parallel(through, range(0, len(maps), count), threads)
    return np.concatenate([f[0] for f in found]), np.concatenate([f[1] for f in found])


def nearest_samples(C: np.ndarray, phi_s: np.ndarray, phi_t: np.ndarray, against: np.ndarray | None) -> np.ndarray:
    """The nearest image of a source point, (m, q_t), for the maps ``C (m, k, k)``; ``against`` as in
    :func:`batched_zoomout`."""
    k = C.shape[1]
    # One column more holds half the squared length, so that the product is the whole score.
    images = np.empty((len(C), len(phi_s), k + 1), dtype=np.float32)
    images[:, :, :k] = phi_s[:, :k] @ C.transpose(0, 2, 1)
    images[:, :, k] = -0.5 * np.einsum("mik,mik->mi", images[:, :, :k], images[:, :, :k])
    places = np.ones((len(phi_t), k + 1), dtype=np.float32)
    places[:, :k] = phi_t[:, :k]
    score = places @ images.transpose(0, 2, 1)
    if against is not None:
        score -= against
    return score.argmax(axis=2)


def pseudo_inverse(basis: SampledBasis, k: int) -> np.ndarray:
    """The matrix ``(k, q)`` float32 that takes values at samples to coefficients, by damped least squares."""
    phi = to_numpy(basis.functions)[:, :k]
    weighted = (to_numpy(basis.mass)[:, None] * phi).T
    solution = (1 + RIDGE) * np.linalg.solve(weighted @ phi + RIDGE * np.eye(k), weighted)
    return np.asarray(solution, dtype=np.float32)
