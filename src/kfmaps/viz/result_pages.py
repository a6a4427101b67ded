"""Pages straight from a match or from a file of one, and a browser to show them."""

from __future__ import annotations

import json
import tempfile
import warnings
import webbrowser
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps._arrays import KfmapsWarning, refuse
from kfmaps.cli.summary import relative_residuals
from kfmaps.config import as_dict
from kfmaps.descriptors.spectral import wave_energies, wave_signature
from kfmaps.fmap.confidence import local_confidence
from kfmaps.fmap.evaluate import geodesic_errors, truth_from_pairs
from kfmaps.geometry.basis import laplace_basis
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.io import MapFile, check_map, read_mesh
from kfmaps.matching.match import Match
from kfmaps.viz.page import result_page

SIGNATURES = 12
"""Wave kernel signatures shown, and ..."""
EIGENFUNCTIONS = 100
"""... the eigenfunctions they are made from."""


def match_summary(match: Match) -> dict[str, Any]:
    """What a page tells of a match, all of it fit for JSON: settings, energies, residuals, times, outcome.

    Residuals are divided by the first.
    """
    k_t, k_s = match.functional_map.shape
    outcome = {
        "verdict": match.verdict,
        "confidence": match.confidence,
        "scores": list(match.scores),
        "size of the map": f"{k_t} × {k_s}",
        "started from": match.initialization,
        "parts": match.partial_reason if match.partial != "none" else None,
    }
    told: dict[str, Any] = {}
    if match.fit is not None:
        fit = match.fit
        outcome |= {
            "solver": fit.solution.status,
            "solver steps": fit.solution.steps,
            "kernel": fit.kernel,
            "features of the kernel": fit.rank,
            "slices": fit.slices,
        }
        told = {"energies": dict(fit.energies), "residuals": relative_residuals(fit).tolist()}
    return {
        **{name: value for name, value in outcome.items() if value not in (None, [])},
        **told,
        "times": dict(match.seconds),
        "settings": as_dict(match.config),
    }


def match_page(
    match: Match,
    source: Mesh,
    target: Mesh,
    names: tuple[str, str],
    *,
    truth: tuple[np.ndarray, np.ndarray] | None = None,
    descriptors: bool = True,
    up: str | None = None,
) -> str:
    """The page of a match: :func:`kfmaps.viz.page.result_page` with all that the match knows.

    Parameters
    ----------
    truth : ((q,), (q,)) int, optional
        Corresponding vertices of the source and of the target, for the errors.
    descriptors : bool
        Whether to work out wave kernel signatures to show, which takes an eigensolve of each shape.
    """
    maps = [match.target_to_source, *match.alternatives]
    return result_page(
        source,
        target,
        match.target_to_source,
        functional_map=match.functional_map,
        errors=None if truth is None else errors_against(source, maps, *truth),
        confidence=_confidences(source, target, maps, match.local_confidence),
        runners_up=match.alternatives,
        descriptors=signatures(source, target) if descriptors else None,
        common=None if match.overlap_source is None else match.overlap_source > 0.5,
        summary=match_summary(match),
        names=names,
        up=up,
    )


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
    """As :func:`match_page`, of a map read from a file; shows what of it the file holds."""
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
        errors=None if truth is None else errors_against(source, maps, *truth),
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


def errors_against(source: Mesh, maps: Sequence[np.ndarray], truth_s: np.ndarray, truth_t: np.ndarray) -> np.ndarray:
    """Geodesic error of each map at each target vertex, (m, n_t), in √area.

    NaN where the truth is not known, or a vertex has no counterpart.

    Parameters
    ----------
    source : Mesh
    maps : m arrays (n_t,)
    truth_s, truth_t : (q,) int
        Corresponding vertices. Of several truths for one target vertex the last counts.
    """
    rows = np.full((len(maps), len(maps[0])), np.nan)
    # All at once, so that one search from a true vertex serves every map.
    predicted = np.concatenate([truth_from_pairs(truth_s, truth_t, points) for points in maps])
    known = predicted >= 0
    errors = np.full(len(predicted), np.nan)
    errors[known] = geodesic_errors(source, predicted[known], np.tile(truth_s, len(maps))[known])
    rows[:, truth_t] = errors.reshape(len(maps), -1)
    return rows


def signatures(source: Mesh, target: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Wave kernel signatures of both shapes at the same energies, (n_s, 12) and (n_t, 12), of unit area."""
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


def mesh_path(given: Path | None, found: MapFile, side: str, beside: Path) -> Path:
    """The file of the shape ``side``: as given, else as the map names it, there or beside the map.

    Raises
    ------
    InvalidInput
        When nothing names a file that exists.
    """
    if given is not None:
        return given
    named = found.extra.get(side)
    if not isinstance(named, str) or not named:
        raise refuse(f"{side} mesh", "its file", "a map that does not name it", f"give --{side} FILE")
    for path in (Path(named), beside.parent / named, beside.parent / Path(named).name):
        if path.is_file():
            return path
    raise refuse(f"{side} mesh", "the file that the map names", f"nothing at {named}", f"give --{side} FILE")


def map_mesh(given: Path | None, found: MapFile, side: str, beside: Path) -> Mesh:
    """The shape ``side`` of a map, read from :func:`mesh_path`.

    What is odd about it was told when it was matched, and is not told again.
    """
    path = mesh_path(given, found, side, beside)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KfmapsWarning)
        return read_mesh(path)
