"""``kfmaps match``: find the map between two surfaces."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from kfmaps._arrays import KfmapsWarning, MissingDependency, check, refuse
from kfmaps._threads import one_blas_thread
from kfmaps.cli.options import UNSURE, Force, Json, Quiet, Require, TruthLists, check_required, meets
from kfmaps.cli.progress import Stages
from kfmaps.cli.summary import table
from kfmaps.cli.terminal import Terminal, print_json
from kfmaps.config import Config
from kfmaps.descriptors.spectral import check_landmarks
from kfmaps.evaluation import assess_if_reached, read_truth
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import check_output, read_values, save_map
from kfmaps.io.mapcontent import summarize_match
from kfmaps.io.mapfile import check_format, with_files
from kfmaps.io.meshes import read_shape_mesh
from kfmaps.io.named_points import read_given_landmarks
from kfmaps.matching.match import match as find_map
from kfmaps.matching.memory import check_match_memory
from kfmaps.settings import SettingsOptions, with_settings
from kfmaps.shape import lower_to_size, prepare_both

_SIDES = ("source", "target")


@with_settings
def match(
    source: Annotated[Path, typer.Argument(help="A mesh or point cloud.", metavar="SOURCE")],
    target: Annotated[Path, typer.Argument(help="A mesh or point cloud.", metavar="TARGET")],
    settings: SettingsOptions,
    landmarks: Annotated[
        list[Path] | None,
        typer.Option(
            help='Pairs of vertices, "source target" per line, counted from 0; or, given twice, the landmarks of '
            "SOURCE and of TARGET (.mrk.json, .fcsv, .tps, .pts, .csv)."
        ),
    ] = None,
    one_based: Annotated[
        bool, typer.Option("--one-based", help="The landmarks file counts from 1, as .vts does.")
    ] = False,
    output: Annotated[
        Path, typer.Option("-o", "--output", help="The map: .npz or .mat (everything), .txt or .vts (vertices).")
    ] = Path("map.npz"),
    force: Force = False,
    json: Json = False,
    quiet: Quiet = False,
    view: Annotated[bool, typer.Option("--view", help="Show the result in the browser.")] = False,
    seed: Annotated[int, typer.Option(help="For the choice of samples; the same seed, the same map.", min=0)] = 0,
    descriptors: Annotated[
        tuple[Path, Path] | None,
        typer.Option(help="Your own descriptors, one row per vertex (.npy, .csv, .txt).", metavar="SOURCE TARGET"),
    ] = None,
    truth: TruthLists = None,
    require: Require = None,
) -> None:
    """Find for each vertex of the target the corresponding vertex of the source, and write the map."""
    # Check everything that needs no computation first.
    check_format(output)
    check_required(require)
    inputs = (source, target, *(landmarks or ()), *(descriptors or ()), *(truth or ()))
    for path in inputs:
        if not path.exists():
            raise refuse(str(path), "a file", "nothing there", "check the path")
    check_output(output, force, inputs)
    if quiet:
        warnings.simplefilter("ignore", KfmapsWarning)

    config = settings.config(Config())
    _check_device(config.device)
    meshes = read_shape_mesh(source), read_shape_mesh(target)
    pairs = None
    if landmarks:
        pairs = read_given_landmarks(landmarks, meshes, (source, target), one_based or None)[0]
        for vertices, mesh, path in zip(pairs.T, meshes, (source, target), strict=True):
            check_landmarks(vertices, len(mesh.vertices), f"landmarks on {path}")
    n_s, n_t = (len(mesh.vertices) for mesh in meshes)
    check_match_memory(config, n_s, n_t, 0 if pairs is None else len(pairs))
    own_descriptors = None if descriptors is None else _own_descriptors(descriptors, meshes)
    correspondences = read_truth(truth, n_s, n_t)

    seconds: dict[str, float] = {}
    with one_blas_thread(), Stages(quiet or json) as stages:
        names = (str(source), str(target))
        config = lower_to_size(config, *meshes)
        shapes = prepare_both(*meshes, config, names, _with_short_names(stages, names))
        for side, shape in zip(_SIDES, shapes, strict=True):
            seconds |= {f"{stage} of {side}": t for stage, t in shape.seconds.items()}
        result = find_map(
            shapes[0], shapes[1], config, landmarks=pairs, descriptors=own_descriptors, rng=seed, progress=stages
        )
        accuracy = None
        if correspondences is not None:
            stages("evaluation", 0.0)
            accuracy = assess_if_reached(meshes[0], result.target_to_source, correspondences)
            stages("evaluation", 1.0)
    result = with_files(result, (source, target), meshes)
    result = replace(result, seconds={**seconds, **result.seconds})
    save_map(output, result, force)
    if json:
        errors = None if accuracy is None else accuracy.as_dict()
        print_json({**summarize_match(result), "errors": errors, "output": output})
    elif not quiet:
        Terminal().print(table(result, accuracy, output))
    if view:
        from kfmaps.api import map_page
        from kfmaps.viz.result_pages import open_page

        path, has_opened = open_page(map_page(result, truth=truth)[0])
        if not has_opened:
            typer.echo(f"no browser was found; open {path.as_uri()}", err=True)
    if not meets(result.verdict, require):
        raise typer.Exit(UNSURE)


def _with_short_names(stages: Callable[[str, float], None], names: tuple[str, str]) -> Callable[[str, float], None]:
    """Return a progress callback with "source" and "target" in the names of stages instead of long paths."""
    short_names = {f" of {name}": f" of {side}" for name, side in zip(reversed(names), reversed(_SIDES), strict=True)}

    def report(stage: str, done: float) -> None:
        suffix = next((name for name in short_names if stage.endswith(name)), "")
        stages(stage.removesuffix(suffix) + short_names.get(suffix, ""), done)

    return report


def _check_device(device: str) -> None:
    """Raise an error where PyTorch cannot make an array on ``device``."""
    if device == "cpu":
        return
    try:
        import torch
    except ImportError as error:
        remedy = "Install it with: pip install 'kfmaps[gpu]'"
        raise MissingDependency(f"--device {device} needs PyTorch. {remedy}.") from error
    try:
        torch.empty(1, dtype=torch.float64, device="cpu" if device == "torch" else device)
    except Exception as error:  # PyTorch has many errors for a missing device
        got = str(error).partition("\n")[0][:120] or type(error).__name__
        raise refuse(f"--device {device}", "a device that PyTorch can use", got, "use cpu") from error


def _own_descriptors(files: tuple[Path, Path], meshes: tuple[Mesh, Mesh]) -> tuple[np.ndarray, np.ndarray]:
    """Return the user's descriptors (n_s, d) and (n_t, d), checked."""
    descriptors = []
    for file, mesh in zip(files, meshes, strict=True):
        values = read_values(file).array
        if values.dtype.kind not in "biuf":
            raise refuse(f"descriptors {file}", "numbers", f"{values.dtype}", "give one row of numbers per vertex")
        values = values.astype(np.float64)
        values = values[:, None] if values.ndim == 1 else values
        check(values, f"descriptors {file}", shape=(len(mesh.vertices), None), remedy="give one row per vertex")
        descriptors.append(values)
    if descriptors[0].shape[1] != descriptors[1].shape[1]:
        got = f"{descriptors[0].shape[1]} and {descriptors[1].shape[1]}"
        raise refuse("descriptors", "equally many columns on both shapes", got, "compute both alike")
    return descriptors[0], descriptors[1]
