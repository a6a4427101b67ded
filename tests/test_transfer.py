"""Things carried through points inside triangles: values, named points, colours, textures, and another shape."""

import json
import types
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import kfmaps
from characters import tree_of
from commandline import run
from conftest import corner_uv, known
from kfmaps import datasets
from kfmaps.fmap.precise import PointMap, invert_precise_map, point_positions
from kfmaps.geometry.mesh import Mesh, surface_area, unit_area
from kfmaps.io import MeshFile, load_map, read_mesh_file, read_values, save_map, write_mesh
from kfmaps.io.bake import projected_uv, transfer_uv
from kfmaps.io.glb import format_glb
from kfmaps.io.gltf import parse_gltf
from kfmaps.io.mapfile import with_files
from kfmaps.io.transfer import transfer_by_functions
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import MatchRegistration


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory, poses: datasets.ExamplePair) -> types.SimpleNamespace:
    """A map with points inside triangles, known exactly, between files that it names."""
    folder = tmp_path_factory.mktemp("carried")
    pair = poses
    paths = {side: folder / f"{side}.ply" for side in ("source", "target")}
    write_mesh(paths["source"], pair.source)
    write_mesh(paths["target"], pair.target)
    place = PointMap(pair.truth_faces, pair.truth_weights)
    found = Match(
        pair.truth,
        functional_map=np.eye(30),  # of which only the size counts: the file's bases may have had other signs
        precise_map=place,
        local_confidence=np.linspace(0, 1, len(pair.truth)),
        registration=MatchRegistration(2 * pair.source.vertices),
    )
    save_map(folder / "map.npz", with_files(found, (paths["source"], paths["target"]), (pair.source, pair.target)))
    return types.SimpleNamespace(folder=folder, pair=pair, place=place, paths=paths, map=folder / "map.npz")


def test_coordinates_are_carried_finer_than_vertices(made: types.SimpleNamespace, tmp_path: Path) -> None:
    np.save(tmp_path / "x.npy", made.pair.source.vertices)
    run("transfer", made.map, tmp_path / "x.npy", "-o", tmp_path / "y.npy")
    np.testing.assert_allclose(np.load(tmp_path / "y.npy"), point_positions(made.place, made.pair.source), atol=1e-12)
    labels = np.arange(len(made.pair.source.vertices))
    np.save(tmp_path / "labels.npy", labels)
    run("transfer", made.map, tmp_path / "labels.npy", "-o", tmp_path / "carried.npy")
    np.testing.assert_array_equal(np.load(tmp_path / "carried.npy"), made.pair.truth)


def test_there_and_back_is_where_it_was(made: types.SimpleNamespace, tmp_path: Path) -> None:
    np.save(tmp_path / "y.npy", made.pair.target.vertices)
    run("transfer", made.map, tmp_path / "y.npy", "--back", "-o", tmp_path / "x.npy")
    there = invert_precise_map(made.place, made.pair.source, made.pair.target)
    np.testing.assert_allclose(np.load(tmp_path / "x.npy"), point_positions(there, made.pair.target), atol=1e-12)
    images = point_positions(made.place, made.pair.source)
    again = np.einsum("ti,tij->tj", there.weights, images[made.pair.target.faces[there.faces]])
    off = np.linalg.norm(again - made.pair.source.vertices, axis=1) / np.sqrt(surface_area(made.pair.source))
    assert np.median(off) < 0.005


def test_named_points_go_both_ways(made: types.SimpleNamespace, tmp_path: Path) -> None:
    """By vertex and by place; there and back a point is nearly where it was, in the mesh's unit."""
    source = made.pair.source
    chosen = np.array([3, 400, 900])
    rows = [f"p{v},{v}" for v in chosen]
    (tmp_path / "a.csv").write_text("\n".join(["name,vertex", *rows]) + "\n")
    run("transfer", made.map, tmp_path / "a.csv", "--points", "-o", tmp_path / "b.csv")
    lines = (tmp_path / "b.csv").read_text().splitlines()
    assert lines[0] == "name,vertex,x,y,z,confidence"
    there = [line.split(",") for line in lines[1:]]
    assert [row[0] for row in there] == ["p3", "p400", "p900"]
    assert all(0 <= float(row[5]) <= 1 for row in there)
    (tmp_path / "c.csv").write_text("\n".join(",".join([row[0], *row[2:5]]) for row in there) + "\n")
    run("transfer", made.map, tmp_path / "c.csv", "--points", "--back", "-o", tmp_path / "d.csv")
    back = np.array([line.split(",")[2:5] for line in (tmp_path / "d.csv").read_text().splitlines()[1:]], dtype=float)
    size = np.sqrt(surface_area(source))
    assert np.linalg.norm(back - source.vertices[chosen], axis=1).max() < 0.02 * size


@pytest.mark.parametrize("text", ["a,1\na,2\n", "a,1,2\n", "a,999999\n", "a,1.5\n", "", "a,1\nb\n", "a,nan\n"])
def test_wrong_points_are_refused(made: types.SimpleNamespace, tmp_path: Path, text: str) -> None:
    (tmp_path / "a.csv").write_text(text)
    ran = run("transfer", made.map, tmp_path / "a.csv", "--points", "-o", tmp_path / "b.csv")
    assert ran.status != 0
    assert "expected" in ran.stderr
    assert not (tmp_path / "b.csv").exists()


def test_a_picture_travels_inside_a_glb_and_no_shape_is_named(made: types.SimpleNamespace, tmp_path: Path) -> None:
    run("export", made.map, "-o", tmp_path / "b.glb")
    data = (tmp_path / "b.glb").read_bytes()
    found = read_mesh_file(tmp_path / "b.glb")
    assert len(found.mesh.faces) == len(made.pair.target.faces)
    assert corner_uv(found).shape == (len(found.mesh.faces), 3, 2)
    corners = found.mesh.vertices[found.mesh.faces]
    np.testing.assert_allclose(corners, made.pair.target.vertices[made.pair.target.faces], rtol=1e-6, atol=1e-6)
    tree, size = tree_of(data), int.from_bytes(data[12:16], "little")
    view = tree["bufferViews"][tree["images"][0]["bufferView"]]
    picture = data[28 + size + view["byteOffset"] :][: view["byteLength"]]
    assert picture.startswith(b"\x89PNG")


def test_the_texture_lies_where_the_points_do(made: types.SimpleNamespace) -> None:
    """Coordinates are mixed in triangles; a face over a seam is torn, all others keep to one side of it."""
    source = made.pair.source
    found = transfer_uv(MeshFile(source), made.pair.target, made.place)
    exact = projected_uv(np.vstack([point_positions(made.place, source), source.vertices]))[: len(made.pair.truth)]
    kept = found.uv_faces < len(exact)
    assert kept.mean() > 0.95
    np.testing.assert_allclose(found.uv[found.uv_faces][kept], exact[made.pair.target.faces][kept], atol=1e-9)
    # The same picture cut in two: the upper half moved far away in it.
    up = source.vertices[source.faces].mean(axis=1)[:, 1] > np.median(source.vertices[:, 1])
    n = len(source.vertices)
    cut = MeshFile(
        source,
        uv=np.vstack([projected_uv(source.vertices), projected_uv(source.vertices) + 10]),
        uv_faces=source.faces + n * up[:, None],
    )
    found = transfer_uv(cut, made.pair.target, made.place)
    reach = np.ptp(found.uv[found.uv_faces], axis=1).max(axis=1)
    assert reach[~found.torn].max() < 1  # the halves are 10 apart
    assert 0 < found.torn.mean() < 0.15


def test_a_changed_file_is_told(made: types.SimpleNamespace, tmp_path: Path) -> None:
    found = load_map(made.map)
    changed = replace(found.target_file, sha256="0" * 64)
    save_map(tmp_path / "map.npz", replace(found, target_file=changed))
    assert "has changed" in run("export", tmp_path / "map.npz", "-o", tmp_path / "b.ply").stderr
    assert "changed" not in run("export", made.map, "-o", tmp_path / "c.ply").stderr
    colors = read_mesh_file(tmp_path / "b.ply").colors
    assert len(np.unique(known(colors), axis=0)) > 100


def test_the_source_morphs_into_the_target(made: types.SimpleNamespace, tmp_path: Path) -> None:
    run("export", made.map, "--morph", "-o", tmp_path / "m.glb")
    assert tree_of((tmp_path / "m.glb").read_bytes())["meshes"][0]["weights"] == [0.0]
    moved = read_mesh_file(tmp_path / "m.glb")
    run("export", made.map, "--morph", "-o", tmp_path / "m.ply")
    registered = read_mesh_file(tmp_path / "m.ply").mesh
    np.testing.assert_array_equal(registered.faces, made.pair.source.faces)
    np.testing.assert_allclose(moved.mesh.vertices + moved.morphs["target"], registered.vertices, atol=1e-5)
    inside = (registered.vertices - made.pair.target.vertices.mean(axis=0)) / np.sqrt(surface_area(made.pair.target))
    np.testing.assert_allclose(inside, 2 * made.pair.source.vertices, atol=1e-9)


def test_glb_keeps_colours_and_shape() -> None:
    mesh = unit_area(datasets.sphere(200, rng=0))
    colors = np.random.default_rng(0).uniform(size=(len(mesh.vertices), 3))
    found = parse_gltf(format_glb(MeshFile(mesh, colors)), "x.glb")
    np.testing.assert_array_equal(found.mesh.faces, mesh.faces)
    np.testing.assert_allclose(found.mesh.vertices, mesh.vertices, atol=1e-6)
    assert found.colors is not None
    assert format_glb(MeshFile(Mesh(mesh.vertices, np.zeros((0, 3))))).startswith(b"glTF")


def test_normals_of_a_glb_have_length_one_throughout() -> None:
    data = format_glb(MeshFile(Mesh(np.eye(4, 3), np.array([[0, 1, 2]]))))
    tree, size = tree_of(data), int.from_bytes(data[12:16], "little")
    accessor = tree["accessors"][tree["meshes"][0]["primitives"][0]["attributes"]["NORMAL"]]
    first = 28 + size + tree["bufferViews"][accessor["bufferView"]]["byteOffset"]
    normals = np.frombuffer(data, "<f4", 12, first).reshape(4, 3)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, rtol=1e-6)


def test_values_of_text_files_are_carried_too(made: types.SimpleNamespace, tmp_path: Path) -> None:
    n = len(made.pair.source.vertices)
    (tmp_path / "a.csv").write_text("height\n" + "".join(f"{i}.5\n" for i in range(n)))
    run("transfer", made.map, tmp_path / "a.csv", "-o", tmp_path / "b.csv")
    found = read_values(tmp_path / "b.csv")
    assert found.columns == ("height",)
    wanted = np.einsum("ti,ti->t", made.place.weights, made.pair.source.faces[made.place.faces] + 0.5)
    np.testing.assert_allclose(found.array, wanted)


def test_evaluate_measures_points_in_triangles(made: types.SimpleNamespace, tmp_path: Path) -> None:
    """Against vertices that are the nearest to the truth: their points are off by that rounding and no more."""
    found = json.loads(run("evaluate", made.map, "--json", *truth_files(made, tmp_path)).stdout)
    assert found["mean"] == 0
    assert 0 < found["precise"]["mean"] < 0.02
    assert found["smoothness"]["flipped_area"] < 0.05
    assert found["smoothness"]["coverage"] > 0.9
    shown = run("evaluate", made.map, *truth_files(made, tmp_path)).stdout
    assert "points in triangles" in shown
    assert "turned over" in shown


def truth_files(made: types.SimpleNamespace, folder: Path) -> list[object]:
    np.savetxt(folder / "s.txt", made.pair.truth, fmt="%d")
    np.savetxt(folder / "t.txt", np.arange(len(made.pair.truth)), fmt="%d")
    return ["--truth", folder / "s.txt", folder / "t.txt"]


def test_the_command_carries_functions_with_products(made: types.SimpleNamespace, tmp_path: Path) -> None:
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
    plain = transfer_by_functions(values, load_map(made.map), source, target, 10)
    order = np.random.default_rng(0).permutation(len(target.vertices))
    place = np.argsort(order)
    moved = Match(made.pair.truth[order], functional_map=np.eye(30))
    other = transfer_by_functions(values, moved, source, Mesh(target.vertices[order], place[target.faces]), 10)
    np.testing.assert_allclose(other, plain[order], atol=2e-3 * np.abs(plain).max())


def test_a_transfer_that_is_impossible_is_refused(made: types.SimpleNamespace, tmp_path: Path) -> None:
    source, target = made.pair.source, made.pair.target
    ones = np.ones((len(source.vertices), 1))
    for values, products, words in (
        (np.full(len(source.vertices), "arm"), 5, "to transfer labels"),
        (ones, 31, "at most 30, the functions"),
        (ones[:-1], 5, "one row per source vertex"),
    ):
        with pytest.raises(kfmaps.InvalidInput, match=words):
            transfer_by_functions(values, load_map(made.map), source, target, products)
    part = np.where(np.arange(len(target.vertices)) < 9, -1, made.pair.truth)
    with pytest.raises(kfmaps.InvalidInput, match="a map of the whole target"):
        transfer_by_functions(ones, Match(part), source, target, 5)
    np.save(tmp_path / "x.npy", ones)
    ran = run("transfer", made.map, tmp_path / "x.npy", "-o", tmp_path / "y.npy", "--products", 5, "--back")
    assert "Leave one of them out" in ran.error
