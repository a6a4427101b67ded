"""``kfmaps view``: a map as a web page."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kfmaps.api import map_page
from kfmaps.cli.options import Force, Identity, Json, MapFile, SourceMesh, TargetMesh, TruthLists, UpAxis
from kfmaps.cli.terminal import print_line, report_files
from kfmaps.io import check_output
from kfmaps.io.atomic import write_text
from kfmaps.viz.page import check_up
from kfmaps.viz.result_pages import open_page


def view(
    map: MapFile,
    source: SourceMesh = None,
    target: TargetMesh = None,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write this HTML file; do not open it.")] = None,
    truth: TruthLists = None,
    identity: Identity = False,
    descriptors: Annotated[bool, typer.Option(help="Compute descriptors to show.")] = True,
    up: UpAxis = None,
    json: Json = False,
    force: Force = False,
) -> None:
    """Show a map in the browser, or write it as one page that needs no network."""
    check_up(up)
    if output is not None:
        check_output(output, force, (map, source, target, *(truth or ())))
    html, _ = map_page(map, source, target, truth=truth, identity=identity, descriptors=descriptors, up=up)
    if output is not None:
        write_text(output, html, force)
        report_files(output, as_json=json)
        return
    path, has_opened = open_page(html)
    report_files(path, as_json=json)
    if not json:
        print_line(str(path) if has_opened else f"no browser was found; open {path.as_uri()}")
