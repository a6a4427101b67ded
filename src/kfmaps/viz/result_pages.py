"""Pages straight from a match or from a file of one, and a browser to show them."""

from __future__ import annotations

import json
import tempfile
import webbrowser
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps.config import as_dict
from kfmaps.descriptors.spectral import wave_energies, wave_signature
from kfmaps.fmap.confidence import local_confidence
from kfmaps.geometry.basis import laplace_basis
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.io import MapFile, check_map, match_map
from kfmaps.matching.result import Match
from kfmaps.viz.encode import to_json
from kfmaps.viz.errors import vertex_errors
from kfmaps.viz.page import result_page

SIGNATURES = 12
"""Wave kernel signatures shown, and ..."""
EIGENFUNCTIONS = 100
"""... the eigenfunctions they are made from."""


def match_summary(match: Match) -> dict[str, Any]:
    """Return what a page tells of a match, fit for JSON: settings, energies, residuals, times, outcome.

    Residuals are divided by the first.
    """
    fit, solution = match.fit, match.fit.solution
    outcome = {
        "verdict": match.verdict,
        "confidence": match.confidence,
        "scores": list(match.score.scores),
        "size of the map": None if match.functional_map is None else "{} × {}".format(*match.functional_map.shape),
        "started from": match.score.initialization,
        "parts": match.partial.reason if match.partial.which != "none" else None,
        "solver": None if solution is None else solution.status,
        "solver steps": None if solution is None else solution.steps,
        "kernel": fit.kernel or None,
        "features of the kernel": fit.rank,
        "slices": fit.n_operators,
    }
    told: dict[str, Any] = {}
    if solution is not None:
        told = {"energies": dict(fit.energies), "residuals": fit.relative_residuals.tolist()}
    return {
        **{name: value for name, value in outcome.items() if value not in (None, [])},
        **told,
        "times": dict(match.seconds),
        "settings": None if match.config is None else as_dict(match.config),
    }


def match_page(match: Match, source: Mesh, target: Mesh, names: tuple[str, str], **options: Any) -> str:
    """Return the page of a match with all that it knows: :func:`map_page`, which has the options."""
    found = match_map(match)
    summary = json.dumps(to_json(match_summary(match)))
    return map_page(replace(found, extra={**found.extra, "summary": summary}), source, target, names, **options)


def map_page(
    found: MapFile,
    source: Mesh,
    target: Mesh,
    names: tuple[str, str],
    *,
    truth: tuple[np.ndarray, np.ndarray] | None = None,
    descriptors: bool = True,
    up: str | None = None,
) -> str:
    """Return the page of a map: :func:`kfmaps.viz.page.result_page` with what of it the file holds.

    Parameters
    ----------
    found : MapFile
    source, target : Mesh
    names : (str, str)
        What the page calls the shapes.
    truth : ((q,), (q,)) int, optional
        Corresponding vertices of the source and of the target, for the errors.
    descriptors : bool
        Whether to work out wave kernel signatures to show, which takes an eigensolve of each shape.
    up : {"x", "y", "z"}, optional
        The vertical axis; by default a good side is found.
    """
    summary = _json_of(found.extra.get("summary"))
    settings = _json_of(found.config)
    if settings:
        summary.setdefault("settings", settings)
    if "confidence" in found.extra:
        summary.setdefault("confidence", found.extra["confidence"])
    others = found.extra.get("runners_up")
    others = np.zeros((0, len(target.vertices)), dtype=np.int64) if others is None else np.atleast_2d(others)
    maps = [found.target_to_source, *others]
    overlap = found.extra.get("overlap_source")
    return result_page(
        source,
        target,
        found.target_to_source,
        functional_map=found.functional_map,
        errors=None if truth is None else vertex_errors(source, maps, *truth),
        confidence=_confidences(source, target, maps, found.extra.get("local_confidence")),
        runners_up=others,
        descriptors=signatures(source, target) if descriptors else None,
        common=None if overlap is None else np.asarray(overlap) > 0.5,
        summary=summary,
        names=names,
        up=up,
    )


def _confidences(source: Mesh, target: Mesh, maps: Sequence[np.ndarray], known: Any) -> np.ndarray:
    """Confidence of each map at each target vertex, (m, n_t); ``known`` is that of the first, or ``None``."""
    sizes = len(source.vertices), len(target.vertices)
    rows = [local_confidence(source, target, check_map(m, *sizes, lost=True)) for m in maps[known is not None :]]
    return np.stack(rows if known is None else [np.asarray(known), *rows])


def _json_of(text: Any) -> dict[str, Any]:
    """The mapping in a JSON text; empty when there is none, and the text itself when it is no JSON."""
    if not isinstance(text, str) or not text:
        return {}
    try:
        value = json.loads(text)
    except ValueError:
        value = text
    return value if isinstance(value, dict) else {"note": value}


def signatures(source: Mesh, target: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return wave kernel signatures of both shapes at the same energies, (n_s, 12) and (n_t, 12), of unit area."""
    most = min(EIGENFUNCTIONS, len(source.vertices) - 1, len(target.vertices) - 1)
    bases = [laplace_basis(unit_area(mesh), most) for mesh in (source, target)]
    energies, sigma = wave_energies(SIGNATURES, *bases)
    first, second = (np.asarray(wave_signature(basis, energies, sigma)) for basis in bases)
    return first, second


def open_page(html: str) -> tuple[Path, bool]:
    """Write a page where only its owner can read it and ask for a browser; return the file, and whether one came.

    The file stays: the browser may read it at any time later.
    """
    path = Path(tempfile.mkdtemp(prefix="kfmaps-")) / "page.html"
    path.write_text(html, encoding="utf-8")
    try:
        return path, webbrowser.open(path.as_uri())
    except webbrowser.Error:
        return path, False
