"""Verdicts as people read them."""

from kfmaps.cli.words import LIKELY, LOUD, VERDICTS, verdict_line
from kfmaps.viz.page import verdict_record


def test_a_map_that_is_likely_right_is_not_said_to_fit_badly():
    """It is poor all the same: nothing is taken from the warning."""
    unlikely, likely = verdict_line("poor", 0.3), verdict_line("poor", 0.6)
    for line in (unlikely, likely):
        assert line.startswith("POOR: ")
        assert line.endswith(LOUD["poor"])
    assert VERDICTS["poor"] in unlikely
    assert LIKELY in likely
    assert verdict_line("poor") == unlikely
    assert verdict_line("sure", 0.95) == VERDICTS["sure"]
    assert verdict_line("of another version") == "of another version"


def test_a_page_says_the_same():
    for confidence, text in ((0.6, LIKELY), (0.1, VERDICTS["poor"]), (None, VERDICTS["poor"]), ("?", VERDICTS["poor"])):
        record = verdict_record({"verdict": "poor", "confidence": confidence})
        assert record == {"kind": "poor", "text": text, "confidence": confidence}
    assert verdict_record({"verdict": "unheard of"}) is None
