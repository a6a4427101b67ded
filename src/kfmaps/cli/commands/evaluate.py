"""``kfmaps evaluate``: how far a map is from the truth."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from kfmaps._arrays import InvalidInput, refuse
from kfmaps.cli.evaluation import Accuracy, assess, known_truth, write_curve
from kfmaps.cli.options import Force, Identity, Json, MapFile, SourceMesh, TruthLists
from kfmaps.cli.partial_truth import PartAccuracy, part_accuracy, read_part_truth
from kfmaps.cli.terminal import Terminal, print_json
from kfmaps.cli.words import UNIT, percent
from kfmaps.fmap.evaluate import Evaluation
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import check_map, check_output, load_map
from kfmaps.io.partial_map import precise_points
from kfmaps.io.provenance import map_mesh
from kfmaps.io.text import check_suffix
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
            raise refuse("--truth-part", "one truth", "another beside it", "leave one out")
    elif truth is None and symmetric is None and not identity:
        raise refuse("truth", "--truth SOURCE TARGET, --truth-part or --identity", "none of them", "say what is true")
    found = load_map(map)
    shape = map_mesh(source, found, "source", map)
    if truth_part is not None:
        other = map_mesh(target, found, "target", map)
        check_map(found, len(shape.vertices), len(other.vertices), str(map), lost=True)
        whole, piece = (shape, other) if part == "target" else (other, shape)
        accuracy = part_accuracy(shape, other, found, read_part_truth(truth_part, whole, piece), part)
    else:
        sizes = len(shape.vertices), len(found.target_to_source)
        known = known_truth(truth, *sizes, symmetric=symmetric, identity=identity)
        assert known is not None
        other = _target(target, found, map)
        check_map(found, len(shape.vertices), None if other is None else len(other.vertices), str(map), lost=True)
        accuracy = assess(shape, found.target_to_source, known, place=precise_points(found, shape), target=other)
    if curve is not None:
        write_curve(curve, accuracy.errors, map.stem, force)
    if json:
        print_json(accuracy.as_dict())
    else:
        Terminal().print(_part_table(accuracy) if isinstance(accuracy, PartAccuracy) else _table(accuracy))


def _target(given: Path | None, found: Match, map: Path) -> Mesh | None:
    """The target, as given or as the map names it; ``None`` where it does not, or the file is gone or another."""
    if given is not None:
        return map_mesh(given, found, "target", map)
    try:
        mesh = map_mesh(None, found, "target", map)
    except InvalidInput:
        return None
    return mesh if len(mesh.vertices) == len(found.target_to_source) else None


def _errors_table(caption: str, sides: dict[str, Evaluation]) -> Table:
    """A column of errors for each evaluation."""
    table = Table("", caption=f"errors in {UNIT}{caption}", caption_justify="left")
    for name in sides:
        table.add_column(name, justify="right")
    every = list(sides.values())
    for name in ("mean", "median", "worst"):
        table.add_row(name, *(percent(getattr(e, name), 3) for e in every))
    table.add_row(f"area under the curve to {100 * every[0].auc_limit:g} %", *(f"{e.auc:.4f}" for e in every))
    table.add_row("points without error", *(f"{100 * e.exact:.1f} %" for e in every))
    table.add_row("points compared", *(f"{len(e.errors):,}" for e in every))
    return table


def _part_table(accuracy: PartAccuracy) -> Table:
    table = _errors_table(" of the whole, points inside triangles", {"": accuracy.errors})
    table.add_row("of the truth's points matched", f"{100 * accuracy.matched:.1f} %")
    if accuracy.overlap is not None:
        table.add_row("overlap, intersection over union", f"{100 * accuracy.overlap:.1f} %")
    table.add_row("missing of the whole's area", f"{100 * accuracy.missing:.1f} %")
    return table


def _table(accuracy: Accuracy) -> Table:
    """Errors, beside those of points inside triangles and against the mirrored truth where they are known."""
    precise, mirrored, smooth = accuracy.precise, accuracy.mirrored, accuracy.smooth
    sides = {"error" if precise is None else "vertices": accuracy.errors}
    sides |= {} if precise is None else {"points in triangles": precise}
    sides |= {} if mirrored is None else {"against the mirrored truth": mirrored}
    table = _errors_table(": per cent of the square root of the source's area", sides)
    if accuracy.matched < 1:
        table.add_row("of the truth's points matched", f"{100 * accuracy.matched:.1f} %")
    if smooth is None:
        table.add_row("source covered", f"{100 * accuracy.coverage:.1f} %")
    else:
        for name, value in (
            ("source covered, with neighbours", smooth.coverage),
            ("target's area turned over", smooth.flipped_area),
            ("edges stretched or shrunk twofold", smooth.stretched_area),
        ):
            table.add_row(name, *[""] * (precise is not None), f"{100 * value:.1f} %")
    if mirrored is not None and mirrored.mean < accuracy.errors.mean:
        table.add_row("", "left and right are swapped", style="bold red")
    return table
