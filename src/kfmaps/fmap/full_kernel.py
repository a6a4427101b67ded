"""The terms of a whole kernel, without Nyström features: equations (8) and (10) to (12) in row blocks."""

from __future__ import annotations

from dataclasses import dataclass

from kfmaps._arrays import Array, blocks, namespace, number
from kfmaps.fmap.terms import GramTerm, TwoSidedTerm, check_same_count, source_term
from kfmaps.geometry.basis import Basis
from kfmaps.kernels.kernels import KernelLike, kernel_matrix


def kernel_descriptor_term(
    kernel: KernelLike, source: Basis, descriptors_s: Array, target: Basis, descriptors_t: Array, block: int = 1024
) -> GramTerm:
    """Return the preservation of the features of a whole kernel (equation 8).

    ``descriptors_s (n_s, d)`` and ``descriptors_t (n_t, d)``; ``block``: rows of one block: no (n_s, n_t) matrix is
    held.
    """
    check_same_count(descriptors_s, descriptors_t)
    sides = ((source, descriptors_s), (target, descriptors_t))
    weighted = _weighted(source), _weighted(target)

    def sandwich(i: int, j: int) -> Array:
        rows = sides[i][1]
        return sum(
            weighted[i][part, :].T @ (kernel_matrix(kernel, rows[part, :], sides[j][1]) @ weighted[j])
            for part in blocks(rows.shape[0], block)
        )

    trace = number(namespace(descriptors_t).linalg.trace(sandwich(1, 1)))
    return source_term(sandwich(0, 0), sandwich(1, 0), 0.5 * trace)


@dataclass(frozen=True, eq=False)
class HadamardCommutativity(TwoSidedTerm):
    """The commutativity term of a whole kernel (equations 10 to 12); made by :func:`hadamard_term`."""

    kernel: KernelLike
    source: Basis
    target: Basis
    descriptors_s: Array
    descriptors_t: Array
    block: int

    def apply(self, C: Array) -> Array:
        mixed = namespace(C).zeros_like(C)
        carried = C @ self.source.functions.T
        weighted_s, weighted_t = _weighted(self.source), _weighted(self.target)
        for rows in blocks(self.target.functions.shape[0], self.block):
            product = (self.target.functions[rows, :] @ carried) * self._cross(rows)
            mixed = mixed + weighted_t[rows, :].T @ (product @ weighted_s)
        return C @ self.gram_s + self.gram_t @ C - 2 * mixed

    def coupling(self, U_t: Array | None = None, U_s: Array | None = None) -> Array:
        squares = []
        for basis, U in ((self.target, U_t), (self.source, U_s)):
            sides = _weighted(basis), basis.functions
            squares.append(sides[0] * sides[1] if U is None else (sides[0] @ U) * (sides[1] @ U))
        cross = self.rhs()
        for rows in blocks(squares[0].shape[0], self.block):
            cross = cross + squares[0][rows, :].T @ (self._cross(rows) @ squares[1])
        return cross

    def _cross(self, rows: slice) -> Array:
        return kernel_matrix(self.kernel, self.descriptors_t[rows, :], self.descriptors_s)


def hadamard_term(
    kernel: KernelLike, source: Basis, descriptors_s: Array, target: Basis, descriptors_t: Array, block: int = 512
) -> HadamardCommutativity:
    """Return the commutativity with the operators of a whole kernel (equations 10 to 12).

    Every application costs ``n_s n_t`` kernel values and as many multiply-adds for each column of ``C``, in blocks of
    ``block`` rows: what :func:`~kfmaps.fmap.terms.operator_term` is tested with, and for when no approximation will do.
    The parameters are those of :func:`kernel_descriptor_term`.
    """
    check_same_count(descriptors_s, descriptors_t)
    sides = ((source, descriptors_s), (target, descriptors_t))
    weighted = _weighted(source), _weighted(target)

    def squares(i: int) -> Array:
        basis, rows = sides[i]
        total = 0.0
        for part in blocks(rows.shape[0], block):
            product = (basis.functions[part, :] @ basis.functions.T) * kernel_matrix(kernel, rows[part, :], rows)
            total = total + weighted[i][part, :].T @ (product @ weighted[i])
        return total

    grams = squares(0), squares(1)
    return HadamardCommutativity(*grams, kernel, source, target, descriptors_s, descriptors_t, block)


def _weighted(basis: Basis) -> Array:
    """``A Φ``, (n, k)."""
    return basis.functions * basis.mass[:, None]
