"""How numbers are told to people, everywhere alike."""

from __future__ import annotations

UNIT = "% of √area"
"""The one unit of errors on terminals, pages and figures: per cent of the square root of the source's area.

Python, JSON and tables for machines have the plain fraction, in units of √area.
"""


def percent(error: float | None, digits: int = 2) -> str:
    """An error, in units of √area, as a number of :data:`UNIT`; empty where there is none."""
    return "" if error is None else f"{100 * error:.{digits}f}"


def probability_text(probability: float) -> str:
    """Return a probability as people read it: "97 %", ">99 %", "<1 %"."""
    if probability > 0.99:
        return ">99 %"
    return "<1 %" if probability < 0.01 else f"{100 * probability:.0f} %"


def in_words(seconds: float) -> str:
    """A duration, rounded to what one can tell: 40 s, 12 min, 3 h 20 min."""
    if seconds < 100:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    if minutes < 100:
        return f"{minutes} min"
    return f"{minutes // 60} h {minutes % 60:02d} min"


VERDICTS = {
    "landmarks": "The landmarks settle which way round it goes.",
    "sure": "Right in all probability: of maps that score like this hardly any is wrong, and no other comes near.",
    "likely": "More likely right than wrong, but not sure. Look at it before you rely on it.",
    "ambiguous": "Another map is about as good. Compare the other maps; a few landmarks decide.",
    "unlikely": "No map that was found fits well. One shape may be a part of the other, or they differ too much.",
    "unchecked": "One fit, compared with no other: without landmarks it may swap left and right.",
}
"""What the verdict of a match means, wherever it is told; the confidence is the probability of being right."""
LOUD = {
    "likely": "look at it (kfmaps view); landmarks, or more of them, may help (kfmaps landmarks)",
    "ambiguous": "give landmarks (kfmaps landmarks), or look at the other maps (kfmaps view)",
    "unlikely": "landmarks, or more of them, may help (kfmaps landmarks)",
}
"""Verdicts that a terminal must not bury in a table, and what to do."""


def verdict_line(kind: str) -> str:
    """Return a verdict for a terminal, in one line; the name itself where it is not known."""
    text = VERDICTS.get(kind, kind)
    return f"{kind.upper()}: {text} What to do: {LOUD[kind]}" if kind in LOUD else text
