"""A penalty by optimal transport: it draws a functional map to a soft point map that covers the area of both shapes.

A small functional map is a low-rank description of a point map, which need not reach all of both surfaces. In the basis
of points instead of eigenfunctions the same map is a transport plan, which should move all area of the source, and to
each point of the target no more than its own (Gasparetto, Cosmo, Rodolà, Bronstein and Torsello, Spatial maps, 2017;
their algorithm is another). The penalty is

    value(C) = min over Π ≥ 0 of  ½ Σ_ij Π_ij ‖φ_t(i) − C φ_s(j)‖² + ε KL(Π | a_t a_sᵀ)
                                  + ρ KL(Π 1 | a_t) + ρ KL(Πᵀ 1 | a_s),

unbalanced optimal transport between the target's points and the images of the source's (Chizat et al. 2018), computed
by scaling rows and columns in turn (Sinkhorn 1967). For a fixed Π it is quadratic in C, and so is its majorizer
(:class:`kfmaps.fmap.losses.Penalty`).
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from kfmaps._arrays import Array, check_positive, namespace, to_numpy
from kfmaps.fmap.terms import Term, source_term
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.sampling import stratified_samples

_STIFFNESS = 10.0
"""``ρ / ε``: cost of moving less or more than a point's area, against that of a blurred plan."""


@dataclass(frozen=True, eq=False)
class TransportPenalty:
    """The penalty above, between some points of both shapes; made by :func:`transport_penalty`."""

    functions_s: Array  # (m_s, k_s)
    functions_t: Array  # (m_t, k_t)
    mass_s: Array  # (m_s,): areas that the points stand for, of sum 1
    mass_t: Array  # (m_t,)
    blur: float  # ``ε``, in the unit of the squared distances
    _last: dict = field(default_factory=dict, repr=False)

    def plan(self, C: Array) -> Array:
        """Return ``Π (m_t, m_s)`` at ``C``: how much area of each source point goes to each target point."""
        return self._solved(C)[0]

    def value(self, C: Array) -> float:
        return self._solved(C)[1]

    def majorizer(self, C: Array) -> Term:
        plan = self.plan(C)
        xp = namespace(plan)
        arriving, leaving = xp.sum(plan, axis=1), xp.sum(plan, axis=0)
        cross = self.functions_t.T @ (plan @ self.functions_s)
        gram = self.functions_s.T @ (leaving[:, None] * self.functions_s)
        total = 0.5 * float(xp.sum(arriving[:, None] * self.functions_t * self.functions_t))
        return source_term(gram, cross, total)

    def _solved(self, C: Array) -> tuple[Array, float]:
        """Return the plan at ``C`` and the value, cached for the last map."""
        if self._last.get("map") is not C:
            cost = _costs(C, self.functions_s, self.functions_t)
            self._last.update(map=C, solution=_transport(cost, self.mass_t, self.mass_s, self.blur))
        return self._last["solution"]


def transport_penalty(C: Array, source: Basis, target: Basis, blur: float = 0.3) -> TransportPenalty:
    """Return the penalty for maps near to ``C``.

    Parameters
    ----------
    C : (k_t, k_s)
    source, target : Basis
        Of at least that many functions; 500 points of each take part.
    blur : float
        ``ε`` in units of the median cost of the nearest point at ``C``.
    """
    check_positive(blur, "blur")
    few = [stratified_samples(b.truncate(k), 500).basis for b, k in ((source, C.shape[1]), (target, C.shape[0]))]
    xp = namespace(C)
    mass_s, mass_t = (b.mass / xp.sum(b.mass) for b in few)
    nearest = to_numpy(xp.min(_costs(C, few[0].functions, few[1].functions), axis=1))
    unit = max(float(np.median(nearest)), 1e-12)
    return TransportPenalty(few[0].functions, few[1].functions, mass_s, mass_t, blur * unit)


def _costs(C: Array, functions_s: Array, functions_t: Array) -> Array:
    """Return ``½‖φ_t(i) − C φ_s(j)‖²``, (m_t, m_s)."""
    xp = namespace(C)
    images = functions_s @ C.T
    squares = xp.sum(functions_t**2, axis=1)[:, None] + xp.sum(images**2, axis=1)[None, :]
    cost = 0.5 * squares - functions_t @ images.T
    return xp.where(cost > 0, cost, xp.zeros_like(cost))


def _transport(cost: Array, a: Array, b: Array, blur: float) -> tuple[Array, float]:
    """Return the plan of unbalanced transport for ``cost (m, n)`` between masses ``a (m,)``, ``b (n,)``, and its value.

    Potentials ``f``, ``g`` of rows and columns are improved in turn. The scalings are absorbed into them from time to
    time, so that nothing under- or overflows.
    """
    xp = namespace(cost)
    tiny = 1e-300  # keeps logarithms finite
    damped = _STIFFNESS / (1.0 + _STIFFNESS)  # ρ / (ρ + ε)
    scaled = -cost / blur
    f = -damped * _log_sum(scaled + xp.log(b)[None, :], 1)
    g = -damped * _log_sum(scaled + (xp.log(a) + f)[:, None], 0)
    kernel = xp.exp(scaled + f[:, None] + g[None, :])
    up, vp = xp.zeros_like(a), xp.zeros_like(b)  # what is to be added to the potentials
    for step in range(300):
        # The new f is −damped · log(K (b eᵍ)), of which the kernel holds eᶠ and eᵍ already.
        moved = -damped * xp.log(kernel @ (b * xp.exp(vp)) + tiny) - (1.0 - damped) * f
        change = float(xp.max(xp.abs(moved - up)))
        up = moved
        vp = -damped * xp.log(kernel.T @ (a * xp.exp(up)) + tiny) - (1.0 - damped) * g
        if change < 1e-7:
            break
        if step % 20 == 19 or change > 50.0:
            f, g = f + up, g + vp
            kernel = xp.exp(scaled + f[:, None] + g[None, :])
            up, vp = xp.zeros_like(a), xp.zeros_like(b)
    f, g = f + up, g + vp
    plan = a[:, None] * xp.exp(scaled + f[:, None] + g[None, :]) * b[None, :]
    # The value by duality, exact where rows and columns have settled.
    one = _STIFFNESS * (xp.sum(a * (1.0 - xp.exp(-f / _STIFFNESS))) + xp.sum(b * (1.0 - xp.exp(-g / _STIFFNESS))))
    dual = float(one) + float(xp.sum(a)) * float(xp.sum(b)) - float(xp.sum(plan))
    return plan, blur * dual


def _log_sum(values: Array, axis: int) -> Array:
    """Return ``log Σ exp`` along an axis."""
    xp = namespace(values)
    top = xp.max(values, axis=axis, keepdims=True)
    return xp.log(xp.sum(xp.exp(values - top), axis=axis)) + (top[:, 0] if axis else top[0, :])
