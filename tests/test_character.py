"""Shape keys, skinning weights and skeletons: in from GLB files, over a map, and out again."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from characters import BODY, changed, character, tree_of
from commandline import run
from kfmaps._arrays import InvalidInput
from kfmaps.datasets import ExamplePair, posed_pair
from kfmaps.datasets.creature import DANCE
from kfmaps.fmap.precise import PointMap, vertex_point_map
from kfmaps.geometry.mesh import MIRROR, Mesh, vertex_normals
from kfmaps.io import load_map, read_mesh_file, save_map, write_mesh
from kfmaps.io.character import local_similarities, transfer_character, turn_morph
from kfmaps.io.convert import as_map
from kfmaps.io.glb import format_glb
from kfmaps.io.gltf import parse_gltf
from kfmaps.io.record import MeshFile, Skin

GUARDS = ("kfmaps.io.character", "kfmaps.io.glb", "kfmaps.io.gltf")


@pytest.fixture(scope="module")
def pair() -> ExamplePair:
    """The unbent creature, and the same dancing, meshed otherwise."""
    return posed_pair("character", BODY, {}, DANCE, (1500, 1500), np.random.default_rng(0))


@pytest.fixture(scope="module")
def source(pair: ExamplePair) -> MeshFile:
    return character(pair.source)


def skin_of(shape: MeshFile) -> Skin:
    assert shape.skin is not None
    return shape.skin


def moved_by(mesh: Mesh, turn: np.ndarray, scale: float, shift: np.ndarray) -> Mesh:
    faces = mesh.faces if np.linalg.det(turn) > 0 else mesh.faces[:, ::-1]
    return Mesh(scale * mesh.vertices @ turn.T + shift, faces)


def same(mesh: Mesh) -> PointMap:
    return vertex_point_map(np.arange(len(mesh.vertices)), mesh)


def test_a_character_turns_and_grows_with_the_target(source: MeshFile) -> None:
    turn, shift = Rotation.from_rotvec([0.4, -2, 1]).as_matrix(), np.array([5.0, 1, -2])
    target = moved_by(source.mesh, turn, 3.0, shift)
    made = transfer_character(source, MeshFile(target), as_map(same(source.mesh), source.mesh))
    assert list(made.morphs) == ["swell", "nod"]
    for name, moved in source.morphs.items():
        np.testing.assert_allclose(made.morphs[name], 3 * moved @ turn.T, atol=1e-8)
    assert skin_of(made).names == skin_of(source).names
    np.testing.assert_array_equal(skin_of(made).parents, skin_of(source).parents)
    np.testing.assert_allclose(skin_of(made).weights, skin_of(source).weights, atol=1e-12)
    own, theirs = skin_of(source).matrices, skin_of(made).matrices
    np.testing.assert_allclose(theirs[:, :3, 3], 3 * own[:, :3, 3] @ turn.T + shift, atol=1e-8)
    np.testing.assert_allclose(theirs[:, :3, :3], turn @ own[:, :3, :3], atol=1e-8)


def test_a_mirror_image_has_mirrored_morphs_and_proper_joints(source: MeshFile) -> None:
    target = moved_by(source.mesh, np.diag(MIRROR), 1.0, np.zeros(3))
    points = replace(as_map(same(source.mesh), source.mesh), orientation="reversing")
    made = transfer_character(source, MeshFile(target), points)
    for name, moved in source.morphs.items():
        np.testing.assert_allclose(made.morphs[name], moved * MIRROR, atol=1e-8)
    own, theirs = skin_of(source).matrices, skin_of(made).matrices
    np.testing.assert_allclose(theirs[:, :3, 3], own[:, :3, 3] * MIRROR, atol=1e-8)
    np.testing.assert_allclose(np.linalg.det(theirs[:, :3, :3]), 1, atol=1e-8)


def test_displacements_turn_with_a_bent_arm(pair: ExamplePair, source: MeshFile) -> None:
    """A thickening along the normal stays one along the normal where arms and legs are bent."""
    places = PointMap(pair.truth_faces, pair.truth_weights)
    turns = local_similarities(source.mesh, pair.target, places)
    np.testing.assert_allclose(turns @ turns.transpose(0, 2, 1) / np.linalg.det(turns)[:, None, None] ** (2 / 3),
                               np.tile(np.eye(3), (len(turns), 1, 1)), atol=1e-6)  # fmt: skip
    carried = turn_morph(vertex_normals(source.mesh), source.mesh, places, turns)
    carried /= np.linalg.norm(carried, axis=1, keepdims=True)
    along = (carried * vertex_normals(pair.target)).sum(axis=1)
    plain = turn_morph(vertex_normals(source.mesh), source.mesh, places, np.tile(np.eye(3), (len(turns), 1, 1)))
    unturned = (plain * vertex_normals(pair.target)).sum(axis=1)
    assert np.median(along) > 0.97
    registered = unturned < 0.8
    assert registered.mean() > 0.1
    assert (along[registered] > 0.8).mean() > 0.9


def test_joints_lie_where_the_body_is_bent(pair: ExamplePair, source: MeshFile) -> None:
    places = as_map(PointMap(pair.truth_faces, pair.truth_weights), source.mesh)
    made = skin_of(transfer_character(source, MeshFile(pair.target), places))
    np.testing.assert_allclose(made.weights.sum(axis=1), 1)
    assert made.weights.min() >= 0
    true = BODY.bend(skin_of(source).matrices[:, :3, 3], DANCE)
    off = np.linalg.norm(made.matrices[:, :3, 3] - true, axis=1)
    assert off.max() < 0.1, "the creature is about two high"
    assert off.mean() < 0.05
    np.testing.assert_allclose(np.linalg.det(made.matrices[:, :3, :3]), 1, atol=1e-8)


def test_joints_that_nothing_follows_move_along(source: MeshFile) -> None:
    """One without weight moves with those below it, and a tip with the one above."""
    own = skin_of(source)
    weights = np.hstack([np.zeros((len(own.weights), 1)), own.weights, np.zeros((len(own.weights), 1))])
    matrices = np.concatenate([np.eye(4)[None], own.matrices, own.matrices[-1:]])
    matrices[-1, :3, 3] = [0.66, 0.52, -0.66]
    parents = np.concatenate([[-1], np.where(own.parents < 0, 0, own.parents + 1), [len(own.names)]])
    rig = Skin(("root", *own.names, "tip"), parents, matrices, weights)
    turn = Rotation.from_rotvec([0, 1, 0]).as_matrix()
    target = moved_by(source.mesh, turn, 2.0, np.ones(3))
    made = transfer_character(MeshFile(source.mesh, skin=rig), MeshFile(target), np.arange(len(weights)))
    np.testing.assert_allclose(skin_of(made).matrices[:, :3, 3], 2 * matrices[:, :3, 3] @ turn.T + 1, atol=1e-7)


def test_a_tip_moves_with_the_limb_that_it_ends(pair: ExamplePair, source: MeshFile) -> None:
    """Nothing follows the end of a foot, which is lifted with the leg."""
    own = skin_of(source)
    tip = np.array([0.22, 0.06, 0.19])
    matrices = np.concatenate([own.matrices, np.eye(4)[None]])
    matrices[-1, :3, 3] = tip
    parents = np.append(own.parents, own.names.index("left foot"))
    weights = np.hstack([own.weights, np.zeros((len(own.weights), 1))])
    rig = MeshFile(source.mesh, skin=Skin((*own.names, "tip"), parents, matrices, weights))
    places = as_map(PointMap(pair.truth_faces, pair.truth_weights), source.mesh)
    made = skin_of(transfer_character(rig, MeshFile(pair.target), places))
    assert np.linalg.norm(made.matrices[-1, :3, 3] - BODY.bend(tip[None], DANCE)[0]) < 0.1


def test_a_joint_scaled_to_nothing_is_written(source: MeshFile) -> None:
    own = skin_of(source)
    matrices = own.matrices.copy()
    matrices[3, :3, :3] = 0
    rig = Skin(own.names, own.parents, matrices, own.weights)
    found = skin_of(parse_gltf(format_glb(MeshFile(source.mesh, skin=rig)), "a"))
    np.testing.assert_allclose(found.matrices, matrices, atol=1e-6)


def test_vertices_outside_a_part_stand_still(source: MeshFile) -> None:
    points = np.arange(len(source.mesh.vertices))
    away = source.mesh.vertices[:, 1] < 0.3  # legs
    points[away] = -1
    made = transfer_character(source, MeshFile(source.mesh), points)
    assert not made.morphs["nod"][away].any()
    np.testing.assert_allclose(made.morphs["nod"][~away], source.morphs["nod"][~away], atol=0.02)
    weights = skin_of(made).weights
    np.testing.assert_allclose(weights.sum(axis=1), 1)
    np.testing.assert_allclose(weights[~away], skin_of(source).weights[~away], atol=1e-12)


def test_files_give_back_what_was_written(source: MeshFile) -> None:
    """Also where the texture's seam repeats vertices; four joints of a vertex are kept."""
    found = parse_gltf(format_glb(source), "a.glb")
    rows = np.unique(np.stack([source.mesh.faces.ravel(), np.asarray(source.uv_faces).ravel()], axis=1), axis=0)[:, 0]
    np.testing.assert_allclose(found.mesh.vertices, source.mesh.vertices[rows], atol=1e-6)
    assert list(found.morphs) == list(source.morphs)
    for name, moved in source.morphs.items():
        np.testing.assert_allclose(found.morphs[name], moved[rows], atol=1e-6)
    own, theirs = skin_of(source), skin_of(found)
    assert theirs.names == own.names
    np.testing.assert_array_equal(theirs.parents, own.parents)
    np.testing.assert_allclose(theirs.matrices, own.matrices, atol=1e-6)
    assert (np.count_nonzero(theirs.weights, axis=1) <= 4).all()
    np.testing.assert_allclose(theirs.weights.sum(axis=1), 1)
    assert np.abs(theirs.weights - own.weights[rows]).max() < 0.05


def test_a_rig_with_turned_and_scaled_joints_comes_back(source: MeshFile) -> None:
    own = skin_of(source)
    matrices = own.matrices.copy()
    turns = Rotation.random(len(matrices), rng=np.random.default_rng(0)).as_matrix()
    matrices[:, :3, :3] = 0.01 * turns
    found = parse_gltf(format_glb(MeshFile(source.mesh, skin=Skin(own.names, own.parents, matrices, own.weights))), "a")
    np.testing.assert_allclose(skin_of(found).matrices, matrices, atol=1e-6)
    np.testing.assert_allclose(found.mesh.vertices, source.mesh.vertices, atol=1e-5)


def test_a_posed_file_is_read_as_it_is_shown(source: MeshFile) -> None:
    """The node of a mesh does not place it where joints do; a turned root turns all that follows it."""

    def edit(tree: dict) -> None:
        tree["nodes"][0]["translation"] = [9, 9, 9]
        tree["nodes"][1]["rotation"] = [0, 1, 0, 0]  # half round y, about the joint

    found = parse_gltf(
        changed(format_glb(MeshFile(source.mesh, None, None, None, None, source.morphs, source.skin)), edit), "a"
    )
    joint = skin_of(source).matrices[0, :3, 3]
    turn = np.diag([-1.0, 1, -1])
    np.testing.assert_allclose(found.mesh.vertices, (source.mesh.vertices - joint) @ turn + joint, atol=1e-5)
    np.testing.assert_allclose(found.morphs["nod"], source.morphs["nod"] @ turn, atol=1e-5)
    np.testing.assert_allclose(skin_of(found).matrices[0, :3, :3], turn, atol=1e-6)


def sparse(tree: dict[str, Any], accessor: dict[str, Any], rows: Any, at: Any) -> None:
    """The accessor says only which rows are not zero; the file has both in one more buffer."""
    import base64

    indices, values = np.asarray(at, "<u2").tobytes(), np.asarray(rows, "<f4").tobytes()
    data = indices + b"\0" * (-len(indices) % 4) + values
    tree["buffers"].append({"byteLength": len(data), "uri": "data:;base64," + base64.b64encode(data).decode()})
    view = {"buffer": len(tree["buffers"]) - 1}
    first = len(data) - len(values)
    tree["bufferViews"] += [
        {**view, "byteLength": len(indices)},
        {**view, "byteOffset": first, "byteLength": len(values)},
    ]
    n = len(tree["bufferViews"])
    accessor.pop("bufferView")
    accessor["sparse"] = {
        "count": len(at),
        "indices": {"bufferView": n - 2, "componentType": 5123},
        "values": {"bufferView": n - 1},
    }


def test_sparse_morphs_are_read_as_blender_writes_them(source: MeshFile) -> None:
    glb = format_glb(MeshFile(source.mesh, morphs={"one": source.morphs["swell"]}))

    def edit(tree: dict) -> None:
        target = tree["meshes"][0]["primitives"][0]["targets"][0]["POSITION"]
        sparse(tree, tree["accessors"][target], [[1, 2, 3], [4, 5, 6]], [7, 11])

    moved = parse_gltf(changed(glb, edit), "a.glb").morphs["one"]
    expected = np.zeros_like(moved)
    expected[[7, 11]] = [[1, 2, 3], [4, 5, 6]]
    np.testing.assert_array_equal(moved, expected)


@pytest.mark.parametrize(
    ("part", "edit"),
    [
        ("3 numbers for each vertex", lambda tree: tree["accessors"][-1].update(count=3)),
        ("joints", lambda tree: tree["skins"][0]["joints"].append(99)),
        ("joints", lambda tree: tree["scenes"][0].update(nodes=[0])),
        ("complete", lambda tree: tree["meshes"][0]["primitives"][0]["attributes"].pop("WEIGHTS_0")),
    ],
)
def test_broken_characters_are_refused(source: MeshFile, part: str, edit: Any, tmp_path: Path) -> None:
    shape = MeshFile(source.mesh, None, None, None, None, source.morphs, source.skin)
    glb = format_glb(shape)

    def damaged(tree: dict) -> None:
        last = tree["meshes"][0]["primitives"][0]["targets"][0]["POSITION"]
        tree["accessors"].append(tree["accessors"][last])
        tree["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = len(tree["accessors"]) - 1
        edit(tree)

    (tmp_path / "a.glb").write_bytes(changed(glb, damaged))
    with pytest.raises(InvalidInput, match=part):
        read_mesh_file(tmp_path / "a.glb")


def test_a_character_goes_over_from_the_command_line(pair: ExamplePair, source: MeshFile, tmp_path: Path) -> None:
    (tmp_path / "a.glb").write_bytes(format_glb(source))
    shape = read_mesh_file(tmp_path / "a.glb")
    write_mesh(tmp_path / "b.ply", pair.target)
    save_map(tmp_path / "map.npz", as_map(PointMap(pair.truth_faces, pair.truth_weights), shape.mesh))
    ran = run("export", tmp_path / "map.npz", "-o", tmp_path / "b.glb", "--source", tmp_path / "a.glb",
              "--target", tmp_path / "b.ply", "--texture-size", 512)  # fmt: skip
    assert ran.status == 0, ran.stderr
    tree = tree_of((tmp_path / "b.glb").read_bytes())
    assert tree["meshes"][0]["extras"]["targetNames"] == ["swell", "nod"]
    assert [node["name"] for node in tree["nodes"][1:]] == list(skin_of(shape).names)
    found = read_mesh_file(tmp_path / "b.glb")
    corners = found.mesh.vertices[found.mesh.faces]
    np.testing.assert_allclose(corners, pair.target.vertices[pair.target.faces], atol=1e-5)
    assert load_map(tmp_path / "map.npz").precise_map is not None
