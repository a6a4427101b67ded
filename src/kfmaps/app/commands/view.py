"""``kfmaps view``: a map as a web page."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from kfmaps._arrays import refuse
from kfmaps.app.files import atomic_output, check_output, load_map, read_mesh, read_vertex_numbers
from kfmaps.app.view.results import map_page, mesh_path, open_page
from kfmaps.surface.mesh import Mesh


def view(
    map: Annotated[Path, typer.Argument(help="A map (.npz, .txt, .vts, .mat).", show_default=False)],
    source: Annotated[
        Path | None, typer.Option(help="The source mesh; default: the one the map names.", show_default=False)
    ] = None,
    target: Annotated[
        Path | None, typer.Option(help="The target mesh; default: the one the map names.", show_default=False)
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Write this HTML file; do not open it.", show_default=False),
    ] = None,
    truth: Annotated[
        tuple[Path, Path] | None,
        typer.Option(
            help="True vertices of source and target, line by line (.vts counts from 1).",
            metavar="SOURCE TARGET",
            show_default=False,
        ),
    ] = None,
    identity: Annotated[bool, typer.Option("--identity", help="Truth: vertex i is vertex i.")] = False,
    descriptors: Annotated[bool, typer.Option(help="Work out descriptors to show.")] = True,
    up: Annotated[str, typer.Option(help="The axis that points upwards: x, y or z.")] = "y",
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """Show a map in the browser, or write it as one page that needs no network."""
    if output is not None:
        check_output(output, force)
    found = load_map(map)
    paths = [mesh_path(given, found, side, map) for given, side in ((source, "source"), (target, "target"))]
    meshes = [read_mesh(path) for path in paths]
    names = (paths[0].stem, paths[1].stem)
    known = _truth(truth, identity, meshes[0], meshes[1])
    html = map_page(found, meshes[0], meshes[1], names, truth=known, descriptors=descriptors, up=up)
    if output is not None:
        with atomic_output(output, force) as temporary:
            temporary.write_text(html, encoding="utf-8")
        return
    path, opened = open_page(html)
    typer.echo(str(path) if opened else f"no browser was found; open {path.as_uri()}")


def _truth(
    files: tuple[Path, Path] | None, identity: bool, source: Mesh, target: Mesh
) -> tuple[np.ndarray, np.ndarray] | None:
    """Corresponding vertices from files or by number, checked."""
    if files is not None and identity:
        raise refuse("truth", "--truth or --identity", "both", "leave one out")
    if files is not None:
        first, second = (read_vertex_numbers(file) for file in files)
        for numbers, mesh, file in zip((first, second), (source, target), files, strict=True):
            if len(numbers) and numbers.max() >= len(mesh.vertices):
                wanted = f"vertices below {len(mesh.vertices)}"
                raise refuse(str(file), wanted, str(numbers.max()), "check that it belongs to the mesh")
        return first, second
    if identity:
        n_s, n_t = len(source.vertices), len(target.vertices)
        if n_s != n_t:
            raise refuse("--identity", "equally many vertices", f"{n_s} and {n_t}", "give --truth instead")
        return np.arange(n_s), np.arange(n_t)
    return None
