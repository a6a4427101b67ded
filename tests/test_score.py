"""Every number that maps are judged by counts, and counts the right way."""

from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest

from kfmaps.matching.score import (
    SCORE,
    Candidate,
    PartEvidence,
    Quality,
    Scoring,
    candidate_score,
    excess_deformation,
    lower_by_torn_area,
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
PART = PartEvidence(0.8, -2.0, 0.02, 0.01, 0.1, 0.95, 0.13, 2.0)

MEASURES = {
    "w_orientation": ("orientation", 1.0),
    "w_distortion": ("distortion", -6.0),
    "w_local_distortion": ("local_distortion", -10.0),
    "w_descriptors": ("descriptors", -12.0),
    "w_heat": ("heat", -2.0),
    "w_coverage": ("coverage", 1.0),
    "w_laplacian": ("laplacian", -2.0),
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
    "w_gap": -50.0 * 0.01,
    "w_scale": -1.5 * 0.25,
    "w_flipped": -4.0 * 0.1,
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


def test_landmarks_that_a_part_contradicts_cost_more_of_two_parts() -> None:
    assert part_score(replace(PART, landmark_cost=0.0)) - part_score(PART) == 2.0
    assert [part_landmark_cost(np.array([0.11, 0.09, 0.3]), two) for two in (False, True)] == [2.0, 6.0]


def test_torn_area_costs() -> None:
    assert torn_score(-9.0, 0.1) == pytest.approx(-11.5)
    assert torn_score(-9.0, None) == torn_score(-9.0, 0.1, without("w_torn")) == -9.0


def test_what_is_not_known_costs_nothing() -> None:
    plain = replace(CANDIDATE.unregistered, landmark_errors=np.zeros(0))
    assert all(getattr(plain, name) is None for name in REGISTERED)
    assert candidate_score(plain) == pytest.approx(QUALITY.score - 8 * 0.3)
    assert placement_score(PART) == pytest.approx(4 * 0.8 + 2)


@pytest.mark.parametrize("number", ["slope", "middle", "tie", "excess_middle", "excess_width"])
def test_every_number_of_the_calibration_counts(number: str) -> None:
    usual = np.exp(0.6 - excess_deformation(-9.0, 1.0))
    for numbers in (SCORE.calibration, SCORE.part.calibration, SCORE.part.calibration_of_two):
        score = numbers.middle + 1 / numbers.slope
        energy = float(np.exp(0.6 - excess_deformation(score, 1.0, numbers)))
        other = replace(numbers, **{number: 1.5 * getattr(numbers, number)})
        before, after = (probability(score, 0.2, energy, numbers=n) for n in (numbers, other))
        assert abs(before - after) > 1e-3
    assert excess_deformation(-9.0, usual) == pytest.approx(0.6)


def test_a_verdict_is_ambiguous_where_a_rival_takes_the_word_away() -> None:
    numbers = SCORE.calibration
    for above, alone in ((6.0, "sure"), (1.0, "likely"), (-1.0, "unlikely")):
        assert verdict(numbers.middle + above, np.inf) == alone
    assert verdict(numbers.middle + 6, 0.0) == verdict(numbers.middle + 1, 0.0) == "ambiguous"
    assert verdict(numbers.middle - 1, 0.0) == "unlikely"


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
    found = lower_by_torn_area(chance, word, torn)
    assert found[1] == lower[1]
    assert found[0] == pytest.approx(lower[0])


def test_the_first_that_differ_are_selected() -> None:
    values = [0, 1, 5, 6, 9, 20]
    assert select_distinct(values, lambda a, b: abs(a - b) > 2) == [0, 5, 9, 20]
    assert select_distinct(values, lambda a, b: abs(a - b) > 2, 2) == [0, 5]


def test_an_alternative_that_is_near_keeps_a_map_from_being_sure() -> None:
    """A map that swapped front and back was 2.1 before the right one."""
    numbers = SCORE.calibration
    score = numbers.middle + 2.5 / numbers.slope
    assert probability(score, 6.0) > numbers.sure > probability(score, 2.1) > numbers.likely
