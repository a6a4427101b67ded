"""``kfmaps view``: a map as a web page."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kfmaps.cli.evaluation import known_truth
from kfmaps.cli.options import Force, Identity, Json, MapFile, SourceMesh, TargetMesh, TruthLists, UpAxis
from kfmaps.cli.terminal import report_files, say
from kfmaps.io import check_output, load_map
from kfmaps.io.atomic import write_text
from kfmaps.io.mapfile import map_mesh_file, mesh_path
from kfmaps.matching.result import Match
from kfmaps.viz.page import check_up
from kfmaps.viz.result_pages import match_page, open_page


def view(
    map: MapFile,
    source: SourceMesh = None,
    target: TargetMesh = None,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write this HTML file; do not open it.")] = None,
    truth: TruthLists = None,
    identity: Identity = False,
    descriptors: Annotated[bool, typer.Option(help="Work out descriptors to show.")] = True,
    up: UpAxis = None,
    json: Json = False,
    force: Force = False,
) -> None:
    """Show a map in the browser, or write it as one page that needs no network."""
    check_up(up)
    if output is not None:
        check_output(output, force, (map, source, target, *(truth or ())))
    html = map_page(
        load_map(map), map, (source, target), truth=truth, identity=identity, descriptors=descriptors, up=up
    )
    if output is not None:
        write_text(output, html, force)
        report_files(output, as_json=json)
        return
    path, opened = open_page(html)
    report_files(path, as_json=json)
    if not json:
        say(str(path) if opened else f"no browser was found; open {path.as_uri()}")


def map_page(
    found: Match,
    map: Path,
    given: tuple[Path | None, Path | None] = (None, None),
    *,
    truth: tuple[Path, Path] | None = None,
    identity: bool = False,
    descriptors: bool = True,
    up: str | None = None,
) -> str:
    """Return the page of a map whose shapes are in files: the ``given`` ones, else those that it names.

    ``map``: its file; ``truth``, ``identity``: see :func:`~kfmaps.cli.evaluation.known_truth`; the rest as for
    :func:`~kfmaps.viz.result_pages.match_page`.
    """
    sides = list(zip(("source", "target"), given, strict=True))
    names = [mesh_path(path, found, side, map).stem for side, path in sides]
    source, target = (map_mesh_file(path, found, side, map) for side, path in sides)
    known = known_truth(truth, len(source.mesh.vertices), len(target.mesh.vertices), identity=identity)
    return match_page(found, source, target.mesh, (names[0], names[1]), truth=known, descriptors=descriptors, up=up)
