"""The whole configuration, with the presets of the paper and of the literature."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, get_args

from kfmaps import _records
from kfmaps._arrays import refuse
from kfmaps._records import JsonObject, check_record, setting, settings_record
from kfmaps.config.sections import BasisConfig, DescriptorConfig, Formulation, NystromConfig, Partial, Search, Weights
from kfmaps.fmap.minimize import Preconditioner
from kfmaps.fmap.refine import ICP, Refinement
from kfmaps.fmap.solvers import CG, Solver
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.kernels.kernels import Gaussian, KernelLike, Linear, describe_kernel
from kfmaps.kernels.transformed import KERNELS
from kfmaps.registration.nonrigid_icp import NonRigid


@settings_record
class Config:
    """Settings of a match. ``Config()`` has those that :func:`kfmaps.match` uses; :meth:`single_fit` makes no search.

    ``kernel`` is a record of :mod:`kfmaps.kernels` or any callable that returns (n, m) values for (n, d) and (m, d)
    arrays; ``refinement`` and ``registration`` may be callables too. Each of ``terms`` is called with both shapes and
    returns a term (:class:`kfmaps.matching.assemble.TermFactory`).

    Examples
    --------
    >>> from dataclasses import replace
    >>> replace(kfmaps.Config(), kernel=kfmaps.Laplacian(gamma=2.0))
    Config(kernel=Laplacian(gamma=2.0))
    >>> kfmaps.Config.single_fit().search is None
    True
    """

    basis: BasisConfig = setting(BasisConfig, "eigenfunctions of the functional map")
    descriptors: DescriptorConfig = setting(DescriptorConfig, "descriptors, which the map preserves")
    kernel: KernelLike = setting(Gaussian, "the kernel", option="--kernel")
    bandwidth_scale: float = setting(0.3, "automatic gamma times the median squared distance", above=0)
    nystrom: NystromConfig = setting(NystromConfig, "the approximation of the kernel")
    full_kernel: bool = setting(False, "the exact kernel in row blocks (equations 8 and 10 to 12), no Nyström; slow")
    weights: Weights = setting(Weights, "weights of the terms")
    terms: tuple[Any, ...] = setting((), "further terms, callables (source, target) -> term", python_only=True)
    formulation: Formulation = setting(Formulation, "constraints and penalties beside least squares")
    operator_rtol: float = setting(
        1e-3, "share of the squared norm of the multiplication operators that is truncated", low=0, below=1
    )
    solver: Solver = setting(CG, "conjugate gradients, or dense for small bases")
    preconditioner: Preconditioner = setting("sylvester", "preconditioner of conjugate gradients")
    fit_samples: int | None = setting(
        10_000, "points of each shape that the fit is made from; the point map always uses all", low=2, none="all"
    )
    refinement: Refinement | None = setting(
        lambda: ZoomOut(start=50, stop=100, step=20, samples=3500, descriptor_weight=36.0),
        "refinement of the map after the fit",
    )
    registration: NonRigid | Callable[..., Any] | None = setting(
        NonRigid, "non-rigid registration after the refinement"
    )
    search: Search | None = setting(Search, "search among many candidate maps; none: one fit")
    partial: Partial = setting(Partial, "matching of parts")
    device: str = setting("cpu", "where the fit is computed: cpu, or a PyTorch device such as cuda", option="--device")
    threads: int | None = setting(None, "number of Python threads, by default every core", low=1, option="--threads")

    def __post_init__(self) -> None:
        check_record(self)
        for one in self.terms:
            if not callable(one) or isinstance(one, type):
                raise refuse("Config.terms", "callables of two shapes", repr(one)[:60], "see docs/extend.md")
        if self.formulation.weighs_features:
            if self.full_kernel:
                got, remedy = "the full kernel, which has none", "take it per descriptor"
                raise refuse("loss per feature", "features", got, remedy)
            if not self.weights.descriptors:
                remedy = "raise it, or take the loss per descriptor"
                raise refuse("loss per feature", "a weight of descriptor preservation above zero", "0", remedy)

    @property
    def n_eigenfunctions(self) -> int:
        """Number of eigenfunctions of each shape: the most that map, descriptors or refinement need."""
        spectral = self.descriptors.signature != "none" or self.descriptors.landmark_descriptor != "none"
        refined = getattr(self.refinement, "n_eigenfunctions", 0)
        return max(self.basis.n_eigenfunctions, self.descriptors.n_eigenfunctions if spectral else 0, refined)

    @classmethod
    def single_fit(cls) -> Config:
        """One fit of whole shapes without a search, which without landmarks cannot tell left from right."""
        return cls(
            descriptors=DescriptorConfig(shot=False, n_eigenfunctions=200),
            refinement=ZoomOut(start=50, stop=200, step=10, samples=5000),
            search=None,
            partial=Partial("none"),
        )

    @classmethod
    def paper(cls) -> Config:
        """The paper's section 7: k = 100, 100 descriptors, a Gaussian kernel, rank 400, α = 1, ten steps of plain
        conjugate gradients, no refinement.

        Each descriptor has a maximum of 1, as in section 7.1. With it the paper's Nyström errors are reproduced, but
        the γ = 500 of figure 6 is far too large: the paper does not give its scale. So γ comes from a grid search on
        the first two people of FAUST, as in the paper (research/paper.md).
        """
        single = cls.single_fit()
        return replace(
            single,
            descriptors=replace(single.descriptors, normalisation="max"),
            kernel=Gaussian(0.1),
            weights=Weights(descriptors=1.0, commutativity=1.0, laplacian=1.0),
            operator_rtol=0.0,
            solver=CG(rtol=1e-12, max_iter=10),
            preconditioner="none",
            fit_samples=None,
            refinement=None,
            registration=None,
        )

    @classmethod
    def no17(cls) -> Config:
        """Nogneng and Ovsjanikov (2017): a linear kernel, each descriptor of norm 1, and a converged solve."""
        paper = cls.paper()
        return replace(
            paper,
            descriptors=replace(paper.descriptors, normalisation="norm"),
            kernel=Linear(),
            solver=CG(rtol=1e-6, max_iter=5000),
            preconditioner="jacobi",
        )

    @classmethod
    def obcs12(cls) -> Config:
        """Ovsjanikov et al. (2012) in the framework of NO17: no commutativity with multiplication by descriptors.

        The weights are those of that framework's demonstration, 0.1 and 1e-3. The second is for Laplacian weights
        divided by their squared Frobenius norm, so it is about 1e-12 here: hardly any regularisation. With α = 1 the
        method has smaller errors.
        """
        return replace(cls.no17(), weights=Weights(descriptors=0.1, commutativity=0.0, laplacian=1e-12))

    @classmethod
    def published(cls, name: str) -> Config:
        """One of :data:`FORMULATIONS` with a linear kernel and nothing but descriptors and the Laplacian.

        Sizes, descriptors and weights are those of :meth:`obcs12` with α = 1, for "ren19" of :meth:`no17`, so that
        presets differ in the formulation alone, and from a run with ``kernel=Gaussian()`` in the kernel alone.
        """
        if name not in FORMULATIONS:
            raise refuse("preset", "one of " + ", ".join(FORMULATIONS), repr(name), "choose one of them")
        base = cls.no17()
        weights = base.weights if name == "ren19" else Weights(1.0, 0.0, 1.0)
        return replace(base, weights=weights, formulation=FORMULATIONS[name])


FORMULATIONS = {
    "kovnatsky13": Formulation(coupled_bases=True),  # Coupled quasi-harmonic bases
    "pokrass13": Formulation(sparsity=0.001),  # Sparse modeling of intrinsic correspondences
    "kovnatsky15": Formulation(loss="l21", loss_group="descriptor"),  # Functional correspondence by matrix completion
    "kovnatsky16": Formulation("orthogonal", loss="l21", loss_group="descriptor"),  # MADMM
    "eynard16": Formulation(bidirectional=True, inverse_weight=1.0, adjoint_weight=0.0),  # Coupled functional maps
    "huang17": Formulation(bidirectional=True, inverse_weight=0.0, adjoint_weight=1.0),  # Adjoint map representation
    "gasparetto17": Formulation(transport_weight=0.1),  # Spatial maps
    "ren19": Formulation(mask="resolvent", mask_power=0.5),  # Structured regularization
}
"""Formulations of published methods; docs/formulations.md describes them."""

KINDS: _records.Kinds = {KernelLike: KERNELS, Refinement: (ZoomOut, ICP)}
"""Records that a settings file can name for fields that take any callable."""

RECORDS = {kind.__name__: kind for kind in (*KERNELS, ZoomOut, ICP, *get_args(Solver), NonRigid, Search)}
"""Records that a settings file names by ``kind``, since a field may hold one of several."""


def as_dict(value: Any) -> Any:
    """Return a configuration as nested dictionaries of plain values, fit for JSON and TOML.

    A record in a field that takes several kinds has its name under ``kind``. A kernel or refinement that is another
    callable becomes ``{"kind": "callable", "name": …}``, which :func:`from_dict` refuses.
    """
    return _records.record_as_dict(value, RECORDS, describe_kernel)


def from_dict(values: JsonObject, base: Config | None = None) -> Config:
    """Return ``base``, by default ``Config()``, with the settings in ``values``; the inverse of :func:`as_dict`."""
    return _records.update(base or Config(), values, Config(), KINDS)
