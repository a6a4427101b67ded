"""Verdicts and probabilities as people read them."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial import KDTree

from kfmaps._texts import VERDICTS, plural, probability_text, verdict_text
from kfmaps.cli.summary import table
from kfmaps.collection.repair import CyclePath, MapEvidence, Replacement
from kfmaps.config import Config, Search
from kfmaps.datasets import sphere
from kfmaps.evaluation import Truth, assess
from kfmaps.kernels.transformed import Metric
from kfmaps.matching.orientation import orientation_text
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import ONE_FIT, MatchFit, MatchPart, MatchRegistration, MatchScore
from kfmaps.registration.accept import RegistrationReport
from kfmaps.viz.page import verdict_record


def test_landmarks_are_advised_only_where_none_were_given() -> None:
    for kind in ("likely", "ambiguous", "unlikely"):
        advice = " Check that the landmarks do not exchange left and right." if kind == "ambiguous" else ""
        assert verdict_text(kind, 3) == VERDICTS[kind] + advice
        assert verdict_text(kind, 0).startswith(f"{VERDICTS[kind]} ")
        assert "landmarks" in verdict_text(kind, 0)
    assert verdict_text("sure", 0) == verdict_text("sure", 3) == VERDICTS["sure"]
    assert verdict_text("of another version", 0) == ""


def test_a_page_says_the_same() -> None:
    for kind, confidence, n_landmarks in (("likely", 0.6, 0), ("unlikely", 0.1, 2), ("unlikely", None, 0)):
        match = replace(_match(landmarks=np.zeros((n_landmarks, 2))), verdict=kind, confidence=confidence)
        expected = {"kind": kind, "text": verdict_text(kind, n_landmarks), "confidence": confidence}
        assert verdict_record(match, SPHERE, SPHERE) == expected
    assert verdict_record(replace(_match(), verdict="unheard of"), SPHERE, SPHERE) is None
    record = verdict_record(_match(orientation="reversing"), SPHERE, SPHERE)
    assert record is not None
    assert str(record["text"]).startswith(f"{VERDICTS['sure']} Orientation reversed: ")


@pytest.mark.parametrize(("scores", "is_told"), [((5.0, 6.1), True), ((5.0, 5.9), False), ((5.0,), False)])
def test_of_a_part_only_its_mirror_image_has_a_better_score(scores: tuple[float, ...], is_told: bool) -> None:
    match = replace(_match(partial=MatchPart("target"), score=MatchScore(scores)), verdict="ambiguous")
    text = orientation_text(match, SPHERE, SPHERE)
    assert ("--orientation reversing" in text) == is_told
    assert orientation_text(replace(match, verdict="likely"), SPHERE, SPHERE) == ""


def test_probabilities_are_whole_per_cents_but_at_the_ends() -> None:
    texts = [probability_text(p) for p in (0.0, 0.009, 0.01, 0.5, 0.974, 0.99, 0.991, 1.0)]
    assert texts == ["<1 %", "<1 %", "1 %", "50 %", "97 %", "99 %", ">99 %", ">99 %"]


def _summary(match: Match) -> dict[str, str]:
    names, values = (list(column.cells) for column in table(match).columns)
    return {str(name): str(value) for name, value in zip(names, values, strict=True)}


SPHERE = sphere(1500)


def _match(**fields: Any) -> Match:
    points = np.arange(len(SPHERE.vertices))
    known = {"source": SPHERE, "target": SPHERE, "verdict": "sure", "config": Config()}
    return Match(points, local_confidence=np.ones(len(points)), **known, **fields)


def test_the_summary_says_which_landmarks_had_no_say() -> None:
    landmarks, score = np.array([[1, 2], [3, 4]]), MatchScore(rejected_landmarks=np.array([1]))
    match = _match(landmarks=landmarks, score=score)
    held, loose = (
        replace(match, registration=MatchRegistration(None, RegistrationReport(0.01, 0.1, 0.9, landmarks_held=hold)))
        for hold in (True, False)
    )
    left_out = "2; left out, since the map contradicts them: number 1, counted from 0"
    assert _summary(match)["landmarks"] == _summary(held)["landmarks"] == left_out
    says = "; most are 4 % of √area or more from the map, so they do not hold it"
    assert _summary(loose)["landmarks"] == left_out + says
    most = replace(match, score=MatchScore(rejected_landmarks=np.array([0, 1])))
    assert _summary(most)["landmarks"].endswith("or is a shape mirrored (--orientation reversing)?")


def test_the_summary_says_what_part_the_kernel_had() -> None:
    fitted = MatchFit(size=20, status="converged", steps=7, kernel="Gaussian(gamma=0.123456789)", rank=30)
    searched, once = _match(confidence=0.95), _match(score=MatchScore(initialization=ONE_FIT))
    assert _summary(searched)["kernel"] == "had no part in this map"
    assert _summary(replace(searched, fit=fitted))["kernel"] == "Gaussian(gamma=0.1235), in the initial map"
    output = _summary(replace(once, fit=fitted))
    assert output["fit"] == "Gaussian(gamma=0.1235), 30 features; converged in 7 steps"
    assert "kernel" not in output
    learned = _summary(replace(searched, config=Config(kernel=Metric(matrix=((1.0, 2.0),)))))
    assert learned["kernel"] == "a search leaves the learned one out; --set search=none takes it"


def test_the_summary_says_what_is_odd() -> None:
    match = _match()
    n = len(match.target_to_source)
    usual = _summary(match)
    assert usual.keys() == {"matched", "verdict", "time"}
    poor = np.where(match.target.vertices[:, 1] > 0, 0.1, 1.0)  # half of the sphere
    share = float(_summary(replace(match, local_confidence=poor))["doubtful"].split("%")[0].split()[-1])
    assert 48 < share < 52
    assert "doubtful" not in _summary(replace(match, local_confidence=poor, verdict="ambiguous"))
    assert "mirror image" in _summary(replace(match, orientation="reversing"))["orientation"]
    lost = np.where(np.arange(n) < 1200, -1, match.target_to_source)
    assert _summary(replace(match, target_to_source=lost))["no counterpart"].startswith("1,200 of the target's 1,500")
    part = MatchPart(reason="the target is a part, 40% of the other's area", suspected=True)
    assert _summary(replace(match, partial=part))["parts"] == part.reason
    accuracy = assess(match.source, match.target_to_source, Truth(np.arange(n), np.arange(n)))
    names, values = (list(column.cells) for column in table(match, accuracy).columns)
    assert str(values[names.index("error")]).startswith("mean 0.00, median 0.00, worst 0.00 % of √area; area under")


def test_the_summary_says_what_decides_between_a_body_and_its_mirror_image() -> None:
    """Only where the first alternative is a map to the mirror image and better, and the settings leave it open."""
    vertices = SPHERE.vertices
    mirrored, turned = (np.asarray(KDTree(vertices).query(vertices * side)[1]) for side in ([-1, 1, 1], [-1, -1, 1]))
    preserving = Config(search=Search(orientation="preserving"))

    def told(gain: float, word: str, other: np.ndarray, **fields: Any) -> bool:
        score = MatchScore(scores=(-3.0, -3.0 + gain))
        rival = replace(_match(), verdict=word, score=score, alternatives=(other,), **fields)
        return "take --orientation reversing if" in _summary(rival).get("orientation", "")

    assert told(1.1, "ambiguous", mirrored)
    assert told(-1.0, "ambiguous", turned, orientation="reversing")
    assert not told(0.9, "ambiguous", mirrored)
    assert not told(1.1, "likely", mirrored)
    assert not told(1.1, "ambiguous", turned)
    assert not told(1.1, "ambiguous", mirrored, config=preserving)
    assert not told(1.1, "ambiguous", mirrored, config=Config.single_fit())


def test_one_of_a_kind_is_no_plural() -> None:
    assert [plural(n, "pair") for n in (0, 1, 2)] == ["0 pairs", "1 pair", "2 pairs"]


def test_a_long_composition_names_few_shapes() -> None:
    names, evidence = [f"s{i}" for i in range(60)], MapEvidence(0.9, 20.0, 0.1)

    def label(count: int) -> str:
        path = CyclePath((), tuple(range(count)))
        return Replacement(0, "composition", evidence, evidence, path=path).label(names)

    assert label(2) == "composition through s0, s1"
    assert label(48) == "composition through s0, s1, s2, s3, s4, 43 more"
    assert Replacement(0, "alternative", evidence, evidence, 2).label(names) == "alternative 2"
