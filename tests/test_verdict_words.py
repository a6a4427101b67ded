"""Verdicts and probabilities as people read them."""

from kfmaps.cli.words import VERDICTS, probability_text, verdict_text
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
