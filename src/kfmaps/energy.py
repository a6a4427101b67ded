"""Quadratic energies of a functional map: ``½⟨C, A(C)⟩ − ⟨B, C⟩ + c`` for ``C`` of shape (k_t, k_s).

Every term keeps its operator ``A`` (half the Hessian of the squared norm it stands for), right-hand side ``B``, the
exact diagonal of ``A`` and the constant ``c``; :func:`value` of a term is half its squared residual norm. With
features ``W`` (descriptors, or Nyström features of a kernel) and ``P̂ = Φᵀ A W``, ``Xⁱ = Φᵀ A diag(wᵢ) Φ``:

=====================  ==============================  ==========================================
term                   squared residual                source
=====================  ==============================  ==========================================
descriptor_term        ‖C P̂_s − P̂_t‖²                  Ovsjanikov et al. 2012; paper, (2) and (8)
slice_term             Σᵢ ‖C X_sⁱ − X_tⁱ C‖²           Nogneng, Ovsjanikov 2017; paper, (3) and (9)
hadamard_term          the same for a whole kernel     paper, (10) to (12)
laplacian_term         ‖C Λ_s − Λ_t C‖²                paper, (1)
=====================  ==============================  ==========================================
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Protocol

from kfmaps._arrays import Array, blocks, check, inner, namespace, refuse
from kfmaps.kernels import KernelLike, gram
from kfmaps.spectrum import Basis


class Term(Protocol):
    """A quadratic term; all arrays have shape (k_t, k_s)."""

    def apply(self, C: Array) -> Array:
        """``A(C)``: linear, self-adjoint, positive semi-definite."""
        ...

    def rhs(self) -> Array:
        """``B``."""
        ...

    def diagonal(self) -> Array:
        """The exact diagonal of ``A``."""
        ...

    def constant(self) -> float:
        """``c``, with which the value is half the squared residual and never negative."""
        ...

    def sides(self) -> tuple[Array, Array]:
        """``S_t`` (k_t, k_t) and ``S_s`` (k_s, k_s) of the part ``S_t C + C S_s`` of ``A``; zeros for none."""
        ...

    def rotated_diagonal(self, U_t: Array, U_s: Array) -> Array:
        """The exact diagonal of ``C ↦ U_tᵀ A(U_t C U_sᵀ) U_s`` for orthogonal ``U_t``, ``U_s``."""
        ...


def value(term: Term, C: Array) -> float:
    """Half the squared residual of ``term`` at ``C``."""
    return 0.5 * inner(C, term.apply(C)) - inner(term.rhs(), C) + term.constant()


@dataclass(frozen=True, eq=False)
class Preservation:
    """``½‖C P_s − P_t‖²`` through Gram matrices; made by :func:`descriptor_term` or :func:`kernel_descriptor_term`."""

    gram_s: Array
    cross: Array
    total: float

    def apply(self, C: Array) -> Array:
        return C @ self.gram_s

    def rhs(self) -> Array:
        return self.cross

    def diagonal(self) -> Array:
        xp = namespace(self.cross)
        return xp.broadcast_to(xp.linalg.diagonal(self.gram_s)[None, :], self.cross.shape)

    def constant(self) -> float:
        return self.total

    def sides(self) -> tuple[Array, Array]:
        return _zeros(self.cross.shape[0], self.gram_s), self.gram_s

    def rotated_diagonal(self, U_t: Array, U_s: Array) -> Array:
        xp = namespace(self.cross)
        return xp.broadcast_to(_rotated(self.gram_s, U_s)[None, :], (U_t.shape[1], U_s.shape[1]))


def descriptor_term(source: Basis, features_s: Array, target: Basis, features_t: Array) -> Preservation:
    """Preservation of the features ``(n_s, r)`` and ``(n_t, r)``."""
    _same_count(features_s, features_t)
    coefficients_s, coefficients_t = source.project(features_s), target.project(features_t)
    return Preservation(
        coefficients_s @ coefficients_s.T,
        coefficients_t @ coefficients_s.T,
        0.5 * inner(coefficients_t, coefficients_t),
    )


def kernel_descriptor_term(
    kernel: KernelLike,
    source: Basis,
    descriptors_s: Array,
    target: Basis,
    descriptors_t: Array,
    block: int = 1024,
) -> Preservation:
    """The same for a whole kernel (equation 8), in row blocks: no (n_s, n_t) matrix is ever held."""
    _same_count(descriptors_s, descriptors_t)
    sides = ((source, descriptors_s), (target, descriptors_t))
    weighted = [basis.functions * basis.mass[:, None] for basis, _ in sides]

    def sandwich(i: int, j: int) -> Array:
        rows = sides[i][1]
        return sum(
            weighted[i][part, :].T @ (gram(kernel, rows[part, :], sides[j][1]) @ weighted[j])
            for part in blocks(rows.shape[0], block)
        )

    trace = float(namespace(descriptors_t).linalg.trace(sandwich(1, 1)))
    return Preservation(sandwich(0, 0), sandwich(1, 0), 0.5 * trace)


@dataclass(frozen=True, eq=False)
class SliceCommutativity:
    """``½ Σᵢ ‖C X_sⁱ − X_tⁱ C‖²`` with the slices at hand; made by :func:`slice_term`.

    ``parity`` is +1 for symmetric slices (multiplication by a function), −1 for antisymmetric ones (the
    orientation operators). The slices lie in two layouts that turn one application into two matrix products.
    """

    left: Array  # (k_t · r, k_t): the target's slices, row a of slice i at a·r + i
    right: Array  # (r · k_s, k_s): the source's slices, one below the other
    gram_s: Array
    gram_t: Array
    cross_diagonal: Array
    parity: int

    @property
    def count(self) -> int:
        """Number of slices, r."""
        return int(self.right.shape[0] // self.right.shape[1])

    def apply(self, C: Array) -> Array:
        xp = namespace(C)
        k_t, k_s = C.shape
        carried = xp.reshape(self.left @ C, (k_t, self.count * k_s))
        return C @ self.gram_s + self.gram_t @ C - (2 * self.parity) * (carried @ self.right)

    def rhs(self) -> Array:
        return namespace(self.gram_t).zeros_like(self.cross_diagonal)

    def diagonal(self) -> Array:
        xp = namespace(self.gram_t)
        own = xp.linalg.diagonal(self.gram_t)[:, None] + xp.linalg.diagonal(self.gram_s)[None, :]
        return own - (2 * self.parity) * self.cross_diagonal

    def constant(self) -> float:
        return 0.0

    def sides(self) -> tuple[Array, Array]:
        return self.gram_t, self.gram_s

    def rotated_diagonal(self, U_t: Array, U_s: Array) -> Array:
        xp = namespace(self.gram_t)
        k_t, k_s = self.gram_t.shape[0], self.gram_s.shape[0]
        of_s = xp.sum(xp.reshape(self.right @ U_s, (self.count, k_s, k_s)) * U_s[None, :, :], axis=1)
        of_t = xp.sum(xp.reshape(self.left @ U_t, (k_t, self.count, k_t)) * U_t[:, None, :], axis=0)
        own = _rotated(self.gram_t, U_t)[:, None] + _rotated(self.gram_s, U_s)[None, :]
        return own - (2 * self.parity) * (of_t.T @ of_s)


def slice_term(slices_s: Array, slices_t: Array, parity: int = 1) -> SliceCommutativity:
    """Commutativity with the operators ``slices_s (r, k_s, k_s)`` and ``slices_t (r, k_t, k_t)``.

    Raises
    ------
    InvalidInput
        Unless both have the same number of square slices and ``parity`` is 1 or −1.
    """
    xp = namespace(slices_s, slices_t)
    r, k_s, _ = slices_s.shape
    k_t = slices_t.shape[1]
    check(slices_s, "slices_s", shape=(r, k_s, k_s))
    check(slices_t, "slices_t", shape=(r, k_t, k_t), remedy="give as many slices on both shapes")
    if parity not in (1, -1):
        raise refuse("parity", "1 (symmetric slices) or -1 (antisymmetric)", repr(parity), "choose one")
    right = xp.reshape(slices_s, (r * k_s, k_s))
    left = xp.reshape(xp.permute_dims(slices_t, (1, 0, 2)), (k_t * r, k_t))
    # Xᵀ = parity X, so that Σ X Xᵀ = parity Σ X X is a Gram matrix of the stacked rows.
    flat_t = xp.reshape(slices_t, (r * k_t, k_t))
    cross = xp.linalg.diagonal(slices_t).T @ xp.linalg.diagonal(slices_s)
    return SliceCommutativity(left, right, right.T @ right, flat_t.T @ flat_t, cross, parity)


@dataclass(frozen=True, eq=False)
class HadamardCommutativity:
    """The commutativity term of a whole kernel (equations 10 to 12); made by :func:`hadamard_term`."""

    kernel: KernelLike
    weighted_s: Array  # A Φ
    weighted_t: Array
    functions_s: Array
    functions_t: Array
    descriptors_s: Array
    descriptors_t: Array
    gram_s: Array
    gram_t: Array
    block: int

    def apply(self, C: Array) -> Array:
        mixed = namespace(C).zeros_like(C)
        carried = C @ self.functions_s.T
        for rows in blocks(self.functions_t.shape[0], self.block):
            product = (self.functions_t[rows, :] @ carried) * self._cross(rows)
            mixed = mixed + self.weighted_t[rows, :].T @ (product @ self.weighted_s)
        return C @ self.gram_s + self.gram_t @ C - 2 * mixed

    def rhs(self) -> Array:
        xp = namespace(self.gram_t)
        shape = (self.gram_t.shape[0], self.gram_s.shape[0])
        return xp.zeros(shape, dtype=self.gram_t.dtype, device=self.gram_t.device)

    def diagonal(self) -> Array:
        xp = namespace(self.gram_t)
        own = xp.linalg.diagonal(self.gram_t)[:, None] + xp.linalg.diagonal(self.gram_s)[None, :]
        return own - 2 * self._coupling(self.weighted_t * self.functions_t, self.weighted_s * self.functions_s)

    def constant(self) -> float:
        return 0.0

    def sides(self) -> tuple[Array, Array]:
        return self.gram_t, self.gram_s

    def rotated_diagonal(self, U_t: Array, U_s: Array) -> Array:
        own = _rotated(self.gram_t, U_t)[:, None] + _rotated(self.gram_s, U_s)[None, :]
        squares_t = (self.weighted_t @ U_t) * (self.functions_t @ U_t)
        return own - 2 * self._coupling(squares_t, (self.weighted_s @ U_s) * (self.functions_s @ U_s))

    def _coupling(self, squares_t: Array, squares_s: Array) -> Array:
        cross = self.rhs()
        for rows in blocks(squares_t.shape[0], self.block):
            cross = cross + squares_t[rows, :].T @ (self._cross(rows) @ squares_s)
        return cross

    def _cross(self, rows: slice) -> Array:
        return gram(self.kernel, self.descriptors_t[rows, :], self.descriptors_s)


def hadamard_term(
    kernel: KernelLike,
    source: Basis,
    descriptors_s: Array,
    target: Basis,
    descriptors_t: Array,
    block: int = 512,
) -> HadamardCommutativity:
    """Commutativity for the exact kernel of the descriptors ``(n_s, d)`` and ``(n_t, d)``.

    Every application costs ``n_s n_t`` kernel values and as many multiply-adds for each column of ``C``, in blocks
    of ``block`` rows: the oracle for :func:`slice_term`, and what to use when no approximation will do.
    """
    _same_count(descriptors_s, descriptors_t)
    sides = ((source, descriptors_s), (target, descriptors_t))
    weighted = [basis.functions * basis.mass[:, None] for basis, _ in sides]

    def squares(i: int) -> Array:
        basis, rows = sides[i]
        total = 0.0
        for part in blocks(rows.shape[0], block):
            product = (basis.functions[part, :] @ basis.functions.T) * gram(kernel, rows[part, :], rows)
            total = total + weighted[i][part, :].T @ (product @ weighted[i])
        return total

    return HadamardCommutativity(
        kernel,
        weighted[0],
        weighted[1],
        source.functions,
        target.functions,
        descriptors_s,
        descriptors_t,
        squares(0),
        squares(1),
        block,
    )


@dataclass(frozen=True, eq=False)
class Elementwise:
    """``½ Σ weightsₐᵦ Cₐᵦ²`` with ``weights (k_t, k_s) >= 0``; made by :func:`laplacian_term`."""

    weights: Array

    def apply(self, C: Array) -> Array:
        return self.weights * C

    def rhs(self) -> Array:
        return namespace(self.weights).zeros_like(self.weights)

    def diagonal(self) -> Array:
        return self.weights

    def constant(self) -> float:
        return 0.0

    def sides(self) -> tuple[Array, Array]:
        k_t, k_s = self.weights.shape
        return _zeros(k_t, self.weights), _zeros(k_s, self.weights)

    def rotated_diagonal(self, U_t: Array, U_s: Array) -> Array:
        return (U_t * U_t).T @ self.weights @ (U_s * U_s)


def laplacian_term(source: Basis, target: Basis, scale: float | None = None) -> Elementwise:
    """Commutativity with the Laplacian: weights ``((λ_s,b − λ_t,a) / scale)²``.

    ``scale=None`` takes the larger of the two last eigenvalues, so that the weights lie in [0, 1] and α means
    the same at every basis size; ``scale=1`` is the paper's term as written.
    """
    xp = namespace(source.eigenvalues)
    if scale is None:
        scale = max(float(xp.max(source.eigenvalues)), float(xp.max(target.eigenvalues)), 1e-300)
    difference = (source.eigenvalues[None, :] - target.eigenvalues[:, None]) / scale
    return Elementwise(difference * difference)


@dataclass(frozen=True, eq=False)
class Energy:
    """A named weighted sum of terms, itself a :class:`Term`; terms of weight zero are left out.

    Parameters
    ----------
    terms : mapping of name to term
    weights : mapping of name to float
        At least zero, one for each term.

    Raises
    ------
    InvalidInput
        When the names differ, a weight is negative or not finite, or no weight is above zero.
    """

    terms: Mapping[str, Term]
    weights: Mapping[str, float]

    def __post_init__(self) -> None:
        if set(self.terms) != set(self.weights):
            raise refuse("Energy weights", f"names {sorted(self.terms)}", f"{sorted(self.weights)}", "name each")
        for name, weight in self.weights.items():
            if not 0 <= weight < float("inf"):
                raise refuse(f"weight of {name}", "a finite number of at least zero", repr(weight), "use 0 to omit")
        if not any(weight > 0 for weight in self.weights.values()):
            raise refuse("Energy weights", "at least one above zero", "none", "nothing would determine the map")

    def _active(self) -> list[tuple[float, Term]]:
        return [(self.weights[name], term) for name, term in self.terms.items() if self.weights[name] > 0]

    def apply(self, C: Array) -> Array:
        return _total(weight * term.apply(C) for weight, term in self._active())

    def rhs(self) -> Array:
        return _total(weight * term.rhs() for weight, term in self._active())

    def diagonal(self) -> Array:
        return _total(weight * term.diagonal() for weight, term in self._active())

    def constant(self) -> float:
        return sum(weight * term.constant() for weight, term in self._active())

    def sides(self) -> tuple[Array, Array]:
        sides = [(weight, term.sides()) for weight, term in self._active()]
        return _total(weight * S[0] for weight, S in sides), _total(weight * S[1] for weight, S in sides)

    def rotated_diagonal(self, U_t: Array, U_s: Array) -> Array:
        return _total(weight * term.rotated_diagonal(U_t, U_s) for weight, term in self._active())

    def breakdown(self, C: Array) -> dict[str, float]:
        """Weighted value of each term at ``C``; they add up to ``value(self, C)``."""
        return {name: weight * value(self.terms[name], C) if weight else 0.0 for name, weight in self.weights.items()}


def _zeros(k: int, like: Array) -> Array:
    return namespace(like).zeros((k, k), dtype=like.dtype, device=like.device)


def _rotated(gram: Array, U: Array) -> Array:
    """The diagonal of ``Uᵀ gram U``."""
    return namespace(gram).sum(U * (gram @ U), axis=0)


def _total(arrays: Iterable[Array]) -> Array:
    result = None
    for array in arrays:
        result = array if result is None else result + array
    return result


def _same_count(a: Array, b: Array) -> None:
    if a.shape[1] != b.shape[1]:
        raise refuse(
            "descriptors",
            "the same number on both shapes",
            f"{a.shape[1]} and {b.shape[1]}",
            "make them alike",
        )
