"""``kfmaps evaluate``: how far a map is from the truth."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from kfmaps._arrays import InvalidInput, refuse
from kfmaps._texts import UNIT, percent
from kfmaps.cli.options import Force, Identity, Json, MapFile, SourceMesh, TruthLists
from kfmaps.cli.terminal import Terminal, print_json
from kfmaps.evaluation import Accuracy, assess, part_accuracy, read_part_truth, read_truth, write_curve
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import check_map, check_output, load_map
from kfmaps.io.mapfile import map_mesh
from kfmaps.io.text import check_suffix
from kfmaps.io.transfer import precise_points
from kfmaps.matching.result import Match

_CURVES = (".csv", ".png", ".svg", ".pdf")


def evaluate(
    map: MapFile,
    source: SourceMesh = None,
    target: Annotated[Path | None, typer.Option(help="The target mesh, to check that the map belongs to it.")] = None,
    truth: TruthLists = None,
    symmetric: Annotated[
        Path | None, typer.Option(help="True vertices of the target with left and right swapped.")
    ] = None,
    truth_part: Annotated[
        Path | None,
        typer.Option(
            help="The truth of a part: .baryc_gt (triangle of the whole, weights), or lines 'whole part' from 0."
        ),
    ] = None,
    part: Annotated[str, typer.Option(help="With --truth-part: which shape is the part, source or target.")] = "target",
    identity: Identity = False,
    curve: Annotated[Path | None, typer.Option(help="Write the error curve (.csv, .png, .svg, .pdf).")] = None,
    json: Json = False,
    force: Force = False,
) -> None:
    """Print the geodesic error of a map, by the Princeton protocol, in per cent of √area."""
    if curve is not None:
        check_suffix(curve, _CURVES, "--curve")
        check_output(curve, force, (map, source, target, symmetric, *(truth or ())))
    if truth_part is not None:
        if part not in ("source", "target"):
            raise refuse("--part", "source or target", repr(part), "choose one of them")
        if truth is not None or symmetric is not None or identity:
            raise refuse("--truth-part", "one truth", "another as well", "leave one out")
    elif truth is None and symmetric is None and not identity:
        raise refuse("truth", "--truth SOURCE TARGET, --truth-part or --identity", "none of them", "say what is true")
    match = load_map(map)
    mesh_s = map_mesh(source, match, "source", map)
    n_s, n_t = len(mesh_s.vertices), len(match.target_to_source)
    if truth_part is not None:
        mesh_t = map_mesh(target, match, "target", map)
        check_map(match, n_s, len(mesh_t.vertices), str(map), partial=True)
        whole, piece = (mesh_s, mesh_t) if part == "target" else (mesh_t, mesh_s)
        accuracy = part_accuracy(mesh_s, mesh_t, match, read_part_truth(truth_part, whole, piece), part)
    else:
        known = read_truth(truth, n_s, n_t, symmetric=symmetric, identity=identity)
        assert known is not None
        mesh_t = _target_mesh(target, match, map)
        check_map(match, n_s, None if mesh_t is None else len(mesh_t.vertices), str(map), partial=True)
        points = precise_points(match, mesh_s)
        accuracy = assess(mesh_s, match.target_to_source, known, points=points, target=mesh_t)
    if curve is not None:
        write_curve(curve, accuracy.errors, map.stem, force)
    if json:
        print_json(accuracy.as_dict())
    else:
        Terminal().print(_table(accuracy))


def _target_mesh(path: Path | None, match: Match, map: Path) -> Mesh | None:
    """Return the target, from ``path`` or as the map names it; ``None`` where that file is missing or has changed."""
    try:
        mesh = map_mesh(path, match, "target", map)
    except InvalidInput:
        if path is not None:
            raise
        return None
    return mesh if path is not None or len(mesh.vertices) == len(match.target_to_source) else None


def _table(accuracy: Accuracy) -> Table:
    """Return a table with a column for each kind of errors, and shares of area below."""
    precise, mirrored, smooth = accuracy.precise, accuracy.mirrored, accuracy.smoothness
    of_part = accuracy.missing is not None
    sides = {"" if of_part else "error" if precise is None else "vertices": accuracy.errors}
    sides |= {} if precise is None else {"points in triangles": precise}
    sides |= {} if mirrored is None else {"against the mirrored truth": mirrored}
    unit = " of the whole, points inside triangles" if of_part else ": per cent of the square root of the source's area"
    table = Table("", caption=f"errors in {UNIT}{unit}", caption_justify="left")
    for name in sides:
        table.add_column(name, justify="right")
    every = list(sides.values())
    for name in ("mean", "median", "worst"):
        table.add_row(name, *(percent(getattr(e, name), 3) for e in every))
    table.add_row(f"area under the curve to {100 * every[0].auc_limit:g} %", *(f"{e.auc:.4f}" for e in every))
    table.add_row("points without error", *(f"{100 * e.exact:.1f} %" for e in every))
    table.add_row("points compared", *(f"{len(e.errors):,}" for e in every))
    skipped = [""] * (precise is not None)
    for value, name, *empty in (
        (accuracy.matched if of_part or accuracy.matched < 1 else None, "of the truth's points matched"),
        (accuracy.overlap, "overlap, intersection over union"),
        (accuracy.missing, "missing of the whole's area"),
        (accuracy.coverage if smooth is None else None, "source covered"),
        (smooth and smooth.coverage, "source covered, with neighbours", *skipped),
        (smooth and smooth.flipped_area, "target's area turned over", *skipped),
        (smooth and smooth.stretched_area, "edges stretched or shrunk twofold", *skipped),
    ):
        if value is not None:
            table.add_row(name, *empty, f"{100 * value:.1f} %")
    if mirrored is not None and mirrored.mean < accuracy.errors.mean:
        table.add_row("", "left and right are swapped", style="bold red")
    return table
