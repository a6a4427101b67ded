"""``kfmaps evaluate``: how far a map is from the truth."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kfmaps._arrays import InvalidInput, refuse
from kfmaps.cli.options import Force, Identity, Json, MapFile, SourceMesh, TruthLists

if TYPE_CHECKING:
    from rich.table import Table

    from kfmaps.cli.evaluation import Accuracy
    from kfmaps.geometry.mesh import Mesh
    from kfmaps.matching.result import Match

CURVES = (".csv", ".png", ".svg", ".pdf")


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
    from kfmaps.cli.evaluation import assess, known_truth, write_curve
    from kfmaps.cli.terminal import Terminal, print_json
    from kfmaps.io import check_map, check_output, load_map
    from kfmaps.io.partial_map import precise_points
    from kfmaps.io.provenance import map_mesh

    if curve is not None:
        if curve.suffix.lower() not in CURVES:
            got = curve.suffix or "no extension"
            raise refuse(f"--curve {curve}", f"one of {' '.join(CURVES)}", got, "rename it")
        check_output(curve, force, (map, source, target, symmetric, *(truth or ())))
    if truth_part is not None:
        _evaluate_part(map, (source, target), truth_part, part, curve, json, force, (truth, symmetric, identity))
        return
    if truth is None and symmetric is None and not identity:
        raise refuse("truth", "--truth SOURCE TARGET, --truth-part or --identity", "none of them", "say what is true")
    found = load_map(map)
    shape = map_mesh(source, found, "source", map)
    known = known_truth(truth, len(shape.vertices), len(found.target_to_source), symmetric=symmetric, identity=identity)
    assert known is not None
    other = _target(target, found, map)
    check_map(found, len(shape.vertices), None if other is None else len(other.vertices), str(map), lost=True)
    accuracy = assess(shape, found.target_to_source, known, place=precise_points(found, shape), target=other)
    if curve is not None:
        write_curve(curve, accuracy.errors, map.stem, force)
    if json:
        print_json(accuracy.as_dict())
        return
    Terminal().print(_table(accuracy))


def _evaluate_part(
    map: Path,
    given: tuple[Path | None, Path | None],
    truth: Path,
    part: str,
    curve: Path | None,
    json: bool,
    force: bool,
    others: tuple[object, ...],
) -> None:
    """The errors of a map between a part and a whole."""
    from rich.table import Table

    from kfmaps.cli.evaluation import write_curve
    from kfmaps.cli.partial_truth import part_accuracy, read_part_truth
    from kfmaps.cli.terminal import Terminal, print_json
    from kfmaps.cli.words import UNIT, percent
    from kfmaps.io import check_map, load_map
    from kfmaps.io.provenance import map_mesh

    if part not in ("source", "target"):
        raise refuse("--part", "source or target", repr(part), "choose one of them")
    if any(others):
        raise refuse("--truth-part", "one truth", "another beside it", "leave one out")
    found = load_map(map)
    shapes = map_mesh(given[0], found, "source", map), map_mesh(given[1], found, "target", map)
    check_map(found, len(shapes[0].vertices), len(shapes[1].vertices), str(map), lost=True)
    whole, piece = shapes if part == "target" else shapes[::-1]
    accuracy = part_accuracy(*shapes, found, read_part_truth(truth, whole, piece), part)
    if curve is not None:
        write_curve(curve, accuracy.errors, map.stem, force)
    if json:
        print_json(accuracy.as_dict())
        return
    table = Table(caption=f"errors in {UNIT} of the whole, points inside triangles", caption_justify="left")
    table.add_column("")
    table.add_column("", justify="right")
    for name in ("mean", "median", "worst"):
        table.add_row(name, percent(getattr(accuracy.errors, name), 3))
    e = accuracy.errors
    table.add_row(f"area under the curve to {100 * e.auc_limit:g} %", f"{e.auc:.4f}")
    table.add_row("points compared", f"{len(e.errors):,}")
    table.add_row("of the truth's points matched", f"{100 * accuracy.matched:.1f} %")
    if accuracy.overlap is not None:
        table.add_row("overlap, intersection over union", f"{100 * accuracy.overlap:.1f} %")
    table.add_row("missing of the whole's area", f"{100 * accuracy.missing:.1f} %")
    Terminal().print(table)


def _target(given: Path | None, found: Match, map: Path) -> Mesh | None:
    """The target, as given or as the map names it; ``None`` where it does not, or the file is gone or another."""
    from kfmaps.io.provenance import map_mesh

    if given is not None:
        return map_mesh(given, found, "target", map)
    try:
        mesh = map_mesh(None, found, "target", map)
    except InvalidInput:
        return None
    return mesh if len(mesh.vertices) == len(found.target_to_source) else None


def _table(accuracy: Accuracy) -> Table:
    """Errors, beside those against the mirrored truth where it is known."""
    from rich.table import Table

    from kfmaps.cli.words import UNIT, percent

    table = Table(caption=f"errors in {UNIT}: per cent of the square root of the source's area", caption_justify="left")
    table.add_column("")
    sides = [("error", accuracy.errors)]
    if accuracy.precise is not None:
        sides = [("vertices", accuracy.errors), ("points in triangles", accuracy.precise)]
    if accuracy.mirrored is not None:
        sides.append(("against the mirrored truth", accuracy.mirrored))
    for name, _ in sides:
        table.add_column(name, justify="right")
    for name in ("mean", "median", "worst"):
        table.add_row(name, *(percent(getattr(errors, name), 3) for _, errors in sides))
    table.add_row(f"area under the curve to {100 * accuracy.errors.auc_limit:g} %", *(f"{e.auc:.4f}" for _, e in sides))
    table.add_row("points without error", *(f"{100 * e.exact:.1f} %" for _, e in sides))
    table.add_row("points compared", *(f"{len(e.errors):,}" for _, e in sides))
    if accuracy.matched < 1:
        table.add_row("of the truth's points matched", f"{100 * accuracy.matched:.1f} %", *([""] * (len(sides) - 1)))
    table.add_row("source covered", f"{100 * accuracy.coverage:.1f} %", *([""] * (len(sides) - 1)))
    if accuracy.smooth is not None:
        for name, value in (
            ("source covered, with neighbours", accuracy.smooth.coverage),
            ("target's area turned over", accuracy.smooth.flipped_area),
            ("edges stretched or shrunk twofold", accuracy.smooth.stretched_area),
        ):
            table.add_row(name, *[""] * (1 if accuracy.precise is not None else 0), f"{100 * value:.1f} %")
    if accuracy.mirrored is not None and accuracy.mirrored.mean < accuracy.errors.mean:
        table.add_row("", "left and right are swapped", style="bold red")
    return table
