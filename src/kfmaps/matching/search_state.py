"""The state of a search."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from kfmaps.config import Config
from kfmaps.matching.landmark_evidence import LandmarkEvidence
from kfmaps.matching.ranking import ProxyCache
from kfmaps.matching.sample_pair import TwoLevelSamples
from kfmaps.matching.score import Candidate
from kfmaps.shape import Shape


@dataclass(frozen=True, eq=False)
class SearchState:
    """Two shapes, their samples, and the candidates of a search so far."""

    source: Shape
    target: Shape
    config: Config
    landmarks: np.ndarray  # (l, 2): as they were given
    evidence: LandmarkEvidence | None  # of all landmarks
    rejected: np.ndarray  # (l,) bool: landmarks that the best candidate contradicts
    samples: TwoLevelSamples  # without the rejected landmarks
    proxies: ProxyCache
    candidates: list[Candidate]  # all
    ranked: list[Candidate]  # the distinct ones, best first
    orientation: str  # "preserving" or "reversing": whether the candidates are maps to the target or its mirror image
    # Maps that make the best one less certain, with its margin over each: a map to the mirror image, one with two limbs
    # exchanged, one that contradicts the landmarks.
    doubts: tuple[tuple[Candidate, float], ...] = ()
    without_landmarks: list[Candidate] = field(default_factory=list)  # candidates that landmarks took no part in
    # Whether a map to the mirror image may come first with the setting "auto": with landmarks only where one fits
    # better without them. Landmarks with left and right exchanged agree with one of any body that is nearly its own
    # mirror image.
    may_reverse: bool = True
    # Whether landmarks raise the probability: not where they contradict a map that is about as good without them.
    trust_landmarks: bool = True
