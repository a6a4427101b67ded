"""Verdicts and probabilities as people read them."""

from dataclasses import replace

import numpy as np

from kfmaps.cli.summary import table
from kfmaps.cli.words import VERDICTS, probability_text, verdict_text
from kfmaps.datasets import sphere
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import MatchRegistration, MatchScore
from kfmaps.registration.accept import RegistrationReport
from kfmaps.viz.page import verdict_record


def test_landmarks_are_advised_only_where_none_were_given() -> None:
    for kind in ("likely", "ambiguous", "unlikely"):
        assert verdict_text(kind, 3) == VERDICTS[kind]
        assert verdict_text(kind, 0).startswith(f"{VERDICTS[kind]} ")
        assert "landmarks" in verdict_text(kind, 0)
        assert "landmarks" not in verdict_text(kind, 3)
    assert verdict_text("sure", 0) == verdict_text("sure", 3) == VERDICTS["sure"]
    assert verdict_text("of another version", 0) == ""


def test_a_page_says_the_same() -> None:
    for kind, confidence, landmarks in (("likely", 0.6, 0), ("unlikely", 0.1, 2), ("unlikely", None, 0)):
        record = verdict_record({"verdict": kind, "confidence": confidence, "landmarks": landmarks})
        assert record == {"kind": kind, "text": verdict_text(kind, landmarks), "confidence": confidence}
    assert verdict_record({"verdict": "unheard of"}) is None


def test_probabilities_are_whole_per_cents_but_at_the_ends() -> None:
    texts = [probability_text(p) for p in (0.0, 0.009, 0.01, 0.5, 0.974, 0.99, 0.991, 1.0)]
    assert texts == ["<1 %", "<1 %", "1 %", "50 %", "97 %", "99 %", ">99 %", ">99 %"]


def test_the_summary_says_which_landmarks_had_no_say() -> None:
    mesh, report = sphere(1500), RegistrationReport(0.01, 0.1, 0.9, landmarks_held=False)
    landmarks, score = np.array([[1, 2], [3, 4]]), MatchScore(rejected_landmarks=np.array([1]))
    points = np.arange(len(mesh.vertices))
    match = Match(points, source=mesh, target=mesh, landmarks=landmarks, score=score, verdict="sure")
    match = replace(match, local_confidence=np.ones(len(points)))

    def told(found: Match) -> str:
        names, values = (list(column.cells) for column in table(found).columns)
        return str(values[names.index("landmarks")])

    left_out = "2; left out, since the map contradicts them: number 1, counted from 0"
    assert (
        told(match)
        == told(replace(match, registration=MatchRegistration(None, RegistrationReport(0, 0, 1))))
        == left_out
    )
    loose = "; most are 4 % of √area or more from the map, so they do not hold it"
    assert told(replace(match, registration=MatchRegistration(None, report))) == left_out + loose
