"""What a collection tells of its shapes, as sections of the summary page: a chart, a picture and a table."""

from __future__ import annotations

import base64
import csv
import io
import warnings
from html import escape
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from kfmaps._arrays import KfmapsWarning
from kfmaps.batch.evidence import FOLDER
from kfmaps.batch.plan import Plan
from kfmaps.batch.specimens import KINDS, SHAPES, latent_paths
from kfmaps.io import read_mesh
from kfmaps.viz import save_figure
from kfmaps.viz.matches import values_figure

NAMED = 60
"""Shapes up to which their names stand in the chart."""


def specimen_sections(plan: Plan) -> list[str]:
    """The sections; none where there is no common basis."""
    folder = plan.folder / FOLDER
    paths = latent_paths(folder)
    if not paths:
        return []
    with open(folder / SHAPES, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    parts = []
    for path in paths:
        with np.load(path, allow_pickle=False) as arrays:
            known = {name: arrays[name] for name in arrays.files}
        own = set(known["names"].tolist())
        parts += [_chart([row for row in rows if row["shape"] in own], known, len(paths) > 1), _varied(plan, known)]
    return [part for part in (*parts, _table(rows)) if part]


def _chart(rows: list[dict[str, str]], known: dict[str, np.ndarray], several: bool) -> str:
    figure = Figure(figsize=(9.6, 4.4), facecolor="white", layout="constrained")
    axes = figure.subplots(1, len(KINDS))
    for ax, kind in zip(axes, KINDS, strict=True):
        titles = [f"{kind}_{i}" for i in (1, 2)]
        explained = known[f"explained_{kind}"]
        if len(explained) < len(titles) or not explained.any():
            ax.set_axis_off()
            continue
        x, y = (np.array([float(row[title]) for row in rows]) for title in titles)
        ax.scatter(x, y, s=18, color="#1d4ed8")
        if len(rows) <= NAMED:
            for row, a, b in zip(rows, x, y, strict=True):
                ax.annotate(
                    row["shape"], (a, b), xytext=(3, 3), textcoords="offset points", fontsize=7, parse_math=False
                )
        ax.set_xlabel(f"component 1 ({100 * explained[0]:.0f} %)")
        ax.set_ylabel(f"component 2 ({100 * explained[1]:.0f} %)")
        ax.set_title(f"{kind} differences", fontsize=10)
        ax.spines[["top", "right"]].set_visible(False)
    buffer = io.BytesIO()
    with matplotlib.rc_context({"svg.fonttype": "none", "font.family": "sans-serif"}):
        save_figure(figure, buffer, "svg")
    image = f'<img alt="Principal components of the shapes" src="{_data("svg+xml", buffer.getvalue())}">'
    told = "Each point is a shape. Shapes that lie together have alike areas (left) or are alike but for areas (right)."
    which = f": {len(rows)} like {known['middle']}" if several else ""
    return f"<h2>How the shapes differ{escape(which)}</h2><figure>{image}<figcaption>{told}</figcaption></figure>"


def _varied(plan: Plan, known: dict[str, np.ndarray]) -> str:
    name = str(known["middle"])
    path = next((t.path for task in plan.tasks for t in (task.source, task.target) if t.name == name), None)
    if path is None or not Path(path).exists():
        return ""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KfmapsWarning)  # the run has noted them
        mesh = read_mesh(path)
    values = {f"{kind} differs by": known[f"variation_{kind}"] for kind in KINDS}
    if any(len(v) != len(mesh.vertices) for v in values.values()):
        return ""
    buffer = io.BytesIO()
    save_figure(values_figure(mesh, values), buffer, "png")
    image = f'<img alt="Where the shapes differ" src="{_data("png", buffer.getvalue())}">'
    told = f"Where on the surface the shapes differ: standard deviation over all, as a part of the mean, on {name}."
    return f"<figure>{image}<figcaption>{escape(told)}</figcaption></figure>"


def _table(rows: list[dict[str, str]]) -> str:
    titles = [t for t in rows[0] if any(row[t] for row in rows) and (t != "part" or len({r[t] for r in rows}) > 1)]
    head = "".join(f"<th>{escape(t.replace('_', ' '))}</th>" for t in titles)
    body = "".join(f"<tr>{''.join(_cell(row[t], t) for t in titles)}</tr>" for row in rows)
    table = f'<table class="sorts"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>'
    return f'<details><summary>Components of every shape</summary><div class="scroll">{table}</div></details>'


def _cell(text: str, title: str) -> str:
    if title in ("shape", "hand"):
        return f"<td>{escape(text)}</td>"
    return f'<td class="n" data-v="{escape(text)}">{float(text):.3f}</td>' if text else "<td></td>"


def _data(kind: str, content: bytes) -> str:
    return f"data:image/{kind};base64,{base64.b64encode(content).decode('ascii')}"
