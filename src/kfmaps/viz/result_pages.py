"""The page of a match, shown in a browser or in a notebook's cell."""

from __future__ import annotations

import io
import tempfile
import webbrowser
from html import escape
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from rich.console import Console

from kfmaps._records import JsonObject
from kfmaps.config import as_dict
from kfmaps.descriptors.spectral import wave_energies, wave_signature
from kfmaps.evaluation import Truth
from kfmaps.fmap.confidence import local_confidence
from kfmaps.geometry.basis import laplace_basis
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.io import MeshFile, check_map, projected_uv
from kfmaps.io.bake import decode_picture
from kfmaps.io.export import with_source_texture
from kfmaps.io.transfer import LOST_GREY, transfer
from kfmaps.matching.result import Match
from kfmaps.viz.camera import fit_rotation
from kfmaps.viz.document import data_address, document, encode_floats, encode_integers
from kfmaps.viz.figures import make_transparent, position_colors
from kfmaps.viz.matches import vertex_errors
from kfmaps.viz.page import (
    check_up,
    map_record,
    painted_record,
    shape_record,
    source_record,
    verdict_record,
    views_record,
)

_SIGNATURES = 12  # wave kernel signatures that are shown
_EIGENFUNCTIONS = 100  # from which these are computed
_MAX_TEXELS = 2048  # longer side of the largest texture in a page
_DPI = 72  # resolution of the picture in a notebook
_CELL = """<style>
.kfmaps-cell {{ width: 100%; height: 600px; border: 0; color-scheme: light dark; }}
{light} {{ color-scheme: light; }}
{dark} {{ color-scheme: dark; }}
</style>
<iframe class="kfmaps-cell" title="{title}" sandbox="allow-scripts allow-downloads" srcdoc="{page}"></iframe>"""
_LIGHT = ('[data-jp-theme-light="true"]', ".vscode-light", '[theme="light"]')
_DARK = ('[data-jp-theme-light="false"]', ".vscode-dark", '[theme="dark"]')
"""Selectors of light and dark notebooks in JupyterLab, Visual Studio Code and Colab; elsewhere the system decides."""


def _match_summary(match: Match) -> JsonObject:
    """Return the facts about a match that a page lists: result, settings, energies, residuals, times."""
    fit, config = match.fit, getattr(match, "config", None)
    facts = {
        "verdict": match.verdict,
        "confidence": match.confidence,
        "landmarks": len(match.landmarks) or None,
        "scores": list(match.score.scores),
        "size of the map": "{} × {}".format(*match.functional_map.shape) if hasattr(match, "functional_map") else None,
        "started from": match.score.initialization,
        "parts": match.partial.reason if match.partial.suspected else None,
        "solver": fit.status,
        "solver steps": fit.steps,
        "kernel": fit.kernel,
        "eigenfunctions of the fit": fit.size,
        "features of the kernel": fit.rank,
        "operators": fit.n_operators,
        "energies": dict(fit.energies),
        "residuals": fit.residuals.tolist(),
        "times": dict(match.seconds),
        "settings": None if config is None else as_dict(config),
    }
    return {name: value for name, value in facts.items() if value not in (None, "", [], {})}


def match_page(
    match: Match,
    source: Mesh | MeshFile,
    target: Mesh,
    names: tuple[str, str] = ("source", "target"),
    *,
    truth: Truth | None = None,
    descriptors: bool = True,
    up: str | None = None,
) -> str:
    """Return the page of a map with everything about the match: one HTML file that needs no other file.

    ``source``: with the picture of a file, if any, for both shapes; ``names``: of the shapes on the page; ``truth``:
    for the errors; ``descriptors``: whether wave kernel signatures are computed and shown, which takes an eigensolve of
    each shape; ``up``: the vertical axis; by default the page chooses a good side.
    """
    up = check_up(up) or "auto"
    file = source if isinstance(source, MeshFile) else MeshFile(source)
    mesh, matrix = file.mesh, getattr(match, "functional_map", None)
    sizes = len(mesh.vertices), len(target.vertices)
    maps = [check_map(match, *sizes, partial=True)]
    maps += [check_map(other, *sizes, f"alternative {i}") for i, other in enumerate(match.alternatives, 1)]
    labels = ["Best map", *(f"Alternative {i}" for i in range(1, len(maps)))]
    colors, overlap = position_colors(mesh), match.partial.overlap_source
    if overlap is not None:  # vertices without a counterpart are grey
        colors = np.where(overlap[:, None] > 0.5, colors, LOST_GREY)
    records = [map_record(mesh, target, points, label) for points, label in zip(maps, labels, strict=True)]
    records[0] |= _transferred(match, mesh, colors)
    confidence = getattr(match, "local_confidence", None)
    fits = [local_confidence(mesh, target, points) for points in maps[confidence is not None :]]
    fits[:0] = [] if confidence is None else [np.asarray(confidence)]
    # Vertices without a counterpart have no fit, which would count as a bad one.
    values = {"confidence": [np.where(points < 0, np.nan, fit) for points, fit in zip(maps, fits, strict=True)]}
    if truth is not None:
        values["errors"] = list(vertex_errors(mesh, maps, truth.source, truth.target))
    waves = [rows.T for rows in signatures(mesh, target)] if descriptors else [[], []]
    data = {
        "kind": "result",
        "up": up,
        "views": views_record(mesh, target, maps[0]),
        "verdict": verdict_record(match, mesh, target),
        "source": source_record(mesh, names[0], colors),
        "target": shape_record(target, names[1]),
        "rotation": _rotation_by_map(mesh, target, maps[0]).ravel(),
        "maps": records,
        **{name: [encode_floats(row) for row in rows] for name, rows in values.items()},
        "descriptors": [
            {"number": i, "source": encode_floats(a), "target": encode_floats(b)}
            for i, (a, b) in enumerate(zip(*waves, strict=True))
        ],
        "matrix": None if matrix is None else encode_floats(matrix),
        "textures": [_texture_record(shape) for shape in _textured(file, match, target)],
        "summary": _match_summary(match),
    }
    return document("result.html.j2", title=" → ".join(names), data=data)


def _textured(source: MeshFile, match: Match, target: Mesh) -> tuple[MeshFile, ...]:
    """Return both shapes with the source's picture; none where it has none."""
    if source.picture is None or len(source.mesh.faces) == 0 or len(target.faces) == 0:
        return ()
    size = _MAX_TEXELS if max(decode_picture(source.picture).shape) > _MAX_TEXELS else None
    textured_source = with_source_texture(
        source, MeshFile(source.mesh), np.arange(len(source.mesh.vertices)), size=size
    )
    return textured_source, with_source_texture(source, MeshFile(target), match, size=size)


def _texture_record(shape: MeshFile) -> dict[str, object]:
    """Return the texture coordinates of a shape, for each corner of its faces, and its picture as a data address."""
    assert shape.uv is not None
    assert shape.uv_faces is not None
    assert shape.picture is not None
    corners = encode_integers(shape.uv_faces.ravel())
    picture = data_address(shape.picture.kind, shape.picture.data)
    return {"uv": encode_floats(shape.uv), "corners": corners, "picture": picture}


def _transferred(match: Match, source: Mesh, colors: np.ndarray) -> dict[str, object]:
    """Return the source's colours and texture coordinates interpolated on the target; empty without a precise map."""
    if match.precise_map is None:
        return {}
    painted = (colors, LOST_GREY), (projected_uv(source.vertices), 0.0)
    return painted_record(*(transfer(values, match, source.faces, lost) for values, lost in painted))


def _rotation_by_map(source: Mesh, target: Mesh, target_to_source: np.ndarray) -> np.ndarray:
    """Return the rotation, (3, 3), that best maps the target's vertices to their images (Kabsch 1976)."""
    matched = np.asarray(target_to_source) >= 0
    if not matched.any():
        return np.eye(3)
    return fit_rotation(target.vertices[matched], source.vertices[np.asarray(target_to_source)[matched]])[0]


def signatures(source: Mesh, target: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return wave kernel signatures of both shapes at the same energies, (n_s, 12) and (n_t, 12), of unit area."""
    size = min(_EIGENFUNCTIONS, len(source.vertices) - 1, len(target.vertices) - 1)
    bases = [laplace_basis(unit_area(mesh), size) for mesh in (source, target)]
    energies, sigma = wave_energies(_SIGNATURES, *bases)
    first, second = (np.asarray(wave_signature(basis, energies, sigma)) for basis in bases)
    return first, second


def open_page(html: str) -> tuple[Path, bool]:
    """Write a page that only its owner can read, and open it in a browser; return the file, and whether one opened.

    The file stays, since the browser may read it at any later time.
    """
    path = Path(tempfile.mkdtemp(prefix="kfmaps-")) / "page.html"
    path.write_text(html, encoding="utf-8")
    try:
        return path, webbrowser.open(path.as_uri())
    except webbrowser.Error:
        return path, False


def figure_html(figure: Figure, description: str) -> str:
    """Return a figure as an image for light and dark notebooks, with a ``description``."""
    buffer = io.BytesIO()
    make_transparent(figure).savefig(buffer, format="png", dpi=_DPI)
    return f'<img alt="{escape(description)}" src="{data_address("image/png", buffer.getvalue())}">'


def in_notebook() -> bool:
    """Return whether this runs in a notebook that shows HTML."""
    return Console().is_jupyter


def cell_html(page: str, title: str) -> str:
    """Return a page as the HTML of a cell: a frame, with the compact layout."""
    light, dark = (", ".join(f"{selector} .kfmaps-cell" for selector in selectors) for selectors in (_LIGHT, _DARK))
    page = page.replace("<body>", '<body class="cell">', 1)
    return _CELL.format(light=light, dark=dark, title=escape(title), page=escape(page))


def show_in_cell(page: str, title: str) -> None:
    """Show a page in the cell that is being run."""
    from IPython.display import HTML, display  # pyright: ignore[reportMissingImports]

    display(HTML(cell_html(page, title)))
