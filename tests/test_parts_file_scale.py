"""What the sizes in the files say about the scale of a part."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from kfmaps.config import Partial
from kfmaps.geometry.mesh import Mesh
from kfmaps.matching.partial import place_part
from kfmaps.matching.partial.relaxation_labeling import Assignment
from kfmaps.matching.partial.samples import PartPair
from kfmaps.matching.partial.scale_search import TRIALS, Placement, place_all
from kfmaps.matching.score import SCORE, PartEvidence, part_score, placement_score, probability, scale_cost, verdict
from test_parts_alternatives import SCALE, pair  # noqa: F401 - a fixture

GUARDS = ("kfmaps.matching.partial", "kfmaps.matching.score")

PART = PartEvidence(0.8, -4.0, 0.04)
TRIANGLE = Mesh(np.eye(3), np.array([[0, 1, 2]]))


def candidate(**evidence: Any) -> Any:
    one = replace(PART, **evidence)
    return SimpleNamespace(evidence=one, score=part_score(one))


@pytest.mark.parametrize(
    ("ratio", "both", "file_scale"),
    [(0.3, False, 0.3), (0.8, False, 0.8), (1.09, False, 1.09), (0.24, False, None), (1.11, False, None),
     (None, False, None), (0.8, True, None)],
)  # fmt: skip
def test_files_of_like_sizes_are_likely_to_be_in_one_unit(
    monkeypatch: pytest.MonkeyPatch, ratio: float | None, both: bool, file_scale: float | None
) -> None:
    seen: list[PartPair] = []

    def searched(given: PartPair, *_: Any) -> Any:
        seen.append(given)
        raise StopIteration

    monkeypatch.setattr(place_part, "_search_placements", searched)
    with pytest.raises(StopIteration):
        place_part.place_part(place_part.PartTask(TRIANGLE, TRIANGLE, Partial(), ratio, both))
    assert seen[0].file_scale == file_scale
    assert seen[0].small_scale == (file_scale if ratio == 0.3 else None)


def test_a_placement_that_has_shrunk_costs_before_and_after_registration(pair: PartPair) -> None:  # noqa: F811
    pair = replace(pair, file_scale=SCALE)
    start = Placement(SCALE, TRIALS[0], Assignment(np.arange(5), np.ones(5), 1.0), np.eye(5, dtype=np.float32))
    at, shrunk = (
        replace(place_all(pair, replace(start, scale=scale)).evidence, deformation_energy=0.04)
        for scale in (SCALE, SCALE / 2)
    )
    assert (at.scale_change, shrunk.scale_change) == (0.0, pytest.approx(np.log(2)))
    assert (scale_cost(at), scale_cost(shrunk)) == (0.0, SCORE.part.w_scale)
    same = replace(shrunk, scale_change=0.0)
    assert placement_score(same) - placement_score(shrunk) == pytest.approx(SCORE.part.w_scale)
    assert part_score(same) - part_score(shrunk) == pytest.approx(SCORE.part.w_scale)


def test_what_is_told_does_not_depend_on_the_unit(monkeypatch: pytest.MonkeyPatch) -> None:
    found = [candidate(scale_change=9.0), candidate(consistency=0.6)]
    results = {"_search_placements": found, "_register_fully": SimpleNamespace(vertices=np.eye(3)), "margin": 1.0}
    for name, result in {**results, "find_overlap": None}.items():
        monkeypatch.setattr(place_part, name, lambda *_, _result=result: _result)
    for one in found:
        one.registration = None
    told = place_part.place_part(place_part.PartTask(TRIANGLE, TRIANGLE, Partial()))
    assert told.scores == (part_score(PART), pytest.approx(found[1].score + SCORE.part.w_scale))


def test_the_scan_of_one_camera_may_not_shrink_in_what_is_told() -> None:
    one = candidate(scale_change=9.0)
    told = [place_part._told_score(one, SimpleNamespace(is_one_view=view)) for view in (False, True)]  # type: ignore
    assert told == [part_score(PART), one.score]


def test_a_part_at_the_scale_of_the_files_is_more_likely_right() -> None:
    """But it is not "sure" for that."""
    known: Any = SimpleNamespace(file_scale=0.7, is_one_view=False, both_partial=False)
    near, far = candidate(scale_change=0.25), candidate(scale_change=0.27)
    numbers = SCORE.part.calibration_in_unit
    assert place_part._calibration(near, known) is numbers
    two: Any = SimpleNamespace(**{**vars(known), "both_partial": True})
    assert place_part._calibration(near, two) is SCORE.part.calibration_of_two
    changes: list[tuple[Any, dict[str, Any]]] = [
        (far, {}),
        (near, {"file_scale": None}),
        (near, {"is_one_view": True}),
    ]
    for one, what in changes:
        other: Any = SimpleNamespace(**{**vars(known), **what})
        assert place_part._calibration(one, other) is not numbers
    assert probability(13.0, 9.0, numbers=numbers) == pytest.approx(0.45, abs=2e-3)
    assert probability(13.0, 9.0, numbers=SCORE.part.calibration) < 0.001
    told = [verdict(score, 9.0, numbers=numbers) for score in (12.0, 14.0, 17.0, 18.0)]
    assert told == ["unlikely", "likely", "likely", "sure"]
    scores = np.linspace(10, 22, 100)
    better = [probability(s, 9.0, numbers=numbers) for s in scores]
    usual = [probability(s, 9.0, numbers=SCORE.part.calibration) for s in scores]
    assert all(b >= u for b, u in zip(better, usual, strict=True))
    assert all(b < SCORE.calibration.sure for b, u in zip(better, usual, strict=True) if u < SCORE.calibration.sure)


@pytest.mark.parametrize(
    ("file_scale", "told", "clear"), [(0.7, 14.1, True), (0.7, 13.9, False), (None, 14.1, False), (None, 17.6, True)]
)
def test_less_of_a_score_is_asked_for_at_the_scale_of_the_files(
    monkeypatch: pytest.MonkeyPatch, file_scale: float | None, told: float, clear: bool
) -> None:
    """Where a second relaxation confirms the placement."""
    evidence = replace(PART, scale_change=0.2)
    placed = SimpleNamespace(match=np.zeros(5, dtype=int))
    one: Any = SimpleNamespace(
        scale=0.7,
        score=told - scale_cost(evidence),
        evidence=evidence,
        registration=SimpleNamespace(scale=0.7),
        placed=placed,
    )
    for name in ("refine_placement", "fit_scale"):
        monkeypatch.setattr(place_part, name, lambda _pair, placement: placement)
    monkeypatch.setattr(place_part, "make_candidate", lambda placement, _pair: placement)
    monkeypatch.setattr(place_part, "try_scales", lambda *_: [one])
    monkeypatch.setattr(place_part, "compare_alternatives", lambda found, _pair: found)
    whole = SimpleNamespace(distances=np.zeros((5, 5)))
    given: Any = SimpleNamespace(both_partial=False, is_one_view=False, file_scale=file_scale, whole=whole)
    assert place_part._clear_placements(given, one) == ([one] if clear else [])
