"""The bars of the main job on research shapes, where there are any: run with KFMAPS_DATA or ../shared/data."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import kfmaps
from kfmaps.io import read_vertex_numbers

pytestmark = [pytest.mark.data, pytest.mark.slow, pytest.mark.timeout(1500)]

LANDMARK_LINES = np.array([201, 1121, 2041, 2961, 3881, 4801]) - 1


@pytest.fixture(scope="module")
def faust(data: Path) -> Path:
    return data / "FAUST_r"


def pairs(folder: Path) -> list[tuple[str, str]]:
    lines = (folder / "test_pairs.txt").read_text(encoding="utf-8").splitlines()
    return [(a, b) for a, b in (line.split() for line in lines[::30])]


@pytest.mark.filterwarnings("ignore::kfmaps.KfmapsWarning")
def test_mean_errors_with_six_landmarks(faust: Path) -> None:
    """Raw map with 100 and with 10 descriptors, and after ZoomOut: mean geodesic error × 100 over seven pairs."""
    config = kfmaps.Config.single_fit()
    assert isinstance(config.refinement, kfmaps.ZoomOut)
    assert config.refinement.stop >= 150
    ten = replace(config, refinement=None, descriptors=replace(config.descriptors, n_spectral=10))
    shapes: dict[str, kfmaps.Shape] = {}
    truths: dict[str, np.ndarray] = {}
    errors: dict[str, list[float]] = {"raw": [], "ten": [], "refined": []}
    for pair in pairs(faust):
        for name in pair:
            if name not in shapes:
                shapes[name] = kfmaps.prepare(kfmaps.read_mesh(faust / f"{name}.ply"), config, name=name)
                truths[name] = read_vertex_numbers(faust / "corres" / f"{name}.vts")
        source, target = (shapes[name] for name in pair)
        true_s, true_t = (truths[name] for name in pair)
        landmarks = np.stack([true_s[LANDMARK_LINES], true_t[LANDMARK_LINES]], axis=1)
        whole = kfmaps.match(source, target, config, landmarks=landmarks)
        fewer = kfmaps.match(source, target, ten, landmarks=landmarks)
        for kind, points in (
            ("raw", whole.fit.raw_target_to_source),
            ("refined", whole.target_to_source),
            ("ten", fewer.target_to_source),
        ):
            assert points is not None
            errors[kind].append(100 * kfmaps.geodesic_errors(source.mesh, points[true_t], true_s).mean())
    means = {kind: float(np.mean(values)) for kind, values in errors.items()}
    print(means)
    assert len(errors["raw"]) == 7
    assert means["raw"] <= 3.1
    assert means["ten"] <= 3.6
    assert means["refined"] <= 1.9
