"""Quadratic energies of a functional map: ``½⟨C, A(C)⟩ − ⟨B, C⟩ + c`` for ``C`` of shape (k_t, k_s).

Every term has its operator ``A`` (half the Hessian of its squared norm), right-hand side ``B``, the exact diagonal of
``A`` and the constant ``c``; its :func:`value` is half its squared residual norm. With features
``W`` (descriptors, or Nyström features of a kernel) and ``P̂ = Φᵀ A W``, ``Xⁱ = Φᵀ A diag(wᵢ) Φ``:

=====================  ==============================  ==============================================
term                   squared residual                source
=====================  ==============================  ==============================================
descriptor_term        ‖C P̂_s − P̂_t‖²                  Ovsjanikov et al. 2012; paper, (2) and (8)
operator_term          Σᵢ ‖C X_sⁱ − X_tⁱ C‖²           Nogneng, Ovsjanikov 2017; paper, (3) and (9)
hadamard_term          the same for a whole kernel     paper, (10) to (12)
laplacian_term         ‖C Λ_s − Λ_t C‖²                paper, (1); or Ren et al. 2019: mask="resolvent"
inverse_term           ‖C D − I‖² + ‖D C − I‖²         Eynard et al. 2016; D (k_s, k_t) the other way
adjoint_term           ‖C − Dᵀ‖²                       Huang, Ovsjanikov 2017
=====================  ==============================  ==============================================
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from kfmaps._arrays import Array, refuse
from kfmaps.fmap.terms import Term, value


@dataclass(frozen=True, eq=False)
class Energy:
    """A named weighted sum of terms, itself a :class:`~kfmaps.fmap.terms.Term`; terms of weight zero are left out.

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
            raise refuse("Energy weights", f"names {sorted(self.terms)}", f"{sorted(self.weights)}", "weigh each term")
        for name, weight in self.weights.items():
            if not 0 <= weight < float("inf"):
                raise refuse(f"weight of {name}", "a finite number of at least zero", repr(weight), "use 0 to omit")
        if not any(weight > 0 for weight in self.weights.values()):
            raise refuse("Energy weights", "at least one above zero", "none", "raise one, or no map is best")

    def _active(self) -> list[tuple[float, Term]]:
        return [(self.weights[name], term) for name, term in self.terms.items() if self.weights[name] > 0]

    def apply(self, C: Array) -> Array:
        return _total(weight * term.apply(C) for weight, term in self._active())

    def rhs(self) -> Array:
        return _total(weight * term.rhs() for weight, term in self._active())

    def diagonal(self, U_t: Array | None = None, U_s: Array | None = None) -> Array:
        return _total(weight * term.diagonal(U_t, U_s) for weight, term in self._active())

    def constant(self) -> float:
        return sum(weight * term.constant() for weight, term in self._active())

    def sides(self) -> tuple[Array, Array]:
        sides = [(weight, term.sides()) for weight, term in self._active()]
        return _total(weight * S[0] for weight, S in sides), _total(weight * S[1] for weight, S in sides)

    def joined(self, more: Mapping[str, tuple[float, Term]]) -> Energy:
        """Return the energy with further terms, ``more`` being ``{name: (weight, term)}``."""
        return Energy(
            {**self.terms, **{name: term for name, (_, term) in more.items()}},
            {**self.weights, **{name: weight for name, (weight, _) in more.items()}},
        )

    def without(self, name: str) -> Energy:
        """Return the energy without the term called ``name``, if it has one."""
        return Energy(
            {other: term for other, term in self.terms.items() if other != name},
            {other: weight for other, weight in self.weights.items() if other != name},
        )

    def breakdown(self, C: Array) -> dict[str, float]:
        """Return the weighted value of each term at ``C``; they add up to ``value(self, C)``."""
        # With operators in single precision a value of zero may come out a little below.
        return {
            name: weight * max(value(self.terms[name], C), 0.0) if weight else 0.0
            for name, weight in self.weights.items()
        }


def _total(arrays: Iterable[Array]) -> Array:
    result = None
    for array in arrays:
        result = array if result is None else result + array
    return result
