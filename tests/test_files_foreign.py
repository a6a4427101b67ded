"""STL and glTF."""

from __future__ import annotations

import base64
import json
import re
import warnings
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from trimesh.exchange.gltf import export_gltf
from trimesh.visual import TextureVisuals

from characters import changed
from conftest import corner_uv, fibonacci_sphere, known, refusal
from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps.geometry.mesh import Mesh, face_normals
from kfmaps.geometry.topology import topology
from kfmaps.io import read_mesh, read_mesh_file
from kfmaps.io.gltf import buffer_files

MESH = fibonacci_sphere(30)
SINGLE = MESH.vertices.astype(np.float32).astype(np.float64)  # both formats keep 32 bits


def exported(mesh: Mesh | trimesh.Scene, kind: str, **more: Any) -> bytes:
    """What trimesh writes."""
    shape = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False, **more) if isinstance(mesh, Mesh) else mesh
    content = shape.export(file_type=kind)
    assert isinstance(content, bytes)
    return content


def scene_of(*transforms: np.ndarray) -> trimesh.Scene:
    scene = trimesh.Scene()
    for transform in transforms:
        scene.add_geometry(trimesh.Trimesh(MESH.vertices, MESH.faces, process=False), transform=transform)
    return scene


refused = partial(refusal, read_mesh)
BINARY_STL = exported(MESH, "stl")


def text_stl(name: str = "", line_end: str = "\n", indent: str = "") -> bytes:
    """The mesh as text, in two solids, with every digit."""
    lines = []
    for part in np.split(MESH.vertices[MESH.faces], [5]):
        lines.append(f"solid {name}")
        for facet in part.tolist():
            lines += ["facet normal 0 0 1", "outer loop"]
            lines += [f"{indent}vertex {x!r} {y!r} {z!r}" for x, y, z in facet]
            lines += ["endloop", "endfacet"]
        lines.append(f"endsolid {name}")
    return (line_end.join(lines)).encode()


def check_joined(mesh: Mesh, places: np.ndarray) -> None:
    """The surface is whole again, its triangles as before, its vertices in the order of first occurrence."""
    np.testing.assert_array_equal(mesh.vertices[mesh.faces], places[MESH.faces])
    _, first = np.unique(mesh.faces, return_index=True)
    assert (np.diff(first) > 0).all()
    assert len(mesh.vertices) == len(places)
    assert topology(mesh).genus == 0


@pytest.mark.parametrize("name", ["", "thing", "a vertex facet solid 1 2 3"])
@pytest.mark.parametrize("line_end", ["\n", "\r\n"])
def test_text_stl(tmp_path: Path, name: str, line_end: str) -> None:
    (tmp_path / "a.stl").write_bytes(text_stl(name, line_end, "   "))
    check_joined(read_mesh(tmp_path / "a.stl"), MESH.vertices)


@pytest.mark.parametrize("start", [b"", b"solid "])
def test_binary_stl(tmp_path: Path, start: bytes) -> None:
    (tmp_path / "a.STL").write_bytes(start + BINARY_STL[len(start) :])
    check_joined(read_mesh(tmp_path / "a.STL"), SINGLE)


def test_zeros_of_either_sign_are_one_place(tmp_path: Path) -> None:
    text = (
        b"solid\n"
        + 2 * b"facet normal 0 0 1\nouter loop\nvertex %s 0 0\nvertex 1 %s 0\nvertex 0 1 0\nendloop\nendfacet\n"
    )
    (tmp_path / "a.stl").write_bytes(text % (b"0", b"-0", b"-0.0", b"0") + b"endsolid")
    with pytest.warns(KfmapsWarning):
        assert len(read_mesh(tmp_path / "a.stl").vertices) == 3


def test_cut_stl(tmp_path: Path) -> None:
    for content in (BINARY_STL, text_stl()):
        last = len(content) - (len(b"endsolid ") if content.startswith(b"solid") else 0)
        for cut in (*range(1, 200, 7), *range(200, last, 97), *range(last - 60, last)):
            assert "expected" in refused(tmp_path / "a.stl", content[:cut]), cut


@pytest.mark.parametrize(
    ("content", "part"),
    [
        (b"\x01" * 100, "100 bytes for 16843009 triangles"),
        (b"x", "got 1 bytes"),
        (BINARY_STL + b"x", "50 per triangle"),
        (bytes(84), "expected vertices, got none"),
        (b"solid\nendsolid\n", "expected vertices, got none"),
        (text_stl().replace(b"endloop\n", b"", 1), "facets of three vertices"),
        (text_stl().replace(b"endsolid", b"solid", 1), "facets of three vertices"),
        (text_stl().replace(b"vertex ", b"vertex x", 1), "expected numbers"),
        (re.sub(rb"vertex \S+", b"vertex nan", text_stl(), count=1), "expected finite"),
        (re.sub(rb"vertex \S+", b"vertex", text_stl(), count=1), "facets of three"),
        (BINARY_STL[:96] + np.float32(np.nan).tobytes() + BINARY_STL[100:], "expected finite"),
    ],
)  # fmt: skip
def test_bad_stl(tmp_path: Path, content: bytes, part: str) -> None:
    assert part in refused(tmp_path / "a.stl", content)


GLB = exported(MESH, "glb")


def test_nothing_is_merged_or_dropped(tmp_path: Path) -> None:
    torn = Mesh(np.vstack([MESH.vertices, MESH.vertices[:2]]), np.vstack([MESH.faces, [[3, 3, 4]]]))
    (tmp_path / "a.glb").write_bytes(exported(torn, "glb"))
    with pytest.warns(KfmapsWarning, match=r"2 duplicated vertices|without area|no face uses"):
        mesh = read_mesh(tmp_path / "a.glb")
    np.testing.assert_array_equal(mesh.vertices, torn.vertices.astype(np.float32))
    np.testing.assert_array_equal(mesh.faces, torn.faces)


def test_gltf_embedded_and_beside(tmp_path: Path) -> None:
    embedded = export_gltf(scene_of(np.eye(4)), embed_buffers=True)["model.gltf"]
    (tmp_path / "a.gltf").write_bytes(embedded)
    np.testing.assert_array_equal(read_mesh(tmp_path / "a.gltf").vertices, SINGLE)
    for name, content in export_gltf(scene_of(np.eye(4))).items():
        (tmp_path / name).write_bytes(content)
    np.testing.assert_array_equal(read_mesh(tmp_path / "model.gltf").faces, MESH.faces)
    beside = buffer_files((tmp_path / "model.gltf").read_bytes(), str(tmp_path / "model.gltf"))
    assert sorted(beside) == sorted(tmp_path.glob("*.bin"))
    beside[0].unlink()
    assert "nothing there" in refused(tmp_path / "model.gltf", (tmp_path / "model.gltf").read_bytes())


@pytest.mark.parametrize("uri", ["/dev/zero", "../a.bin", "file:///dev/zero", "http://a/b", "a\\b", "%2Fdev%2Fzero"])
def test_gltf_reads_nothing_elsewhere(tmp_path: Path, uri: str) -> None:
    text = json.dumps({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 1, "uri": uri}]})
    assert "a file beside it" in refused(tmp_path / "a.gltf", text.encode())
    (tmp_path / "zero.bin").symlink_to("/dev/zero")
    text = json.dumps({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 1, "uri": "zero.bin"}]})
    assert "a device" in refused(tmp_path / "a.gltf", text.encode())


def test_gltf_strips_quantised_colors_and_nested_nodes(tmp_path: Path) -> None:
    """Two triangles of a strip that face the same way, colours as bytes, moved by a node and turned by its child."""
    places = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], "<f4")
    tints = np.array([[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [51, 51, 51, 255]], "u1")
    content = base64.b64encode(places.tobytes() + tints.tobytes()).decode()
    half = float(np.sqrt(0.5))
    tree = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 64, "uri": "data:application/octet-stream;base64," + content}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 16}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5121, "count": 4, "type": "VEC4", "normalized": True},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 1}, "mode": 5}]}],
        "nodes": [{"translation": [0, 0, 5], "children": [1]}, {"rotation": [0, 0, half, half], "mesh": 0}],
    }
    (tmp_path / "a.gltf").write_text(json.dumps(tree))
    with pytest.warns(KfmapsWarning, match="boundary"):
        found = read_mesh_file(tmp_path / "a.gltf")
    np.testing.assert_allclose(found.mesh.vertices, [[0, 0, 5], [0, 1, 5], [-1, 0, 5], [-1, 1, 5]], atol=1e-12)
    np.testing.assert_allclose(face_normals(found.mesh), [[0, 0, 1], [0, 0, 1]], atol=1e-12)
    np.testing.assert_allclose(known(found.colors), tints[:, :3] / 255)
    tree["nodes"][1]["children"] = [0]
    assert "form a tree" in refused(tmp_path / "a.gltf", json.dumps({**tree, "scenes": [{"nodes": [0]}]}).encode())


def copies(vertices: int, parts: int, nodes: int) -> bytes:
    """A file that shows a mesh of equal parts at so many nodes."""
    places = np.zeros((vertices, 3), "<f4").tobytes()
    tree = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(places), "uri": "data:;base64," + base64.b64encode(places).decode()}],
        "bufferViews": [{"buffer": 0, "byteLength": len(places)}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": vertices, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}] * parts}],
        "nodes": [{"mesh": 0}] * nodes,
        "scenes": [{"nodes": list(range(nodes))}],
    }
    return json.dumps(tree).encode()


@pytest.mark.parametrize(("vertices", "parts", "nodes"), [(99, 1, 50_000), (20_000, 2000, 20)])
def test_gltf_of_more_copies_than_anybody_means_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, vertices: int, parts: int, nodes: int
) -> None:
    """Nodes may show a mesh as often as they like; the file is refused before any copy is made."""
    monkeypatch.setattr("kfmaps.io.gltf._Scene.numbers", lambda *_: pytest.fail("numbers were read"))
    output = refused(tmp_path / "a.gltf", copies(vertices, parts, nodes))
    assert "at most 4,000,000 vertices and corners that nodes repeat" in output
    assert "Export each shape once" in output


def test_gltf_that_does_not_fit_into_memory_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("kfmaps._memory._installed_memory", lambda: 1 << 20)
    assert "got 5 MB for 20,000 vertices and corners of 1 parts" in refused(tmp_path / "a.gltf", copies(20_000, 1, 1))


def test_parts_follow_in_order_and_are_placed(tmp_path: Path) -> None:
    there, mirror = trimesh.transformations.translation_matrix([5, 0, 0]), np.diag([-2.0, 2.0, 2.0, 1.0])
    (tmp_path / "a.glb").write_bytes(exported(scene_of(there, mirror), "glb"))
    with pytest.warns(KfmapsWarning, match="2 components"):
        mesh = read_mesh(tmp_path / "a.glb")
    n, f = len(MESH.vertices), len(MESH.faces)
    np.testing.assert_allclose(mesh.vertices[:n], MESH.vertices + np.array([5, 0, 0]), atol=1e-6)
    np.testing.assert_allclose(mesh.vertices[n:], MESH.vertices * [-2, 2, 2], atol=1e-6)
    np.testing.assert_array_equal(mesh.faces[:f], MESH.faces)
    np.testing.assert_array_equal(np.sort(mesh.faces[f:], axis=1), np.sort(MESH.faces, axis=1) + n)
    outward = (face_normals(mesh) * mesh.vertices[mesh.faces[:, 0]]).sum(axis=1)[f:]
    assert (outward > 0).all()


def test_glb_colors_and_texture(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    colors = rng.integers(0, 256, (len(MESH.vertices), 4)).astype(np.uint8)
    (tmp_path / "a.glb").write_bytes(exported(MESH, "glb", vertex_colors=colors))
    found = read_mesh_file(tmp_path / "a.glb")
    np.testing.assert_allclose(known(found.colors), colors[:, :3] / 255)
    uv = rng.random((len(MESH.vertices), 2))
    (tmp_path / "b.glb").write_bytes(exported(MESH, "glb", visual=TextureVisuals(uv=uv)))
    found = read_mesh_file(tmp_path / "b.glb")
    np.testing.assert_allclose(corner_uv(found), uv[MESH.faces], atol=1e-6)


def test_cut_glb(tmp_path: Path) -> None:
    for cut in (*range(1, 60), *range(60, len(GLB), 61), len(GLB) - 1):
        assert "expected" in refused(tmp_path / "a.glb", GLB[:cut]), cut


def primitive(tree: dict[str, Any]) -> dict[str, Any]:
    return tree["meshes"][0]["primitives"][0]


def accessor(tree: dict[str, Any], **more: Any) -> None:
    tree["accessors"][primitive(tree)["attributes"]["POSITION"]].update(more)


@pytest.mark.parametrize(
    ("change", "part"),
    [
        (lambda t: t["accessors"][0].pop("bufferView"), "Export it without compression"),
        (lambda t: accessor(t, sparse={}), "Export it without compression"),
        (
            lambda t: t["bufferViews"][0].update(extensions={"EXT_meshopt_compression": {"buffer": 0}}),
            "compressed data (EXT_meshopt_compression). Export it without compression",
        ),
        (lambda t: t.update(extensionsRequired=["KHR_draco_mesh_compression"]), "Export it without compression"),
        (lambda t: t.update(extensionsRequired=["EXT_mesh_gpu_instancing"]), "the extension EXT_mesh_gpu_instancing"),
        (lambda t: accessor(t, componentType=5123), "Export it unquantised"),
        (lambda t: accessor(t, count=3), "part 0: expected corners of faces from 0 to 2, for it has 3 vertices"),
        (lambda t: accessor(t, count=10**9), "complete glTF 2.0 file"),
        (lambda t: t["accessors"][primitive(t)["indices"]].update(componentType=5126), "unsigned vertex numbers"),
        (lambda t: primitive(t).update(mode=6), "Export it as triangles"),
        (lambda t: primitive(t).update(mode=1), "vertices, got none"),
        (lambda t: t.update(meshes=[]), "complete .glb file"),
        (lambda t: t.pop("bufferViews"), "complete .glb file"),
    ],
)
def test_bad_glb(tmp_path: Path, change: Any, part: str) -> None:
    assert part in refused(tmp_path / "a.glb", changed(GLB, change))


STRANGE = [None, -1, 0, 1, 2**31, 10**30, 1.5, float("nan"), "", "a", [], {}, [[]], True, "VEC2", 5120, 5125, [1] * 16]


def test_glb_with_other_values_in_its_tree(tmp_path: Path) -> None:
    """Whatever stands where: a mesh, or a line that says what is wrong."""
    rng = np.random.default_rng(0)

    def places(tree: Any) -> list[tuple[Any, Any]]:
        inside = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
        return [place for key, value in inside for place in ((tree, key), *places(value))]

    def change(tree: dict[str, Any]) -> None:
        found = places(tree)
        for i in rng.choice(len(found), 2):
            where, key = found[i]
            where[key] = STRANGE[rng.integers(len(STRANGE))]

    outcomes = set()
    for _ in range(300):
        (tmp_path / "a.glb").write_bytes(changed(GLB, change))
        with warnings.catch_warnings(action="ignore", category=KfmapsWarning):
            try:
                outcomes.add(len(read_mesh(tmp_path / "a.glb").vertices) > 0)
            except InvalidInput as error:
                outcomes.add("\n" not in str(error))
    assert outcomes == {True}


def test_glb_of_another_version_or_none_at_all(tmp_path: Path) -> None:
    assert "version 1" in refused(tmp_path / "a.glb", GLB[:4] + b"\1" + GLB[5:])
    assert "complete .glb file" in refused(tmp_path / "a.glb", b"hello")
    assert "complete .gltf file" in refused(tmp_path / "a.gltf", b"[]")
    assert "got version 1.0" in refused(tmp_path / "a.gltf", b'{"asset": {"version": "1.0"}}')
    assert "as it says" in refused(tmp_path / "a.glb", GLB + b"x")
