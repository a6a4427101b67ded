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
from kfmaps.io.provenance import map_mesh_file, mesh_path
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
    found = load_map(map)
    paths = [mesh_path(given, found, side, map) for given, side in ((source, "source"), (target, "target"))]
    shapes = [map_mesh_file(path, found, side, map) for path, side in zip(paths, ("source", "target"), strict=True)]
    meshes = [shape.mesh for shape in shapes]
    names = (paths[0].stem, paths[1].stem)
    known = known_truth(truth, *(len(mesh.vertices) for mesh in meshes), identity=identity)
    pairs = None if known is None else (known.source, known.target)
    given = {"truth": pairs, "descriptors": descriptors, "up": up, "texture": shapes[0]}
    html = match_page(found, meshes[0], meshes[1], names, **given)
    if output is not None:
        write_text(output, html, force)
        report_files(output, as_json=json)
        return
    path, opened = open_page(html)
    report_files(path, as_json=json)
    if not json:
        say(str(path) if opened else f"no browser was found; open {path.as_uri()}")
