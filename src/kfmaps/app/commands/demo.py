"""``kfmaps demo``: shapes made by code, matched, and set beside the truth."""

from __future__ import annotations

import json as jsonlib
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kfmaps._arrays import refuse

if TYPE_CHECKING:
    import numpy as np
    from rich.table import Table

    from kfmaps.app.datasets import Pair
    from kfmaps.config import Config
    from kfmaps.pipeline import Match

SHAPES = ("two-poses", "non-isometric", "partial")


def demo(
    output: Annotated[Path, typer.Option("-o", "--output", help="The picture (.png, .svg, .pdf).")] = Path("demo.png"),
    shape: Annotated[str, typer.Option(help=f"Which pair: {', '.join(SHAPES)}.")] = "two-poses",
    vertices: Annotated[int, typer.Option(help="Of the source, from 1500 to 50000.")] = 6000,
    landmarks: Annotated[
        int, typer.Option(help="How many to take from the truth; 0 matches without any.", min=0, max=100)
    ] = 6,
    seed: Annotated[int, typer.Option(help="For the shapes and for the match.", min=0)] = 0,
    json: Annotated[bool, typer.Option("--json", help="Print the numbers for machines.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """Make two poses of a shape, match them, print the error beside that without a kernel, draw a picture."""
    from kfmaps.app.files import atomic_output, check_output
    from kfmaps.app.pictures import match_figure, picture_format, save_figure

    picture_format(output)
    check_output(output, force)
    if shape not in SHAPES:
        raise refuse("--shape", "one of " + ", ".join(SHAPES), repr(shape), "choose one of them")
    found = compared(shape, vertices, landmarks, seed, quiet=json)
    pair, ours = found.pair, found.rows[0]
    title = f"{pair.name.capitalize()}: mean geodesic error {ours.error:.4f} √area"
    figure = match_figure(pair.source, pair.target, ours.points, errors=ours.errors, title=title)
    with atomic_output(output, force) as temporary:
        save_figure(figure, temporary)
    if json:
        typer.echo(jsonlib.dumps({**found.as_dict(), "output": str(output)}))
        return
    from rich.console import Console

    console = Console(highlight=False)
    console.print(found.table())
    console.print(f"picture: {output}", markup=False)


@dataclass(frozen=True, eq=False)
class Row:
    """One method: its refined ``points (n_t,)``, their ``errors (n_t,)`` in √area, and the raw map's mean error."""

    method: str
    points: np.ndarray
    errors: np.ndarray
    raw_error: float
    seconds: float
    status: str

    @property
    def error(self) -> float:
        """Mean of ``errors``."""
        return float(self.errors.mean())


@dataclass(frozen=True, eq=False)
class Comparison:
    """The demonstration's shapes and what each method made of them, the recommended one first."""

    pair: Pair
    landmarks: int
    rows: tuple[Row, ...]

    def as_dict(self) -> dict[str, Any]:
        """Plain numbers; errors in units of √area."""
        return {
            "shape": self.pair.name,
            "source_vertices": len(self.pair.source.vertices),
            "target_vertices": len(self.pair.target.vertices),
            "landmarks": self.landmarks,
            "methods": {
                row.method: {
                    "error": row.error,
                    "raw_error": row.raw_error,
                    "seconds": row.seconds,
                    "solver": row.status,
                }
                for row in self.rows
            },
        }

    def table(self) -> Table:
        """For people."""
        from rich.table import Table

        n_s, n_t = len(self.pair.source.vertices), len(self.pair.target.vertices)
        given = f"{self.landmarks} landmarks taken from the truth" if self.landmarks else "no landmarks"
        table = Table(
            title=f"{self.pair.name}: {n_s:,} and {n_t:,} vertices; {given}",
            caption="mean geodesic error × 100, in units of √area; time of the match without the eigenfunctions",
            title_justify="left",
            caption_justify="left",
        )
        table.add_column("method")
        for name in ("fit alone", "refined", "time"):
            table.add_column(name, justify="right")
        for row in self.rows:
            table.add_row(row.method, f"{100 * row.raw_error:.2f}", f"{100 * row.error:.2f}", f"{row.seconds:.1f} s")
        return table


def compared(shape: str, vertices: int, landmarks: int, seed: int, *, quiet: bool = False) -> Comparison:
    """Match a pair of the package's own shapes with the recommended settings, and with those of NO17.

    Both get the same eigenfunctions, landmarks and refinement, so that what differs is the fit.
    """
    import numpy as np

    from kfmaps.app import datasets
    from kfmaps.app.progress import Stages
    from kfmaps.config import Config
    from kfmaps.geodesics import farthest_geodesic
    from kfmaps.shape import prepare

    with Stages(quiet) as stages:
        stages("shapes", 0.0)
        pair: Pair = getattr(datasets, shape.replace("-", "_"))(vertices, seed)
        stages("shapes", 1.0)
        pairs = None
        if landmarks:
            rows = farthest_geodesic(pair.target, landmarks, np.random.default_rng(seed))
            pairs = np.stack([pair.truth[rows], rows], axis=1)
        config = Config() if landmarks else Config.automatic()
        shapes = (
            prepare(pair.source, config, name="source", progress=stages),
            prepare(pair.target, config, name="target", progress=stages),
        )
        plain = replace(Config.no17(), refinement=config.refinement)
        methods = {"kernel functional map": config, "without a kernel (NO17)": plain}
        found = tuple(_row(name, c, pair, shapes, pairs, seed, stages) for name, c in methods.items())
    return Comparison(pair, landmarks, found)


def _row(
    method: str, config: Config, pair: Pair, shapes: Any, landmarks: np.ndarray | None, seed: int, stages: Any
) -> Row:
    from kfmaps.evaluate import geodesic_errors
    from kfmaps.matching import match

    def named(stage: str, done: float) -> None:
        stages(f"{stage}, {'NO17' if 'NO17' in method else 'kernel'}", done)

    start = time.perf_counter()
    found: Match = match(shapes[0], shapes[1], config, landmarks=landmarks, rng=seed, progress=named)
    seconds = time.perf_counter() - start
    errors, raw = (
        geodesic_errors(pair.source, points, pair.truth)
        for points in (found.target_to_source, found.raw_target_to_source)
    )
    return Row(method, found.target_to_source, errors, float(raw.mean()), seconds, found.solution.status)
