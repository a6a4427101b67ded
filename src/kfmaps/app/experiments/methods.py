"""The settings that the experiments compare, by number of descriptors."""

from __future__ import annotations

from dataclasses import replace

from kfmaps.config import Config
from kfmaps.kernels import Gaussian

PAPER_GAMMAS = {100: 500.0, 10: 100.0}
"""γ of the paper's figure 6, by number of descriptors."""


def with_count(config: Config, count: int) -> Config:
    """The same settings with ``count`` spectral descriptors."""
    return replace(config, descriptors=replace(config.descriptors, count=count))


def paper(count: int) -> Config:
    """The paper's settings, with its γ for that number of descriptors (of the nearest number that it names)."""
    nearest = min(PAPER_GAMMAS, key=lambda known: abs(known - count))
    return replace(with_count(Config.paper(), count), kernel=Gaussian(PAPER_GAMMAS[nearest]))


def no17(count: int) -> Config:
    """Nogneng and Ovsjanikov (2017) with ``count`` descriptors."""
    return with_count(Config.no17(), count)


def obcs12(count: int) -> Config:
    """Ovsjanikov et al. (2012) with ``count`` descriptors."""
    return with_count(Config.obcs12(), count)


def recommended(count: int) -> Config:
    """What the package recommends with landmarks, without refinement."""
    return replace(with_count(Config(), count), refinement=None)
