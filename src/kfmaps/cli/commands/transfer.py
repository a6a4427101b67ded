"""``kfmaps transfer``: carry per-vertex values or named points over a map."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kfmaps._arrays import refuse
from kfmaps.cli.options import Force, Json, MapFile, SourceMesh, TargetMesh
from kfmaps.cli.terminal import report_files
from kfmaps.io import Values, check_output, load_map, read_values, write_values
from kfmaps.io.landmark_files import landmark_format, mesh_space
from kfmaps.io.mapfile import map_mesh, map_meshes, mesh_path
from kfmaps.io.named_points import read_named_points, transfer_points, write_named_points
from kfmaps.io.transfer import Counterparts, find_counterparts, precise_points, transfer_back, transfer_by_functions
from kfmaps.io.transfer import transfer as transfer_values
from kfmaps.matching.result import Match


def transfer(
    map: MapFile,
    values: Annotated[Path, typer.Argument(help="A row for each source vertex (.npy, .csv, .txt).", metavar="VALUES")],
    output: Annotated[Path, typer.Option("-o", "--output", help="A row for each target vertex (.npy, .csv, .txt).")],
    points: Annotated[
        bool, typer.Option("--points", help="VALUES are points (.mrk.json, .fcsv, .tps, .pts, .csv, .particles).")
    ] = False,
    products: Annotated[
        int | None,
        typer.Option(
            min=2,
            metavar="NUMBER",
            help="Carry VALUES by the functional map, with products of this many eigenfunctions (20, say).",
        ),
    ] = None,
    back: Annotated[bool, typer.Option("--back", help="From the target to the source.")] = False,
    source: SourceMesh = None,
    target: TargetMesh = None,
    lost: Annotated[
        float | None,
        typer.Option(help="Value for vertices without a counterpart; default: NaN, or -1 for whole numbers."),
    ] = None,
    json: Json = False,
    force: Force = False,
) -> None:
    """Carry functions, labels or named points over a map."""
    check_output(output, force, (map, values, source, target))
    if products is not None and (points or back):
        other_option = "--points" if points else "--back"
        raise refuse("--products", "values of the source", other_option, "leave one of them out")
    match, paths = load_map(map), (source, target)
    if points:
        landmark_format(output, "output")
        _transfer_points(match, map, values, output, paths, back, force)
    else:
        content = read_values(values)
        fill_value = lost
        if lost is not None and lost.is_integer() and content.array.dtype.kind in "iu":
            fill_value = int(lost)
        if back:
            array = transfer_back(content.array, _find_counterparts(match, map, paths), fill_value)
        elif products is not None:
            array = transfer_by_functions(content.array, match, *map_meshes(paths, match, map), products)
        else:
            faces = None
            if match.precise_map is not None and content.array.dtype.kind == "f":
                mesh = map_mesh(source, match, "source", map)
                precise_points(match, mesh)
                faces = mesh.faces
            array = transfer_values(content.array, match, faces, fill_value)
        write_values(output, Values(array, content.columns), force)
    report_files(output, as_json=json)


def _find_counterparts(match: Match, map: Path, paths: tuple[Path | None, Path | None]) -> Counterparts:
    """Return which vertices of both shapes have counterparts; point clouds are refused."""
    meshes = map_meshes(paths, match, map)
    for mesh, side in zip(meshes, ("source", "target"), strict=True):
        if len(mesh.faces) == 0:
            raise refuse(side, "a surface with faces", "a point cloud", "leave --points and --back out")
    return find_counterparts(match, *meshes, str(map))


def _transfer_points(
    match: Match, map: Path, points: Path, output: Path, paths: tuple[Path | None, Path | None], back: bool, force: bool
) -> None:
    """Read named points of one shape, and write them on the other, each in the coordinate system of its mesh's file."""
    counterparts = _find_counterparts(match, map, paths)
    files = mesh_path(paths[0], match, "source", map), mesh_path(paths[1], match, "target", map)
    origin, destination = files[::-1] if back else files
    space = mesh_space(origin)
    given = read_named_points(points, counterparts.meshes[int(back)], specimen=origin.stem, space=space)
    transferred = transfer_points(given, counterparts, getattr(match, "local_confidence", None), back=back)
    write_named_points(output, transferred, force, mesh_space(destination) or space)
