"""Verdicts as people read them."""

from kfmaps.cli.words import LOUD, VERDICTS, verdict_line
from kfmaps.viz.page import verdict_record


def test_a_terminal_warns_of_all_but_sure_maps():
    for kind in ("likely", "ambiguous", "unlikely"):
        assert verdict_line(kind).startswith(f"{kind.upper()}: {VERDICTS[kind]}")
        assert verdict_line(kind).endswith(LOUD[kind])
    assert verdict_line("sure") == VERDICTS["sure"]
    assert verdict_line("of another version") == "of another version"


def test_a_page_says_the_same():
    for kind, confidence in (("likely", 0.6), ("unlikely", 0.1), ("unlikely", None)):
        record = verdict_record({"verdict": kind, "confidence": confidence})
        assert record == {"kind": kind, "text": VERDICTS[kind], "confidence": confidence}
    assert verdict_record({"verdict": "unheard of"}) is None
