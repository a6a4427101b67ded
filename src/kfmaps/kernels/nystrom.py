"""Nyström features of the joint kernel of both surfaces (section 6.2 of the paper).

One set of samples, drawn from both surfaces, serves both: with ``R₀ = k(S, S) = V Λ Vᵀ`` the features are ``W = k(P, S)
V Λ^(-1/2)``, so that ``W_s W_tᵀ`` approximates the kernel between the surfaces and ``W_s W_sᵀ`` that within one, all
from a single positive semi-definite approximation. Whatever is computed from ``W`` as if it were a descriptor keeps the
least-squares form, and with it the convergence of conjugate gradients.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import Array, KfmapsWarning, blocks, check, like, namespace, refuse, take, to_numpy
from kfmaps.kernels.kernels import KernelLike, describe_kernel, kernel_matrix


@dataclass(frozen=True, eq=False)
class Nystrom:
    """A factored kernel approximation; made by :func:`nystrom`."""

    kernel: KernelLike
    samples: Array  # (q, d): the descriptors that the approximation is built from
    whitener: Array  # (q, r): ``V Λ^(-1/2)`` over the kept eigenvalues, largest first

    @property
    def rank(self) -> int:
        """Number of features, r."""
        return int(self.whitener.shape[1])

    def features(self, X: Array, block: int = 8192) -> Array:
        """Return the features ``W (n, r)`` of descriptors ``X (n, d)``, with ``W Wᵀ ≈ k(X, X)``, by ``block`` rows."""
        check(X, "descriptors", shape=(None, self.samples.shape[1]), remedy="use those that the samples come from")
        rows = [
            kernel_matrix(self.kernel, X[part, :], self.samples) @ self.whitener for part in blocks(X.shape[0], block)
        ]
        return namespace(X).concat(rows)


def nystrom(kernel: KernelLike, samples: Array, rtol: float = 1e-12) -> Nystrom:
    """Factor the kernel matrix of some samples.

    ``R₀`` is numerically singular for smooth kernels, so small eigenvalues are dropped. Negative ones beyond that (an
    indefinite kernel such as tanh) are dropped with a :class:`KfmapsWarning`, and with them all that are smaller than a
    fifth of the most negative one. Of those, a point that is no sample has in ``k(P, S) V`` much of the negative part
    beside its own: divided by their roots it would give features of any length, where it now has at most ``‖k(P, S)‖² /
    (λ_min / 5)``.

    Parameters
    ----------
    kernel : Kernel or callable
    samples : (q, d)
        Descriptors.
    rtol : float
        Part of the largest eigenvalue below which others are dropped.

    Returns
    -------
    Nystrom

    Raises
    ------
    InvalidInput
        If no eigenvalue is positive, or the kernel returns a wrong shape or NaN.
    """
    if not 0 <= rtol < 1:
        raise refuse("Nyström rtol", "a number from 0 to below 1", repr(rtol), "choose 1e-12, say")
    xp = namespace(samples)
    values = kernel_matrix(kernel, samples, samples)
    eigenvalues, vectors = xp.linalg.eigh((values + values.T) / 2)
    spectrum = to_numpy(eigenvalues)
    top = float(spectrum[-1])
    if not top > 0:
        remedy = "use a positive definite kernel such as Gaussian"
        raise refuse(f"kernel {describe_kernel(kernel)}", "a positive eigenvalue", f"{top:.3g} as the largest", remedy)
    negative = max(0.0, -float(spectrum[0])) / top
    indefinite = negative > max(rtol, 1e-10)
    least = min(max(rtol, 0.2 * negative), 0.999) if indefinite else rtol  # the largest stays
    keep = np.flatnonzero(spectrum > least * top)[::-1]
    if indefinite:
        warnings.warn(
            f"kernel {describe_kernel(kernel)} is not positive definite on these samples (most negative eigenvalue "
            f"{negative:.2g} of the largest); its negative part is left out",
            KfmapsWarning,
            stacklevel=2,
        )
    kept = take(vectors, keep, axis=1)
    scale = like(1 / np.sqrt(spectrum[keep]), samples)
    return Nystrom(kernel, samples, kept * scale[None, :])
