"""Pages straight from a match or from a file of one, and a browser to show them."""

from __future__ import annotations

import tempfile
import webbrowser
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from kfmaps._records import JsonObject
from kfmaps.cli.evaluation import Truth
from kfmaps.config import as_dict
from kfmaps.descriptors.spectral import wave_energies, wave_signature
from kfmaps.fmap.confidence import local_confidence
from kfmaps.geometry.basis import laplace_basis
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.io import MeshFile, check_map
from kfmaps.io.bake import decode_picture
from kfmaps.io.export import textured
from kfmaps.matching.result import Match
from kfmaps.viz.matches import vertex_errors
from kfmaps.viz.page import ResultPage

_SIGNATURES = 12  # wave kernel signatures shown, and ...
_EIGENFUNCTIONS = 100  # ... the eigenfunctions they are made from.
_MOST_TEXELS = 2048  # longer side of the largest picture of a texture in a page.


def _match_summary(match: Match) -> JsonObject:
    """Return what a page tells of a match: settings, energies, residuals, times, outcome."""
    fit, config = match.fit, getattr(match, "config", None)
    told = {
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
    return {name: value for name, value in told.items() if value not in (None, "", [], {})}


def match_page(
    match: Match,
    source: Mesh | MeshFile,
    target: Mesh,
    names: tuple[str, str],
    *,
    truth: Truth | None = None,
    descriptors: bool = True,
    up: str | None = None,
) -> str:
    """Return the page of a map with all that the match knows.

    ``source``: a file's picture is shown on both shapes; ``names``: what the page calls the shapes; ``truth``: for the
    errors; ``descriptors``: whether to work out wave kernel signatures to show, which takes an eigensolve of each
    shape; ``up``: the vertical axis; by default a good side is found.
    """
    file = source if isinstance(source, MeshFile) else MeshFile(source)
    maps = [match.target_to_source, *match.alternatives]
    overlap = match.partial.overlap_source
    return ResultPage(
        file.mesh,
        target,
        match,
        functional_map=getattr(match, "functional_map", None),
        errors=None if truth is None else vertex_errors(file.mesh, maps, truth.source, truth.target),
        confidence=_confidences(file.mesh, target, maps, getattr(match, "local_confidence", None)),
        alternatives=match.alternatives,
        descriptors=signatures(file.mesh, target) if descriptors else None,
        common=None if overlap is None else overlap > 0.5,
        summary=_match_summary(match),
        names=names,
        up=up,
        textures=_textured(file, match, target),
    ).html()


def _textured(source: MeshFile, match: Match, target: Mesh) -> tuple[MeshFile, MeshFile] | None:
    """Both shapes with the source's picture; ``None`` where it has none."""
    if source.picture is None or len(source.mesh.faces) == 0 or len(target.faces) == 0:
        return None
    size = _MOST_TEXELS if max(decode_picture(source.picture).shape) > _MOST_TEXELS else None
    own = textured(source, MeshFile(source.mesh), np.arange(len(source.mesh.vertices)), size=size)
    return own, textured(source, MeshFile(target), match, size=size)


def _confidences(source: Mesh, target: Mesh, maps: Sequence[np.ndarray], known: np.ndarray | None) -> np.ndarray:
    """Confidence of each map at each target vertex, (m, n_t); ``known`` is that of the first, or ``None``."""
    sizes = len(source.vertices), len(target.vertices)
    rows = [local_confidence(source, target, check_map(m, *sizes, lost=True)) for m in maps[known is not None :]]
    return np.stack(rows if known is None else [np.asarray(known), *rows])


def signatures(source: Mesh, target: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return wave kernel signatures of both shapes at the same energies, (n_s, 12) and (n_t, 12), of unit area."""
    most = min(_EIGENFUNCTIONS, len(source.vertices) - 1, len(target.vertices) - 1)
    bases = [laplace_basis(unit_area(mesh), most) for mesh in (source, target)]
    energies, sigma = wave_energies(_SIGNATURES, *bases)
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
