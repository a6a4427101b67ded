"""``kfmaps demo``: shapes made by code, matched, and set beside the truth."""

from __future__ import annotations

import json as jsonlib
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kfmaps._arrays import refuse
from kfmaps.cli.words import UNIT, percent

if TYPE_CHECKING:
    import numpy as np
    from rich.table import Table

    from kfmaps.config import Config
    from kfmaps.datasets import Pair
    from kfmaps.matching.match import Match

SHAPES = ("two-poses", "non-isometric", "partial")


def demo(
    output: Annotated[Path, typer.Option("-o", "--output", help="The picture (.png, .svg, .pdf).")] = Path("demo.png"),
    shape: Annotated[str, typer.Option(help=f"Which pair: {', '.join(SHAPES)}.")] = "two-poses",
    vertices: Annotated[int, typer.Option(help="Of the source, from 1500 to 300000.")] = 6000,
    landmarks: Annotated[
        int, typer.Option(help="How many to take from the truth, for the comparison.", min=1, max=100)
    ] = 6,
    seed: Annotated[int, typer.Option(help="For the shapes and for the match.", min=0)] = 0,
    write: Annotated[
        Path | None,
        typer.Option(
            help="Match nothing: write the shapes into this folder, to try the other commands on "
            "(a.ply, b.ply, their truth a.vts, b.vts, landmarks pairs.txt).",
            metavar="FOLDER",
            show_default=False,
        ),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print the numbers for machines.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """Make two poses of a shape, match them, print the error beside that without a kernel, draw a picture."""
    from kfmaps.cli.terminal import Terminal, say
    from kfmaps.io import atomic_output, check_output
    from kfmaps.viz import match_figure, picture_format, save_figure

    if shape not in SHAPES:
        raise refuse("--shape", "one of " + ", ".join(SHAPES), repr(shape), "choose one of them")
    if write is not None:
        for path in written(write, shape, vertices, landmarks, seed, force):
            say(str(path))
        return
    picture_format(output)
    check_output(output, force)
    found = compared(shape, vertices, landmarks, seed, quiet=json)
    pair, ours = found.pair, found.rows[0]
    title = f"{pair.name.capitalize()}, {ours.given}: mean geodesic error {percent(ours.error)} {UNIT}"
    figure = match_figure(pair.source, pair.target, ours.points, errors=ours.errors, title=title)
    with atomic_output(output, force) as temporary:
        save_figure(figure, temporary)
    if json:
        typer.echo(jsonlib.dumps({**found.as_dict(), "output": str(output)}))
        return
    console = Terminal(highlight=False)
    console.print(found.table())
    console.print(f"picture: {output}", markup=False)


def written(folder: Path, shape: str, vertices: int, landmarks: int, seed: int, force: bool = False) -> list[Path]:
    """The files of a pair: both shapes, line by line the truth, and some of it as landmarks."""
    import numpy as np

    from kfmaps.io import check_output, write_landmarks, write_mesh, write_vertex_numbers

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


def _pair(shape: str, vertices: int, landmarks: int, seed: int) -> tuple[Pair, np.ndarray]:
    """The shapes, and well spread vertices (l,) of the target."""
    import numpy as np

    from kfmaps import datasets
    from kfmaps.geometry.geodesics import farthest_geodesic

    pair: Pair = getattr(datasets, shape.replace("-", "_"))(vertices, seed)
    return pair, farthest_geodesic(pair.target, landmarks, np.random.default_rng(seed))


@dataclass(frozen=True, eq=False)
class Row:
    """What one method made of the pair.

    Attributes
    ----------
    method, given : str
        Its name, and what it was told of the truth.
    points : (n_t,) int64
        The refined map, and ...
    errors : (n_t,) float64
        ... its errors in units of √area.
    raw_error : float or None
        Mean error of the fit alone.
    verdict : str
    seconds : float
    """

    method: str
    given: str
    points: np.ndarray
    errors: np.ndarray
    raw_error: float | None
    verdict: str
    seconds: float

    @property
    def error(self) -> float:
        """Mean of ``errors`` where there is a counterpart."""
        return float(self.errors[self.points >= 0].mean())


@dataclass(frozen=True, eq=False)
class Comparison:
    """The demonstration's shapes and what each method made of them, the automatic match first."""

    pair: Pair
    rows: tuple[Row, ...]

    def as_dict(self) -> dict[str, Any]:
        """Plain numbers; errors in units of √area."""
        names = ("method", "given", "error", "raw_error", "verdict", "seconds")
        return {
            "shape": self.pair.name,
            "source_vertices": len(self.pair.source.vertices),
            "target_vertices": len(self.pair.target.vertices),
            "methods": [{name: getattr(row, name) for name in names} for row in self.rows],
        }

    def table(self) -> Table:
        """For people."""
        from rich.table import Table

        n_s, n_t = len(self.pair.source.vertices), len(self.pair.target.vertices)
        table = Table(
            title=f"{self.pair.name}: {n_s:,} and {n_t:,} vertices, meshed independently",
            caption=f"mean geodesic error in {UNIT}; time without the eigenfunctions",
            title_justify="left",
            caption_justify="left",
        )
        for name in ("method", "given", "outcome"):
            table.add_column(name)
        for name in ("fit alone", "refined", "time"):
            table.add_column(name, justify="right", no_wrap=True)
        for row in self.rows:
            numbers = percent(row.raw_error), percent(row.error), f"{row.seconds:.1f} s"
            table.add_row(row.method, row.given, row.verdict, *numbers)
        return table


def compared(shape: str, vertices: int, landmarks: int, seed: int, *, quiet: bool = False) -> Comparison:
    """Match a pair of the package's own shapes automatically, then with landmarks with a kernel and without (NO17).

    The last two get the same eigenfunctions, landmarks and refinement, so that what differs is the fit.
    """
    import numpy as np

    from kfmaps._threads import one_blas_thread
    from kfmaps.cli.progress import Stages
    from kfmaps.config import Config
    from kfmaps.matching.match import default_config
    from kfmaps.shape import prepare

    with one_blas_thread(), Stages(quiet) as stages:
        stages("shapes", 0.0)
        pair, rows = _pair(shape, vertices, landmarks, seed)
        stages("shapes", 1.0)
        pairs = np.stack([pair.truth[rows], rows], axis=1)
        automatic, ours = default_config(), Config.single_fit()
        # The same shapes for all: as many functions as the fits with landmarks need, which need more.
        wanted = max(automatic.eigenfunctions, ours.eigenfunctions)
        each = replace(automatic, descriptors=replace(automatic.descriptors, eigenfunctions=wanted))
        shapes = [
            prepare(mesh, each, name=side, progress=stages)
            for side, mesh in (("source", pair.source), ("target", pair.target))
        ]
        told = f"{landmarks} landmarks from the truth"
        without = replace(Config.no17(), refinement=ours.refinement)
        methods = (
            ("kernel", "no landmarks", automatic, None),
            ("kernel", told, automatic if shape == "partial" else ours, pairs),
            ("no kernel (NO17)", told, without, pairs),
        )
        found = tuple(_row(*method, pair, shapes, seed, stages) for method in methods)
    return Comparison(pair, found)


def _row(
    method: str,
    given: str,
    config: Config,
    landmarks: np.ndarray | None,
    pair: Pair,
    shapes: list[Any],
    seed: int,
    stages: Callable[[str, float], None],
) -> Row:
    import numpy as np

    from kfmaps.fmap.evaluate import geodesic_errors
    from kfmaps.matching.match import match

    name = "automatic" if landmarks is None else method
    start = time.perf_counter()
    stages(name, 0.0)
    found: Match = match(shapes[0], shapes[1], config, landmarks=landmarks, rng=seed)
    stages(name, 1.0)
    seconds = time.perf_counter() - start
    known = found.target_to_source >= 0
    errors = np.full(len(known), np.nan)
    errors[known] = geodesic_errors(pair.source, found.target_to_source[known], pair.truth[known])
    raw = found.raw_target_to_source
    raw_error = None if raw is None else float(geodesic_errors(pair.source, raw, pair.truth).mean())
    return Row(method, given, found.target_to_source, errors, raw_error, found.verdict, seconds)
