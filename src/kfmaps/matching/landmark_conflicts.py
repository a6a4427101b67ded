"""Landmarks that the best map contradicts: which to reject, and how far the others support the map.

A landmark may be wrong. So a search makes candidates with the landmarks and without them. A landmark is rejected where
the best map keeps to most of the others, or where a map that was found without landmarks is clearly better.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import to_numpy
from kfmaps.matching.candidates import map_distance, rerefine
from kfmaps.matching.landmark_evidence import landmark_errors
from kfmaps.matching.ranking import ranking
from kfmaps.matching.sample_pair import SamplePair
from kfmaps.matching.score import (
    SCORE,
    Candidate,
    landmark_support,
    max_landmark_error,
    rejected_landmarks,
    verdict,
)
from kfmaps.matching.search_state import SearchState


def contradicted_landmarks(state: SearchState) -> tuple[np.ndarray, tuple[tuple[Candidate, float], ...]]:
    """Return the landmarks (l,) bool to reject, and a map that casts a doubt on the others with the margin over it.

    The best map contradicts some while it keeps to most of the others. A map that was found without landmarks and would
    be called "sure" or "likely" contradicts any number, unless a map that keeps to them fits the surfaces nearly as
    well: then none is rejected for it, and it casts a doubt. Where it rejects some, the map that keeps to them does;
    unless it rejects all, these count in the margin. Between shapes that a rotation may keep, landmarks decide instead.
    """
    best, samples = state.ranked[0], state.samples.fine
    errors = ignore_landmarks(best, samples).landmark_errors
    limit = max_landmark_error(best.quality.calibrated_score)
    rejected = rejected_landmarks(errors, limit)
    least = without_landmark_errors(best.unregistered).score - SCORE.repairable_margin
    near = [c for c in state.candidates if without_landmark_errors(c.unregistered).score > least]
    has_alternative = any(map_distance(c, best, samples.source) > SCORE.distinct_distance for c in near)
    if samples.margin_factor < 1.0 or not (has_alternative or (errors > limit).any()):
        return rejected, ()
    order = rank_by_surface(state)
    free, margin = order[0], order[0].score - order[1].score if len(order) > 1 else np.inf
    if verdict(free.quality.calibrated_score, margin, free.deformation_energy) not in ("sure", "likely"):
        return rejected, ()
    contradicted = contradicted_without_them(free, samples)
    if is_most(contradicted):
        # Where left and right were exchanged, landmarks near the middle would mislead too.
        contradicted = np.ones(len(contradicted), dtype=bool)
    gain = without_landmark_errors(free).score - without_landmark_errors(best).score
    if gain <= SCORE.close_margin and (contradicted & (errors <= limit)).any():
        return rejected, ((free, -gain),)
    if not contradicted.all():
        gain -= SCORE.w_landmark * float(contradicted.sum())
    return contradicted, doubt_of_led(best, free, gain, samples) if contradicted.any() else ()


def doubt_of_led(
    led: Candidate, free: Candidate, margin: float, samples: SamplePair
) -> tuple[tuple[Candidate, float], ...]:
    """Return the doubt that the map ``led`` by rejected landmarks casts on the ``free`` one, if they differ.

    Rejected landmarks may be right, as on a vase that half a turn preserves.
    """
    differs = map_distance(led, free, samples.source) > SCORE.distinct_distance
    return ((led, margin),) if differs else ()


def is_most(which: np.ndarray) -> bool:
    """Return whether more than half of the landmarks, ``which (l,)`` bool, are among those meant."""
    return 2 * int(which.sum()) > len(which)


def contradicted_by(best: Candidate, state: SearchState) -> np.ndarray:
    """Return which landmarks (l,) bool of ``state`` a final candidate contradicts."""
    return final_landmark_errors(best, state) > max_landmark_error(best.quality.calibrated_score)


def rank_by_surface(state: SearchState) -> list[Candidate]:
    """Return the distinct candidates that were found without landmarks, ranked without them, best first."""
    found = state.candidates if state.orientation == "reversing" else state.without_landmarks
    found = [replace(c, landmark_errors=np.zeros(0)) for c in found or state.candidates]
    return ranking(found, state.samples.fine, state.proxies)


def without_landmark_errors(candidate: Candidate) -> Candidate:
    """Return a candidate without landmark errors, and without evidence that is relative to other candidates."""
    return replace(candidate, landmark_errors=np.zeros(0), strain=None, shot_error=None)


def ignore_landmarks(candidate: Candidate, samples: SamplePair) -> Candidate:
    """Return the candidate refined without landmarks, so that its landmark errors test both map and landmarks."""
    return rerefine([candidate], replace(samples, landmark_cost=None))[0]


def contradicted_without_them(candidate: Candidate, samples: SamplePair) -> np.ndarray:
    """Return which landmarks (l,) bool a candidate contradicts once it is refined without them."""
    limit = max_landmark_error(candidate.quality.calibrated_score)
    return ignore_landmarks(candidate, samples).landmark_errors > limit


def support_of_landmarks(best: Candidate, samples: SamplePair) -> float:
    """Return :func:`kfmaps.matching.score.landmark_support` of a map by the landmarks; 0 without any."""
    if samples.landmark_evidence is None:
        return 0.0
    errors = ignore_landmarks(best, samples).landmark_errors
    return landmark_support(errors, samples.landmark_evidence.distances, to_numpy(samples.source.samples.basis.mass))


def final_landmark_errors(best: Candidate, state: SearchState) -> np.ndarray:
    """Return the errors (l,) of all landmarks by a final candidate, in √area.

    They are those of its functions or, where these are less, of its registration: the functions alone
    may take a vertex at the end of a limb for one of another limb.
    """
    landmarks, evidence = state.landmarks, state.evidence
    if evidence is None:
        return np.zeros(0)
    samples, registered = state.samples.fine.source.samples, best.registered_vertices
    errors = landmark_errors(best.functional_map, samples.basis.functions, evidence)
    if registered is None:
        return errors
    if best.swapped:
        places, images = state.source.mesh.vertices[samples.vertices], registered[landmarks[:, 1]]
    else:
        places, images = registered[samples.vertices], state.proxies.image.mesh.vertices[landmarks[:, 1]]
    nearest_samples = KDTree(places).query(images)[1]
    return np.minimum(errors, evidence.distances[np.arange(len(landmarks)), nearest_samples])
