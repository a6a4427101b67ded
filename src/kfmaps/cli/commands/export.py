"""``kfmaps export``: a map in other programs' formats."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from kfmaps._arrays import refuse
from kfmaps.cli.options import Force, Json, MapFile, SourceMesh, TargetMesh
from kfmaps.cli.terminal import report_files
from kfmaps.io import Values, check_map, check_output, load_map, save_map, write_colored, write_textured, write_values
from kfmaps.io.export import write_morph
from kfmaps.io.mapfile import map_mesh_file
from kfmaps.io.text import check_suffix
from kfmaps.viz import position_colors

_SHAPES = (".obj", ".ply", ".off", ".glb")
_MAPS = (".txt", ".vts", ".mat", ".npz")
_MATRICES = (".txt", ".csv", ".npy")


def export(
    map: MapFile,
    output: Annotated[
        Path,
        typer.Option(
            "-o",
            "--output",
            help="OBJ (texture, MTL and picture), GLB (texture inside), PLY, OFF (colours), .txt, .vts, .mat, .npz.",
        ),
    ],
    source: SourceMesh = None,
    target: TargetMesh = None,
    picture: Annotated[
        Path | None, typer.Option(help="The source's texture (PNG, JPEG); default: its own, or a grid.")
    ] = None,
    texture_size: Annotated[
        int | None,
        typer.Option(min=16, max=16384, metavar="TEXELS", help="Longer side of the picture; default: the source's."),
    ] = None,
    functional: Annotated[
        bool, typer.Option("--functional", help="Write the functional map C alone (.txt, .csv, .npy).")
    ] = False,
    confidence: Annotated[
        bool, typer.Option("--confidence", help="Write the confidence of each target vertex (.txt, .csv, .npy).")
    ] = False,
    morph: Annotated[
        bool, typer.Option("--morph", help="Write the source in the target's shape (GLB: as a morph target).")
    ] = False,
    json: Json = False,
    force: Force = False,
) -> None:
    """Write the target with the source's texture, shape keys and skeleton, or the map in another format."""
    if morph:
        check_suffix(output, _SHAPES, "--morph")
    if functional and confidence:
        raise refuse("export", "--functional or --confidence", "both", "run the command twice")
    formats = _MATRICES if functional or confidence else _SHAPES + _MAPS
    suffix = check_suffix(output, formats, "output", "choose one of these")
    check_output(output, force, (map, source, target, picture))
    match = load_map(map)
    is_shape = suffix in _SHAPES
    shape_s, shape_t = (
        map_mesh_file(path, match, side, map) if is_shape or path is not None else None
        for path, side in ((source, "source"), (target, "target"))
    )
    n_s, n_t = (None if file is None else len(file.mesh.vertices) for file in (shape_s, shape_t))
    check_map(match, n_s, n_t, partial=True)
    if functional:
        if not hasattr(match, "functional_map"):
            raise refuse(str(map), "a functional map", "a point map alone", "give the .npz file of a match")
        write_values(output, Values(match.functional_map), force)
    elif confidence:
        values = getattr(match, "local_confidence", None)
        if values is None:
            raise refuse(str(map), "confidence per vertex", "none", "give the .npz or .mat file of a match")
        write_values(output, Values(np.asarray(values)), force)
    elif suffix in _MAPS:
        save_map(output, match, force)
    elif shape_s is None or shape_t is None:
        raise refuse("export", "both --source and --target for a shape", "one of them, or none", "name the two meshes")
    elif morph:
        registered = match.registration.registered_vertices
        if registered is None:
            raise refuse(str(map), "a non-rigid fit for --morph", "none", "give the .npz file of a match that kept it")
        write_morph(output, shape_s, shape_t.mesh, np.asarray(registered), force)
    elif suffix in (".obj", ".glb"):
        write_textured(output, shape_s, shape_t, match, picture=picture, size=texture_size, force=force)
    else:
        colors = position_colors(shape_s.mesh) if shape_s.colors is None else shape_s.colors
        write_colored(output, colors, shape_t.mesh, match, source=shape_s.mesh, force=force)
    report_files(output, as_json=json)
