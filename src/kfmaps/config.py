"""Every number of a match, as small frozen records whose defaults are the recommended ones."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import Any, Literal, get_args

from kfmaps import _records
from kfmaps._arrays import check_count, check_positive, refuse
from kfmaps.descriptors.spectral import NORMALISATIONS, Normalisation
from kfmaps.fmap.losses import LOSSES, LossName
from kfmaps.fmap.minimize import CONSTRAINTS, Constraint, Preconditioner
from kfmaps.fmap.refine import Refinement, ZoomOut
from kfmaps.fmap.solvers import CG, Solver
from kfmaps.fmap.terms import MASKS, Mask
from kfmaps.kernels.kernels import Gaussian, KernelLike, Linear, describe_kernel
from kfmaps.kernels.transformed import KERNELS
from kfmaps.registration.nonrigid_icp import NonRigid

Sampling = Literal["descriptor", "geodesic", "uniform", "cholesky", "random-cholesky", "squared-cholesky"]
SAMPLINGS: tuple[str, ...] = get_args(Sampling)


def _choice(value: str, name: str, options: tuple[str, ...]) -> None:
    if value not in options:
        raise refuse(name, "one of " + ", ".join(options), repr(value), "choose one of them")


@dataclass(frozen=True)
class BasisConfig:
    """``functions``: size of the functional map on both sides; ``laplacian``: "robust" (tufted) or "cotangent"."""

    functions: int = 100
    laplacian: Literal["robust", "cotangent"] = "robust"

    def __post_init__(self) -> None:
        check_count(self.functions, "basis functions", low=2)
        _choice(self.laplacian, "laplacian", ("robust", "cotangent"))


@dataclass(frozen=True)
class DescriptorConfig:
    """What is preserved.

    Attributes
    ----------
    count : int
        Spectral descriptors in all, shared out between the signature and the landmarks' maps.
    signature : "wave", "heat" or "none"
    landmark_map : "wave", "heat" or "none"
    signature_share : float
        Part of ``count`` that goes to the signature when there are landmarks; the rest is split evenly.
    eigenfunctions : int
        How many the descriptors are made from.
    layout : "even" or "every-nth"
        Energies spread evenly over the numbers wanted, or, as the framework of NO17 does, 200 energies for the
        signature and for each landmark, in one list from which every n-th is taken.
    shot : bool
        Whether to add the SHOT descriptor (Tombari et al. 2010), beyond ``count``.
    shot_radius : float
        Its radius, in units of √area.
    shot_weight : float
        Its weight in squared distances between descriptors, against 1 for all others together.
    normalisation : str
        See :func:`kfmaps.descriptors.spectral.normalize`.
    """

    count: int = 100
    signature: Literal["wave", "heat", "none"] = "wave"
    landmark_map: Literal["wave", "heat", "none"] = "wave"
    signature_share: float = 0.3
    eigenfunctions: int = 150
    layout: Literal["even", "every-nth"] = "even"
    shot: bool = True
    shot_radius: float = 0.09
    shot_weight: float = 1.0
    normalisation: Normalisation = "variance"

    def __post_init__(self) -> None:
        check_count(self.count, "descriptor count")
        check_count(self.eigenfunctions, "descriptor eigenfunctions", low=2)
        _choice(self.signature, "signature", ("wave", "heat", "none"))
        _choice(self.landmark_map, "landmark map", ("wave", "heat", "none"))
        _choice(self.layout, "descriptor layout", ("even", "every-nth"))
        _choice(self.normalisation, "normalisation", NORMALISATIONS)
        if not 0 <= self.signature_share <= 1:
            raise refuse("signature share", "a number from 0 to 1", repr(self.signature_share), "0.3 is usual")
        check_positive(self.shot_radius, "SHOT radius")
        check_positive(self.shot_weight, "SHOT weight")


@dataclass(frozen=True)
class NystromConfig:
    """``samples``: of both shapes together, half from each (the paper's "rank"); ``rtol``: see :func:`nystrom`."""

    samples: int = 400
    sampling: Sampling = "descriptor"
    rtol: float = 1e-12

    def __post_init__(self) -> None:
        check_count(self.samples, "Nyström samples", low=2)
        _choice(self.sampling, "sampling", SAMPLINGS)


@dataclass(frozen=True)
class Weights:
    """Of the energy's terms; ``laplacian`` is the paper's α, for eigenvalues divided by the largest."""

    descriptors: float = 100.0
    commutativity: float = 1.0
    laplacian: float = 1.0
    orientation: float = 0.0

    def __post_init__(self) -> None:
        for item in fields(self):
            weight = getattr(self, item.name)
            if not 0 <= weight < float("inf"):
                raise refuse(
                    f"weight of {item.name}",
                    "a finite number of at least zero",
                    repr(weight),
                    "use 0 to omit",
                )


LossPer = Literal["landmark", "descriptor", "feature"]


@dataclass(frozen=True)
class Formulation:
    """What is asked of the map beside least squares; by default nothing. See docs/formulations.md.

    Attributes
    ----------
    constraint : "none" or "orthogonal"
        Orthogonal maps keep areas (:mod:`kfmaps.fmap.constraints`).
    directions : "one" or "both"
        Both maps at once, tied to each other (:func:`kfmaps.fmap.minimize.fit_bidirectional`).
    inverse, adjoint : float
        Weights of that tie: each map the other's inverse, each the other's adjoint. As those of ``sparsity`` and
        ``spatial`` they are in units of the mean diagonal of the energy's operator.
    loss : "squared", "huber", "l21" or "geman"
        Of the data (:mod:`kfmaps.fmap.losses`).
    loss_per : "landmark", "descriptor" or "feature"
        Whose residuals the loss is of. Landmarks and descriptors are weighed before the kernel
        (:mod:`kfmaps.matching.robust_weights`), features, which are the kernel's, after.
    loss_width : float
        Scale of the loss, in medians of the residuals of least squares.
    sparsity : float
        Weight of the entries' absolute values, growing away from the diagonal; 0 for none.
    mask : "squared" or "resolvent"
        How Laplacian commutativity weighs entries (:func:`kfmaps.fmap.energy.laplacian_term`).
    mask_power : float
        Power of the Laplacian in the resolvent.
    bases : "own" or "coupled"
        Whether Laplacian commutativity and sparsity are asked for in coupled bases
        (:mod:`kfmaps.fmap.coupled`), which the map without them speaks for.
    coupling : float
        Weight of that map against diagonal Laplacians in the choice of the bases.
    rounds : int
        At most, of reweighting and of both directions in turn.
    spatial : float
        Weight of agreement with the soft point map that moves the whole area of both shapes
        (:mod:`kfmaps.fmap.optimal_transport`); 0 for none.
    spatial_blur : float
        How soft that map is, in units of the cost of a nearest point.
    """

    constraint: Constraint = "none"
    directions: Literal["one", "both"] = "one"
    inverse: float = 0.1
    adjoint: float = 0.1
    loss: LossName = "squared"
    loss_per: LossPer = "landmark"
    loss_width: float = 1.0
    sparsity: float = 0.0
    mask: Mask = "squared"
    mask_power: float = 0.5
    bases: Literal["own", "coupled"] = "own"
    coupling: float = 1.0
    rounds: int = 20
    spatial: float = 0.0
    spatial_blur: float = 0.3

    def __post_init__(self) -> None:
        _choice(self.constraint, "constraint", CONSTRAINTS)
        _choice(self.directions, "directions", ("one", "both"))
        _choice(self.loss, "loss", LOSSES)
        _choice(self.loss_per, "loss per", get_args(LossPer))
        _choice(self.mask, "mask", MASKS)
        _choice(self.bases, "bases", ("own", "coupled"))
        for name in ("inverse", "adjoint", "sparsity", "spatial"):
            if not 0 <= getattr(self, name) < float("inf"):
                raise refuse(name, "a finite number of at least zero", repr(getattr(self, name)), "use 0 to omit")
        if self.directions == "both" and not (self.inverse or self.adjoint):
            raise refuse("inverse and adjoint", "one of them above zero", "both 0", "nothing ties the two directions")
        for name in ("loss_width", "mask_power", "coupling", "spatial_blur"):
            check_positive(getattr(self, name), name)
        check_count(self.rounds, "rounds")

    @property
    def weighs_data(self) -> bool:
        """Whether landmarks or descriptors are weighed before the kernel."""
        return self.loss != "squared" and self.loss_per != "feature"

    @property
    def weighs_features(self) -> bool:
        """Whether features of the kernel are weighed."""
        return self.loss != "squared" and self.loss_per == "feature"


@dataclass(frozen=True)
class Search:
    """How to find the map among many; see :mod:`kfmaps.matching.search`.

    ``candidates``: how many small fits are tried, each refined from three starts; ``signs``: how many low functions
    after the constant one have both their signs tried, 2^signs diagonal maps; ``tips``: whether the tips of limbs are
    paired in all likely ways as well, for bodies of different proportions; ``orientation``: whether the map keeps
    orientation ("kept"), is one to a mirror image ("reversed"), the latter only where one that keeps it would have to
    bend the source unduly and the other does not ("auto"), or the one of both that fits clearly better
    ("either": for bones, shoes or hands, which are not their own mirror images; of a body that is, either map fits, and
    "kept" is right); ``runners_up``: how many distinct other maps are
    returned at most.
    """

    candidates: int = 6
    orientation: Literal["auto", "kept", "reversed", "either"] = "auto"
    runners_up: int = 3
    signs: int = 5
    tips: bool = True

    def __post_init__(self) -> None:
        check_count(self.candidates, "candidates")
        check_count(self.signs, "signs", low=0)
        if self.signs > 10:
            raise refuse("signs", "at most 10", str(self.signs), "they make 2^signs maps: take more candidates instead")
        check_count(self.runners_up, "runners_up", low=0)
        _choice(self.orientation, "orientation", ("auto", "kept", "reversed", "either"))


Which = Literal["auto", "none", "source", "target", "both"]
Units = Literal["unknown", "same"]


@dataclass(frozen=True)
class Partial:
    """What of the shapes may be missing; see :mod:`kfmaps.matching.partial`.

    Attributes
    ----------
    which : "auto", "none", "source", "target" or "both"
        Which shape is a part of the other; "both": each has something that the other lacks. "auto" looks at their
        boundaries and, where these differ, at how one fits into the other.
    units : "unknown" or "same"
        Whether sizes of the two as they are given can be compared.
    samples, whole_samples : int
        Evenly spread points of the part and of the whole that are matched first.
    candidates : int
        Scales of the part that are followed up.
    """

    which: Which = "auto"
    units: Units = "unknown"
    samples: int = 300
    whole_samples: int = 1000
    candidates: int = 3

    def __post_init__(self) -> None:
        _choice(self.which, "partial", get_args(Which))
        _choice(self.units, "units", get_args(Units))
        check_count(self.samples, "samples of a part", low=20)
        check_count(self.whole_samples, "samples of a whole", low=20)
        check_count(self.candidates, "candidates of a part")


@dataclass(frozen=True)
class Config:
    """Settings of a match. ``Config()`` is what :func:`kfmaps.match` uses; :meth:`single_fit` makes no search.

    Attributes
    ----------
    exact : bool
        The whole kernel in row blocks (equations 8 and 10 to 12) instead of its Nyström features; slow.
    sharpness : float
        For a kernel without explicit γ, see :func:`kfmaps.kernels.kernels.resolve_kernel`.
    formulation : Formulation
        What is asked of the map beside least squares.
    compression : float
        Part of the slices' squared norm that may be left out, see
        :func:`kfmaps.fmap.multiplication_operators.truncate_operators`.
    preconditioner : "sylvester", "jacobi" or "none"
        See :mod:`kfmaps.fmap.preconditioners`.
    fit_samples : int or None
        Points of each shape that the fit is made from when there are more; the point map and the end of the
        refinement always use all. ``None`` takes all.
    refinement : ZoomOut, ICP or None
    finish : NonRigid or None
        The fit that makes a refined map finer than the source's vertices, see :mod:`kfmaps.registration.nonrigid_icp`.
        Without a refinement there is none.
    search : Search or None
        ``None`` makes one fit, which without landmarks cannot tell left from right.
    partial : Partial
        Whether one of the shapes is only a part of the other.
    device : str
        "cpu" for NumPy, or a PyTorch device such as "cuda"; "torch" is PyTorch on the CPU.
    threads : int or None
        Python threads; ``None`` takes every core.
    """

    basis: BasisConfig = field(default_factory=BasisConfig)
    descriptors: DescriptorConfig = field(default_factory=DescriptorConfig)
    kernel: KernelLike = field(default_factory=Gaussian)
    sharpness: float = 0.3
    nystrom: NystromConfig = field(default_factory=NystromConfig)
    exact: bool = False
    weights: Weights = field(default_factory=Weights)
    formulation: Formulation = field(default_factory=Formulation)
    compression: float = 1e-3
    solver: Solver = field(default_factory=lambda: CG(rtol=1e-6, max_steps=1000))
    preconditioner: Preconditioner = "sylvester"
    fit_samples: int | None = 10_000
    refinement: Refinement | None = field(
        default_factory=lambda: ZoomOut(start=50, stop=150, step=20, samples=3500, guidance=36.0)
    )
    finish: NonRigid | None = field(default_factory=NonRigid)
    search: Search | None = field(default_factory=Search)
    partial: Partial = field(default_factory=Partial)
    device: str = "cpu"
    threads: int | None = None

    def __post_init__(self) -> None:
        check_positive(self.sharpness, "sharpness")
        _choice(self.preconditioner, "preconditioner", ("none", "jacobi", "sylvester"))
        if not 0 <= self.compression < 1:
            raise refuse("compression", "a number from 0 to below 1", repr(self.compression), "1e-3 is usual")
        if self.fit_samples is not None:
            check_count(self.fit_samples, "fit_samples", low=2)
        if self.threads is not None:
            check_count(self.threads, "threads")
        if self.formulation.weighs_features:
            if self.exact:
                raise refuse(
                    "loss per feature", "features", "the exact kernel, which has none", "take it per descriptor"
                )
            if not self.weights.descriptors:
                remedy = "raise it, or take the loss per descriptor"
                raise refuse("loss per feature", "a weight of descriptor preservation above zero", "0", remedy)

    @property
    def eigenfunctions(self) -> int:
        """How many eigenfunctions each shape needs, the most of what map, descriptors and refinement ask for."""
        zoom = self.refinement.stop if isinstance(self.refinement, ZoomOut) else 0
        spectral = self.descriptors.signature != "none" or self.descriptors.landmark_map != "none"
        return max(self.basis.functions, self.descriptors.eigenfunctions if spectral else 0, zoom)

    @classmethod
    def single_fit(cls) -> Config:
        """One fit of whole shapes without a search, which without landmarks cannot tell left from right."""
        return cls(
            descriptors=DescriptorConfig(shot=False, eigenfunctions=200),
            refinement=ZoomOut(start=50, stop=200, step=10, samples=5000),
            search=None,
            partial=Partial("none"),
        )

    @classmethod
    def paper(cls) -> Config:
        """The paper's section 7: k = 100, 100 descriptors, a Gaussian kernel, rank 400, α = 1, ten steps of plain
        conjugate gradients, no refinement.

        Each descriptor has a maximum of 1, as in section 7.1. That is the reading under which the paper's Nyström
        errors come out, but the γ = 500 of figure 6 is then far too sharp: the paper does not give the scale that it
        belongs to. So γ is found as there, by a grid search, on the first two people of FAUST (research/paper.md).
        """
        single = cls.single_fit()
        return replace(
            single,
            descriptors=replace(single.descriptors, normalisation="max"),
            kernel=Gaussian(0.1),
            weights=Weights(descriptors=1.0, commutativity=1.0, laplacian=1.0),
            compression=0.0,
            solver=CG(rtol=1e-12, max_steps=10),
            preconditioner="none",
            fit_samples=None,
            refinement=None,
            finish=None,
        )

    @classmethod
    def no17(cls) -> Config:
        """Nogneng and Ovsjanikov (2017): a linear kernel, each descriptor of norm 1, and a converged solve."""
        paper = cls.paper()
        return replace(
            paper,
            descriptors=replace(paper.descriptors, normalisation="norm"),
            kernel=Linear(),
            solver=CG(rtol=1e-6, max_steps=5000),
            preconditioner="jacobi",
        )

    @classmethod
    def obcs12(cls) -> Config:
        """Ovsjanikov et al. (2012) in the framework of NO17: no commutativity with multiplication by descriptors.

        Weights are those of that framework's demonstration, 0.1 and 1e-3, the second for Laplacian weights divided by
        their squared Frobenius norm, which makes it about 1e-12 here: next to no regularisation. With α = 1 the
        method is better than this.
        """
        return replace(cls.no17(), weights=Weights(descriptors=0.1, commutativity=0.0, laplacian=1e-12))

    @classmethod
    def published(cls, formulation: Formulation) -> Config:
        """``formulation`` with a linear kernel and nothing but descriptors and the Laplacian, as its authors had it.

        Sizes, descriptors and weights are those of :meth:`obcs12` with α = 1, so that presets differ in the formulation
        alone, and from a run with ``kernel=Gaussian()`` in the kernel alone.
        """
        return replace(cls.no17(), weights=Weights(1.0, 0.0, 1.0), formulation=formulation)

    @classmethod
    def kovnatsky13(cls) -> Config:
        """Kovnatsky et al. (2013), Coupled quasi-harmonic bases: a fit in coupled bases."""
        return cls.published(Formulation(bases="coupled"))

    @classmethod
    def pokrass13(cls) -> Config:
        """Pokrass et al. (2013), Sparse modeling of intrinsic correspondences: few entries, near the diagonal."""
        return cls.published(Formulation(sparsity=0.001))

    @classmethod
    def kovnatsky15(cls) -> Config:
        """Kovnatsky et al. (2015), Functional correspondence by matrix completion: their L2,1 loss per descriptor."""
        return cls.published(Formulation(loss="l21", loss_per="descriptor"))

    @classmethod
    def kovnatsky16(cls) -> Config:
        """Kovnatsky et al. (2016), MADMM: the L2,1 loss over orthogonal maps."""
        return cls.published(Formulation(constraint="orthogonal", loss="l21", loss_per="descriptor"))

    @classmethod
    def eynard16(cls) -> Config:
        """Eynard et al. (2016), Coupled functional maps: both directions, each the other's inverse."""
        return cls.published(Formulation(directions="both", inverse=1.0, adjoint=0.0))

    @classmethod
    def huang17(cls) -> Config:
        """Huang and Ovsjanikov (2017), Adjoint map representation: both directions, each the other's adjoint."""
        return cls.published(Formulation(directions="both", inverse=0.0, adjoint=1.0))

    @classmethod
    def gasparetto17(cls) -> Config:
        """Gasparetto et al. (2017), Spatial maps: a map that moves the whole area of both shapes."""
        return cls.published(Formulation(spatial=0.1))

    @classmethod
    def ren19(cls) -> Config:
        """Ren et al. (2019), Structured regularization: NO17 with the resolvent mask, γ = 0.5."""
        return replace(cls.no17(), formulation=Formulation(mask="resolvent", mask_power=0.5))


RECORDS = {kind.__name__: kind for kind in (*KERNELS, *get_args(Refinement), *get_args(Solver), NonRigid, Search)}
"""Records that a settings file names by ``kind``, since a field may hold one of several."""


def as_dict(value: Any) -> Any:
    """A configuration as nested dictionaries of plain values, fit for JSON and TOML.

    Records of which a field may hold several kinds carry theirs under ``kind``. A kernel that is a callable of
    the user's own becomes ``{"kind": "callable", "name": …}``, which :func:`from_dict` refuses.
    """
    return _records.as_dict(value, RECORDS, describe_kernel)


def from_dict(values: dict[str, Any], base: Config | None = None) -> Config:
    """``base`` (``Config()``) with what ``values`` names replaced; the inverse of :func:`as_dict`.

    Raises
    ------
    InvalidInput
        On names and kinds that do not exist, naming those that do, and on values of the wrong type or out of range.
    """
    return _records.updated(base or Config(), values, Config(), {KernelLike: KERNELS})
