"""``kfmaps demo``: match generated shapes and compare the maps with the truth."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich.table import Table

from kfmaps import datasets
from kfmaps._arrays import refuse
from kfmaps._records import JsonObject
from kfmaps._texts import UNIT, percent
from kfmaps._threads import one_blas_thread
from kfmaps.cli.options import Force, Json
from kfmaps.cli.progress import Stages
from kfmaps.cli.terminal import Terminal, print_json, print_line, report_files
from kfmaps.config import Config
from kfmaps.datasets import ExamplePair
from kfmaps.fmap.evaluate import geodesic_errors
from kfmaps.geometry.geodesics import farthest_geodesic
from kfmaps.io import atomic_output, check_output, write_landmarks, write_mesh, write_vertex_numbers
from kfmaps.matching.match import match
from kfmaps.shape import prepare

_SHAPES = ("two-poses", "non-isometric", "partial")


def demo(
    output: Annotated[Path, typer.Option("-o", "--output", help="The picture (.png, .svg, .pdf).")] = Path("demo.png"),
    shape: Annotated[str, typer.Option(help=f"Which pair: {', '.join(_SHAPES)}.")] = "two-poses",
    vertices: Annotated[int, typer.Option(help="Vertices of the source, from 1500 to 300000.")] = 6000,
    landmarks: Annotated[
        int, typer.Option(help="Number of landmarks taken from the truth for the comparison.", min=1, max=100)
    ] = 6,
    seed: Annotated[int, typer.Option(help="For the shapes and for the match.", min=0)] = 0,
    write: Annotated[
        Path | None,
        typer.Option(
            help="Match nothing: write the shapes into this folder, to try the other commands on "
            "(a.ply, b.ply, their truth a.vts, b.vts, landmarks pairs.txt).",
            metavar="FOLDER",
        ),
    ] = None,
    json: Json = False,
    force: Force = False,
) -> None:
    """Make two poses of a shape, match them, print the error beside that without a kernel, draw a picture."""
    from kfmaps.viz import match_figure, picture_format, save_figure

    if shape not in _SHAPES:
        raise refuse("--shape", "one of " + ", ".join(_SHAPES), repr(shape), "choose one of them")
    if write is not None:
        paths = _write(write, shape, vertices, landmarks, seed, force)
        report_files(*paths, as_json=json)
        for path in () if json else paths:
            print_line(str(path))
        return
    picture_format(output)
    check_output(output, force)
    pair, methods = _compare(shape, vertices, landmarks, seed, quiet=json)
    first = methods[0]
    title = f"{pair.name.capitalize()}, {first['given']}: mean geodesic error {percent(first['error'])} {UNIT}"
    figure = match_figure(pair.source, pair.target, first["points"], errors=first["errors"], title=title)
    with atomic_output(output, force) as temporary:
        save_figure(figure, temporary)
    sizes = {"source_vertices": len(pair.source.vertices), "target_vertices": len(pair.target.vertices)}
    if json:
        rows = [{name: v for name, v in row.items() if name not in ("points", "errors")} for row in methods]
        print_json({"shape": pair.name, **sizes, "methods": rows, "output": output})
        return
    console = Terminal(highlight=False)
    console.print(_table(pair.name, sizes, methods))
    console.print(f"picture: {output}", markup=False)


def _write(folder: Path, shape: str, vertices: int, landmarks: int, seed: int, force: bool = False) -> list[Path]:
    """Write both shapes, the truth line by line and some of it as landmarks; return the files."""
    paths = [folder / name for name in ("a.ply", "b.ply", "a.vts", "b.vts", "pairs.txt")]
    folder.mkdir(parents=True, exist_ok=True)
    for path in paths:
        check_output(path, force)
    pair, rows = _pair(shape, vertices, landmarks, seed)
    write_mesh(paths[0], pair.source, force=force)
    write_mesh(paths[1], pair.target, force=force)
    write_vertex_numbers(paths[2], pair.truth, force=force)
    write_vertex_numbers(paths[3], np.arange(len(pair.truth)), force=force)
    write_landmarks(paths[4], np.stack([pair.truth[rows], rows], axis=1), force=force)
    return paths


def _pair(shape: str, vertices: int, landmarks: int, seed: int) -> tuple[ExamplePair, np.ndarray]:
    """Return the shapes, and vertices (l,) of the target far from each other."""
    pair: ExamplePair = getattr(datasets, shape.replace("-", "_"))(vertices, seed)
    return pair, farthest_geodesic(pair.target, landmarks, np.random.default_rng(seed))


def _table(name: str, sizes: dict[str, int], methods: list[JsonObject]) -> Table:
    n_s, n_t = sizes.values()
    table = Table(
        title=f"{name}: {n_s:,} and {n_t:,} vertices, meshed independently",
        caption=f"mean geodesic error in {UNIT}; time without the eigenfunctions",
        title_justify="left",
        caption_justify="left",
    )
    for column in ("method", "given", "outcome"):
        table.add_column(column)
    for column in ("fit alone", "refined", "time"):
        table.add_column(column, justify="right", no_wrap=True)
    for row in methods:
        numbers = percent(row["raw_error"]), percent(row["error"]), f"{row['seconds']:.1f} s"
        table.add_row(row["method"], row["given"], row["verdict"], *numbers)
    return table


def _compare(
    shape: str, vertices: int, landmarks: int, seed: int, *, quiet: bool = False
) -> tuple[ExamplePair, list[JsonObject]]:
    """Match a pair automatically, then with landmarks with a kernel and without (NO17).

    The last two have the same eigenfunctions, landmarks and refinement, so that only the fit differs. Errors of the
    refined and the raw map are in units of √area.
    """
    with one_blas_thread(), Stages(quiet) as stages:
        stages("shapes", 0.0)
        pair, rows = _pair(shape, vertices, landmarks, seed)
        stages("shapes", 1.0)
        automatic, single = Config(), Config.single_fit()
        # The same shapes serve all matches; those with landmarks need more eigenfunctions.
        size = max(automatic.n_eigenfunctions, single.n_eigenfunctions)
        config = replace(automatic, descriptors=replace(automatic.descriptors, n_eigenfunctions=size))
        sides = (("source", pair.source), ("target", pair.target))
        source, target = (prepare(mesh, config, name=side, progress=stages) for side, mesh in sides)
        pairs, landmark_text = np.stack([pair.truth[rows], rows], axis=1), f"{landmarks} landmarks from the truth"
        no_kernel = replace(Config.no17(), refinement=single.refinement)
        methods = []
        for stage, method, config, match_landmarks in (
            ("automatic", "kernel", automatic, None),
            ("kernel", "kernel", automatic if shape == "partial" else single, pairs),
            ("no kernel (NO17)", "no kernel (NO17)", no_kernel, pairs),
        ):
            start = time.perf_counter()
            stages(stage, 0.0)
            result = match(source, target, config, landmarks=match_landmarks, rng=seed)
            stages(stage, 1.0)
            seconds = time.perf_counter() - start
            points, raw = result.target_to_source, result.fit.raw_target_to_source
            errors = geodesic_errors(pair.source, points, pair.truth)
            raw_error = None if raw is None else float(geodesic_errors(pair.source, raw, pair.truth).mean())
            row = {"method": method, "given": "no landmarks" if match_landmarks is None else landmark_text}
            row |= {"error": float(errors[points >= 0].mean()), "raw_error": raw_error, "verdict": result.verdict}
            methods.append(row | {"seconds": seconds, "points": points, "errors": errors})
    return pair, methods
