"""Tables of the summary page: columns of which something is known, sortable, every text escaped."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape

from kfmaps.batch.results import Result
from kfmaps.batch.summary import BAD, worst_first
from kfmaps.cli.words import UNIT, percent


@dataclass(frozen=True)
class Column:
    """One column.

    Attributes
    ----------
    title : str
    value : callable
        What a row has there to be sorted by: a number, a text, or ``None``.
    text : callable
        How that is shown.
    bar : bool
        Whether a bar below the number shows it beside the largest.
    wide : bool
        Whether it holds sentences.
    """

    title: str
    value: Callable[[Result], float | str | None]
    text: Callable[[float | str], str] = str
    bar: bool = False
    wide: bool = False


def _percent(value: float | str) -> str:
    return percent(float(value))


COLUMNS = (
    Column("mean", lambda r: r.error_mean, _percent, bar=True),
    Column("median", lambda r: r.error_median, _percent),
    Column("max", lambda r: r.error_max, _percent),
    Column("mirrored", lambda r: r.mirrored_mean, _percent),
    Column("verdict", lambda r: r.verdict or None),
    Column("confidence", lambda r: r.confidence, lambda v: f"{float(v):.3g}"),
    Column("local confidence", lambda r: r.local_confidence, lambda v: f"{float(v):.2f}"),
    Column("agreement", lambda r: r.agreement, lambda v: f"{float(v):.3g}"),
    Column("orientation", lambda r: r.orientation if r.orientation == "reversed" else None),
    Column("of source", lambda r: r.common_s, lambda v: f"{float(v):.0%}"),
    Column("of target", lambda r: r.common_t, lambda v: f"{float(v):.0%}"),
    Column("exchanged for", lambda r: r.changed or None),
    Column("time (s)", lambda r: r.seconds.get("total"), lambda v: f"{float(v):.1f}"),
)
"""Of the table of all pairs; what is known of no pair is left out."""


def pairs_table(results: Sequence[Result], pages: dict[tuple[str, str], str]) -> str:
    """All pairs, worst first; ``pages`` are addresses of the pages of some."""
    rows = worst_first(results)
    if not rows:
        return ""
    columns = [c for c in COLUMNS if any(c.value(r) is not None for r in rows)]
    head = "<th>source</th><th>target</th>" + "".join(
        f'<th class="n">{escape(c.title)}</th>' if _numeric(c, rows) else f"<th>{escape(c.title)}</th>" for c in columns
    )
    most = {c.title: max(float(v) for r in rows if (v := c.value(r)) is not None) for c in columns if c.bar}
    body = []
    for r in rows:
        wrong = r.error_mean is not None and r.error_mean > BAD
        cells = "".join(_cell(c, c.value(r), _numeric(c, rows), most.get(c.title, 0.0)) for c in columns)
        body.append(f"<tr{' class=bad' if wrong else ''}>{names(r, pages)}{cells}</tr>")
    table = f'<table class="sorts"><thead><tr>{head}</tr></thead><tbody>{"".join(body)}</tbody></table>'
    unit = f" (errors in {UNIT})" if any(r.error_mean is not None for r in rows) else ""
    return f'<h2>All pairs, worst first{unit}</h2><div class="scroll">{table}</div>'


def names(result: Result, pages: dict[tuple[str, str], str]) -> str:
    """The two first cells of a pair; the second leads to its page, where there is one."""
    target = escape(result.target)
    address = pages.get((result.source, result.target))
    if address is not None:
        target = f'<a href="{escape(address, quote=True)}">{target}</a>'
    return f"<td>{escape(result.source)}</td><td>{target}</td>"


def _numeric(column: Column, rows: Sequence[Result]) -> bool:
    return any(isinstance(column.value(r), float | int) for r in rows)


def _cell(column: Column, value: float | str | None, numeric: bool, most: float) -> str:
    kind = " ".join(["n"] * numeric + ["b"] * column.bar + ["w"] * column.wide)
    kind = f' class="{kind}"' if kind else ""
    if value is None:
        return f'<td{kind} data-v=""></td>'
    shown = escape(column.text(value))
    if column.bar and most > 0:
        # A width must not be a style, which the page's own policy forbids: a picture may have one.
        width = max(100 * float(value) / most, 1.0)
        shown += (
            '<svg class="bar" preserveAspectRatio="none" viewBox="0 0 100 1" width="100%" height="3">'
            f'<rect width="{width:.1f}" height="1" fill="currentColor"/></svg>'
        )
    return f'<td{kind} data-v="{escape(f"{value!r}" if numeric else str(value), quote=True)}">{shown}</td>'


def changes_table(results: Sequence[Result], pages: dict[tuple[str, str], str]) -> str:
    """Pairs whose maps were exchanged: before and after."""
    rows = [r for r in results if r.changed]
    if not rows:
        return ""
    known = any(r.error_before is not None for r in rows)
    head = "<th>source</th><th>target</th><th>exchanged for</th>"
    head += f'<th class="n">error before</th><th class="n">now ({UNIT})</th>' if known else ""
    body = []
    for r in rows:
        cells = f"<td>{escape(r.changed)}</td>"
        if known:
            cells += f'<td class="n was" data-v="{"" if r.error_before is None else r.error_before}">'
            cells += f'{percent(r.error_before)}</td><td class="n now" data-v="'
            cells += f'{"" if r.error_mean is None else r.error_mean}">{percent(r.error_mean)}</td>'
        body.append(f'<tr>{names(r, pages)}{cells}<td class="w">{escape(r.why)}</td></tr>')
    table = f'<table class="sorts"><thead><tr>{head}<th>why</th></tr></thead><tbody>{"".join(body)}</tbody></table>'
    return f'<h2>Exchanged maps</h2><div class="scroll">{table}</div>'
