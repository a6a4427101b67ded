"""``kfmaps render``: figures for papers, drawn without a display."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Annotated

import typer
from matplotlib.figure import Figure

from kfmaps._arrays import check_positive, refuse
from kfmaps._texts import UNIT, percent
from kfmaps.api import render
from kfmaps.batch.page import mean_error_curve
from kfmaps.batch.results import Result, all_results, summarize
from kfmaps.batch.run_spec import read_run_spec
from kfmaps.batch.work import map_path
from kfmaps.cli.options import Force, Json, MapFile, SourceMesh, TargetMesh, TruthLists
from kfmaps.cli.terminal import report_files
from kfmaps.io import atomic_output, check_map, check_output, load_map
from kfmaps.io.mapfile import map_mesh
from kfmaps.viz import Panel, View, curves_figure, grid_figure, picture_format, save_figure, view_from

app = typer.Typer(help="Figures for papers (PNG, SVG, PDF), drawn without a display.", no_args_is_help=True)

Output = Annotated[Path, typer.Option("-o", "--output", help="The figure: .png, .svg or .pdf.")]
Dpi = Annotated[float, typer.Option(help="Dots per inch, of the surfaces in SVG and PDF too.", min=20, max=2400)]
Title = Annotated[str | None, typer.Option(help="Title of the figure.")]
From = Annotated[
    tuple[float, float, float] | None,
    typer.Option("--from", help="Look at the source from this direction.", metavar="X Y Z"),
]
Up = Annotated[
    tuple[float, float, float] | None,
    typer.Option(help="The upward direction in the picture; with --from.", metavar="X Y Z"),
]


@app.command("pair")
def render_pair(
    map: MapFile,
    output: Output,
    source: SourceMesh = None,
    target: TargetMesh = None,
    truth: TruthLists = None,
    limit: Annotated[float | None, typer.Option(help=f"Error at which the colour scale ends, in {UNIT}.")] = None,
    title: Title = None,
    towards: From = None,
    up: Up = None,
    dpi: Dpi = 300,
    json: Json = False,
    force: Force = False,
) -> None:
    """One map: the source, the target in the source's colours, and the error when the truth is given."""
    _check(output, force, (map, source, target, *(truth or ())))
    if limit is not None:
        limit = check_positive(limit, "--limit") / 100
    figure = render(map, source, target, truth=truth, limit=limit, title=title, view=_view(towards, up))
    _save(figure, output, dpi, json, force)


@app.command("grid")
def render_grid(
    folder: Annotated[Path, typer.Argument(help="Output folder of kfmaps batch.")],
    source: Annotated[str, typer.Option(help="The shape whose colours all targets get.")],
    output: Output,
    targets: Annotated[str | None, typer.Option(help="Comma-separated names; default: all it was matched to.")] = None,
    columns: Annotated[int | None, typer.Option(help="Columns of the figure; default: balanced.")] = None,
    errors: Annotated[bool, typer.Option(help=f"Mean error ({UNIT}) beside each name, where known.")] = True,
    title: Title = None,
    towards: From = None,
    up: Up = None,
    dpi: Dpi = 300,
    json: Json = False,
    force: Force = False,
) -> None:
    """A collection: one source, and its colours on every target that it was matched to."""
    _check(output, force)
    done = [r for r in _results(folder) if r.status == "done" and r.source == source]
    if not done:
        sources = ", ".join(sorted({r.source for r in _results(folder)})[:6]) or "none"
        raise refuse(
            "--source", f"a shape that was matched as a source ({sources})", repr(source), "choose one of them"
        )
    if targets is not None:
        names = [name.strip() for name in targets.split(",") if name.strip()]
        by_name = {r.target: r for r in done}
        missing = [name for name in names if name not in by_name]
        if missing or not names:
            got = repr(missing[0]) if missing else "none"
            raise refuse("--targets", f"shapes that {source} was matched to", got, "check the spelling")
        done = [by_name[name] for name in names]
    source_mesh, panels = None, []
    for result in done:
        path = map_path(folder, result.pair.key)
        match = load_map(path)
        if source_mesh is None:
            source_mesh = map_mesh(None, match, "source", path)
        mesh = map_mesh(None, match, "target", path)
        check_map(match, len(source_mesh.vertices), len(mesh.vertices), str(path), partial=True)
        has_error = errors and result.error_mean is not None
        panels.append(
            Panel(f"{result.target}  {percent(result.error_mean, 1)} %" if has_error else result.target, mesh, match)
        )
    assert source_mesh is not None
    figure = grid_figure(source_mesh, panels, label=source, columns=columns, title=title, view=_view(towards, up))
    _save(figure, output, dpi, json, force)


@app.command("curves")
def render_curves(
    folders: Annotated[list[Path], typer.Argument(help="Output folders of kfmaps batch.")],
    output: Output,
    labels: Annotated[str | None, typer.Option(help="Comma-separated names; default: the folders'.")] = None,
    title: Title = None,
    dpi: Dpi = 300,
    json: Json = False,
    force: Force = False,
) -> None:
    """Error curves of whole runs, each the mean of its pairs, in one figure."""
    _check(output, force)
    names = [folder.resolve().name for folder in folders] if labels is None else [n.strip() for n in labels.split(",")]
    if len(names) != len(folders):
        raise refuse("--labels", f"{len(folders)} names", f"{len(names)}", "give one for each folder")
    curves = []
    for folder, name in zip(folders, names, strict=True):
        results = _results(folder)
        mean = percent(summarize(results)["error_mean"] or 0)
        curve = mean_error_curve(results, f"{name}, mean {mean} %")
        if curve is None:
            raise refuse(f"{folder}", "pairs whose truth is known", "none", "run batch on shapes with truth")
        curves.append(curve)
    _save(curves_figure(curves, title=title), output, dpi, json, force)


def _check(output: Path, force: bool, reads: Iterable[Path | None] = ()) -> None:
    """Check that the figure can be written, before anything is read."""
    picture_format(output)
    check_output(output, force, reads)


def _save(figure: Figure, output: Path, dpi: float, json: bool, force: bool) -> None:
    with atomic_output(output, force) as temporary:
        save_figure(figure, temporary, dpi=dpi)
    report_files(output, as_json=json)


def _results(folder: Path) -> list[Result]:
    return all_results(folder, str(read_run_spec(folder)["digest"]))


def _view(towards: tuple[float, float, float] | None, up: tuple[float, float, float] | None) -> View | None:
    if towards is None:
        if up is not None:
            raise refuse("--up", "--from beside it", "--up alone", "give both")
        return None
    return view_from(towards, (0, 1, 0) if up is None else up)
