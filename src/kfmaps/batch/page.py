"""The summary of a collection as one HTML file without network access, and the pages of single pairs."""

from __future__ import annotations

import io
import json
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any
from urllib.parse import quote

import matplotlib
import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure

from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps._texts import UNIT, format_seconds, percent, probability_text
from kfmaps._threads import one_blas_thread
from kfmaps.api import render
from kfmaps.batch.consistent import DIFFERENCE_KINDS, ConsistentResult, ShapeStatistics, map_in_use
from kfmaps.batch.layout import Pair
from kfmaps.batch.plan import Plan
from kfmaps.batch.results import BAD, CURVE_ERRORS, Result, describe_result, summarize, worst_first
from kfmaps.batch.run_spec import read_run_spec
from kfmaps.batch.work import PairTask, map_path, true_vertices
from kfmaps.evaluation import Truth
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import load_map, read_mesh
from kfmaps.io.atomic import write_text
from kfmaps.viz import Curve, curves_figure, mean_curve, save_figure
from kfmaps.viz.document import data_address, environment, policy
from kfmaps.viz.figures import error_limit, make_transparent
from kfmaps.viz.matches import values_figure
from kfmaps.viz.result_pages import match_page

PAGE = "summary.html"
_PAGES = "pages"
_MAX_NAMED = 60  # number of shapes up to which their names are written into the chart of components
_TEMPLATES = environment("kfmaps.batch")
_TEMPLATES.filters |= {"percent": percent, "in_words": format_seconds}

_Column = tuple[str, Callable[[Result], Any], Callable[[Any], str]]
_COLUMNS: tuple[_Column, ...] = (
    ("mean", lambda r: r.error_mean, percent),
    ("median", lambda r: r.error_median, percent),
    ("max", lambda r: r.error_max, percent),
    ("mirrored", lambda r: r.mirrored_mean, percent),
    ("verdict", lambda r: r.verdict or None, str),
    ("probability", lambda r: r.confidence, probability_text),
    ("local fit", lambda r: r.local_confidence, "{:.0%}".format),
    ("agreement", lambda r: r.agreement, probability_text),
    ("orientation", lambda r: r.orientation if r.orientation == "reversing" else None, str),
    ("of source", lambda r: r.common_s, "{:.0%}".format),
    ("of target", lambda r: r.common_t, "{:.0%}".format),
    ("replaced by", lambda r: r.changed or None, str),
    ("time (s)", lambda r: r.seconds.get("total"), "{:.1f}".format),
)
"""Columns of the table of pairs: title, sorting value, and text. A column without values is left out."""


def write_page(
    plan: Plan, results: Sequence[Result], name: str, worst: int, consistent: ConsistentResult | None = None
) -> Path:
    """Write the summary of a run, and the pages of the pairs that it shows as pictures.

    ``results``: of all pairs in the output folder; ``name``: title, any text; ``worst``: number of the worst pairs
    with a picture; ``consistent``: where maps were made consistent.
    """
    tasks = {task.pair: task for task in plan.tasks}
    ranked = worst_first(results)
    shown = ranked[:worst] + [r for r in results if r.changed][: 2 * worst]
    pages = _write_pages(plan.folder, tasks, shown)
    agreement: dict[str, Any] = {}
    if consistent is not None:
        replaced = [r for r in consistent.results if r.changed and r.pair in consistent.before]
        changed = _pictures(tasks, replaced, worst, _error_limit(consistent.results), consistent.before)
        agreement = {"changed": changed, "doubted": consistent.doubted, **_specimens(plan, consistent.shapes)}
    page = summary_page(
        name,
        results,
        read_run_spec(plan.folder),
        _pictures(tasks, ranked, worst, _error_limit(results)),
        len({r.pair for r in results} | tasks.keys()),
        pages,
        agreement,
    )
    write_text(plan.folder / PAGE, page, force=True)
    return plan.folder / PAGE


def summary_page(
    name: str,
    results: Sequence[Result],
    settings: Mapping[str, object],
    pictures: Mapping[str, str],
    pairs: int,
    pages: Mapping[Pair, str] | None = None,
    agreement: Mapping[str, Any] | None = None,
) -> str:
    """Return the summary page.

    ``name``: title, any text; ``settings``: plain values for JSON; ``pictures``: addresses by caption, of the worst
    pairs; ``pairs``: number of planned pairs; ``pages``: addresses of single maps, relative to the summary;
    ``agreement``: of consistent maps: pictures of ``changed`` maps by caption, a line for each ``doubted`` pair, charts
    and pictures of ``specimens``, and the table of ``shapes``.
    """
    numbers, ordered = summarize(results), worst_first(results)
    folder = files("kfmaps.batch").joinpath("templates")
    style, script = (folder.joinpath(f"summary.{kind}").read_text(encoding="utf-8") for kind in ("css", "js"))
    columns, cells = [], []
    for title, value, text in _COLUMNS:
        values = [value(r) for r in ordered]
        if any(v is not None for v in values):
            numeric = any(isinstance(v, float | int) for v in values)
            columns.append({"title": title, "numeric": numeric})
            cells.append([("", "") if v is None else (v, text(v)) for v in values])
    return _TEMPLATES.get_template("summary.html.j2").render(
        name=name,
        policy=policy(script, style, connect=False),
        style=Markup(style),
        script=Markup(script),
        numbers=numbers,
        unit=UNIT,
        bad=BAD,
        left=max(pairs - numbers["done"] - numbers["failed"], 0),
        curve=_curve(results),
        results=results,
        ordered=ordered,
        columns=columns,
        cells=list(zip(*cells, strict=True)),
        largest=max((r.error_mean or 0.0 for r in ordered), default=0.0),
        pages=pages or {},
        pictures=pictures,
        agreement={"changed": {}, "doubted": (), "specimens": (), "shapes": None, **(agreement or {})},
        settings=json.dumps(settings, indent=2),
    )


def _curve(results: Sequence[Result]) -> dict[str, str] | None:
    curve = mean_error_curve(results, "mean of all pairs")
    if curve is None:
        return None
    fractions = np.interp((0.01, 0.05, 0.1), curve.thresholds, curve.fractions)
    within = [f"{100 * f:.1f} % within {limit} {UNIT}" for f, limit in zip(fractions, (1, 5, 10), strict=True)]
    return {"within": ", ".join(within), "address": _picture(curves_figure([curve], size=(6.4, 3.8)), "svg+xml")}


def mean_error_curve(results: Sequence[Result], label: str) -> Curve | None:
    """Return the mean error curve of the pairs with a known truth, with the band of the middle 80 % of them."""
    curves = [r.curve for r in results if r.status == "done" and r.curve]
    return mean_curve(label, np.array(CURVE_ERRORS), np.array(curves)) if curves else None


def _picture(figure: Figure, kind: str) -> str:
    """Return a figure as a data address; ``kind``: "svg+xml" for charts, whose text can be searched, or "png"."""
    buffer = io.BytesIO()
    with matplotlib.rc_context({"svg.fonttype": "none", "font.family": "sans-serif"}):
        save_figure(make_transparent(figure), buffer, kind.removesuffix("+xml"))
    return data_address(f"image/{kind}", buffer.getvalue())


def _specimens(plan: Plan, statistics: ShapeStatistics) -> dict[str, Any]:
    """Return a chart and a picture of each connected component, and the table of shapes; empty without any."""
    if not statistics.parts:
        return {}
    rows = [dict(zip(statistics.table[0], row, strict=True)) for row in statistics.table[1:]]
    meshes = {t.name: t.path for task in plan.tasks for t in (task.source, task.target)}
    sections = []
    for part in statistics.parts:
        members, middle = set(part["names"].tolist()), str(part["middle"])
        chart = _chart([row for row in rows if row["shape"] in members], part)
        suffix = f": {len(members)} like {middle}" if len(statistics.parts) > 1 else ""
        variation = _variation(meshes[middle], part)
        sections.append(
            {"chart": _picture(chart, "svg+xml"), "which": suffix, "variation": variation, "middle": middle}
        )
    titles = [t for t in rows[0] if any(row[t] for row in rows) and (t != "part" or len({r[t] for r in rows}) > 1)]
    return {"specimens": sections, "shapes": {"titles": titles, "rows": rows}}


def _chart(rows: list[dict[str, str]], component: dict[str, np.ndarray]) -> Figure:
    figure = Figure(figsize=(9.6, 4.4), facecolor="white", layout="constrained")
    for ax, kind in zip(figure.subplots(1, len(DIFFERENCE_KINDS)), DIFFERENCE_KINDS, strict=True):
        explained = component[f"explained_{kind}"]
        if len(explained) < 2 or not explained.any():
            ax.set_axis_off()
            continue
        x, y = (np.array([float(row[f"{kind}_{i}"]) for row in rows]) for i in (1, 2))
        ax.scatter(x, y, s=18, color="#1d4ed8")
        for row, a, b in zip(rows, x, y, strict=True) if len(rows) <= _MAX_NAMED else ():
            place = {"xytext": (3, 3), "textcoords": "offset points", "fontsize": 7, "parse_math": False}
            ax.annotate(row["shape"], (a, b), **place)
        ax.set_xlabel(f"component 1 ({100 * explained[0]:.0f} %)")
        ax.set_ylabel(f"component 2 ({100 * explained[1]:.0f} %)")
        ax.set_title(f"{kind} differences", fontsize=10)
        ax.spines[["top", "right"]].set_visible(False)
    return figure


def _variation(path: Path, part: dict[str, np.ndarray]) -> str:
    if not path.exists():
        return ""
    mesh = _quiet_mesh(path)
    values = {f"{kind} differs by": part[f"variation_{kind}"] for kind in DIFFERENCE_KINDS}
    if any(len(v) != len(mesh.vertices) for v in values.values()):
        return ""
    return _picture(values_figure(mesh, values), "png")


def _quiet_mesh(path: Path) -> Mesh:
    with warnings.catch_warnings(action="ignore", category=KfmapsWarning):  # the run has reported them
        return read_mesh(path)


def _error_limit(results: Sequence[Result]) -> float | None:
    """Return the error at which the colours of all pictures end: from thrice the errors of maps that are not bad."""
    errors = np.array([r.error_mean for r in results if r.error_mean is not None])
    good_errors = errors[errors <= BAD] if (errors <= BAD).any() else errors
    return error_limit(3 * good_errors) if len(good_errors) else None


def _pictures(
    tasks: Mapping[Pair, PairTask],
    results: Iterable[Result],
    count: int,
    limit: float | None,
    before: Mapping[Pair, Result] | None = None,
) -> dict[str, str]:
    """Return pictures of at most ``count`` pairs by caption, also of the old map where ``before`` has its result.

    A pair is left out where its map or meshes are missing or do not fit any more.
    """
    pictures: dict[str, str] = {}
    n_drawn = 0
    for result in results:
        task = tasks.get(result.pair)
        if task is None or n_drawn == count:
            continue
        try:
            caption, new = describe_result(result), {}
            if before is not None:
                old = _draw(task, limit, map_path(task.folder, task.key))
                new[f"before: {describe_result(before[result.pair])}"] = old
                caption = f"now: {caption}, {result.changed}"
            new[caption] = _draw(task, limit, map_in_use(task.folder, task.key))
        except (InvalidInput, OSError):
            continue
        pictures |= new
        n_drawn += 1
    return pictures


def _draw(task: PairTask, limit: float | None, path: Path) -> str:
    """Return the picture of a map, with errors up to ``limit`` where the truth is known."""
    source, target, truth = _read_pair(task)
    with one_blas_thread():
        figure = render(load_map(path), source, target, truth=truth, limit=limit, small=True)
        return _picture(figure, "png")


def _read_pair(task: PairTask) -> tuple[Mesh, Mesh, Truth | None]:
    """Return both meshes of a pair, and the truth where it is known."""
    source, target = _quiet_mesh(task.source.path), _quiet_mesh(task.target.path)
    return source, target, true_vertices(task, len(source.vertices), len(target.vertices))


def _write_pages(folder: Path, tasks: Mapping[Pair, PairTask], results: Iterable[Result]) -> dict[Pair, str]:
    """Write the pages of ``results`` that are missing or older than their map; return the addresses of all pages.

    A map that cannot be shown has no page.
    """
    (folder / _PAGES).mkdir(exist_ok=True)
    for result in results:
        task = tasks.get(result.pair)
        if task is None or result.status != "done":
            continue
        page, path = folder / _PAGES / f"{task.key}.html", map_in_use(folder, task.key)
        try:
            if page.exists() and page.stat().st_mtime >= path.stat().st_mtime:
                continue
            source, target, truth = _read_pair(task)
            with one_blas_thread():
                html = match_page(
                    load_map(path), source, target, (result.source, result.target), truth=truth, descriptors=False
                )
        except (InvalidInput, OSError):
            continue
        write_text(page, html, force=True)
    paths = {pair: folder / _PAGES / f"{task.key}.html" for pair, task in tasks.items()}
    return {pair: f"{_PAGES}/{quote(path.name)}" for pair, path in paths.items() if path.exists()}
