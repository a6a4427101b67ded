"""The summary of a collection as one HTML file without network access, and the pages of single pairs."""

from __future__ import annotations

import base64
import csv
import io
import json
import warnings
from collections.abc import Callable, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any
from urllib.parse import quote

import matplotlib
import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure

from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps._threads import one_blas_thread
from kfmaps.batch.consistent import CONSISTENT, ConsistentResult, map_in_use
from kfmaps.batch.layout import Pair
from kfmaps.batch.plan import Plan
from kfmaps.batch.results import (
    BAD,
    CURVE_ERRORS,
    Result,
    Summary,
    fitting_limit,
    summarize,
    worst_first,
)
from kfmaps.batch.run_spec import read_settings
from kfmaps.batch.shape_statistics import KINDS, SHAPES, limit_shape_paths
from kfmaps.batch.work import PairTask, map_path, true_vertices
from kfmaps.cli.words import UNIT, in_words, percent
from kfmaps.io import atomic_output, check_map, load_map, read_mesh
from kfmaps.viz import Curve, curves_figure, match_figure, mean_curve, painted_errors, save_figure, true_views
from kfmaps.viz.document import environment, policy
from kfmaps.viz.figures import make_transparent
from kfmaps.viz.matches import values_figure
from kfmaps.viz.result_pages import map_page

PAGE, PAGES = "summary.html", "pages"
TEXT_SIZE = 18.0
"""Letters in points: the pictures are shown at half their size."""
MAX_NAMED = 60
"""Shapes up to which their names stand in the chart of principal components."""
_TEMPLATES = environment("kfmaps.batch")

Column = tuple[str, Callable[[Result], Any], Callable[[Any], str]]
COLUMNS: tuple[Column, ...] = (
    ("mean", lambda r: r.error_mean, percent),
    ("median", lambda r: r.error_median, percent),
    ("max", lambda r: r.error_max, percent),
    ("mirrored", lambda r: r.mirrored_mean, percent),
    ("verdict", lambda r: r.verdict or None, str),
    ("confidence", lambda r: r.confidence, "{:.3g}".format),
    ("local confidence", lambda r: r.local_confidence, "{:.2f}".format),
    ("agreement", lambda r: r.agreement, "{:.3g}".format),
    ("orientation", lambda r: r.orientation if r.orientation == "reversing" else None, str),
    ("of source", lambda r: r.common_s, "{:.0%}".format),
    ("of target", lambda r: r.common_t, "{:.0%}".format),
    ("exchanged for", lambda r: r.changed or None, str),
    ("time (s)", lambda r: r.seconds.get("total"), "{:.1f}".format),
)
"""Title, value to sort by and text of the columns of all pairs; one of which nothing is known is left out."""


def write_page(
    plan: Plan, results: Sequence[Result], name: str, worst: int, consistent: ConsistentResult | None = None
) -> Path:
    """Write the summary of a run, and the pages of the pairs that it shows as pictures; its path."""
    shown = worst_first(results)[:worst] + [r for r in results if r.changed][: 2 * worst]
    pairs = {(r.source, r.target) for r in results} | {(t.pair.source, t.pair.target) for t in plan.tasks}
    page = summary_page(
        name,
        results,
        read_settings(plan.folder),
        worst_pictures(plan.tasks, results, worst),
        len(pairs),
        pages=write_pages(plan.folder, plan.tasks, shown),
        changed={} if consistent is None else changed_pictures(plan.tasks, consistent, worst),
        doubted=() if consistent is None else consistent.doubted,
        specimens=None if consistent is None else specimen_sections(plan),
    )
    with atomic_output(plan.folder / PAGE, force=True) as temporary:
        temporary.write_text(page, encoding="utf-8")
    return plan.folder / PAGE


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
    specimens: Mapping[str, Any] | None = None,
) -> str:
    """Return the page.

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
        Of replaced maps, before and after.
    doubted : sequence of str
        Pairs that others contradict and that nothing better is known for, a line each.
    specimens : mapping, optional
        From :func:`specimen_sections`.
    """
    pages, numbers, ordered = pages or {}, summarize(results), worst_first(results)
    folder = files("kfmaps.batch").joinpath("templates")
    style, script = (folder.joinpath(f"summary.{kind}").read_text(encoding="utf-8") for kind in ("css", "js"))
    changes = [r for r in results if r.changed]
    columns = [c for c in COLUMNS if any(c[1](r) is not None for r in ordered)]
    numeric = {c[0]: any(isinstance(c[1](r), float | int) for r in ordered) for c in columns}
    largest = max((r.error_mean or 0.0 for r in ordered), default=0.0)

    def named(r: Result) -> dict[str, Any]:
        return {"source": r.source, "target": r.target, "page": pages.get((r.source, r.target), "")}

    return _TEMPLATES.get_template("summary.html.j2").render(
        name=name,
        policy=policy(script, style, connect=False),
        style=Markup(style),
        script=Markup(script),
        numbers=numbers,
        unit=UNIT,
        state=_state(numbers, pairs),
        tiles=_tiles(numbers),
        curve=_curve(results),
        changes=[named(r) | vars(r) | {"before": _error(r.error_before), "now": _error(r.error_mean)} for r in changes],
        changes_known=any(r.error_before is not None for r in changes),
        changed_pictures=_addresses(changed or {}),
        doubted=doubted,
        specimens=(specimens or {}).get("sections", ()),
        shapes=(specimens or {}).get("shapes"),
        pictures=_addresses(pictures),
        failed=[r for r in results if r.status == "failed"],
        columns=[{"title": c[0], "numeric": numeric[c[0]]} for c in columns],
        rows=[
            named(r)
            | {"bad": (r.error_mean or 0.0) > BAD, "cells": [_cell(c, r, numeric[c[0]], largest) for c in columns]}
            for r in ordered
        ],
        settings=json.dumps(settings, indent=2),
    )


def _cell(column: Column, result: Result, numeric: bool, largest: float) -> dict[str, str]:
    title, value, text = column[0], column[1](result), column[2]
    bar = title == "mean"
    kind = " ".join(["n"] * numeric + ["b"] * bar)
    if value is None:
        return {"kind": kind, "value": "", "text": "", "bar": ""}
    # A width must not be a style, which the page's own policy forbids: a picture may have one.
    width = f"{max(100 * float(value) / largest, 1.0):.1f}" if bar and largest > 0 else ""
    return {"kind": kind, "value": repr(value) if numeric else str(value), "text": text(value), "bar": width}


def _error(value: float | None) -> tuple[str, str]:
    return "" if value is None else str(value), percent(value)


def _state(numbers: Summary, pairs: int) -> str:
    left = max(pairs - numbers.done - numbers.failed, 0)
    parts = [f"{numbers.done} pairs matched"]
    parts += [f"{numbers.failed} failed"] if numbers.failed else []
    parts += [f"{left} not done yet"] if left else []
    known = " Errors are geodesic, in per cent of the square root of the source's area." if numbers.evaluated else ""
    return ", ".join(parts) + "." + known


def _tiles(numbers: Summary) -> list[tuple[str, str]]:
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
    return tiles


def _curve(results: Sequence[Result]) -> dict[str, str] | None:
    curve = error_curve_of(results, "mean of all pairs")
    if curve is None:
        return None
    within = []
    for threshold in (0.01, 0.05, 0.1):
        fraction = curve.fractions[int((curve.thresholds <= threshold + 1e-12).sum()) - 1]
        within.append(f"{100 * float(fraction):.1f} % within {100 * threshold:g} {UNIT}")
    return {"within": ", ".join(within), "address": _svg(curves_figure([curve], size=(6.4, 3.8)))}


def error_curve_of(results: Sequence[Result], label: str) -> Curve | None:
    """The mean error curve of the pairs whose truth is known, with the band of the middle 80 % of them."""
    curves = [r.curve for r in results if r.status == "done" and r.curve]
    return mean_curve(label, np.array(CURVE_ERRORS), np.array(curves)) if curves else None


def _svg(figure: Figure) -> str:
    buffer = io.BytesIO()
    with matplotlib.rc_context({"svg.fonttype": "none", "font.family": "sans-serif"}):  # text can be searched
        save_figure(make_transparent(figure), buffer, "svg")
    return _address("svg+xml", buffer.getvalue())


def _png(figure: Figure) -> bytes:
    buffer = io.BytesIO()
    save_figure(make_transparent(figure), buffer, "png")
    return buffer.getvalue()


def _address(kind: str, content: bytes) -> str:
    return f"data:image/{kind};base64,{base64.b64encode(content).decode('ascii')}"


def _addresses(pictures: Mapping[str, bytes]) -> list[tuple[str, str]]:
    return [(caption, _address("png", png)) for caption, png in pictures.items()]


def specimen_sections(plan: Plan) -> dict[str, Any] | None:
    """What the maps say of the shapes: a chart and a picture of each component, and a table; ``None`` without."""
    folder = plan.folder / CONSISTENT
    paths = limit_shape_paths(folder)
    if not paths:
        return None
    with open(folder / SHAPES, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    meshes = {t.name: t.path for task in plan.tasks for t in (task.source, task.target)}
    sections = []
    for path in paths:
        with np.load(path, allow_pickle=False) as arrays:
            known = {name: arrays[name] for name in arrays.files}
        own, middle = set(known["names"].tolist()), str(known["middle"])
        chart = _chart([row for row in rows if row["shape"] in own], known)
        which = f": {len(own)} like {middle}" if len(paths) > 1 else ""
        varied = _variation(meshes.get(middle), known)
        sections.append({"chart": _svg(chart), "which": which, "variation": varied, "middle": middle})
    titles = [t for t in rows[0] if any(row[t] for row in rows) and (t != "part" or len({r[t] for r in rows}) > 1)]
    return {"sections": sections, "shapes": {"titles": titles, "rows": rows}}


def _chart(rows: list[dict[str, str]], known: dict[str, np.ndarray]) -> Figure:
    figure = Figure(figsize=(9.6, 4.4), facecolor="white", layout="constrained")
    for ax, kind in zip(figure.subplots(1, len(KINDS)), KINDS, strict=True):
        explained = known[f"explained_{kind}"]
        if len(explained) < 2 or not explained.any():
            ax.set_axis_off()
            continue
        x, y = (np.array([float(row[f"{kind}_{i}"]) for row in rows]) for i in (1, 2))
        ax.scatter(x, y, s=18, color="#1d4ed8")
        for row, a, b in zip(rows, x, y, strict=True) if len(rows) <= MAX_NAMED else ():
            place = {"xytext": (3, 3), "textcoords": "offset points", "fontsize": 7, "parse_math": False}
            ax.annotate(row["shape"], (a, b), **place)
        ax.set_xlabel(f"component 1 ({100 * explained[0]:.0f} %)")
        ax.set_ylabel(f"component 2 ({100 * explained[1]:.0f} %)")
        ax.set_title(f"{kind} differences", fontsize=10)
        ax.spines[["top", "right"]].set_visible(False)
    return figure


def _variation(path: str | None, known: dict[str, np.ndarray]) -> str:
    if path is None or not Path(path).exists():
        return ""
    mesh = _quiet_mesh(path)
    values = {f"{kind} differs by": known[f"variation_{kind}"] for kind in KINDS}
    if any(len(v) != len(mesh.vertices) for v in values.values()):
        return ""
    return _address("png", _png(values_figure(mesh, values)))


def _quiet_mesh(path: str):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KfmapsWarning)  # the run has noted them
        return read_mesh(path)


def pair_picture(task: PairTask, limit: float = 0.1, path: Path | None = None) -> bytes:
    """Return the PNG of a pair: source, target in the source's colours, and the error when the truth is known.

    The error's colours end at ``limit``, in √area. ``path`` is another map than the one in use.

    Raises
    ------
    InvalidInput
        When the map or the meshes are gone or do not fit each other any more.
    """
    source, target = _quiet_mesh(task.source.path), _quiet_mesh(task.target.path)
    sizes = len(source.vertices), len(target.vertices)
    points = check_map(load_map(path or map_in_use(Path(task.folder), task.key)), *sizes, lost=True)
    truth = true_vertices(task, *sizes)
    errors, views = None, (None, None)
    if truth is not None:
        with one_blas_thread():
            errors = painted_errors(source, target, points, truth.source, truth.target)
            views = true_views(source, target, truth.source, truth.target)
    a, b = views
    style = {"errors": errors, "limit": limit, "text": TEXT_SIZE, "labels": False, "view": a, "target_view": b}
    return _png(match_figure(source, target, points, **style))


def _caption(result: Result) -> str:
    parts = [f"{result.source} → {result.target}"]
    parts += [] if result.error_mean is None else [f"mean error {percent(result.error_mean)} {UNIT}"]
    parts += [] if result.confidence is None else [f"confidence {result.confidence:.3g} ({result.verdict})"]
    return ", ".join(parts)


def changed_pictures(tasks: Sequence[PairTask], consistent: ConsistentResult, count: int) -> dict[str, bytes]:
    """Return pictures of replaced maps by caption, before and after, of at most ``count`` of them."""
    known = {(task.pair.source, task.pair.target): task for task in tasks}
    pictures: dict[str, bytes] = {}
    limit = fitting_limit(consistent.results)
    for result in [r for r in consistent.results if r.changed][:count]:
        key = result.source, result.target
        if key in known and key in consistent.before:
            task, before = known[key], _caption(consistent.before[key])
            try:
                old = pair_picture(task, limit, map_path(Path(task.folder), task.key))
                new = f"now: {_caption(result)}, {result.changed}"
                pictures |= {f"before: {before}": old, new: pair_picture(task, limit)}
            except (InvalidInput, OSError):
                continue
    return pictures


def worst_pictures(tasks: Sequence[PairTask], results: Sequence[Result], count: int) -> dict[str, bytes]:
    """Return pictures of the ``count`` worst of the ``tasks`` by caption; one that cannot be drawn is left out."""
    known = {task.pair: task for task in tasks}
    pictures: dict[str, bytes] = {}
    limit = fitting_limit(results)
    for result in worst_first(results):
        if len(pictures) == count:
            break
        task = known.get(Pair(result.source, result.target))
        if task is not None:
            try:
                pictures[_caption(result)] = pair_picture(task, limit)
            except (InvalidInput, OSError):
                continue
    return pictures


def write_pages(folder: Path, tasks: Sequence[PairTask], results: Sequence[Result]) -> dict[tuple[str, str], str]:
    """Write the pages of ``results`` that are not there or older than their map; return addresses of all there are.

    A map that cannot be shown has none.
    """
    known = {task.pair: task for task in tasks}
    for result in results:
        task = known.get(Pair(result.source, result.target))
        if task is not None and result.status == "done" and not _is_fresh(task):
            _write_pair_page(task)
    return {
        (task.pair.source, task.pair.target): f"{PAGES}/{quote(path.name)}"
        for task in tasks
        if (path := _page_path(task)).exists() and folder in path.parents
    }


def _page_path(task: PairTask) -> Path:
    return Path(task.folder) / PAGES / f"{task.key}.html"


def _is_fresh(task: PairTask) -> bool:
    try:
        return _page_path(task).stat().st_mtime >= map_in_use(Path(task.folder), task.key).stat().st_mtime
    except OSError:
        return False


def _write_pair_page(task: PairTask) -> None:
    try:
        source, target = _quiet_mesh(task.source.path), _quiet_mesh(task.target.path)
        truth = true_vertices(task, len(source.vertices), len(target.vertices))
        with one_blas_thread():
            html = map_page(
                load_map(map_in_use(Path(task.folder), task.key)),
                source,
                target,
                (task.pair.source, task.pair.target),
                truth=None if truth is None else (truth.source, truth.target),
                descriptors=False,
            )
    except (InvalidInput, OSError):
        return
    _page_path(task).parent.mkdir(exist_ok=True)
    with atomic_output(_page_path(task), force=True) as temporary:
        temporary.write_text(html, encoding="utf-8")
