# pyright: strict
"""A user's script in a strict project: ``make lint`` fails where a public name has types that are not known."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import kfmaps
from kfmaps.datasets import two_poses


def heights(mesh: kfmaps.Mesh) -> NDArray[np.float64]:
    return np.asarray(mesh.vertices[:, 1], dtype=np.float64)


def test_a_script(tmp_path: Path) -> None:
    pair = two_poses(1500)
    config = replace(kfmaps.Config.single_fit(), refinement=kfmaps.ZoomOut(start=20, stop=50, step=10))
    landmark_vertices = np.stack([pair.truth[::200], np.arange(len(pair.truth))[::200]], axis=1)
    shapes = [kfmaps.prepare(mesh, config) for mesh in (pair.source, pair.target)]
    result = kfmaps.match(shapes[0], shapes[1], config, landmarks=landmark_vertices)
    result.save(tmp_path / "map.npz")
    loaded: kfmaps.Match = kfmaps.load_map(tmp_path / "map.npz")
    carried = kfmaps.transfer(heights(pair.source), loaded)
    errors: NDArray[np.float64] = kfmaps.geodesic_errors(pair.source, loaded, pair.truth)
    basis = kfmaps.laplace_basis(pair.source, 20)
    points = kfmaps.to_points(np.eye(20), basis, basis)
    sure: float | None = result.confidence
    words = [result.verdict, f"{errors.mean():.3f}", str(carried.dtype), str(points.shape)]
    figure = kfmaps.render(loaded, pair.source, pair.target, output=tmp_path / "pair.png")
    page = result.view(output=tmp_path / "page.html", descriptors=False)
    assert sure is None
    assert page is not None
    assert page.exists()
    assert words[0] == "landmarks"
    assert len(figure.axes) == 2
    assert errors.mean() < 0.05
