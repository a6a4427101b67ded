"""Every number that maps are judged by counts, and counts the right way."""

import itertools
from dataclasses import fields, replace
from functools import partial
from typing import Any

import numpy as np
import pytest

from kfmaps.matching.score import (
    SCORE,
    Calibration,
    Candidate,
    PartEvidence,
    Quality,
    Scoring,
    candidate_score,
    landmark_support,
    lower_probability,
    part_landmark_cost,
    part_score,
    placement_score,
    probability,
    select_distinct,
    torn_score,
    verdict,
)

GUARDS = ("kfmaps.matching.score",)

QUALITY = Quality(0.9, 0.1, 0.12, 0.2, 0.1, 0.9, 0.05, 0.3)
REGISTERED: dict[str, Any] = {"deformation_energy": 0.3, "strain": 0.4, "shot_error": 0.05}
CANDIDATE = Candidate("a", np.eye(2), np.zeros(3, dtype=int), QUALITY, True, np.array([0.1, 0.9]), **REGISTERED)
PART = PartEvidence(0.8, -2.0, 0.02, 0.01, 0.1, 0.95, -3.0, 0.13, 2.0, 0.03)

MEASURES = {
    "w_orientation": ("orientation", 1.0),
    "w_distortion": ("distortion", -6.0),
    "w_local_distortion": ("local_distortion", -10.0),
    "w_descriptors": ("descriptors", -12.0),
    "w_heat": ("heat", -2.0),
    "w_coverage": ("coverage", 1.0),
    "w_laplacian": ("laplacian", -2.0),
    "w_reflection": ("reflection_error", -25.0),
    "w_extremities": ("extremity_descriptor_error", -8.0),
}
"""Weights of the measures of a map: those of the table in docs/mathematics.md."""
CANDIDATE_WEIGHTS = {
    "w_deformation": -5.0 * np.log(2.0),
    "w_strain": -6.0 * 0.4,
    "w_shot": -60.0 * 0.05,
    "w_landmark": -2.0 * (1 / 3 + 1),
}
"""What each weight contributes to the score of :data:`CANDIDATE`."""
PART_WEIGHTS = {
    "w_consistency": 4.0 * 0.8,
    "w_pair_consistency": 12.0 * 0.1,
    "w_similarity_rank": 2.0,
    "w_overlap_rank": -4.0 * 0.3,
    "w_gap": -50.0 * 0.01,
    "w_scale": -3.0 * (0.13 / 0.47) ** 2,
    "w_flipped": -4.0 * 0.1,
    "w_doubled": -10.0 * 0.03,
    "w_deformation": -3.0 * np.log(0.025),
}


def without(weight: str, **more: Any) -> Scoring:
    return replace(SCORE, **{weight: 0.0, **more})


@pytest.mark.parametrize("weight", MEASURES)
def test_every_measure_has_its_weight(weight: str) -> None:
    measure, expected = MEASURES[weight]
    more = replace(CANDIDATE, quality=replace(QUALITY, **{measure: getattr(QUALITY, measure) + 0.01}))
    assert candidate_score(more) - candidate_score(CANDIDATE) == pytest.approx(0.01 * expected)
    numbers = without(weight)
    assert candidate_score(more, numbers) == candidate_score(CANDIDATE, numbers)


@pytest.mark.parametrize("weight", CANDIDATE_WEIGHTS)
def test_every_weight_of_a_candidate_counts(weight: str) -> None:
    lost = candidate_score(CANDIDATE) - candidate_score(CANDIDATE, without(weight))
    assert lost == pytest.approx(CANDIDATE_WEIGHTS[weight])


@pytest.mark.parametrize("weight", PART_WEIGHTS)
def test_every_weight_of_a_part_counts(weight: str) -> None:
    lost = part_score(PART) - part_score(PART, replace(SCORE.part, **{weight: 0.0}))
    assert lost == pytest.approx(PART_WEIGHTS[weight])


def test_the_tables_name_all_weights() -> None:
    named = {*MEASURES, *CANDIDATE_WEIGHTS, "w_torn"}
    assert {f.name for f in fields(SCORE) if f.name.startswith("w_")} == named
    assert {f.name for f in fields(SCORE.part) if f.name.startswith("w_")} == set(PART_WEIGHTS)


def test_costs_of_a_part_are_bounded_and_landmarks_cost_more_of_two() -> None:
    assert part_score(replace(PART, landmark_cost=0.0)) - part_score(PART) == 2.0
    assert part_score(replace(PART, scale_change=0.47)) == part_score(replace(PART, scale_change=9.0))  # at most
    assert [part_landmark_cost(np.array([0.11, 0.09, 0.3]), two) for two in (False, True)] == [2.0, 6.0]


def test_torn_area_costs() -> None:
    assert torn_score(-9.0, 0.1) == pytest.approx(-11.5)
    assert torn_score(-9.0, None) == torn_score(-9.0, 0.1, without("w_torn")) == -9.0


def test_a_probability_does_not_depend_on_how_exact_reflections_are() -> None:
    worse = replace(QUALITY, reflection_error=0.2)
    assert worse.score == pytest.approx(QUALITY.score - 5.0)
    assert worse.calibrated_score == QUALITY.calibrated_score == QUALITY.score


def test_unknown_evidence_costs_nothing() -> None:
    plain = replace(CANDIDATE.unregistered, landmark_errors=np.zeros(0))
    assert all(getattr(plain, name) is None for name in REGISTERED)
    assert candidate_score(plain) == pytest.approx(QUALITY.score - 8 * 0.3)
    assert placement_score(replace(PART, scale_change=0.0)) == pytest.approx(4 * 0.8 + 2)


CALIBRATIONS = pytest.mark.parametrize(
    ("numbers", "slope", "middle", "steep_middle", "tie"),
    [
        (SCORE.calibration, 0.92, -11.8, -12.0, 1.4),
        (SCORE.part.calibration, 1 / 0.43, 16.2, np.inf, 1.3),
        (SCORE.part.calibration_of_view, 1 / 0.43, 16.2, np.inf, 1.6),
        (replace(SCORE.part.calibration_of_two, max_fit=1.0), 1 / 2.7, 9.9, np.inf, 1.3),
    ],
    ids=["wholes", "part", "one camera", "two parts"],
)


@CALIBRATIONS
def test_the_probability_is_that_of_the_manual(
    numbers: Calibration, slope: float, middle: float, steep_middle: float, tie: float
) -> None:
    """docs/mathematics.md: score, margin, deformation, and landmarks that take away doubt."""
    for above, margin in itertools.product((-3.0, 0.0, 2.0, 1e4), (-1.0, 0.0, 0.3, 1.4, np.inf)):
        score = middle + above
        steep = 0.9 / (1 + np.exp(-4.0 * (score - steep_middle)))
        fits = (1 - 0.5 * np.exp(-max(margin, 0) / tie)) * max(1 / (1 + np.exp(-slope * above)), steep)
        assert probability(score, margin, numbers=numbers) == pytest.approx(fits)
        for excess, support in itertools.product((-2.0, 0.7, 0.9), (0.0, 0.25, 1.0)):
            energy = np.exp(excess - 3.6 - 0.233 * score)
            if energy > 0:
                alone = fits / (1 + np.exp(20 * (excess - 0.78)))
                found = probability(score, margin, energy, support, numbers)
                assert found == pytest.approx(1 - (1 - support) * (1 - alone))
    assert probability(-1e5, 0.0, numbers=numbers) == pytest.approx(0)


@CALIBRATIONS
def test_a_verdict_is_ambiguous_where_a_rival_takes_the_word_away(
    numbers: Calibration, slope: float, middle: float, steep_middle: float, tie: float
) -> None:
    word = partial(verdict, numbers=numbers)
    below = min(middle, steep_middle + 0.05) - middle
    for above, alone in ((9.0, "sure"), (1.0, "likely"), (below * slope - 0.01, "unlikely")):
        score, most = middle + above / slope, numbers.max_margin
        assert word(score, most) == alone
        assert word(score, 0.0) == ("unlikely" if alone == "unlikely" else "ambiguous")
        assert word(score, most, np.exp(4 - 3.6 - 0.233 * score)) == "unlikely"
        assert word(score, most, None, 0.95) == "sure"
    # What would be sure without its rival is ambiguous, also where it is the landmarks that make it so.
    bad = min(middle, steep_middle) - 1 / slope
    enough = 1 - 0.9 * (1 - numbers.sure) / (1 - probability(bad, np.inf, numbers=numbers))
    assert probability(bad, 0.1 * tie, None, enough, numbers) < numbers.sure
    assert word(bad, 0.1 * tie, None, enough) == "ambiguous"
    # With the greatest margin nothing else is as good, however near "sure" is.
    if np.isfinite(numbers.max_margin):
        edge = middle + np.log(9.01) / slope
        assert (word(edge, numbers.max_margin), word(edge, 0.9 * numbers.max_margin)) == ("likely", "ambiguous")


def test_the_steep_function_makes_no_map_sure() -> None:
    """It raises what is told of maps between unlike bodies, up to "likely"; what shapes without anything in common
    score is told as before."""
    numbers = SCORE.calibration
    alone = replace(numbers, steep_middle=np.inf)
    for score in np.arange(-20.0, 0.0, 0.1):
        output, before = probability(score, np.inf), probability(score, np.inf, numbers=alone)
        assert output >= before
        assert (output >= numbers.sure) == (before >= numbers.sure)
        assert (output > before) == (-12.0 < score < -9.45) or abs(score + 12.0) < 0.3
    assert probability(-11.5, np.inf) > 0.75 > 0.6 > probability(-11.5, np.inf, numbers=alone)


@pytest.mark.parametrize(
    ("chance", "word", "torn", "lower"),
    [
        (0.95, "sure", 0.0, (0.95, "sure")),
        (0.95, "sure", 0.1, (0.855, "likely")),
        (0.6, "likely", 0.25, (0.45, "unlikely")),
        (0.95, "ambiguous", 0.1, (0.855, "ambiguous")),
        (None, "landmarks", 0.5, (None, "landmarks")),
    ],
)
def test_torn_area_lowers_the_probability(chance: Any, word: str, torn: float, lower: tuple[Any, str]) -> None:
    found = lower_probability(chance, word, torn, False)
    assert found[1] == lower[1]
    assert found[0] == pytest.approx(lower[0])


def test_a_map_whose_registration_is_refused_is_not_sure() -> None:
    """It is "likely" at most; a word that says more stays, and a fit without a probability has none."""
    assert lower_probability(1.0, "sure", 0.0, True) == (SCORE.refused_registration, "likely")
    assert lower_probability(0.8, "likely", 0.5, True) == (pytest.approx(0.24), "unlikely")
    assert lower_probability(1.0, "ambiguous", 0.0, True)[1] == "ambiguous"
    assert lower_probability(None, "unchecked", 0.0, True) == (None, "unchecked")


def test_loose_pieces_lower_the_probability() -> None:
    assert lower_probability(1.0, "sure", 0.0, is_loose=True) == (SCORE.loose_pieces, "likely")


@pytest.mark.parametrize("errors", [[0.0], [0.05, 0.058, 0.06], [0.0] * 5 + [0.2], [0.0] * 5 + [9.0], [0.3, 0.3]])
def test_landmarks_support_a_map_by_the_area_around_them_and_their_mean_error(errors: list[float], rng) -> None:
    """The squared share of the area, not of the samples, times a logistic function; a single one has a limited say."""
    distances, areas = rng.uniform(0, 1, (len(errors), 100)), rng.random(100)
    near = (distances < 0.2).any(axis=0)
    kept = 1 / (1 + np.exp((np.minimum(errors, 0.3).mean() - 0.055) / 0.004))
    found = landmark_support(np.array(errors), distances, areas)
    assert found == pytest.approx((areas[near].sum() / areas.sum()) ** 2 * kept)
    assert landmark_support(np.zeros(0), distances[:0], areas) == 0.0


def test_the_first_that_differ_are_selected() -> None:
    values = [0, 1, 5, 6, 9, 20]
    assert select_distinct(values, lambda a, b: abs(a - b) > 2) == [0, 5, 9, 20]
    assert select_distinct(values, lambda a, b: abs(a - b) > 2, 2) == [0, 5]


def test_an_alternative_that_is_near_keeps_a_map_from_being_sure() -> None:
    """A map that swapped front and back was 2.1 before the right one."""
    numbers = SCORE.calibration
    score = numbers.middle + 2.5 / numbers.slope
    assert probability(score, 6.0) > numbers.sure > probability(score, 2.1) > numbers.likely
