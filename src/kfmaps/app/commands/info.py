"""``kfmaps info``: what is in a mesh file."""

from __future__ import annotations

import json as jsonlib
import warnings
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from kfmaps._arrays import KfmapsWarning
from kfmaps.app.files import MeshFile, read_mesh_file
from kfmaps.surface.mesh import surface_area
from kfmaps.surface.topology import topology

_DEFECTS = (
    "boundary_edges",
    "nonmanifold_edges",
    "nonmanifold_vertices",
    "inconsistent_edges",
    "degenerate_faces",
    "unreferenced_vertices",
    "duplicated_vertices",
)


def description(path: str | Path, content: MeshFile) -> dict[str, Any]:
    """What ``kfmaps info --json`` prints: sizes, extent, topology (None for a point cloud), colours."""
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
        "topology": {**asdict(counts), "closed": counts.closed, "manifold": counts.manifold} if surface else None,
    }


def _rows(facts: dict[str, Any]) -> list[tuple[str, str]]:
    """Names and values of the table."""
    counts = facts["topology"]
    extra = [k.replace("_", " ") for k in ("colors", "texture_coordinates") if facts[k]]
    rows = [
        ("vertices", f"{facts['vertices']:,}"),
        ("faces", f"{facts['faces']:,}" if counts else "none (a point cloud)"),
        ("extent", " × ".join(f"{side:.6g}" for side in facts["extent"])),
        ("also in the file", ", ".join(extra) or "nothing"),
    ]
    if counts is None:
        return rows
    defects = [f"{counts[k]:,} {k.replace('_', ' ')}" for k in _DEFECTS if counts[k]]
    return [
        *rows[:2],
        ("area", f"{facts['area']:.6g}"),
        *rows[2:],
        ("components", f"{counts['components']:,}"),
        ("boundary loops", f"{counts['boundary_loops']:,}" if counts["boundary_loops"] else "none (closed)"),
        ("genus", "not defined (no orientable manifold)" if counts["genus"] is None else str(counts["genus"])),
        ("Euler characteristic", str(counts["euler_characteristic"])),
        ("defects", "\n".join(defects) or "none"),
    ]


def info(
    mesh: Annotated[Path, typer.Argument(help="A mesh or point cloud.", metavar="MESH", show_default=False)],
    json: Annotated[bool, typer.Option("--json", help="Print it for machines.")] = False,
) -> None:
    """Show what is in a file: vertices, faces, components, area, genus, defects."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KfmapsWarning)  # the table says it all
        facts = description(mesh, read_mesh_file(mesh))
    if json:
        print(jsonlib.dumps(facts))
        return
    table = Table(title=Text(str(mesh)), show_header=False)
    for name, value in _rows(facts):
        table.add_row(name, Text(value))
    Console().print(table)
