"""``kfmaps info``: what is in mesh files."""

from __future__ import annotations

import warnings
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich.table import Table
from rich.text import Text

from kfmaps._arrays import InvalidInput, KfmapsWarning, printable
from kfmaps._records import JsonObject
from kfmaps.cli.options import Json
from kfmaps.cli.terminal import Terminal, print_json
from kfmaps.geometry.clean import clean_mesh
from kfmaps.geometry.face_orientation import inward_faces
from kfmaps.geometry.mesh import surface_area
from kfmaps.geometry.topology import topology
from kfmaps.io import MeshFile, read_mesh_file

_DEFECTS = (
    "boundary_edges",
    "nonmanifold_edges",
    "nonmanifold_vertices",
    "inconsistent_edges",
    "inward_faces",
    "degenerate_faces",
    "unreferenced_vertices",
    "duplicated_vertices",
)


def description(path: str | Path, content: MeshFile) -> JsonObject:
    """Return what ``kfmaps info --json`` prints: sizes, extent, topology (None for a point cloud), colours."""
    mesh = content.mesh
    surface = len(mesh.faces) > 0
    counts = topology(mesh)
    return {
        "file": str(path),
        "vertices": len(mesh.vertices),
        "faces": len(mesh.faces),
        "extent": np.ptp(mesh.vertices, axis=0).tolist(),
        "area": surface_area(mesh) if surface else None,
        "colors": content.colors is not None,
        "texture_coordinates": content.uv is not None,
        "topology": {
            **asdict(counts),
            "closed": counts.is_closed,
            "manifold": counts.is_manifold,
            "inward_faces": int(inward_faces(clean_mesh(mesh).mesh).sum()),
        }
        if surface
        else None,
    }


def _cells(facts: JsonObject) -> dict[str, str]:
    """Return the cells of the table for a file, by the name of the row or column."""
    counts = facts["topology"]
    extra = [k.replace("_", " ") for k in ("colors", "texture_coordinates") if facts[k]]
    cells = {
        "vertices": f"{facts['vertices']:,}",
        "faces": f"{facts['faces']:,}" if counts else "none (a point cloud)",
        "extent": " × ".join(f"{side:.6g}" for side in facts["extent"]),
        "also in the file": ", ".join(extra) or "nothing",
    }
    if counts is None:
        return cells
    return cells | {
        "area": f"{facts['area']:.6g}",
        "components": f"{counts['components']:,}",
        "boundary loops": f"{counts['boundary_loops']:,}" if counts["boundary_loops"] else "none (closed)",
        "genus": "not defined (no orientable manifold)" if counts["genus"] is None else str(counts["genus"]),
        "Euler characteristic": str(counts["euler_characteristic"]),
        "defects": "\n".join(f"{counts[k]:,} {k.replace('_', ' ')}" for k in _DEFECTS if counts[k]) or "none",
    }


def info(
    meshes: Annotated[list[Path], typer.Argument(help="Meshes or point clouds.", metavar="MESH")], json: Json = False
) -> None:
    """Show what is in files: vertices, faces, components, area, genus, defects."""
    errors, files = [], []
    for path in meshes:
        try:
            with warnings.catch_warnings(action="ignore", category=KfmapsWarning):  # the table shows the same
                files.append(description(path, read_mesh_file(path)))
        except InvalidInput as error:
            errors.append(str(error))
    if json:
        for file in files:
            print_json(file)
    elif files:
        Terminal().print(_table(files[0]) if len(meshes) == 1 else _overview(files))
    if errors:  # after the others were printed
        others = "" if len(errors) == 1 else f"; and {len(errors) - 1} more of the files cannot be read"
        raise InvalidInput(errors[0] + others)


def _table(facts: JsonObject) -> Table:
    """Return a table with a row for each fact about one file."""
    table = Table(title=Text(printable(facts["file"])), show_header=False)
    for name, value in _cells(facts).items():
        table.add_row(name, Text(value))
    return table


def _overview(files: list[JsonObject]) -> Table:
    """Return a table with a row for each file, without remarks in brackets."""
    columns = ("vertices", "faces", "area", "components", "genus", "defects")
    table = Table()
    for name in ("file", *columns):
        table.add_column(name, justify="left" if name in ("file", "defects") else "right", overflow="fold")
    for file in files:
        cells = _cells(file)
        table.add_row(Text(printable(file["file"])), *(cells.get(name, "").partition(" (")[0] for name in columns))
    return table
