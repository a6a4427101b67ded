"""The summary of a collection as one HTML file: no script, no network, every name escaped."""

from __future__ import annotations

import base64
import hashlib
import io
import json
from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

import matplotlib

from kfmaps.app.batch.results import Result
from kfmaps.app.batch.summary import BAD, Summary, error_curve_of, summarised, worst_first
from kfmaps.app.pictures import curves_figure, save_figure
from kfmaps.app.words import UNIT, in_words, percent

STYLE = """
:root { color-scheme: light; font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff; }
body { max-width: 74rem; margin: 2rem auto; padding: 0 1.5rem; }
h1 { font-size: 1.7rem; margin-bottom: 0; } h2 { font-size: 1.2rem; margin: 2.2rem 0 .6rem; }
.note { color: #555; margin: .2rem 0; }
dl { display: grid; grid-template-columns: repeat(auto-fit, minmax(9.5rem, 1fr)); gap: 1rem; margin: 1.4rem 0; }
dl div { border-left: 3px solid #0072b2; padding-left: .7rem; }
dt { color: #555; font-size: .85rem; } dd { margin: 0; font-size: 1.4rem; font-variant-numeric: tabular-nums; }
.gallery { display: grid; grid-template-columns: repeat(auto-fit, minmax(30rem, 1fr)); gap: 1rem 2rem; }
figure { margin: 0 0 1rem; } figcaption { color: #555; font-size: .9rem; } img { max-width: 100%; height: auto; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-size: .85rem; width: 100%; }
th, td { padding: .25rem .7rem .25rem 0; text-align: left; border-bottom: 1px solid #e2e2e2; vertical-align: top; }
th { position: sticky; top: 0; background: #fff; } .n { text-align: right; font-variant-numeric: tabular-nums; }
.bad td { background: #fdeeee; } pre { background: #f6f6f6; padding: 1rem; overflow: auto; font-size: .8rem; }
summary { cursor: pointer; }
"""


def summary_page(
    name: str,
    results: Sequence[Result],
    settings: Mapping[str, Any],
    pictures: Mapping[str, bytes],
    pairs: int,
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
    """
    numbers = summarised(results)
    hashed = base64.b64encode(hashlib.sha256(STYLE.encode()).digest()).decode("ascii")
    policy = f"default-src 'none'; style-src 'sha256-{hashed}'; img-src data:; base-uri 'none'; form-action 'none'"
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
        _gallery(pictures, numbers),
        _failures(results),
        _table(results),
        _settings(settings),
        "</body></html>",
    ]
    return "\n".join(part for part in parts if part) + "\n"


def _state(numbers: Summary, pairs: int) -> str:
    left = max(pairs - numbers.done - numbers.failed, 0)
    told = [f"{numbers.done} pairs matched"]
    told += [f"{numbers.failed} failed"] if numbers.failed else []
    told += [f"{left} not done yet"] if left else []
    return ", ".join(told) + ". Errors are geodesic, in per cent of the square root of the source's area."


def _tiles(numbers: Summary) -> str:
    tiles = []
    if numbers.error_mean is not None:
        tiles += [
            (f"mean error ({UNIT})", percent(numbers.error_mean)),
            (f"median pair ({UNIT})", percent(numbers.error_median)),
            (f"worst pair ({UNIT})", percent(numbers.error_worst)),
            (f"pairs above {100 * BAD:g} {UNIT}", str(numbers.bad)),
            ("nearer to the mirrored truth", str(numbers.flipped)),
        ]
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


def _gallery(pictures: Mapping[str, bytes], numbers: Summary) -> str:
    if not pictures:
        return ""
    title = "Worst pairs" if numbers.evaluated else "Least sure pairs"
    shown = (
        f'<figure><img alt="{escape(name)}" src="{_data("png", png)}"><figcaption>{escape(name)}</figcaption></figure>'
        for name, png in pictures.items()
    )
    return f'<h2>{title}</h2><div class="gallery">{"".join(shown)}</div>'


def _failures(results: Sequence[Result]) -> str:
    failed = [r for r in results if r.status == "failed"]
    if not failed:
        return ""
    rows = "".join(
        f"<tr><td>{escape(r.source)}</td><td>{escape(r.target)}</td><td>{escape(r.reason)}</td></tr>" for r in failed
    )
    head = "<tr><th>source</th><th>target</th><th>reason</th></tr>"
    return f'<h2>Failed pairs</h2><div class="scroll"><table>{head}{rows}</table></div>'


def _table(results: Sequence[Result]) -> str:
    errors = [f"{what} ({UNIT})" for what in ("mean", "median", "max", "mirrored")]
    columns = (*errors, "confidence", "verdict", "time (s)")
    head = "<th>source</th><th>target</th>" + "".join(
        f'<th class="n">{c}</th>' if c != "verdict" else f"<th>{c}</th>" for c in columns
    )
    rows = []
    for r in worst_first(results):
        found = (r.error_mean, r.error_median, r.error_max, r.mirrored_mean)
        cells = [f'<td class="n">{percent(e)}</td>' for e in found]
        cells.append(f'<td class="n">{"" if r.confidence is None else format(r.confidence, ".3g")}</td>')
        cells.append(f"<td>{escape(r.verdict)}</td>")
        cells.append(f'<td class="n">{r.seconds.get("total", 0.0):.1f}</td>')
        wrong = r.error_mean is not None and r.error_mean > BAD
        names = f"<td>{escape(r.source)}</td><td>{escape(r.target)}</td>"
        rows.append(f"<tr{' class=bad' if wrong else ''}>{names}{''.join(cells)}</tr>")
    if not rows:
        return ""
    table = f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table>"
    return f'<h2>All pairs, worst first</h2><div class="scroll">{table}</div>'


def _settings(settings: Mapping[str, Any]) -> str:
    text = escape(json.dumps(settings, indent=2))
    return f"<h2>Settings</h2><details><summary>Everything the results depend on</summary><pre>{text}</pre></details>"


def _data(kind: str, content: bytes) -> str:
    return f"data:image/{kind};base64,{base64.b64encode(content).decode('ascii')}"
