"""Functions carried by the functional map of a file, with products of eigenfunctions."""

import types
from pathlib import Path

import numpy as np
import pytest

from commandline import run
from kfmaps import datasets
from kfmaps._arrays import InvalidInput
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import save_map, write_mesh
from kfmaps.io.mapfile import with_files
from kfmaps.io.transfer import transfer_by_functions
from kfmaps.matching.result import Match


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory, poses: datasets.ExamplePair) -> types.SimpleNamespace:
    folder = tmp_path_factory.mktemp("functions")
    pair = poses
    paths = {side: folder / f"{side}.ply" for side in ("source", "target")}
    write_mesh(paths["source"], pair.source)
    write_mesh(paths["target"], pair.target)
    small = np.eye(30)  # of the file's map only the size counts: its bases may have had other signs
    found = Match(pair.truth, functional_map=small)
    found = with_files(found, (paths["source"], paths["target"]), (pair.source, pair.target))
    save_map(folder / "map.npz", found)
    return types.SimpleNamespace(pair=pair, found=found, map=folder / "map.npz")


def test_the_command_carries_functions_with_products(made: types.SimpleNamespace, tmp_path: Path) -> None:
    """Smooth functions come out as they are at the true points, and the better the more products there are."""
    values = made.pair.source.vertices - made.pair.source.vertices.mean(axis=0)
    np.save(tmp_path / "x.npy", values)
    errors = {}
    for products in (2, 20):
        run("transfer", made.map, tmp_path / "x.npy", "-o", tmp_path / "y.npy", "--products", products, "--force")
        errors[products] = np.linalg.norm(np.load(tmp_path / "y.npy") - values[made.pair.truth])
    size = np.linalg.norm(values[made.pair.truth])
    assert errors[20] < 0.08 * size
    assert errors[20] < 0.95 * errors[2]


def test_a_permutation_of_the_target_permutes_what_is_carried(made: types.SimpleNamespace) -> None:
    source, target = made.pair.source, made.pair.target
    values = np.cos(3 * source.vertices[:, :1])
    plain = transfer_by_functions(values, made.found, source, target, 10)
    order = np.random.default_rng(0).permutation(len(target.vertices))
    place = np.argsort(order)
    moved = Match(made.pair.truth[order], functional_map=made.found.functional_map)
    other = transfer_by_functions(values, moved, source, Mesh(target.vertices[order], place[target.faces]), 10)
    np.testing.assert_allclose(other, plain[order], atol=2e-3 * np.abs(plain).max())


def test_what_cannot_be_is_said(made: types.SimpleNamespace, tmp_path: Path) -> None:
    source, target = made.pair.source, made.pair.target
    ones = np.ones((len(source.vertices), 1))
    for values, products, words in (
        (np.full(len(source.vertices), "arm"), 5, "to transfer labels"),
        (ones, 31, "at most 30, the functions"),
        (ones[:-1], 5, "one row per source vertex"),
    ):
        with pytest.raises(InvalidInput, match=words):
            transfer_by_functions(values, made.found, source, target, products)
    part = np.where(np.arange(len(target.vertices)) < 9, -1, made.pair.truth)
    with pytest.raises(InvalidInput, match="a map of the whole target"):
        transfer_by_functions(ones, Match(part), source, target, 5)
    np.save(tmp_path / "x.npy", ones)
    ran = run("transfer", made.map, tmp_path / "x.npy", "-o", tmp_path / "y.npy", "--products", 5, "--back")
    assert "Leave one of them out" in ran.error
