"""``kfmaps transfer``: carry per-vertex values or named points over a map."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from kfmaps._arrays import refuse
from kfmaps.cli.options import Force, Json, MapFile, SourceMesh, TargetMesh
from kfmaps.cli.terminal import report_files
from kfmaps.io import Values, check_output, load_map, read_values, write_values
from kfmaps.io.landmark_files import landmark_format, mesh_space
from kfmaps.io.mapfile import map_mesh, mesh_path
from kfmaps.io.named_points import read_named_points, transfer_points, write_named_points
from kfmaps.io.transfer import Counterparts, find_counterparts, precise_points, transfer_back, transfer_by_functions
from kfmaps.io.transfer import transfer as transfer_values
from kfmaps.matching.result import Match

_SIDES = ("source", "target")


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
            help="Carry VALUES by the functional map, with products of so many eigenfunctions, not by points; 20 say.",
        ),
    ] = None,
    back: Annotated[bool, typer.Option("--back", help="From the target to the source.")] = False,
    source: SourceMesh = None,
    target: TargetMesh = None,
    lost: Annotated[
        float | None, typer.Option(help="For vertices without counterpart; default: NaN, -1 of whole numbers.")
    ] = None,
    json: Json = False,
    force: Force = False,
) -> None:
    """Carry functions, labels or named points over a map."""
    check_output(output, force, (map, values, source, target))
    if products is not None and (points or back):
        with_it = "--points" if points else "--back"
        raise refuse("--products", "values of the source", with_it, "leave one of them out")
    found = load_map(map)
    if points:
        landmark_format(output, "output")
        _points(found, map, values, output, back, (source, target), force)
    else:
        write_values(output, _carried(found, map, values, (source, target), back, products, lost), force)
    report_files(output, as_json=json)


def _carried(
    found: Match,
    map: Path,
    values: Path,
    given: tuple[Path | None, Path | None],
    back: bool,
    products: int | None,
    lost: float | None,
) -> Values:
    """Return the values of a file, carried to the other shape."""
    read = read_values(values)
    gone = int(lost) if lost is not None and read.array.dtype.kind in "iu" and lost == int(lost) else lost
    if back:
        return Values(transfer_back(read.array, _counterparts(found, map, given), gone), read.columns)
    if products is not None:
        source, target = (map_mesh(path, found, side, map) for side, path in zip(_SIDES, given, strict=True))
        return Values(transfer_by_functions(read.array, found, source, target, products), read.columns)
    faces = None
    if found.precise_map is not None and read.array.dtype.kind == "f":
        shape = map_mesh(given[0], found, "source", map)
        precise_points(found, shape)
        faces = shape.faces
    return Values(transfer_values(read.array, found, faces, gone), read.columns)


def _counterparts(found: Match, map: Path, given: tuple[Path | None, Path | None]) -> Counterparts:
    """Return which vertices of both shapes have counterparts; point clouds are refused."""
    source, target = (map_mesh(path, found, side, map) for side, path in zip(_SIDES, given, strict=True))
    for mesh, side in ((source, "source"), (target, "target")):
        if len(mesh.faces) == 0:
            raise refuse(side, "a surface with faces", "a point cloud", "leave --points and --back out")
    return find_counterparts(found, source, target, str(map))


def _points(
    found: Match, map: Path, values: Path, output: Path, back: bool, given: tuple[Path | None, Path | None], force: bool
) -> None:
    ways = _counterparts(found, map, given)
    trust = getattr(found, "local_confidence", None)
    confidence = None if trust is None else np.asarray(trust)
    paths = [mesh_path(path, found, side, map) for side, path in zip(_SIDES, given, strict=True)]
    here, there = paths[::-1] if back else paths
    mesh, space = ways.meshes[1 if back else 0], mesh_space(here)
    named = read_named_points(values, mesh, specimen=here.stem, space=space)
    write_named_points(output, transfer_points(named, ways, confidence, back=back), force, mesh_space(there) or space)
