"""The settings that the experiments compare, by number of descriptors."""

from __future__ import annotations

from dataclasses import replace

from kfmaps.config import Config
from kfmaps.fmap.solvers import CG
from kfmaps.kernels.kernels import Gaussian

PRINTED = {100: 500.0, 10: 100.0}
"""γ that the paper's figure 6 names, by number of descriptors."""

SEARCHED = {100: 0.1, 10: 0.3}
"""γ by grid search on people 0 and 1 of FAUST and FAUST_r, for descriptors with a maximum of 1 each."""


def with_count(config: Config, count: int) -> Config:
    """Return the same settings with ``count`` spectral descriptors."""
    return replace(config, descriptors=replace(config.descriptors, n_spectral=count))


def paper(count: int) -> Config:
    """Return the paper's settings, with the γ of the grid search for about that number of descriptors."""
    return replace(with_count(Config.paper(), count), kernel=Gaussian(_nearest(SEARCHED, count)))


def literal(count: int) -> Config:
    """Return the same with the γ that the paper prints, in the normalisation under which it is best.

    All descriptors are divided by one number, so that the longest vector of descriptors at a vertex has length 1:
    of the readings of "normalised to have a maximum value of 1" the one in which γ = 500 suits 100 descriptors.
    """
    config = paper(count)
    return replace(
        config,
        descriptors=replace(config.descriptors, normalisation="row"),
        kernel=Gaussian(_nearest(PRINTED, count)),
    )


def _nearest(known: dict[int, float], count: int) -> float:
    return known[min(known, key=lambda other: abs(other - count))]


def no17(count: int) -> Config:
    """Return the settings of Nogneng and Ovsjanikov (2017) with ``count`` descriptors."""
    return with_count(Config.no17(), count)


def obcs12(count: int) -> Config:
    """Return the settings of Ovsjanikov et al. (2012) with ``count`` descriptors."""
    return with_count(Config.obcs12(), count)


def obcs12_regularised(count: int) -> Config:
    """Return OBCS12 with α = 1, the weight that the paper names for its own energy."""
    config = obcs12(count)
    return replace(config, weights=replace(config.weights, descriptors=1.0, laplacian=1.0))


def no17_maxima(count: int) -> Config:
    """Return NO17 with descriptors of maximum 1, as in :func:`paper`: only the kernel differs."""
    config = no17(count)
    return replace(config, descriptors=replace(config.descriptors, normalisation="max"))


def converged(config: Config) -> Config:
    """Return the same energy, minimised to a residual of 1e-6 instead of ten steps of conjugate gradients.

    Slices lose 1e-4 of their squared norm: twice as fast, and errors of training pairs change by less than 1 %.
    """
    return replace(config, solver=CG(rtol=1e-6, max_iter=1000), preconditioner="sylvester", operator_rtol=1e-4)


def recommended(count: int) -> Config:
    """Return what the package recommends with landmarks, without refinement."""
    return replace(with_count(Config.single_fit(), count), refinement=None)
