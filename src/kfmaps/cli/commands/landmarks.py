"""``kfmaps landmarks``: pairs picked by hand on a local page, landmarks carried to many scans, and their review."""

from __future__ import annotations

import shutil
import warnings
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from typer.core import TyperGroup

from kfmaps._arrays import KfmapsWarning
from kfmaps.cli.commands._landmarks_transfer import transfer
from kfmaps.cli.options import Json, UpAxis
from kfmaps.cli.terminal import print_json
from kfmaps.config import Config
from kfmaps.io import check_output, read_mesh
from kfmaps.io.mapfile import check_format
from kfmaps.io.named_points import read_given_landmarks
from kfmaps.settings.options import Chosen, with_settings
from kfmaps.viz.document import forwarding_page
from kfmaps.viz.landmark_review import ReviewServer
from kfmaps.viz.page import check_up
from kfmaps.viz.picker import Picker, PickerServer, check_pairs
from kfmaps.viz.result_pages import open_page
from kfmaps.viz.runs import InteractiveMatcher

_Port = Annotated[int, typer.Option(help="Of this machine; 0 takes a free one.", min=0, max=65535)]
_OpenPage = Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page.")]


class _PickByDefault(TyperGroup):
    """``kfmaps landmarks SOURCE TARGET`` is short for ``kfmaps landmarks pick SOURCE TARGET``."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        if args and args[0] not in (*self.commands, *ctx.help_option_names):
            args = ["pick", *args]
        return super().parse_args(ctx, args)


app = typer.Typer(
    cls=_PickByDefault,
    no_args_is_help=True,
    help="Pick landmarks on a local page, carry those of some specimens to a folder of scans, review them.",
)
app.command("transfer")(transfer)


@app.command("pick")
@with_settings
def pick(
    source: Annotated[Path, typer.Argument(help="The source mesh.")],
    target: Annotated[Path, typer.Argument(help="The target mesh.")],
    settings: Chosen,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", help="Where the page saves them; default: landmarks.txt, or the file of --landmarks."
        ),
    ] = None,
    landmarks: Annotated[
        list[Path] | None,
        typer.Option("--landmarks", help="Pairs to begin with; given twice, the landmarks of SOURCE and of TARGET."),
    ] = None,
    map_output: Annotated[
        Path, typer.Option("--map", help="Where the page saves the map of a run: .npz, .mat, .txt or .vts.")
    ] = Path("map.npz"),
    up: UpAxis = None,
    port: _Port = 0,
    browser: _OpenPage = True,
    json: Json = False,
    force: Annotated[bool, typer.Option("--force", help="Save over an existing file without asking.")] = False,
) -> None:
    """Pick landmarks on a local page: click a point on one shape, then its match on the other.

    The settings are those of the matches that are run from the page.
    """
    check_up(up)
    begun = landmarks or []
    output = output or (begun[0] if len(begun) == 1 else Path("landmarks.txt"))
    check_format(map_output)
    for path in (output, map_output):
        # The page asks before it replaces a file, that of the landmarks it began with too; the shapes it never does.
        check_output(path, True, (source, target) if path is output else (source, target, *begun, output))
    with warnings.catch_warnings(action="ignore", category=KfmapsWarning):  # kfmaps match says it, once
        shapes = read_mesh(source), read_mesh(target)
    known, labels = np.zeros((0, 2), dtype=np.int64), []
    if begun:
        known, labels = read_given_landmarks(begun, shapes, (source, target))
    pairs = check_pairs(known.tolist(), *shapes)
    names = (source.stem, target.stem)
    matcher = InteractiveMatcher(shapes, names, (source, target), settings.config(Config()))
    picker = Picker(*shapes, names, output, force, pairs, labels, matcher, map_output, up)
    _serve(PickerServer(picker, port), {"output": [output, map_output]}, browser, json)


@app.command("review")
def review(
    study: Annotated[Path, typer.Argument(help="A folder that landmarks transfer wrote.", metavar="STUDY")],
    up: UpAxis = None,
    port: _Port = 0,
    browser: _OpenPage = True,
    json: Json = False,
) -> None:
    """Look at the landmarks of each specimen on a local page, move those that are wrong, accept those that are right.

    Tables and statistics are written anew at each save. The same landmarks transfer as before keeps the corrections,
    and fits the maps of corrected specimens to them.
    """
    with warnings.catch_warnings(action="ignore", category=KfmapsWarning):  # the study has said it
        _serve(ReviewServer(study, port, up), {"output": [study]}, browser, json)


def _serve(serving: PickerServer | ReviewServer, told: dict[str, object], browser: bool, json: bool) -> None:
    """Say where the page is, open it, and answer until the user interrupts."""
    if json:
        print_json({"address": serving.server.address, **told})
    else:
        typer.echo(serving.server.address)
        typer.echo("Only this machine can reach it, and only with that address. Ctrl-C ends.")
    opened = None
    try:
        if browser:  # by a file: the browser's command line, with a name in it, is there for all users to see
            opened, found = open_page(forwarding_page(serving.server.address))
            if not found and not json:
                typer.echo("No browser was found; open the address yourself.")
        serving.server.serve_forever()
    except KeyboardInterrupt:
        if not json:
            typer.echo("Ended.")
    finally:
        serving.close()
        if opened is not None:
            shutil.rmtree(opened.parent, ignore_errors=True)
