"""The quadratic terms that an energy is made of; what each stands for is in :mod:`kfmaps.fmap.energy`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, Protocol, get_args

from kfmaps._arrays import Array, check, check_positive, inner, namespace, refuse
from kfmaps.geometry.basis import Basis, eigenvalue_tolerance

Mask = Literal["squared", "resolvent"]


class Term(Protocol):
    """A quadratic term; all arrays have shape (k_t, k_s)."""

    def apply(self, C: Array) -> Array:
        """Return ``A(C)`` at ``C (k_t, k_s)``: linear, self-adjoint, positive semi-definite."""
        ...

    def rhs(self) -> Array:
        """Return ``B``."""
        ...

    def diagonal(self, U_t: Array | None = None, U_s: Array | None = None) -> Array:
        """Return the exact diagonal of ``A``, or of ``C ↦ U_tᵀ A(U_t C U_sᵀ) U_s`` for orthogonal ``U_t``, ``U_s``."""
        ...

    def constant(self) -> float:
        """Return ``c``, with which the value is half the squared residual and never negative."""
        ...

    def sides(self) -> tuple[Array, Array]:
        """Return ``S_t`` (k_t, k_t) and ``S_s`` (k_s, k_s) of the part ``S_t C + C S_s`` of ``A``; zeros for none."""
        ...


def value(term: Term, C: Array) -> float:
    """Return half the squared residual of a term at ``C (k_t, k_s)``."""
    return 0.5 * inner(C, term.apply(C)) - inner(term.rhs(), C) + term.constant()


@dataclass(frozen=True, eq=False)
class CompletedTerm:
    """A user's term with what preconditioners need besides; made by :func:`complete_term`.

    Its one-sided parts are zero, and its diagonal in other bases, which nobody knows, is taken to be the mean.
    """

    term: Any  # has the first four methods of :class:`Term`

    def apply(self, C: Array) -> Array:
        return self.term.apply(C)

    def rhs(self) -> Array:
        return self.term.rhs()

    def diagonal(self, U_t: Array | None = None, U_s: Array | None = None) -> Array:
        diagonal = self.term.diagonal()
        if U_t is None or U_s is None:
            return diagonal
        xp = namespace(diagonal)
        mean = float(xp.mean(diagonal))
        return xp.full((U_t.shape[1], U_s.shape[1]), mean, dtype=diagonal.dtype, device=diagonal.device)

    def constant(self) -> float:
        return self.term.constant()

    def sides(self) -> tuple[Array, Array]:
        B = self.term.rhs()
        return _zeros(B.shape[0], B), _zeros(B.shape[1], B)


def complete_term(term: Any) -> Term:
    """Return ``term``, an object with ``apply``, ``rhs``, ``diagonal`` and ``constant``, as a :class:`Term`.

    Raises
    ------
    InvalidInput
        When one of these four methods is missing.
    """
    missing = [name for name in ("apply", "rhs", "diagonal", "constant") if not hasattr(term, name)]
    if missing:
        raise refuse("term", "an object with apply, rhs, diagonal and constant", f"no {missing[0]}", "add that method")
    return term if hasattr(term, "sides") else CompletedTerm(term)


@dataclass(frozen=True, eq=False)
class TwoSidedTerm:
    """Base of terms ``½⟨C, gram_t C + C gram_s − 2 M(C)⟩``; ``M(C)`` of a commutativity is ``Σᵢ X_tⁱ C X_sⁱ``."""

    gram_s: Array  # (k_s, k_s), in a commutativity ``Σᵢ X Xᵀ`` of the shape's operators
    gram_t: Array  # (k_t, k_t)

    def coupling(self, U_t: Array | None = None, U_s: Array | None = None) -> Array | float:
        """Return the diagonal of ``M`` in bases rotated by ``U_t`` and ``U_s``, where given; 0 without ``M``."""
        del U_t, U_s
        return 0.0

    def rhs(self) -> Array:
        shape = (self.gram_t.shape[0], self.gram_s.shape[0])
        return namespace(self.gram_t).zeros(shape, dtype=self.gram_t.dtype, device=self.gram_t.device)

    def diagonal(self, U_t: Array | None = None, U_s: Array | None = None) -> Array:
        one_sided = rotated_diagonal(self.gram_t, U_t)[:, None] + rotated_diagonal(self.gram_s, U_s)[None, :]
        return one_sided - 2 * self.coupling(U_t, U_s)

    def constant(self) -> float:
        return 0.0

    def sides(self) -> tuple[Array, Array]:
        return self.gram_t, self.gram_s


@dataclass(frozen=True, eq=False)
class GramTerm(TwoSidedTerm):
    """``½⟨C, gram_t C + C gram_s⟩ − ⟨cross, C⟩ + total``, a term of two Gram matrices."""

    cross: Array  # (k_t, k_s)
    total: float

    def apply(self, C: Array) -> Array:
        return self.gram_t @ C + C @ self.gram_s

    def rhs(self) -> Array:
        return self.cross

    def constant(self) -> float:
        return self.total


def source_term(gram_s: Array, cross: Array, total: float) -> GramTerm:
    """Return ``½⟨C, C gram_s⟩ − ⟨cross, C⟩ + total``, a term of one Gram matrix."""
    return GramTerm(gram_s, _zeros(cross.shape[0], gram_s), cross, total)


def descriptor_term(source: Basis, features_s: Array, target: Basis, features_t: Array) -> GramTerm:
    """Return the preservation of ``features_s (n_s, r)``, ``features_t (n_t, r)``: ``½‖C Φ_s⁺ W_s − Φ_t⁺ W_t‖²``."""
    check_same_count(features_s, features_t)
    coefficients_s, coefficients_t = source.project(features_s), target.project(features_t)
    total = 0.5 * inner(coefficients_t, coefficients_t)
    return source_term(coefficients_s @ coefficients_s.T, coefficients_t @ coefficients_s.T, total)


@dataclass(frozen=True, eq=False)
class OperatorCommutativity(TwoSidedTerm):
    """``½ Σᵢ ‖C X_sⁱ − X_tⁱ C‖²``; made by :func:`operator_term`.

    The operators are stacked so that applying the term takes two matrix products, in the precision that they are stored
    in. The Gram matrices keep full precision, without which small differences would be lost.
    """

    left: Array  # (k_t · r, k_t): the target's operators, row a of operator i at a·r + i
    right: Array  # (r · k_s, k_s): the source's operators, one below the other
    cross_diagonal: Array  # (k_t, k_s): ``Σᵢ diag(X_tⁱ) diag(X_sⁱ)ᵀ``; zero where the operators are antisymmetric
    parity: int  # +1 for symmetric operators (multiplication by a function), −1 for antisymmetric ones (orientation)

    @property
    def count(self) -> int:
        """Number of operators, r."""
        return int(self.right.shape[0] // self.right.shape[1])

    def apply(self, C: Array) -> Array:
        xp = namespace(C)
        k_t, k_s = C.shape
        products = xp.reshape(self.left @ xp.astype(C, self.left.dtype, copy=False), (k_t, self.count * k_s))
        return C @ self.gram_s + self.gram_t @ C - (2 * self.parity) * (products @ self.right)

    def coupling(self, U_t: Array | None = None, U_s: Array | None = None) -> Array:
        if U_t is None or U_s is None:
            return self.cross_diagonal
        xp, k_t, k_s = namespace(self.gram_t), U_t.shape[0], U_s.shape[0]
        diagonals_s = xp.sum(xp.reshape(self.right @ U_s, (self.count, k_s, k_s)) * U_s[None, :, :], axis=1)
        diagonals_t = xp.sum(xp.reshape(self.left @ U_t, (k_t, self.count, k_t)) * U_t[:, None, :], axis=0)
        return diagonals_t.T @ diagonals_s


def operator_term(
    operators_s: Array, operators_t: Array, parity: int = 1, single: bool = False
) -> OperatorCommutativity:
    """Return the commutativity with operators, ``½ Σᵢ ‖C X_sⁱ − X_tⁱ C‖²``.

    Parameters
    ----------
    operators_s, operators_t : (r, k_s, k_s), (r, k_t, k_t)
    parity : {1, -1}
        Whether they are symmetric (multiplication by a function) or antisymmetric (orientation operators).
    single : bool
        Whether :meth:`OperatorCommutativity.apply` multiplies by them in single precision: half of the time, and
        conjugate gradients reach a relative residual of 1e-7.

    Raises
    ------
    InvalidInput
        Unless both have the same number of square operators and ``parity`` is 1 or −1.
    """
    xp = namespace(operators_s, operators_t)
    r, k_s, _ = operators_s.shape
    k_t = operators_t.shape[1]
    check(operators_s, "operators_s", shape=(r, k_s, k_s))
    check(operators_t, "operators_t", shape=(r, k_t, k_t), remedy="give as many operators on both shapes")
    if parity not in (1, -1):
        raise refuse("parity", "1 (symmetric operators) or -1 (antisymmetric)", repr(parity), "choose one")
    right = xp.reshape(operators_s, (r * k_s, k_s))
    left = xp.reshape(xp.permute_dims(operators_t, (1, 0, 2)), (k_t * r, k_t))
    # Xᵀ = parity X, so that Σ X Xᵀ = parity Σ X X is a Gram matrix of the stacked rows.
    flat_t = xp.reshape(operators_t, (r * k_t, k_t))
    cross = xp.linalg.diagonal(operators_t).T @ xp.linalg.diagonal(operators_s)
    grams = right.T @ right, flat_t.T @ flat_t
    if single:
        left, right = xp.astype(left, xp.float32), xp.astype(right, xp.float32)
    return OperatorCommutativity(*grams, left, right, cross, parity)


@dataclass(frozen=True, eq=False)
class Elementwise:
    """``½ Σ weightsₐᵦ Cₐᵦ²`` with ``weights (k_t, k_s) >= 0``; made by :func:`laplacian_term`."""

    weights: Array

    def apply(self, C: Array) -> Array:
        return self.weights * C

    def rhs(self) -> Array:
        return namespace(self.weights).zeros_like(self.weights)

    def diagonal(self, U_t: Array | None = None, U_s: Array | None = None) -> Array:
        if U_t is None or U_s is None:
            return self.weights
        return (U_t * U_t).T @ self.weights @ (U_s * U_s)

    def constant(self) -> float:
        return 0.0

    def sides(self) -> tuple[Array, Array]:
        k_t, k_s = self.weights.shape
        return _zeros(k_t, self.weights), _zeros(k_s, self.weights)


def laplacian_term(
    source: Basis, target: Basis, scale: float | None = None, mask: Mask = "squared", power: float = 0.5
) -> Elementwise:
    """Return the commutativity with the Laplacian: weights ``((λ_s,b − λ_t,a) / scale)²``.

    With the mask "resolvent" it is commutativity with the resolvent ``(Δ^γ − i)⁻¹`` of the scaled Laplacian's power
    ``γ``, a bounded operator: weights ``|1 / (λ_t,a^γ − i) − 1 / (λ_s,b^γ − i)|²``, in [0, 1] (Ren, Panine, Wonka and
    Ovsjanikov, Structured regularization of functional map computations, 2019).

    Parameters
    ----------
    source, target : Basis
    scale : float, optional
        By default the larger of the two last eigenvalues, so that the weights lie in [0, 1] and α means the same at
        every basis size; 1 is the paper's term as written.
    mask : {"squared", "resolvent"}
    power : float
        ``γ``.
    """
    xp = namespace(source.eigenvalues)
    if mask not in get_args(Mask):
        raise refuse("mask", "one of " + ", ".join(get_args(Mask)), repr(mask), "choose one of them")
    if scale is None:
        scale = max(float(xp.max(source.eigenvalues)), float(xp.max(target.eigenvalues)), eigenvalue_tolerance(source))
    if mask == "squared":
        difference = (source.eigenvalues[None, :] - target.eigenvalues[:, None]) / scale
        return Elementwise(difference * difference)
    check_positive(power, "resolvent power", "0.5 is usual")
    resolvents = []
    for basis in (source, target):
        root = xp.where(basis.eigenvalues > 0, basis.eigenvalues, xp.zeros_like(basis.eigenvalues)) / scale
        root = root**power
        resolvents.append((root / (root * root + 1), 1 / (root * root + 1)))  # real and imaginary part of 1 / (λ^γ − i)
    real, imaginary = (t[:, None] - s[None, :] for s, t in zip(*resolvents, strict=True))
    return Elementwise(real * real + imaginary * imaginary)


def inverse_term(back: Array) -> GramTerm:
    """Return ``½‖C back − I‖² + ½‖back C − I‖²`` for a map ``back (k_s, k_t)`` the other way (Eynard et al. 2016)."""
    k_s, k_t = back.shape
    return GramTerm(back @ back.T, back.T @ back, 2.0 * back.T, 0.5 * (k_s + k_t))


def adjoint_term(back: Array) -> GramTerm:
    """Return ``½‖C − backᵀ‖²`` for a map ``back (k_s, k_t)`` the other way (Huang and Ovsjanikov 2017).

    In bases that are orthonormal in the area the adjoint is the transpose: the map back of one that keeps areas.
    """
    xp = namespace(back)
    one = xp.eye(back.shape[0], dtype=back.dtype, device=back.device)
    return source_term(one, back.T, 0.5 * inner(back, back))


def _zeros(k: int, like: Array) -> Array:
    return namespace(like).zeros((k, k), dtype=like.dtype, device=like.device)


def rotated_diagonal(gram: Array, U: Array | None) -> Array:
    """Return the diagonal of ``Uᵀ gram U`` for ``gram (k, k)`` and orthogonal ``U``, of ``gram`` without ``U``."""
    xp = namespace(gram)
    return xp.linalg.diagonal(gram) if U is None else xp.sum(U * (gram @ U), axis=0)


def check_same_count(a: Array, b: Array) -> None:
    if a.shape[1] != b.shape[1]:
        raise refuse(
            "descriptors", "the same number on both shapes", f"{a.shape[1]} and {b.shape[1]}", "compute both alike"
        )
