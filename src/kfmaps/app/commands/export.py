"""``kfmaps export``: a map in other programs' formats."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from kfmaps._arrays import refuse
from kfmaps.app.files import (
    MapFile,
    MeshFile,
    Values,
    check_map,
    check_output,
    load_map,
    read_mesh_file,
    save_map,
    write_colored,
    write_textured,
    write_values,
)
from kfmaps.app.pictures import position_colors

SHAPES = (".obj", ".ply", ".off")
MAPS = (".txt", ".vts", ".mat", ".npz")
MATRICES = (".txt", ".csv", ".npy")


def export(
    map: Annotated[Path, typer.Argument(help="A map (.npz, .txt, .vts, .mat).", metavar="MAP", show_default=False)],
    output: Annotated[
        Path,
        typer.Option(
            "-o",
            "--output",
            help="OBJ (with texture, MTL and picture), PLY or OFF (with colours), .txt, .vts, .mat, .npz.",
            show_default=False,
        ),
    ],
    source: Annotated[Path | None, typer.Option(help="The source mesh.", show_default=False)] = None,
    target: Annotated[Path | None, typer.Option(help="The target mesh.", show_default=False)] = None,
    picture: Annotated[
        Path | None, typer.Option(help="The source's texture (PNG, JPEG); default: a grid.", show_default=False)
    ] = None,
    functional: Annotated[
        bool, typer.Option("--functional", help="Write the functional map C alone (.txt, .csv, .npy).")
    ] = False,
    confidence: Annotated[
        bool, typer.Option("--confidence", help="Write the confidence of each target vertex (.txt, .csv, .npy).")
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace existing files.")] = False,
) -> None:
    """Write the target with the source's texture or colours, or the map in another format."""
    suffix = output.suffix.lower()
    if functional and confidence:
        raise refuse("export", "--functional or --confidence", "both", "run the command twice")
    formats = MATRICES if functional or confidence else SHAPES + MAPS
    if suffix not in formats:
        got = suffix or "no extension"
        raise refuse(f"output {output}", f"one of {' '.join(formats)}", got, "choose one of these")
    check_output(output, force, (map, source, target, picture))
    found = load_map(map)
    shape_s = None if source is None else read_mesh_file(source)
    shape_t = None if target is None else read_mesh_file(target)
    _check(found, shape_s, shape_t)
    if functional:
        if found.functional_map is None:
            raise refuse(str(map), "a functional map", "a point map alone", "give the .npz file of a match")
        write_values(output, Values(found.functional_map), force)
    elif confidence:
        values = found.extra.get("local_confidence")
        if values is None:
            raise refuse(str(map), "confidence per vertex", "none", "give the .npz or .mat file of a match")
        write_values(output, Values(np.asarray(values)), force)
    elif suffix in MAPS:
        save_map(output, found, force)
    elif shape_s is None or shape_t is None:
        raise refuse("export", "--source and --target for a shape", "not both", "name the two meshes")
    elif suffix == ".obj":
        write_textured(output, shape_s, shape_t.mesh, found, picture=picture, force=force)
    else:
        colors = position_colors(shape_s.mesh) if shape_s.colors is None else shape_s.colors
        write_colored(output, colors, shape_t.mesh, found, force=force)


def _check(found: MapFile, source: MeshFile | None, target: MeshFile | None) -> None:
    n_s = None if source is None else len(source.mesh.vertices)
    n_t = None if target is None else len(target.mesh.vertices)
    check_map(found, n_s, n_t)
