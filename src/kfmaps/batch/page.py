"""The summary of a collection as one HTML file: no network, every name escaped, one script of its own to sort by."""

from __future__ import annotations

import base64
import hashlib
import io
import json
from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

import matplotlib

from kfmaps.batch.results import Result
from kfmaps.batch.style import SCRIPT, STYLE
from kfmaps.batch.summary import BAD, Summary, error_curve_of, summarised
from kfmaps.batch.tables import changes_table, pairs_table
from kfmaps.cli.words import UNIT, in_words, percent
from kfmaps.viz import curves_figure, save_figure


def summary_page(
    name: str,
    results: Sequence[Result],
    settings: Mapping[str, Any],
    pictures: Mapping[str, bytes],
    pairs: int,
    *,
    pages: Mapping[tuple[str, str], str] | None = None,
    changed: Mapping[str, bytes] | None = None,
    doubted: Sequence[str] = (),
    specimens: Sequence[str] = (),
) -> str:
    """The page.

    Parameters
    ----------
    name : str
        The collection's, any text.
    results : sequence of Result
    settings : mapping
        As JSON holds them.
    pictures : mapping of caption to PNG bytes
        In the order to be shown.
    pairs : int
        How many pairs were asked for.
    pages : mapping of (source, target) to address, optional
        Of the pages of single maps, relative to the summary.
    changed : mapping of caption to PNG bytes, optional
        Of exchanged pairs, before and after.
    doubted : sequence of str
        Pairs that others contradict and that nothing better is known for, a line each.
    specimens : sequence of str
        Sections about the shapes, as HTML.
    """
    addresses = dict(pages or {})
    numbers = summarised(results)
    policy = (
        f"default-src 'none'; style-src '{_hash(STYLE)}'; script-src '{_hash(SCRIPT)}'; img-src data:; "
        "base-uri 'none'; form-action 'none'"
    )
    parts = [
        "<!DOCTYPE html>",
        '<html lang="en"><head><meta charset="utf-8">',
        f'<meta http-equiv="Content-Security-Policy" content="{escape(policy)}">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{escape(name)}: {numbers.done} pairs</title>",
        f"<style>{STYLE}</style></head><body>",
        f"<h1>{escape(name)}</h1>",
        f'<p class="note">{_state(numbers, pairs)}</p>',
        _tiles(numbers),
        _curves(results),
        changes_table(results, addresses),
        _figures(changed or {}),
        _doubts(doubted),
        *specimens,
        _gallery(pictures, numbers),
        _failures(results),
        pairs_table(results, addresses),
        _settings(settings),
        f"<script>{SCRIPT}</script></body></html>",
    ]
    return "\n".join(part for part in parts if part) + "\n"


def _hash(text: str) -> str:
    return f"sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode('ascii')}"


def _state(numbers: Summary, pairs: int) -> str:
    left = max(pairs - numbers.done - numbers.failed, 0)
    told = [f"{numbers.done} pairs matched"]
    told += [f"{numbers.failed} failed"] if numbers.failed else []
    told += [f"{left} not done yet"] if left else []
    known = " Errors are geodesic, in per cent of the square root of the source's area." if numbers.evaluated else ""
    return ", ".join(told) + "." + known


def _tiles(numbers: Summary) -> str:
    tiles = []
    if numbers.error_mean is not None:
        tiles += [
            (f"mean error ({UNIT})", percent(numbers.error_mean)),
            (f"median pair ({UNIT})", percent(numbers.error_median)),
            (f"worst pair ({UNIT})", percent(numbers.error_worst)),
            (f"pairs above {100 * BAD:g} {UNIT}", str(numbers.bad)),
        ]
        tiles += [("nearer to the mirrored truth", str(numbers.flipped))] if numbers.mirrored else []
    tiles += [("pairs with a part", str(numbers.parts))] if numbers.parts else []
    tiles += [("maps exchanged", str(numbers.changed))] if numbers.agreed else []
    tiles += [(f"verdict: {verdict}", str(count)) for verdict, count in numbers.verdicts.items() if verdict]
    if numbers.seconds_mean is not None and numbers.seconds_total is not None:
        tiles += [
            ("mean time of a pair", f"{numbers.seconds_mean:.1f} s"),
            ("all pairs, one by one", in_words(numbers.seconds_total)),
        ]
    rows = (f"<div><dt>{escape(what)}</dt><dd>{escape(value)}</dd></div>" for what, value in tiles)
    return f"<dl>{''.join(rows)}</dl>" if tiles else ""


def _curves(results: Sequence[Result]) -> str:
    curve = error_curve_of(results, "mean of all pairs")
    if curve is None:
        return ""
    buffer = io.BytesIO()
    # Labels as text, which is smaller and can be searched.
    with matplotlib.rc_context({"svg.fonttype": "none", "font.family": "sans-serif"}):
        save_figure(curves_figure([curve], size=(6.4, 3.8)), buffer, "svg")
    at = [f"{100 * float(_at(curve, t)):.1f} % within {100 * t:g} {UNIT}" for t in (0.01, 0.05, 0.1)]
    caption = f"Points within an error of the truth: {', '.join(at)}. The band holds the middle 80 % of the pairs."
    image = f'<img alt="Error curve: {escape(", ".join(at))}" src="{_data("svg+xml", buffer.getvalue())}">'
    return f"<h2>Error curve</h2><figure>{image}<figcaption>{escape(caption)}</figcaption></figure>"


def _at(curve: Any, threshold: float) -> float:
    """The fraction at the last threshold kept that is not above ``threshold``."""
    return curve.fractions[int((curve.thresholds <= threshold + 1e-12).sum()) - 1]


def _doubts(lines: Sequence[str]) -> str:
    if not lines:
        return ""
    items = "".join(f"<li>{escape(line)}</li>" for line in lines)
    title = "Maps that others contradict, and no better one is known"
    return f'<h2>{title}</h2><div class="scroll"><ul>{items}</ul></div>'


def _gallery(pictures: Mapping[str, bytes], numbers: Summary) -> str:
    if not pictures:
        return ""
    title = "Worst pairs" if numbers.evaluated else "Least sure pairs"
    return f"<h2>{title}</h2>{_figures(pictures)}"


def _figures(pictures: Mapping[str, bytes]) -> str:
    shown = (
        f'<figure><img alt="{escape(name)}" src="{_data("png", png)}"><figcaption>{escape(name)}</figcaption></figure>'
        for name, png in pictures.items()
    )
    return f'<div class="gallery">{"".join(shown)}</div>' if pictures else ""


def _failures(results: Sequence[Result]) -> str:
    failed = [r for r in results if r.status == "failed"]
    if not failed:
        return ""
    rows = "".join(
        f"<tr><td>{escape(r.source)}</td><td>{escape(r.target)}</td><td>{escape(r.reason)}</td></tr>" for r in failed
    )
    head = "<tr><th>source</th><th>target</th><th>reason</th></tr>"
    return f'<h2>Failed pairs</h2><div class="scroll"><table>{head}{rows}</table></div>'


def _settings(settings: Mapping[str, Any]) -> str:
    text = escape(json.dumps(settings, indent=2))
    return f"<h2>Settings</h2><details><summary>Everything the results depend on</summary><pre>{text}</pre></details>"


def _data(kind: str, content: bytes) -> str:
    return f"data:image/{kind};base64,{base64.b64encode(content).decode('ascii')}"
