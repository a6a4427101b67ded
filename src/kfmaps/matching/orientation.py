"""Maps to the mirror image of the target, and whether one of them is the answer.

A map to the mirror image is right where the shapes are a left and a right bone, or where one was mirrored by mistake.
The shapes usually preserve orientation, so such a map must be much better. With the setting "either" both are matched
(:mod:`kfmaps.matching.match`).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from kfmaps.fmap.evaluate import reverses_orientation
from kfmaps.geometry.mesh import Mesh
from kfmaps.matching.candidates import by_score, compose_with_symmetries, rerefine, score_maps
from kfmaps.matching.landmark_conflicts import contradicted_without_them, rank_by_surface, without_landmark_errors
from kfmaps.matching.ranking import ProxyCache, ranking
from kfmaps.matching.result import Match
from kfmaps.matching.sample_pair import SamplePair, mirrored_pair
from kfmaps.matching.score import SCORE, Candidate
from kfmaps.matching.search_state import SearchState


def choose_orientation(state: SearchState, deforms_too_much: bool) -> SearchState:
    """Compare the best map with maps to the mirror image where the orientation is "auto" and one may be better.

    Maps to the mirror image are registered only where the best map ``deforms_too_much`` or where one of them has a
    better score before registration. One that is clearly better replaces the best map, and so does one that is better
    and hardly deforms the shape, unless the state forbids it
    (:attr:`~kfmaps.matching.search_state.SearchState.may_reverse`) or a map that keeps orientation preserves distances
    nearly as well: then the shape is nearly its own mirror image, and the poses may be mirrored, as those of a walk.
    There landmarks decide. Any other that is better becomes a doubt. So does the best map where it is replaced, unless
    landmarks decide or the shapes are congruent: of two poses of a person in a robe, one mirrored, none that keeps
    orientation does so as well.
    """
    config, samples = state.config, state.samples
    assert config.search is not None
    if not samples.fine.are_surfaces or config.search.orientation != "auto":
        return state
    mirrored = mirrored_pair(samples.fine)
    images = mirror_candidates(state.candidates, mirrored)
    score = state.ranked[0].unregistered.score
    if not images or (not deforms_too_much and images[0].score < score + SCORE.mirror_gain):
        return state
    proxies = ProxyCache.of(state.source, state.target, mirrored)
    # Registration with more points raises no score by more than the margin.
    ranked = ranking(images, mirrored, proxies, state.ranked[0].score - SCORE.close_margin)
    image, energy = ranked[0], ranked[0].deformation_energy
    gain = _gain(image, state)
    if gain > SCORE.mirror_gain:
        # A body that is nearly its own mirror image has a map that preserves orientation and is as good.
        composed = compose_with_symmetries(image, samples)
        if composed:
            found = [*state.candidates, *composed]
            free = [*state.without_landmarks, *composed] if state.without_landmarks else []
            preserving = ranking(found, samples.fine, state.proxies)
            state = replace(state, candidates=found, without_landmarks=free, ranked=preserving)
            gain = _gain(image, state)
    is_congruent = energy is not None and energy < SCORE.congruent_energy
    is_led = state.may_reverse and gain > SCORE.mirror_gain and _landmarks_prefer(image, mirrored, state)
    margin = SCORE.mirror_gain if is_congruent or is_led else SCORE.mirror_margin
    advantage = _isometry_advantage(image, state.candidates) - SCORE.isometry_margin
    if gain > margin and (is_led or (state.may_reverse and advantage > 0)):
        doubts = () if is_congruent or is_led else ((state.ranked[0], SCORE.isometry_factor * advantage),)
        samples = replace(samples, fine=mirrored)
        return replace(
            state,
            samples=samples,
            proxies=proxies,
            candidates=images,
            ranked=ranked,
            orientation="reversing",
            doubts=doubts,
        )
    return replace(state, doubts=((image, -gain),)) if gain > SCORE.mirror_gain else state


def _isometry_advantage(image: Candidate, found: list[Candidate]) -> float:
    """Return by how much the map to the mirror image is more isometric than all maps that keep orientation."""
    kept = [c.quality.isometry_score for c in found if c.quality.orientation > 0.5]
    return image.quality.isometry_score - max(kept, default=-np.inf)


def _landmarks_prefer(image: Candidate, mirrored: SamplePair, state: SearchState) -> bool:
    """Return whether landmarks keep to a map to the mirror image, and not to the best that was found without them.

    Then two kinds of evidence say that the shapes are mirror images, as a left and a right bone are.
    """
    if not len(state.landmarks):
        return False
    if contradicted_without_them(image, mirrored).any():
        return False
    return bool(contradicted_without_them(rank_by_surface(state)[0], state.samples.fine).any())


def _gain(image: Candidate, state: SearchState) -> float:
    """Return by how much the score of a map to the mirror image exceeds that of the best map.

    With landmarks it must exceed it without them too: landmarks with left and right exchanged agree with the mirror
    image of any body that is nearly its own mirror image.
    """
    gain = image.score - state.ranked[0].score
    if not len(state.landmarks):
        return gain
    best = rank_by_surface(state)[0]
    return min(gain, without_landmark_errors(image).score - without_landmark_errors(best).score)


def mirror_candidates(found: list[Candidate], mirrored: SamplePair) -> list[Candidate]:
    """Return candidates as maps to the mirror image, best first; the best few are refined with its descriptors.

    The candidates include maps that were refined without descriptors: only these find an isometry that reverses
    orientation.
    """
    images = by_score(score_maps([replace(c, uses_descriptors=True) for c in found], mirrored))
    n_refined = 3  # maps to the mirror image that are refined again with its descriptors
    return by_score(rerefine(images[:n_refined], mirrored) + images[n_refined:])


def orientation_text(match: Match, source: Mesh, target: Mesh) -> str:
    """Return what a map between two meshes has to do with mirror images; empty where nothing or where it is unknown."""
    config = getattr(match, "config", None)
    search = config and config.search
    is_open = match.verdict == "ambiguous" and search is not None and search.orientation == "auto"
    mirrored = "one shape is mirrored, as a left and a right bone are"
    remedy = f"; take --orientation reversing if {mirrored}, else preserving" if is_open else ""
    if match.orientation == "reversing":
        return f"reversed: the target is matched as the mirror image of the source{remedy}"
    if is_open and _is_mirror_image_better(match, source, target):
        return f"preserved, but a map to the mirror image of the target fits better{remedy}"
    return ""


def _is_mirror_image_better(match: Match, source: Mesh, target: Mesh) -> bool:
    """Return whether a map to the mirror image has a better score: of a part the second, else the first alternative."""
    scores = match.score.scores
    if len(scores) < 2 or scores[1] - scores[0] <= SCORE.mirror_gain:
        return False
    if match.partial.which != "none":
        return True
    return len(match.alternatives) > 0 and reverses_orientation(source, target, match.alternatives[0])
