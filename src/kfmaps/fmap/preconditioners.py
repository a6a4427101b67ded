"""Approximate inverses of the energy's operator, for conjugate gradients.

The operator is ``A(C) = C S_s + S_t C + rest``, where the Gram matrices of descriptors and operators are ``S_s`` and
``S_t``, and the rest couples both sides. :func:`jacobi` divides by the diagonal. :func:`sylvester` divides by the
diagonal that the whole operator has in the eigenbases of ``S_s`` and ``S_t``: were there no rest, that would be the
exact inverse. Without the rest's diagonal it is worse than :func:`jacobi`; see research/operator.md.
"""

from __future__ import annotations

from kfmaps._arrays import Array, namespace
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.solvers import Operator


def jacobi(diagonal: Array) -> Operator:
    """Return the division by ``diagonal (k_t, k_s)``, which leaves entries alone where the diagonal is zero."""
    safe = _safe(diagonal)
    return lambda r: r / safe


def sylvester(energy: Energy) -> Operator:
    """Return the division by the exact diagonal of the operator in the eigenbases of its two one-sided parts.

    It costs two eigendecompositions and the diagonal, once, and four k × k products an application.
    """
    S_t, S_s = energy.sides()
    xp = namespace(S_t, S_s)
    U_t, U_s = xp.linalg.eigh(S_t)[1], xp.linalg.eigh(S_s)[1]
    safe = _safe(energy.diagonal(U_t, U_s))
    return lambda r: U_t @ ((U_t.T @ r @ U_s) / safe) @ U_s.T


def _safe(diagonal: Array) -> Array:
    xp = namespace(diagonal)
    floor = 1e-12 * float(xp.max(diagonal))
    return xp.where(diagonal > floor, diagonal, xp.ones_like(diagonal))
