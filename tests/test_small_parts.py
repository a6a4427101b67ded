"""Parts below a quarter of the whole: SHOT near the boundary, further candidates, and the scale of the file."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from kfmaps import Config
from kfmaps.geometry.mesh import Mesh
from kfmaps.matching.partial import candidates, place_part
from kfmaps.matching.partial.relaxation_labeling import Assignment
from kfmaps.matching.partial.samples import PartPair, PartSamples
from kfmaps.matching.partial.scale_search import TRIALS, Placement, place_all, shot_similarity
from kfmaps.matching.score import SCORE, PartEvidence, part_score

GUARDS = ("kfmaps.matching.partial", "kfmaps.matching.score")

SCALE, RADIUS = 0.4, max(TRIALS[0].radii)
AWAY = np.array([0.0, 0.25, 0.5, 1.0, 9.0], dtype=np.float32)
"""Distances of five samples from the boundary, in radii of SHOT."""
WEIGHTS = np.array([0.05, 0.25, 0.5, 1.0, 1.0])


@pytest.fixture
def pair(monkeypatch: pytest.MonkeyPatch) -> PartPair:
    """Five samples on a line of a small part and of the whole, all of whose descriptors are alike."""
    line = np.arange(5)[:, None] * [0.1, 0.0, 0.0]
    away = AWAY * np.float32(RADIUS / SCALE)
    sides = []
    for scale, boundary in ((SCALE, away), (1.0, np.full(5, np.inf, dtype=np.float32))):
        mesh = Mesh(line / scale, np.zeros((0, 3), dtype=np.int64))
        between = np.abs(line[:, :1] - line[:, 0]).astype(np.float32) / np.float32(scale)
        sides.append(PartSamples(mesh, np.arange(5), between, boundary))
    monkeypatch.setattr(PartSamples, "shot", lambda *_: np.ones((5, 1), dtype=np.float32))
    return PartPair(*sides, small_scale=SCALE)


def test_shot_counts_as_far_as_its_ball_fits(pair: PartPair) -> None:
    np.testing.assert_allclose(pair.shot_weights(SCALE, RADIUS), WEIGHTS, rtol=1e-6)
    np.testing.assert_allclose(pair.shot_weights(SCALE, 2 * RADIUS), [0.05, 0.125, 0.25, 0.5, 1.0], rtol=1e-6)
    np.testing.assert_allclose(pair.shot_weights(SCALE / 2, RADIUS), [0.05, 0.125, 0.25, 0.5, 1.0], rtol=1e-6)
    narrow = replace(pair, part=replace(pair.part, boundary_distance=pair.part.boundary_distance[:3]))
    np.testing.assert_allclose(narrow.shot_weights(SCALE, RADIUS), [0.05, 0.5, 1.0], rtol=1e-6)


def test_similarities_of_a_small_part_alone_are_weighted(pair: PartPair) -> None:
    for params in TRIALS[:2]:
        weights = pair.shot_weights(SCALE, max(params.radii))
        np.testing.assert_allclose(shot_similarity(pair, SCALE, params), np.tile(weights, (5, 1)).T)
        assert (shot_similarity(replace(pair, small_scale=None), SCALE, params) == 1.0).all()


def test_ranks_of_a_small_part_are_weighted_by_squares(pair: PartPair) -> None:
    similarity = np.tile(np.arange(5.0), (5, 1)).astype(np.float32)
    begun = Placement(SCALE, TRIALS[0], Assignment(np.arange(5), np.ones(5), 1.0), similarity)
    ranks = np.log((5 - np.arange(5)) / 5)
    for one, wanted in (
        (place_all(replace(pair, small_scale=None), begun), ranks.mean()),
        (place_all(pair, begun), (WEIGHTS**2 * ranks).sum() / (WEIGHTS**2).sum()),
    ):
        told = replace(one, placed=replace(one.placed, match=np.arange(5))).evidence
        assert told.similarity_rank == pytest.approx(wanted)


def test_another_scale_than_that_of_the_file_costs_up_to_a_bound() -> None:
    usual, most, far = PartEvidence(0.8, -4.0, 0.01), SCORE.part.w_scale, SCORE.part.other_scale
    for change, cost in ((0.0, 0.0), (0.5 * far, 0.25 * most), (far, most), (9 * far, most)):
        assert part_score(usual) - part_score(replace(usual, scale_change=change)) == pytest.approx(cost)


def test_a_candidate_knows_its_scale_against_the_file(monkeypatch: pytest.MonkeyPatch, pair: PartPair) -> None:
    found = SimpleNamespace(
        vertices=np.eye(5),
        deformation_energy=0.01,
        gap=0.0,
        flipped_area=0.0,
        places=SimpleNamespace(points=np.eye(5)),
    )
    monkeypatch.setattr(candidates, "register_part", lambda *_, **__: found)
    surface = SimpleNamespace(normals=np.eye(5))
    whole: Any = SimpleNamespace(
        samples=np.arange(5), landmarks=np.arange(0), mesh=SimpleNamespace(vertices=np.eye(5)), surface=surface
    )
    pair = replace(pair, whole=whole)
    begun = Placement(SCALE, TRIALS[0], Assignment(np.arange(5), np.ones(5), 1.0), np.eye(5))
    for scale in (SCALE, 0.8 * SCALE, 1.25 * SCALE):
        one = replace(begun, scale=scale)
        changed = candidates.make_candidate(one, pair).evidence.scale_change
        assert changed == pytest.approx(abs(np.log(scale / SCALE)))
        assert candidates.make_candidate(one, replace(pair, small_scale=None)).evidence.scale_change == 0.0


def test_all_placements_at_a_known_scale_are_registered_and_the_best_that_differ_kept(
    monkeypatch: pytest.MonkeyPatch, pair: PartPair
) -> None:
    """Each of two trials has three placements by beams and one by relaxation; two lie at one place."""
    scores = iter([5.0, 9.0, 7.0, 8.0, 6.0, 8.9, 4.0, 3.0])
    at = iter([0.0, 1.0, 2.0, 3.0, 4.0, 1.01, 5.0, 6.0])

    def registered(one: Placement, _pair: PartPair) -> Any:
        assert one.scale == SCALE
        return SimpleNamespace(score=next(scores), points=np.full((5, 3), next(at)), times=0)

    monkeypatch.setattr(
        candidates, "rough_placements", lambda _pair, scale, _params: [SimpleNamespace(scale=scale)] * 4
    )
    monkeypatch.setattr(candidates, "place_all", lambda _pair, one: one)
    monkeypatch.setattr(candidates, "make_candidate", registered)
    monkeypatch.setattr(candidates, "_place_again", lambda one, _pair: SimpleNamespace(**{**vars(one), "times": 1}))
    found: Any = candidates.candidates_at_scale(pair, SCALE)
    assert [(one.score, one.times) for one in found] == [(9.0, 1), (8.0, 1), (7.0, 1), (6.0, 1)]


@pytest.mark.parametrize(
    ("ratio", "both", "known"),
    [(0.4, False, True), (0.49, False, True), (0.26, False, True), (0.51, False, False), (0.24, False, False),
     (None, False, False), (0.4, True, False), (0.6, True, True), (1.9, True, True), (2.1, True, False)],
)  # fmt: skip
def test_all_placements_of_small_parts_and_of_two_parts_in_one_unit_are_registered(
    monkeypatch: pytest.MonkeyPatch, ratio: float | None, both: bool, known: bool
) -> None:
    """A part is small below a quarter of the area; two parts of like size are taken to be in one unit."""
    seen: list[Any] = []

    def candidates_at_scale(pair: PartPair, scale: float) -> Any:
        assert pair.small_scale == (None if both else scale)
        return [scale]

    def compared(found: Any, _pair: PartPair) -> Any:
        seen.append(found)
        raise StopIteration

    likely = SimpleNamespace(scale=1.0)
    monkeypatch.setattr(place_part, "try_scales", lambda *_: [likely])
    monkeypatch.setattr(place_part, "_clear_candidate", lambda *_: None)
    monkeypatch.setattr(place_part, "_likely_placements", lambda *_: [likely])
    monkeypatch.setattr(place_part, "make_candidate", lambda one, _pair: one)
    monkeypatch.setattr(place_part, "candidates_at_scale", candidates_at_scale)
    monkeypatch.setattr(place_part, "compare_alternatives", compared)
    triangle = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    with pytest.raises(StopIteration):
        place_part.place_part(triangle, triangle, Config(), ratio=ratio, both_partial=both)
    assert seen == [[likely] + [ratio] * known]


@pytest.mark.parametrize(
    ("scales", "tried", "ends"), [((0.3, 0.4), [0.3], "last"), ((0.3, 0.6), [0.3, 0.6], "compare")]
)
def test_where_all_placements_are_too_small_the_first_alone_is_registered(
    monkeypatch: pytest.MonkeyPatch, scales: tuple[float, ...], tried: list[float], ends: str
) -> None:
    class End(Exception):
        """Where placing a part was left."""

    def left(name: str) -> Any:
        def leave(*_: Any) -> Any:
            raise End(name)

        return leave

    seen: list[float] = []
    likely = [SimpleNamespace(scale=scale) for scale in scales]
    monkeypatch.setattr(place_part, "try_scales", lambda *_: likely)
    monkeypatch.setattr(place_part, "_clear_candidate", lambda *_: None)
    monkeypatch.setattr(place_part, "_likely_placements", lambda *_: likely)
    monkeypatch.setattr(
        place_part, "make_candidate", lambda one, _: seen.append(one.scale) or SimpleNamespace(registration=None)
    )
    monkeypatch.setattr(place_part, "compare_alternatives", left("compare"))
    monkeypatch.setattr(place_part, "_register_fully", left("last"))
    triangle = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    with pytest.raises(End, match=ends):
        place_part.place_part(triangle, triangle, Config(), least_scale=0.5)
    assert seen == tried


@pytest.mark.parametrize(
    ("score", "scale", "both", "agree", "clear"),
    [
        (0.0, 0.5, False, 97, True),
        (9.0, 0.9, False, 96, False),
        (-0.1, 0.9, False, 100, False),
        (9.0, 0.49, False, 100, False),
        (9.0, 0.9, True, 100, False),
    ],
)
def test_the_search_ends_where_the_best_supported_placement_of_a_large_part_is_clear(
    monkeypatch: pytest.MonkeyPatch, score: float, scale: float, both: bool, agree: int, clear: bool
) -> None:
    """Its alternatives are looked for all the same."""
    each = np.arange(100)
    one, again = (
        SimpleNamespace(
            score=SCORE.part.early_exit_score + score,
            scale=scale,
            registration=SimpleNamespace(scale=scale),
            placed=SimpleNamespace(match=match),
        )
        for match in (each, np.where(each < agree, each, (each + 50) % 100))
    )
    likely = SimpleNamespace(scale=1.0)
    scales_tried: list[list[float]] = []

    def try_scales(_pair: Any, scales: list[float], params: Any = TRIALS[0]) -> list[Any]:
        if params is TRIALS[1]:
            assert scales == [scale]
            return [again]
        scales_tried.append(scales)
        return [one]

    monkeypatch.setattr(place_part, "try_scales", try_scales)
    monkeypatch.setattr(place_part, "refine_placement", lambda _pair, placement: placement)
    monkeypatch.setattr(place_part, "fit_scale", lambda _pair, placement: placement)
    monkeypatch.setattr(place_part, "make_candidate", lambda placement, _pair: placement)
    monkeypatch.setattr(place_part, "_likely_placements", lambda *_: [likely])
    monkeypatch.setattr(place_part, "compare_alternatives", lambda found, _pair: found)
    line = np.abs(each[:, None] - each) * 0.05
    pair: Any = SimpleNamespace(
        fixed_scale=False, both_partial=both, small_scale=None, whole=SimpleNamespace(distances=line)
    )
    found = place_part._search_placements(pair, 0.9, 3, 0.0, False, lambda _done: None)
    assert found == ([one] if clear else [likely])
    assert scales_tried[0] == [0.9]  # the scale of the files comes first
    assert len(scales_tried) == (1 if clear else 2)
    if not clear:
        with pytest.raises(place_part.NotClear):
            place_part._search_placements(pair, 0.9, 3, 0.0, True, lambda _done: None)
