"""``kfmaps learn``: a kernel, a metric and weights from pairs of shapes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fnmatch import fnmatch
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
import typer

from kfmaps._arrays import check_count, refuse
from kfmaps._records import JsonObject
from kfmaps.batch.layout import Pair, ShapeFolder, find_collection
from kfmaps.cli.options import Identity, Json, Quiet, line_numbers
from kfmaps.cli.progress import Stages
from kfmaps.cli.terminal import print_json
from kfmaps.config import Config, DescriptorConfig, Formulation, Weights
from kfmaps.io import atomic_output, check_output, read_mesh, read_vertex_numbers
from kfmaps.io.atomic import write_text
from kfmaps.io.text import check_suffix
from kfmaps.settings import SettingsOptions, settings_text, with_settings
from kfmaps.shape import Shape, prepare

if TYPE_CHECKING:
    from kfmaps.learn import State, TrainingPair


_PARTS = "gamma,metric,terms"

NUMBERS: dict[str, int | float] = {
    **{"pairs": 32, "held_out_pairs": 6, "epochs": 5, "batch": 2, "rate": 0.1, "patience": 3},
    **{"temperature": 0.03, "seconds": float("inf"), "seed": 0},
}
"""Defaults of --training: numbers of pairs, and fields of TrainingOptions."""

_MAX_SAMPLES = 2500  # points of each shape in the fits of learning; matches use the number of the settings
_START = replace(
    Config.single_fit(),
    descriptors=DescriptorConfig(shot=True, n_eigenfunctions=200),
    bandwidth_scale=5.0,
    weights=Weights(descriptors=1000.0, commutativity=1.0, laplacian=300.0),
    formulation=Formulation(mask="resolvent"),
)
"""The settings that learning starts from, with SHOT and the signature. Few strong descriptors need less commutativity
and a sharper kernel."""


@with_settings
def learn(
    data: Annotated[Path, typer.Argument(help="Folder of shapes with true correspondences.", metavar="FOLDER")],
    output: Annotated[
        Path,
        typer.Option(
            "-o",
            "--output",
            help="Settings for kfmaps match --config: .toml, or .pt. Also writes the state (.pt) and a picture (.png).",
        ),
    ],
    truth_landmarks: Annotated[
        str, typer.Option(help="Landmarks: these lines of the truth, counted from 1.", metavar="201,1121,...")
    ],
    settings: SettingsOptions,
    parts: Annotated[str, typer.Option("--learn", metavar="NAMES", help="What to learn.")] = _PARTS,
    shapes: Annotated[str, typer.Option(metavar="PATTERNS", help="Shapes to learn from, as a?,b*.")] = "*",
    held_out: Annotated[
        str,
        typer.Option(
            metavar="PATTERNS", help="Shapes to stop by; default: the last quarter. none: learn from all, to the end."
        ),
    ] = "",
    identity: Identity = False,
    training: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=NUMBER", help="Repeatable: " + ", ".join(f"{k} ({v:g})" for k, v in NUMBERS.items()) + "."
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace existing files and start again.")] = False,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Learn a kernel from pairs of shapes, and write settings for kfmaps match --config.

    Needs PyTorch; what it learns does not, unless it is written as .pt. The same command continues a run that was
    stopped.
    """
    numbers = _numbers(training or [])
    check_suffix(output, (".toml", ".pt"), "output")
    from kfmaps import learn as library  # fails without PyTorch, before any work

    state_file = output.with_suffix(".pt")
    stopped = state_file.is_file() and not force
    for path in {output, state_file, output.with_suffix(".png")}:
        check_output(path, force or stopped)
    rows = [line - 1 for line in line_numbers(truth_landmarks, "--truth-landmarks")]
    requested = settings.config(_START)
    config = replace(requested, fit_samples=min(requested.fit_samples or _MAX_SAMPLES, _MAX_SAMPLES))
    with Stages(quiet or json) as stages:
        folder = find_collection(data)
        training_draw, held_out_draw = _draw(folder, shapes, held_out, numbers)
        prepare = _preparation(folder, config, rows, identity, int(numbers["seed"]))
        all_pairs = []
        for i, pair in enumerate([*training_draw, *held_out_draw]):
            stages("preparing pairs", i / (len(training_draw) + len(held_out_draw)))
            all_pairs.append(prepare(pair))
        pairs, held_out_pairs = all_pairs[: len(training_draw)], all_pairs[len(training_draw) :]
        learned_parts = [word.strip() for word in parts.split(",")]
        model = library.Model(config, pairs, learned_parts)
        option_values = {name: value for name, value in numbers.items() if name not in ("pairs", "held_out_pairs")}
        options = library.TrainingOptions(**option_values)  # pyright: ignore
        # A run is continued by the same request; only its end may differ.
        request = {
            "--learn": learned_parts,
            "pairs": [pair.name for pair in all_pairs],
            "--training": {name: numbers[name] for name in numbers if name not in ("epochs", "patience", "seconds")},
            "settings": settings_text(config, comments=False),
        }
        state = _read_state(state_file, request) if stopped else None

        def write(state: State) -> None:
            best = replace(model.settings(state.best), fit_samples=requested.fit_samples)
            library.save(state_file, state, settings_text(best), request)
            _write(output, best, state)

        state = library.learn(model, pairs, held_out_pairs, options, state=state, on_epoch=write, progress=stages)
    first, best = state.history[0], state.best_epoch
    if json:
        print_json(
            {
                "before": first.held_out,
                "best": best.held_out,
                "epoch": best.number,
                "kernel": repr(model.settings().kernel),
                "output": [output, state_file, output.with_suffix(".png")],
            }
        )
    elif not quiet:
        print(f"held-out pairs: {first.held_out:.5f} before, {best.held_out:.5f} after epoch {best.number}")
        print(f"kernel: {model.settings().kernel!r}", f"settings: {output}", f"state: {state_file}", sep="\n")


def _numbers(assignments: list[str]) -> dict[str, int | float]:
    """Return the numbers of --training, defaults included."""
    numbers = dict(NUMBERS)
    for text in assignments:
        name, _, value = (part.strip() for part in text.partition("="))
        if name not in NUMBERS:
            raise refuse(f"--training {text}", "one of " + ", ".join(NUMBERS), repr(name), "write epochs=5, say")
        numbers[name] = _number(f"--training {name}", value, type(NUMBERS[name]))
    for name in ("pairs", "held_out_pairs"):
        check_count(int(numbers[name]), f"--training {name}")
    return numbers


def _number(name: str, text: str, kind: type) -> int | float:
    try:
        return kind(text)
    except ValueError as error:
        expected = "a whole number" if kind is int else "a number"
        raise refuse(name, expected, repr(text), "write it as NAME=NUMBER") from error


def _draw(
    folder: ShapeFolder, shapes: str, held_out: str, numbers: dict[str, int | float]
) -> tuple[list[Pair], list[Pair]]:
    """Return the pairs to learn from and those held out."""

    def matching(patterns: str) -> list[str]:
        return [name for name in folder.shapes if any(fnmatch(name, p.strip()) for p in patterns.split(","))]

    def draw(names: list[str], count: str, salt: int, option: str) -> list[Pair]:
        if len(names) < 2:
            raise refuse(option, "at least two shapes", f"{len(names)} of {len(folder.shapes)}", "choose others")
        all_pairs = [Pair(a, b) for a in names for b in names if a != b]
        order = np.random.default_rng([int(numbers["seed"]), salt]).permutation(len(all_pairs))
        return [all_pairs[i] for i in order[: int(numbers[count])]]

    names = matching(shapes)
    if held_out:
        held_out_names = matching(held_out)
        names = [name for name in names if name not in held_out_names]
    else:
        names, held_out_names = names[: len(names) - len(names) // 4], names[len(names) - len(names) // 4 :]
    pairs = draw(names, "pairs", 0, "--shapes")
    return pairs, [] if held_out == "none" else draw(held_out_names, "held_out_pairs", 1, "--held-out")


def _preparation(
    folder: ShapeFolder, config: Config, lines: list[int], identity: bool, seed: int
) -> Callable[[Pair], TrainingPair]:
    """Return a function that prepares a pair; each shape is read once."""
    from kfmaps.learn import training_pair

    @cache
    def shape(name: str) -> Shape:
        return prepare(read_mesh(folder.shapes[name]), config, name=name)

    @cache
    def truth(name: str) -> np.ndarray:
        if identity:
            return np.arange(len(shape(name).mesh.vertices))
        if name not in folder.truth:
            raise refuse(f"truth of {name}", "a list of vertices in corres/", "none", "give --shapes, or --identity")
        return read_vertex_numbers(folder.truth[name])

    def prepared(pair: Pair) -> TrainingPair:
        truths = truth(pair.source), truth(pair.target)
        counts = [len(side) for side in truths]
        if counts[0] != counts[1]:
            got = f"{counts[0]} and {counts[1]} lines"
            raise refuse(f"truth of {pair.source} and {pair.target}", "equally many lines", got, "give --shapes")
        if max(lines) >= counts[0]:
            got = f"{counts[0]} lines"
            raise refuse("--truth-landmarks", f"a truth of {max(lines) + 1} lines", got, "choose other lines")
        landmarks = np.stack([side[lines] for side in truths], axis=1)
        sides = shape(pair.source), shape(pair.target)
        return training_pair(*sides, config, landmarks=landmarks, truth=truths, rng=seed)

    return prepared


def _read_state(path: Path, request: JsonObject) -> State:
    """Return the state that an earlier run with the same request left."""
    from kfmaps.learn import load

    state, _, before = load(path)
    differing = [name for name in request if before.get(name) != request[name]]
    if differing:
        remedy = "give the same arguments to continue, --force to start again, or another output"
        raise refuse(f"{path}", "the state of the same run", f"another {', '.join(differing)}", remedy)
    return state


def _write(output: Path, best: Config, state: State) -> None:
    """Write settings and picture."""
    from kfmaps.learn import learning_figure

    if output.suffix == ".toml":
        epoch = state.best_epoch
        head = f"# Learned from pairs of shapes; error in √area: {epoch.held_out:.5f}, epoch {epoch.number}.\n"
        write_text(output, head + settings_text(best), force=True)
    with atomic_output(output.with_suffix(".png"), force=True) as temporary:
        learning_figure(state.history).savefig(temporary, dpi=150)
