"""Matching without landmarks: several candidate maps, compared without knowing the truth."""

from __future__ import annotations

from typing import Any

import numpy as np

from kfmaps.config import Config
from kfmaps.pipeline import Match, fit
from kfmaps.shape import Progress, Shape


def choose(
    source: Shape,
    target: Shape,
    config: Config,
    *,
    landmarks: Any = None,
    descriptors: tuple[Any, Any] | None = None,
    rng: int | np.random.Generator | None = 0,
    progress: Progress | None = None,
) -> Match:
    """A single fit for now."""
    return fit(source, target, config, landmarks=landmarks, descriptors=descriptors, rng=rng, progress=progress)
