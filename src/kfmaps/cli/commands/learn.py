"""``kfmaps learn``: a kernel, a metric and weights from pairs of shapes."""

from __future__ import annotations

from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kfmaps._arrays import refuse
from kfmaps.learn.names import LOSSES, PARTS
from kfmaps.settings.options import Chosen, with_settings

if TYPE_CHECKING:
    import numpy as np

    from kfmaps.batch.layout import Pair, ShapeFolder
    from kfmaps.config import Config
    from kfmaps.learn.lessons import Lesson
    from kfmaps.learn.model import Model
    from kfmaps.learn.training import State, Training

WITH_TRUTH = {"geodesic": 1.0}
WITHOUT = {"orthogonality": 0.05, "cycle": 0.05, "coupling": 1.0}
KNOWN, UNKNOWN = "gamma,metric,terms", "gamma,ard,terms"
"""What is learned where the truth is known, and else."""
RANK, RANK_ALONE = "2,1,2", "4,1,28"
"""Rows of the metric with landmarks, and without."""
COUNT_ALONE = 30
"""Energies of the signature without landmarks, as many as the search's own fits have."""
POINTS = 2500
"""Of each shape that learning fits maps from; matches take as many as the settings say."""
PART_LIST = "; ".join(f"{name}: {meaning}" for name, meaning in PARTS.items())
LOSS_LIST = "; ".join(f"{name}: {meaning}" for name, meaning in LOSSES.items())


@with_settings
def learn(
    data: Annotated[
        Path,
        typer.Option(help="A folder of shapes, with their true correspondences if there are any.", show_default=False),
    ],
    output: Annotated[
        Path,
        typer.Option(
            "-o",
            "--output",
            help="Settings for kfmaps match --config: .toml, or .pt. Beside it, what --resume needs, and a picture.",
        ),
    ],
    settings: Chosen,
    parts: Annotated[
        str,
        typer.Option(
            "--learn",
            metavar="NAMES",
            show_default=False,
            help=f"What to learn; default: {KNOWN}, where no truth is known {UNKNOWN}. {PART_LIST}.",
        ),
    ] = "",
    losses: Annotated[
        str,
        typer.Option(
            "--loss", metavar="NAMES", show_default=False, help=f"Losses, as NAME or NAME=WEIGHT. {LOSS_LIST}."
        ),
    ] = "",
    shapes: Annotated[str, typer.Option(metavar="PATTERNS", help="Shapes to learn from, as a?,b*.")] = "*",
    held_out: Annotated[
        str,
        typer.Option(
            metavar="PATTERNS",
            show_default=False,
            help="Shapes to stop by; default: the last quarter of those. none: learn from all, to the end.",
        ),
    ] = "",
    pairs: Annotated[int, typer.Option(min=1, help="Pairs to learn from.")] = 32,
    held_out_pairs: Annotated[int, typer.Option(min=1, help="Pairs to stop by.")] = 6,
    truth_landmarks: Annotated[
        str | None,
        typer.Option(help="Landmarks: these lines of the truth, counted from 1.", metavar="201,1121,..."),
    ] = None,
    identity: Annotated[bool, typer.Option("--identity", help="Truth: vertex i is vertex i.")] = False,
    epochs: Annotated[int, typer.Option(min=1, help="Times through all pairs, at most.")] = 5,
    rate: Annotated[float, typer.Option(help="Of learning.")] = 0.1,
    patience: Annotated[int, typer.Option(min=1, help="Epochs without anything better before it stops.")] = 3,
    minutes: Annotated[float | None, typer.Option(help="Time to stay within.", show_default=False)] = None,
    rank: Annotated[
        str,
        typer.Option(
            metavar="NUMBERS",
            show_default=False,
            help="Rows of the metric for the signature, each landmark and SHOT; one number r is r, r / 2 and r. "
            f"Default: {RANK}, without landmarks {RANK_ALONE}.",
        ),
    ] = "",
    resume: Annotated[bool, typer.Option("--resume", help="Go on from where the output's .pt file is.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace existing files.")] = False,
    seed: Annotated[int, typer.Option(min=0, help="For everything that is drawn at random.")] = 0,
    quiet: Annotated[bool, typer.Option("-q", "--quiet", help="Say nothing.")] = False,
) -> None:
    """Learn a kernel from pairs of shapes, and write settings for kfmaps match --config.

    Needs PyTorch; what it learns does not, unless it is written as .pt.
    """
    chosen, limit, rows = _losses(losses), _seconds(minutes), _rank(rank or (RANK if truth_landmarks else RANK_ALONE))
    files = _files(output, force, resume)
    # PyTorch's absence is told before anything is read.
    from kfmaps.cli.progress import Stages
    from kfmaps.learn import Model, Training
    from kfmaps.learn import learn as learned
    from kfmaps.learn.checkpoint import load, save
    from kfmaps.settings.toml import settings_text

    asked = settings.config(_base(truth_landmarks))
    config = _lean(asked)
    task = _task(data, shapes, held_out, pairs, held_out_pairs, truth_landmarks, identity, seed)
    with Stages(quiet) as stages:
        training_pairs, judges = _lessons(task, config, seed, stages)
        known = all(each.known for each in training_pairs)
        chosen = chosen or (WITH_TRUTH if known else WITHOUT)
        names = tuple(part.strip() for part in (parts or (KNOWN if known else UNKNOWN)).split(",") if part.strip())
        model = Model(config, training_pairs, names, rank=rows, seed=seed)
        training = Training(chosen, epochs, rate=rate, patience=patience, seed=seed, seconds=limit)
        # What must be asked for again to go on: everything but when to stop.
        request = {
            "learn": list(names),
            "losses": dict(training.losses),
            "pairs": [each.name for each in training_pairs],
            "held out": [each.name for each in judges],
            "rate": rate,
            "rank": rows,
            "seed": seed,
            "settings": settings_text(config, comments=False),
        }
        state = None
        if resume:
            state, _, before = load(files.state)
            _same_request(before, request, files.state)

        def keep(state: State) -> None:
            best = _asked(_best(model, state), asked)
            save(files.state, state, settings_text(best), request)
            _written(files, best, state, truth=bool(judges) and all(each.known for each in judges), training=training)

        done = learned(model, training_pairs, judges, training, state=state, keep=keep, progress=stages)
    if not quiet:
        _told(done, files, model)


@dataclass(frozen=True)
class _Files:
    """What is written: settings, the state to resume from (the same file when that is asked for), the picture."""

    settings: Path
    state: Path
    picture: Path


def _files(output: Path, force: bool, resume: bool) -> _Files:
    from kfmaps.io import check_output

    if output.suffix not in (".toml", ".pt"):
        raise refuse(f"output {output}", "a name that ends in .toml or .pt", output.suffix or "none", "choose one")
    found = _Files(output, output.with_suffix(".pt"), output.with_suffix(".png"))
    for path in {found.settings, found.state, found.picture}:
        check_output(path, force or resume)
    if resume and not found.state.is_file():
        raise refuse("--resume", "what an earlier run left", f"no file {found.state}", "leave --resume out")
    return found


def _losses(text: str) -> dict[str, float]:
    """``"geodesic,cycle=0.1"`` as names and weights; empty for none."""
    found = {}
    for word in (part.strip() for part in text.split(",") if part.strip()):
        name, sign, weight = word.partition("=")
        try:
            found[name.strip()] = float(weight) if sign else 1.0
        except ValueError as error:
            raise refuse(f"--loss {word}", "NAME or NAME=WEIGHT", repr(weight), "for instance cycle=0.1") from error
    return found


def _seconds(minutes: float | None) -> float | None:
    if minutes is not None and not 0 < minutes < float("inf"):
        raise refuse("--minutes", "a number above zero", repr(minutes), "leave it out for no limit")
    return None if minutes is None else 60 * minutes


def _rank(text: str) -> int | dict[str, int]:
    """``"2,1,2"`` as rows for each kind of descriptors, ``"8"`` as the number."""
    words = [word.strip() for word in text.split(",")]
    if len(words) not in (1, 3) or not all(word.isdecimal() and int(word) > 0 for word in words):
        raise refuse("--rank", "a whole number above zero, or three with commas", repr(text), "for instance 2,1,2")
    numbers = [int(word) for word in words]
    return numbers[0] if len(numbers) == 1 else dict(zip(("signature", "landmark", "shot"), numbers, strict=True))


def _base(truth_landmarks: str | None) -> Config:
    from dataclasses import replace

    from kfmaps.config import Config, DescriptorConfig, Formulation, Weights

    # SHOT tells what the signature cannot, and few strong descriptors want less commutativity and a sharper kernel.
    if not truth_landmarks:
        return replace(Config(), descriptors=DescriptorConfig(count=COUNT_ALONE, shot=True, eigenfunctions=200))
    start = replace(Config.single_fit(), descriptors=DescriptorConfig(shot=True, eigenfunctions=200))
    weights = Weights(descriptors=1000.0, commutativity=1.0, laplacian=300.0)
    return replace(start, sharpness=5.0, weights=weights, formulation=Formulation(mask="resolvent"))


def _lean(config: Config) -> Config:
    """The same from fewer points of each shape: thousands of fits are made."""
    from dataclasses import replace

    return replace(config, fit_samples=min(config.fit_samples or POINTS, POINTS))


def _asked(learned: Config, asked: Config) -> Config:
    """What was learned, for fits from as many points as were asked for."""
    from dataclasses import replace

    return replace(learned, fit_samples=asked.fit_samples)


@dataclass(frozen=True)
class _Task:
    """Where shapes and truths are, and which pairs to take."""

    folder: ShapeFolder
    pairs: list[Pair]
    held_out: list[Pair]
    lines: tuple[int, ...]
    identity: bool


def _task(
    data: Path,
    shapes: str,
    held_out: str,
    count: int,
    held_out_count: int,
    truth_landmarks: str | None,
    identity: bool,
    seed: int,
) -> _Task:
    import numpy as np

    from kfmaps.batch.layout import Pair, find_collection

    folder = find_collection(data)
    names = [name for name in folder.shapes if _like(name, shapes) and not (held_out and _like(name, held_out))]
    if held_out == "none":
        judges = []
    elif held_out:
        judges = [name for name in folder.shapes if _like(name, held_out)]
    else:
        names, judges = names[: len(names) - len(names) // 4], names[len(names) - len(names) // 4 :]
    lines = tuple(int(word) for word in (truth_landmarks or "").split(",") if word.strip().isdecimal())
    if truth_landmarks and (not lines or min(lines) < 1):
        raise refuse("--truth-landmarks", "lines of the truth, with commas", repr(truth_landmarks), "as 201,1121")

    def drawn(some: list[str], count: int, salt: int, flag: str) -> list[Pair]:
        if len(some) < 2:
            raise refuse(flag, "at least two shapes", f"{len(some)} of {len(folder.shapes)}", "choose others")
        every = [Pair(a, b) for a in some for b in some if a != b]
        order = np.random.default_rng([seed, salt]).permutation(len(every))
        return [every[i] for i in order[:count]]

    return _Task(
        folder,
        drawn(names, count, 0, "--shapes"),
        [] if held_out == "none" else drawn(judges, held_out_count, 1, "--held-out"),
        lines,
        identity,
    )


def _like(name: str, patterns: str) -> bool:
    return any(fnmatch(name, pattern.strip()) for pattern in patterns.split(","))


def _lessons(task: _Task, config: Config, seed: int, progress: Any) -> tuple[list[Lesson], list[Lesson]]:
    """The pairs to learn from and those held out; each shape is prepared once."""
    from functools import cache

    import numpy as np

    from kfmaps.io import read_mesh, read_vertex_numbers
    from kfmaps.learn import lesson
    from kfmaps.shape import Shape, prepare

    @cache
    def shape(name: str) -> Shape:
        return prepare(read_mesh(task.folder.shapes[name]), config, name=name)

    @cache
    def truth(name: str) -> np.ndarray | None:
        if task.identity:
            return np.arange(len(shape(name).mesh.vertices))
        path = task.folder.truth.get(name)
        return None if path is None else read_vertex_numbers(path)

    def one(pair: Pair) -> Lesson:
        sides = truth(pair.source), truth(pair.target)
        known = None if sides[0] is None or sides[1] is None else (sides[0], sides[1])
        if known is not None and len(known[0]) != len(known[1]):
            got = f"{len(known[0])} and {len(known[1])} lines"
            raise refuse(f"truth of {pair.source} and {pair.target}", "equally many lines", got, "choose --shapes")
        marks = None
        if task.lines:
            if known is None or max(task.lines) > len(known[0]):
                got = "no truth" if known is None else f"{len(known[0])} lines"
                raise refuse("--truth-landmarks", f"a truth of {max(task.lines)} lines", got, "choose other lines")
            rows = np.array(task.lines) - 1
            marks = np.stack([known[0][rows], known[1][rows]], axis=1)
        return lesson(shape(pair.source), shape(pair.target), config, landmarks=marks, truth=known, rng=seed)

    every = [*task.pairs, *task.held_out]
    found = []
    for i, pair in enumerate(every):
        progress("preparing pairs", i / len(every))
        found.append(one(pair))
    progress("preparing pairs", 1.0)
    return found[: len(task.pairs)], found[len(task.pairs) :]


def _same_request(before: dict[str, Any], now: dict[str, Any], path: Path) -> None:
    differing = [name for name in now if before.get(name) != now[name]]
    if differing:
        remedy = "give the same arguments, or leave --resume out"
        raise refuse(f"--resume {path}", "the run that it belongs to", f"another {', '.join(differing)}", remedy)


def _best(model: Model, state: State) -> Config:
    """The settings of the best parameters; the model itself is left as it is."""
    now = {name: tensor.clone() for name, tensor in model.state_dict().items()}
    model.load_state_dict(state.best)
    found = model.settings()
    model.load_state_dict(now)
    return found


def _written(files: _Files, best: Config, state: State, *, truth: bool, training: Training) -> None:
    """Settings and picture, anew after each epoch."""
    from kfmaps.io import atomic_output
    from kfmaps.learn import learning_figure
    from kfmaps.settings.toml import settings_text

    if files.settings != files.state:
        with atomic_output(files.settings, force=True) as temporary:
            chosen = state.chosen
            what = "error of held-out pairs, in √area" if truth else "loss of held-out pairs"
            head = f"# Learned by {', '.join(training.losses)}; {what}: {chosen.held_out:.5f}, epoch {chosen.number}.\n"
            temporary.write_text(head + settings_text(best), encoding="utf-8")
    figure = learning_figure(state.history, truth=truth)
    with atomic_output(files.picture, force=True) as temporary:
        figure.savefig(temporary, dpi=150)


def _told(state: State, files: _Files, model: Model) -> None:
    from rich.console import Console

    first, best = state.history[0], state.chosen
    console = Console()
    console.print(f"held-out pairs: {first.held_out:.5f} before, {best.held_out:.5f} after epoch {best.number}")
    console.print(f"kernel: {model.settings().kernel!r}", soft_wrap=True, highlight=False)
    console.print(f"settings: {files.settings}", f"picture: {files.picture}", sep="\n", soft_wrap=True)
