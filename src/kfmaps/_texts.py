"""Texts of numbers and verdicts for terminals, pages and figures."""

from __future__ import annotations

UNIT = "% of √area"
"""Unit of errors for people: per cent of the square root of the source's area.

Python, JSON and tables for programs have the plain fraction, in units of √area.
"""


def percent(error: float | None, digits: int = 2) -> str:
    """Return an error, in units of √area, as a number of :data:`UNIT`; empty where there is none."""
    return "" if error is None else f"{100 * error:.{digits}f}"


def plural(number: int, word: str, words: str | None = None) -> str:
    """Return a number with its noun: "1 pair", "12 pairs". ``words``: the plural, where it is no ``word`` and an s."""
    return f"{number} {word}" if number == 1 else f"{number} {words or word + 's'}"


def probability_text(probability: float) -> str:
    """Return a probability as people read it: "97 %", ">99 %", "<1 %"."""
    if probability > 0.99:
        return ">99 %"
    return "<1 %" if probability < 0.01 else f"{100 * probability:.0f} %"


def format_seconds(seconds: float) -> str:
    """Return a rounded duration: 40 s, 12 min, 3 h 20 min."""
    if seconds < 100:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    if minutes < 100:
        return f"{minutes} min"
    return f"{minutes // 60} h {minutes % 60:02d} min"


VERDICTS = {
    "landmarks": "One fit, guided by the landmarks and compared with no other map.",
    "sure": "Very likely right.",
    "likely": "Probably right. Look at it before you rely on it.",
    "ambiguous": "Another map fits about as well. Compare the two.",
    "unlikely": "Probably wrong: no map fits well. The shapes may differ too much, or --partial must name the part.",
    "unchecked": "One fit, compared with no other map. Without landmarks it may swap left and right.",
}
"""Meaning of each verdict."""
_WITHOUT_LANDMARKS = {
    "likely": "If it is wrong, two or three landmarks help.",
    "ambiguous": "Two or three landmarks decide.",
    "unlikely": "Two or three landmarks may help.",
}
"""Advice for matches without landmarks."""
_WITH_LANDMARKS = {"ambiguous": "Check that the landmarks do not exchange left and right."}
"""Advice for matches with landmarks."""


def verdict_text(verdict: str, n_landmarks: int) -> str:
    """Return the meaning of a verdict and advice, for a match with ``n_landmarks``; empty for an unknown verdict."""
    advice = (_WITH_LANDMARKS if n_landmarks else _WITHOUT_LANDMARKS).get(verdict, "")
    return f"{VERDICTS.get(verdict, '')} {advice}".strip()
