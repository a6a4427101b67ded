"""Sections of the configuration."""

from __future__ import annotations

from typing import Any, Literal

from kfmaps._arrays import refuse
from kfmaps._records import check_record, setting, settings_record
from kfmaps.descriptors.spectral import Normalisation
from kfmaps.fmap.losses import LossName
from kfmaps.fmap.minimize import Constraint
from kfmaps.fmap.terms import Mask

Sampling = Literal["descriptor", "geodesic", "uniform", "cholesky", "random-cholesky", "squared-cholesky"]
Signature = Literal["wave", "heat", "none"]


@settings_record
class BasisConfig:
    """The Laplacian and its eigenfunctions.

    Examples
    --------
    >>> kfmaps.Config(basis=kfmaps.BasisConfig(n_eigenfunctions=60)).basis
    BasisConfig(n_eigenfunctions=60)
    """

    n_eigenfunctions: int = setting(100, "size of the functional map on both sides", low=2)
    laplacian: Literal["robust", "cotangent"] = setting("robust", "the Laplacian; robust takes any triangles")


@settings_record
class DescriptorConfig:
    """Descriptors, which the map preserves.

    Energies are either spread evenly or, as in the framework of NO17 ("every-nth"), every n-th of a list with 200 for
    the signature and for each landmark. SHOT is the descriptor of Tombari et al. (2010). Normalisations: see
    :func:`kfmaps.descriptors.spectral.normalize`. ``extra`` are further ones (:class:`kfmaps.shape.Descriptor`).

    Examples
    --------
    >>> kfmaps.DescriptorConfig(signature="heat", n_spectral=50)
    DescriptorConfig(n_spectral=50, signature='heat')
    """

    n_spectral: int = setting(100, "spectral descriptors in all, shared out between signature and landmarks", low=1)
    signature: Signature = setting("wave", "signature of each point")
    landmark_descriptor: Signature = setting("wave", "descriptor of the distance to each landmark")
    signature_share: float = setting(
        0.3, "part of n_spectral for the signature where there are landmarks", low=0, high=1
    )
    n_eigenfunctions: int = setting(100, "eigenfunctions that spectral descriptors are made from", low=2)
    energy_sampling: Literal["even", "every-nth"] = setting("even", "energies: evenly spread, or each n-th of 200")
    shot: bool = setting(True, "add the SHOT descriptor of the local surface")
    shot_radius: float = setting(0.09, "radius of SHOT in √area", above=0)
    shot_weight: float = setting(1.0, "weight of SHOT against 1 for all others together", above=0)
    normalisation: Normalisation = setting("variance", "how descriptors are scaled, alike on both shapes")
    extra: tuple[Any, ...] = setting((), "further descriptors, objects with compute(shape) -> (n, d)", python_only=True)

    def __post_init__(self) -> None:
        check_record(self)
        for one in self.extra:
            if not callable(getattr(one, "compute", None)):
                raise refuse("DescriptorConfig.extra", "objects with compute(shape)", repr(one)[:60], "add that method")


@settings_record
class NystromConfig:
    """The Nyström approximation of the kernel; see :func:`kfmaps.kernels.nystrom.nystrom`.

    Examples
    --------
    >>> kfmaps.NystromConfig(samples=200)
    NystromConfig(samples=200)
    """

    samples: int = setting(400, 'samples of both shapes together, half from each (the paper\'s "rank")', low=2)
    sampling: Sampling = setting("descriptor", "how samples are chosen")
    rtol: float = setting(1e-12, "kernel eigenvalues below this part of the largest are dropped", low=0, below=1)


@settings_record
class Weights:
    """Weights of the energy's terms; 0 leaves one out.

    Examples
    --------
    >>> kfmaps.Weights(laplacian=0.5)
    Weights(laplacian=0.5)
    """

    descriptors: float = setting(100.0, "weight of descriptor preservation", low=0)
    commutativity: float = setting(1.0, "weight of commutativity with multiplication by descriptors", low=0)
    laplacian: float = setting(
        1.0, "weight of Laplacian commutativity, the paper's alpha, for eigenvalues divided by the largest", low=0
    )
    orientation: float = setting(0.0, "weight of the term that tells a map from a mirrored one", low=0)


@settings_record
class Formulation:
    """Constraints and penalties of the map beside least squares; by default there are none. See docs/formulations.md.

    Inverse, adjoint, sparsity and transport weights are in units of the mean diagonal of the energy's operator.
    Orthogonal maps keep areas (:mod:`kfmaps.fmap.constraints`); losses are those of :mod:`kfmaps.fmap.losses`.

    Examples
    --------
    >>> kfmaps.Formulation(constraint="orthogonal")
    Formulation(constraint='orthogonal')
    """

    constraint: Constraint = setting("none", "constraint on the map")
    bidirectional: bool = setting(False, "fit both maps at once, tied to each other")
    inverse_weight: float = setting(0.1, "weight of each map being the other's inverse", low=0)
    adjoint_weight: float = setting(0.1, "weight of each map being the other's adjoint", low=0)
    loss: LossName = setting("squared", "loss of the data")
    loss_group: Literal["landmark", "descriptor", "feature"] = setting(
        "landmark", "whose residuals the loss is of; features are those of the kernel"
    )
    loss_scale: float = setting(1.0, "scale of the loss, in medians of the residuals of least squares", above=0)
    sparsity: float = setting(0.0, "weight of the entries' absolute values, growing away from the diagonal", low=0)
    mask: Mask = setting("squared", "how Laplacian commutativity weighs entries")
    mask_power: float = setting(0.5, "power of the Laplacian in the resolvent", above=0)
    coupled_bases: bool = setting(False, "Laplacian commutativity and sparsity in coupled bases")
    coupling_weight: float = setting(
        1.0, "weight of the map against diagonal Laplacians in the choice of coupled bases", above=0
    )
    max_outer_iter: int = setting(20, "most iterations of reweighting and of both directions in turn", low=1)
    transport_weight: float = setting(0.0, "weight of agreement with an optimal transport between both shapes", low=0)
    transport_blur: float = setting(0.3, "entropic blur of that transport, in costs of a nearest point", above=0)

    def __post_init__(self) -> None:
        check_record(self)
        if self.bidirectional and not (self.inverse_weight or self.adjoint_weight):
            raise refuse(
                "inverse_weight and adjoint_weight",
                "one of them above zero",
                "both 0",
                "raise one of them, which ties the two directions together",
            )

    @property
    def weighs_data(self) -> bool:
        """Whether a robust loss weighs landmarks or descriptors, before the kernel."""
        return self.loss != "squared" and self.loss_group != "feature"

    @property
    def weighs_features(self) -> bool:
        """Whether a robust loss weighs features of the kernel."""
        return self.loss != "squared" and self.loss_group == "feature"


@settings_record
class Search:
    """The search among many candidate maps; see :mod:`kfmaps.matching.search`.

    ``orientation``: a "reversing" map is one to the mirror image. "auto" takes it only where a map that preserves
    orientation would deform the source too much and the reversing one does not, and never for a part; a part that fits
    its mirror image better is "ambiguous". "either" matches both ways, and is "sure" only if the shapes are far from
    symmetric, as bones, shoes or hands are.

    Examples
    --------
    >>> kfmaps.Search(orientation="either")
    Search(orientation='either')
    """

    candidates: int = setting(6, "small kernel fits, each refined from three starts; 0: no kernel", low=0)
    orientation: Literal["auto", "preserving", "reversing", "either"] = setting(
        "auto", "whether the map preserves orientation or is one to a mirror image", option="--orientation"
    )
    n_alternatives: int = setting(3, "most distinct other maps that are returned", low=0)
    n_sign_functions: int = setting(5, "low functions of which all 2^n signs are tried", low=0, high=10)
    match_extremities: bool = setting(True, "match extremities, for unlike proportions")


@settings_record
class Partial:
    """Matching of parts; see :mod:`kfmaps.matching.partial`.

    ``part``: with "both" each shape has something that the other lacks; "auto" compares their boundaries and, where
    these differ, tries to place one on the other. What is stated is tried first, and what the boundaries suggest where
    that is not "sure". ``scale``: "auto" is "fixed" for two parts of about the same size.

    Examples
    --------
    >>> kfmaps.Config(partial=kfmaps.Partial(part="target")).partial
    Partial(part='target')
    """

    part: Literal["auto", "none", "source", "target", "both"] = setting(
        "auto", "which shape may be a part of the other", option="--partial"
    )
    scale: Literal["auto", "free", "fixed"] = setting("auto", "fixed: both shapes are in the same units")
    samples: int = setting(300, "samples of the part", low=20)
    whole_samples: int = setting(1000, "samples of the whole", low=20)
    candidates: int = setting(3, "scales of the part that are refined", low=1)
