"""Assemble the energy of a functional map from the descriptors of two shapes, as the configuration says."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from kfmaps._arrays import Array, inner, is_numpy, like, refuse, to_numpy
from kfmaps.config import Config
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.full_kernel import hadamard_term, kernel_descriptor_term
from kfmaps.fmap.multiplication_operators import (
    multiplication_operators,
    truncate_features,
    truncate_operators,
    unpack_operators,
)
from kfmaps.fmap.terms import Term, complete_term, descriptor_term, laplacian_term, operator_term
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.orientation_operators import orientation_operators
from kfmaps.kernels.kernels import KernelLike
from kfmaps.matching.features import Descriptors, Features, kernel_features, resolve_kernel_width
from kfmaps.shape import Shape

FEATURES_SHARE = 0.5
"""Part of ``operator_rtol`` that is spent on the features, before operators are formed of them."""
ORIENTATION_FEATURES = 40
"""Features whose orientation operators are formed: the strongest of the joint singular value decomposition."""


class TermFactory(Protocol):
    """Makes a term of the energy for two shapes; one of :attr:`kfmaps.Config.terms`.

    It is called with both prepared shapes, on the points that the fit is made from, and their bases truncated to the
    size of the map. It returns a term (:class:`kfmaps.fmap.terms.Term`), one of the package's own or an object with
    ``apply``, ``rhs``, ``diagonal`` and ``constant``. Its attribute ``weight`` is that in the energy, by default 1.
    """

    def __call__(self, source: Shape, target: Shape) -> Term: ...


@dataclass(frozen=True, eq=False)
class FitProblem:
    """All that the energy of a map between two shapes is made of, in both directions; made by :func:`assemble`."""

    config: Config
    shapes: tuple[Shape, Shape]  # on the points that the fit is made from
    bases: tuple[Basis, Basis]  # as large as the map, on the device of the computation
    kernel: KernelLike  # with every γ a number
    descriptors: Descriptors
    features: Features | None = None  # ``None`` with the exact kernel
    # Operators that the map should commute with, packed, on source and target.
    multiplications: tuple[Array, Array] | None = None
    orientations: tuple[Array, Array] | None = None

    @property
    def rank(self) -> int:
        """Number of kernel features; without Nyström approximation that of all points."""
        sides = (self.descriptors.source, self.descriptors.target)
        return sum(D.shape[0] for D in sides) if self.features is None else int(self.features.source.shape[1])

    @property
    def n_operators(self) -> int:
        """Number of multiplication operators after truncation."""
        return 0 if self.multiplications is None else int(self.multiplications[0].shape[0])

    @cached_property
    def energy(self) -> Energy:
        """The energy of the map from source to target."""
        return self._energy(0, 1)

    @cached_property
    def reverse(self) -> Energy:
        """The energy of the map from target to source."""
        return self._energy(1, 0)

    def _energy(self, s: int, t: int) -> Energy:
        weights, bases, formulation = self.config.weights, self.bases, self.config.formulation
        terms: dict[str, Term] = {
            "laplacian": laplacian_term(bases[s], bases[t], mask=formulation.mask, power=formulation.mask_power)
        }
        if self.features is None:
            D = (self.descriptors.source, self.descriptors.target)
            arguments = (self.kernel, bases[s], D[s], bases[t], D[t])
            if weights.descriptors:
                terms["descriptors"] = kernel_descriptor_term(*arguments)
            if weights.commutativity:
                terms["commutativity"] = hadamard_term(*arguments)
        elif weights.descriptors:
            F = (self.features.source, self.features.target)
            terms["descriptors"] = descriptor_term(bases[s], F[s], bases[t], F[t])
        sets = (("commutativity", self.multiplications, 1), ("orientation", self.orientations, -1))
        for name, operators, parity in sets:
            if operators is not None:
                single = is_numpy(*operators) and _serves_in_single(self.config.operator_rtol)
                terms[name] = operator_term(operators[s], operators[t], parity, single)
        energy = Energy(terms, {name: getattr(weights, name) for name in terms})
        pair = [replace(shape, basis=basis) for shape, basis in zip(self.shapes, bases, strict=True)]
        more = {}
        for factory in self.config.terms:
            name = getattr(factory, "__name__", type(factory).__name__)  # of the function or class
            name = name if name not in (*terms, *more) else f"{name} {len(more) + 1}"
            more[name] = (float(getattr(factory, "weight", 1.0)), complete_term(factory(pair[s], pair[t])))
        return energy.joined(more)


def assemble(
    source: Shape,
    target: Shape,
    bases: tuple[Basis, Basis],
    descriptors: Descriptors,
    config: Config,
    rng: np.random.Generator,
    whole: tuple[Shape, Shape] | None = None,
) -> FitProblem:
    """Compute kernel, features and operators as ``config`` says, from which the energy is made.

    ``bases`` have at least the map's size and are on the device of ``descriptors``. Where ``source`` and ``target`` are
    samples of shapes (:func:`kfmaps.shape.sample_shape`), ``whole`` are those shapes: orientation needs their faces.
    """
    small = (bases[0].truncate(config.basis.n_eigenfunctions), bases[1].truncate(config.basis.n_eigenfunctions))
    weights, shapes = config.weights, (source, target)
    if config.full_kernel:
        if weights.orientation:
            raise refuse("orientation weight", "0 with the full kernel", str(weights.orientation), "use features")
        return FitProblem(config, shapes, small, resolve_kernel_width(descriptors, config, rng), descriptors)
    features = kernel_features(source, target, descriptors, config, rng)
    multiplications, orientations, size = None, None, 0.0
    if weights.commutativity:
        packed = compressed_operators(small, (features.source, features.target), config.operator_rtol)
        size = sum(inner(X, X) for X in packed)
        multiplications = (unpack_operators(packed[0]), unpack_operators(packed[1]))
    if weights.orientation:
        strongest = principal_features(small, features, ORIENTATION_FEATURES)
        size = size or 2.0 * small[0].functions.shape[1]
        k = config.basis.n_eigenfunctions
        orientations = orientation_pair(shapes, whole or shapes, bases, strongest, k, size)
    return FitProblem(config, shapes, small, features.kernel, descriptors, features, multiplications, orientations)


def compressed_operators(bases: tuple[Basis, Basis], features: tuple[Array, Array], rtol: float) -> tuple[Array, Array]:
    """Return packed multiplication operators of the features of both shapes, truncated to ``rtol`` unless it is 0."""
    if rtol:
        features = truncate_features(bases[0], features[0], bases[1], features[1], FEATURES_SHARE * rtol)
    packed_s, packed_t = (
        multiplication_operators(b, F, single=_serves_in_single(rtol)) for b, F in zip(bases, features, strict=True)
    )
    return truncate_operators(packed_s, packed_t, rtol) if rtol else (packed_s, packed_t)


def _serves_in_single(rtol: float) -> bool:
    """Return whether a truncation to ``rtol`` leaves out more than single precision rounds."""
    return rtol >= 1e-10


def scale_operators(pair: Sequence[Array], size: float) -> tuple[Array, Array]:
    """Return operators of both shapes scaled so that their summed squared norm is ``size``."""
    total = sum(inner(X, X) for X in pair)
    scale = (size / total) ** 0.5 if total else 0.0
    return pair[0] * scale, pair[1] * scale


def orientation_pair(
    shapes: tuple[Shape, Shape],
    whole: tuple[Shape, Shape],
    bases: tuple[Basis, Basis],
    features: Features,
    k: int,
    size: float,
) -> tuple[Array, Array]:
    """Return operators ``Ω_w[g] = n · (∇w × ∇g)`` for each of ``features``, (k, k), of both shapes (Ren et al. 2018).

    The operators change sign under a mirror, so maps that commute with them preserve orientation. Their summed squared
    norm is scaled to ``size``, that of the multiplication operators, so that the weights of both terms compare.
    Features on samples are extended to the ``whole`` shapes by their coefficients in the basis.
    """
    operators = []
    for shape, full, basis, F in zip(shapes, whole, bases, (features.source, features.target), strict=True):
        if full is not shape:
            F, basis = full.basis.reconstruct(to_numpy(basis.project(F))), full.basis
        operators.append(like(orientation_operators(full.mesh, basis.truncate(k), F), features.source))
    return scale_operators(operators, size)


def principal_features(bases: tuple[Basis, Basis], features: Features, count: int) -> Features:
    """Return the first ``count`` principal components of the features of both shapes, about their common mean."""
    F = [to_numpy(features.source), to_numpy(features.target)]
    mass = [to_numpy(b.mass) for b in bases]
    whole = sum(float(m @ (f * f).sum(axis=1)) for m, f in zip(mass, F, strict=True))
    mean = sum(m @ f / m.sum() for m, f in zip(mass, F, strict=True)) / 2
    F = [f - mean for f in F]
    gram = sum((f * m[:, None]).T @ f for m, f in zip(mass, F, strict=True))
    energies, rotation = np.linalg.eigh(gram)
    # Constants without their mean are rounding errors.
    is_signal = energies > 1e-24 * whole
    rotation = rotation[:, is_signal][:, ::-1][:, :count]
    strongest = [like(f @ rotation, features.source) for f in F]
    return Features(strongest[0], strongest[1], features.kernel)
