"""Terms of a full kernel, without Nyström features: equations (8) and (10) to (12) of the paper in row blocks."""

from __future__ import annotations

from dataclasses import dataclass

from kfmaps._arrays import Array, blocks, namespace, number
from kfmaps.fmap.terms import GramTerm, TwoSidedTerm, check_same_count, source_term
from kfmaps.geometry.basis import Basis
from kfmaps.kernels.kernels import KernelLike, kernel_matrix


def kernel_descriptor_term(
    kernel: KernelLike, source: Basis, descriptors_s: Array, target: Basis, descriptors_t: Array, block: int = 1024
) -> GramTerm:
    """Return the preservation of the features of a full kernel (equation 8).

    ``descriptors_s (n_s, d)`` and ``descriptors_t (n_t, d)``; ``block``: rows of one block, so that no (n_s, n_t)
    matrix is held.
    """
    check_same_count(descriptors_s, descriptors_t)
    sides = ((source, descriptors_s), (target, descriptors_t))
    weighted = _weighted(source), _weighted(target)

    def gram(i: int, j: int) -> Array:
        """``Φᵢᵀ Aᵢ K Aⱼ Φⱼ`` between two shapes."""
        rows = sides[i][1]
        return sum(
            weighted[i][part, :].T @ (kernel_matrix(kernel, rows[part, :], sides[j][1]) @ weighted[j])
            for part in blocks(rows.shape[0], block)
        )

    trace = number(namespace(descriptors_t).linalg.trace(gram(1, 1)))
    return source_term(gram(0, 0), gram(1, 0), 0.5 * trace)


@dataclass(frozen=True, eq=False)
class HadamardCommutativity(TwoSidedTerm):
    """The commutativity term of a full kernel (equations 10 to 12); made by :func:`hadamard_term`."""

    kernel: KernelLike
    source: Basis
    target: Basis
    descriptors_s: Array
    descriptors_t: Array
    block: int

    def apply(self, C: Array) -> Array:
        coupled = namespace(C).zeros_like(C)
        images = C @ self.source.functions.T
        weighted_s, weighted_t = _weighted(self.source), _weighted(self.target)
        for rows in blocks(self.target.functions.shape[0], self.block):
            product = (self.target.functions[rows, :] @ images) * self._kernel_rows(rows)
            coupled = coupled + weighted_t[rows, :].T @ (product @ weighted_s)
        return C @ self.gram_s + self.gram_t @ C - 2 * coupled

    def coupling(self, U_t: Array | None = None, U_s: Array | None = None) -> Array:
        squares = []
        for basis, U in ((self.target, U_t), (self.source, U_s)):
            weighted, functions = _weighted(basis), basis.functions
            squares.append(weighted * functions if U is None else (weighted @ U) * (functions @ U))
        diagonal = self.rhs()  # zeros
        for rows in blocks(squares[0].shape[0], self.block):
            diagonal = diagonal + squares[0][rows, :].T @ (self._kernel_rows(rows) @ squares[1])
        return diagonal

    def _kernel_rows(self, rows: slice) -> Array:
        return kernel_matrix(self.kernel, self.descriptors_t[rows, :], self.descriptors_s)


def hadamard_term(
    kernel: KernelLike, source: Basis, descriptors_s: Array, target: Basis, descriptors_t: Array, block: int = 512
) -> HadamardCommutativity:
    """Return the commutativity with the operators of a full kernel (equations 10 to 12).

    Every application costs ``n_s n_t`` kernel values and as many multiply-adds for each column of ``C``.
    :func:`~kfmaps.fmap.terms.operator_term` is tested with it. The parameters are those of
    :func:`kernel_descriptor_term`.
    """
    check_same_count(descriptors_s, descriptors_t)
    grams = []
    for basis, descriptors in ((source, descriptors_s), (target, descriptors_t)):
        weighted, gram = _weighted(basis), 0.0
        for rows in blocks(descriptors.shape[0], block):
            kernel_rows = kernel_matrix(kernel, descriptors[rows, :], descriptors)
            product = (basis.functions[rows, :] @ basis.functions.T) * kernel_rows
            gram = gram + weighted[rows, :].T @ (product @ weighted)
        grams.append(gram)
    return HadamardCommutativity(grams[0], grams[1], kernel, source, target, descriptors_s, descriptors_t, block)


def _weighted(basis: Basis) -> Array:
    """Return ``A Φ``, (n, k)."""
    return basis.functions * basis.mass[:, None]
