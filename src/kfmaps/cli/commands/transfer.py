"""``kfmaps transfer``: carry per-vertex values or named points over a map."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from kfmaps._arrays import KfmapsWarning, refuse
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import Values, check_output, load_map, read_mesh, read_values, write_values
from kfmaps.io.landmark_files import check_landmark_format, mesh_space
from kfmaps.io.named_points import read_named_points, transfer_points, write_named_points
from kfmaps.io.partial_map import Counterparts, find_counterparts, precise_points
from kfmaps.io.provenance import mesh_path, warn_of_change
from kfmaps.io.transfer import transfer as transfer_values
from kfmaps.io.transfer import transfer_back, transfer_by_functions
from kfmaps.matching.result import Match


def transfer(
    output: Annotated[
        Path,
        typer.Option("-o", "--output", help="A row for each target vertex (.npy, .csv, .txt).", show_default=False),
    ],
    map: Annotated[
        Path | None, typer.Argument(help="A map (.npz, .txt, .vts, .mat).", metavar="MAP", show_default=False)
    ] = None,
    values: Annotated[
        Path | None,
        typer.Argument(help="A row for each source vertex (.npy, .csv, .txt).", metavar="VALUES", show_default=False),
    ] = None,
    collection: Annotated[
        Path | None,
        typer.Option(help="Instead of MAP: the output folder of kfmaps batch.", metavar="OUT", show_default=False),
    ] = None,
    landmarks: Annotated[
        Path | None,
        typer.Option(
            help="Of one specimen, to all of --collection (.mrk.json, .fcsv, .tps, .pts, .csv, .particles).",
            show_default=False,
        ),
    ] = None,
    on: Annotated[
        str | None, typer.Option(help="The specimen that --landmarks are on.", metavar="SHAPE", show_default=False)
    ] = None,
    tps: Annotated[
        Path | None, typer.Option(help="Write all landmarks as TPS too (geomorph, MorphoJ).", show_default=False)
    ] = None,
    points: Annotated[
        bool,
        typer.Option("--points", help="VALUES are points (.mrk.json, .fcsv, .tps, .pts, .csv, .particles)."),
    ] = False,
    products: Annotated[
        int | None,
        typer.Option(
            min=2,
            metavar="NUMBER",
            show_default=False,
            help="Carry VALUES by the functional map, with products of so many eigenfunctions, not by points; 20 say.",
        ),
    ] = None,
    back: Annotated[bool, typer.Option("--back", help="From the target to the source.")] = False,
    source: Annotated[
        Path | None, typer.Option(help="The source mesh; default: the one the map names.", show_default=False)
    ] = None,
    target: Annotated[Path | None, typer.Option(help="The same for the target.", show_default=False)] = None,
    lost: Annotated[
        float | None,
        typer.Option(help="For vertices without counterpart; default: NaN, -1 of whole numbers.", show_default=False),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """Carry functions, labels or named points over a map, or landmarks to all shapes of a collection."""
    if collection is not None or landmarks is not None:
        _everywhere(collection, landmarks, on, output, tps, force, (map, values, source, target))
        return
    if map is None or values is None:
        raise refuse("transfer", "MAP and VALUES, or --collection and --landmarks", "neither", "give two of them")
    check_output(output, force, (map, values, source, target))
    if products is not None and (points or back):
        with_it = "--points" if points else "--back"
        raise refuse("--products", "values of the source", with_it, "leave one of them out")
    found = load_map(map)
    if points:
        check_landmark_format(output, "output")
        _points(found, map, values, output, back, (source, target), force)
        return
    given = read_values(values)
    gone: float | int | None = lost
    if lost is not None and given.array.dtype.kind in "iu" and lost == int(lost):
        gone = int(lost)
    if back:
        _, mesh, ways = _both(found, map, (source, target))
        write_values(output, Values(transfer_back(given.array, ways, mesh, gone), given.columns), force)
        return
    if products is not None:
        sides = _shape(found, "source", source, map), _shape(found, "target", target, map)
        write_values(output, Values(transfer_by_functions(given.array, found, *sides, products), given.columns), force)
        return
    faces = None
    if found.precise_map is not None and given.array.dtype.kind == "f":
        shape = _shape(found, "source", source, map)
        precise_points(found, shape)
        faces = shape.faces
    write_values(output, Values(transfer_values(given.array, found, faces, gone), given.columns), force)


def _everywhere(
    collection: Path | None,
    landmarks: Path | None,
    on: str | None,
    output: Path,
    tps: Path | None,
    force: bool,
    others: tuple[Path | None, ...],
) -> None:
    """Landmarks of one specimen on all of a collection."""
    from kfmaps.batch.propagate_landmarks import propagate_landmarks, write_landmarks_csv, write_tps

    if collection is None or landmarks is None:
        missing = "--landmarks" if landmarks is None else "--collection"
        raise refuse("transfer", "--collection and --landmarks together", f"no {missing}", "give both")
    if any(one is not None for one in others):
        raise refuse("transfer", "--collection and --landmarks alone", "a map or mesh beside them", "leave that out")
    if output.suffix.lower() != ".csv":
        raise refuse(f"output {output}", "the extension .csv", output.suffix or "none", "rename it")
    for path in (output, *([] if tps is None else [tps])):
        check_output(path, force, (landmarks,))
    found, missed = propagate_landmarks(collection, landmarks, on)
    write_landmarks_csv(output, found, force)
    if tps is not None:
        write_tps(tps, found, force)
    if missed:
        text = f"no map leads to {', '.join(missed[:5])}{' and others' if len(missed) > 5 else ''}"
        warnings.warn(f"{text}; they have no landmarks", KfmapsWarning, stacklevel=2)


def _shape(found: Match, side: str, given: Path | None, map: Path) -> Mesh:
    path = mesh_path(given, found, side, map)
    warn_of_change(found, side, path)
    return read_mesh(path)


def _both(found: Match, map: Path, given: tuple[Path | None, Path | None]) -> tuple[Mesh, Mesh, Counterparts]:
    """Both shapes and what of each has a counterpart, at vertices where the map has no points inside triangles."""
    source, target = (_shape(found, side, path, map) for side, path in zip(("source", "target"), given, strict=True))
    for mesh, side in ((source, "source"), (target, "target")):
        if len(mesh.faces) == 0:
            raise refuse(side, "a surface with faces", "a point cloud", "leave --points and --back out")
    return source, target, find_counterparts(found, source, target, str(map))


def _points(
    found: Match,
    map: Path,
    values: Path,
    output: Path,
    back: bool,
    given: tuple[Path | None, Path | None],
    force: bool,
) -> None:
    source, target, ways = _both(found, map, given)
    trust = getattr(found, "local_confidence", None)
    confidence = None if trust is None else np.asarray(trust)
    paths = [mesh_path(path, found, side, map) for side, path in zip(("source", "target"), given, strict=True)]
    here, there = paths[::-1] if back else paths
    mesh, space = target if back else source, mesh_space(here)
    named = read_named_points(values, mesh, specimen=here.stem, space=space)
    some = {} if ways.complete else {"known": ways.target, "common": ways.source}
    carried = transfer_points(named, source, target, ways.place, confidence, back=back, **some)
    write_named_points(output, carried, force, mesh_space(there) or space)
