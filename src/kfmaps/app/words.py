"""How numbers are told to people, everywhere alike."""

from __future__ import annotations

UNIT = "% of √area"
"""The one unit of errors on terminals, pages and figures: per cent of the square root of the source's area.

Python, JSON and tables for machines have the plain fraction, in units of √area.
"""


def percent(error: float | None, digits: int = 2) -> str:
    """An error, in units of √area, as a number of :data:`UNIT`; empty where there is none."""
    return "" if error is None else f"{100 * error:.{digits}f}"


def in_words(seconds: float) -> str:
    """A duration, rounded to what one can tell: 40 s, 12 min, 3 h 20 min."""
    if seconds < 100:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    if minutes < 100:
        return f"{minutes} min"
    return f"{minutes // 60} h {minutes % 60:02d} min"
