"""The Blender add-on: in Blender itself where its module is there, else with the few things of Blender that it uses."""

from __future__ import annotations

import importlib.util
import sys
import types
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from characters import BODY, character
from kfmaps.datasets import ExamplePair, posed_pair
from kfmaps.datasets.creature import DANCE
from kfmaps.fmap.precise import PointMap
from kfmaps.io.bake import encode_png
from kfmaps.io.convert import as_map
from kfmaps.io.record import MeshFile

FILE = Path(__file__).parents[1] / "addons" / "kfmaps_blender.py"
BLENDER = importlib.util.find_spec("bpy") is not None


@pytest.fixture(scope="module")
def addon() -> types.ModuleType:
    spec = importlib.util.spec_from_file_location("kfmaps_blender", FILE)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["kfmaps_blender"] = module  # Blender looks annotations up there
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def pair() -> ExamplePair:
    return posed_pair("character", BODY, {}, DANCE, (1500, 1500), np.random.default_rng(0))


class Items(list):
    """A collection of Blender: of rows that all are read or written at once, or of things with names."""

    kind: Any = None
    active: Any = None

    def foreach_get(self, name: str, values: np.ndarray) -> None:
        values[:] = np.concatenate([np.ravel(getattr(one, name)) for one in self])

    def foreach_set(self, name: str, values: np.ndarray) -> None:
        for one, row in zip(self, np.reshape(values, (len(self), -1)), strict=True):
            setattr(one, name, row)

    def get(self, name: str) -> Any:
        return next((one for one in self if one.name == name), None)

    def new(self, name: str) -> Any:
        self.append(self.kind(name))
        return self[-1]


def rows(name: str, values: Any) -> Items:
    return Items(types.SimpleNamespace(**{name: row}) for row in values)


class Thing:
    """An object with triangles, vertex groups and shape keys."""

    def __init__(self, name: str, shape: MeshFile) -> None:
        self.name, self.active_material = name, None
        faces, data = shape.mesh.faces, types.SimpleNamespace(shape_keys=None, materials=[])
        data.vertices = rows("co", shape.mesh.vertices)
        for i, vertex in enumerate(data.vertices):
            vertex.index, vertex.groups = i, []
        loops = np.arange(faces.size).reshape(-1, 3)
        data.loops = list(loops.ravel())
        data.loop_triangles = Items(
            types.SimpleNamespace(vertices=f, loops=x) for f, x in zip(faces, loops, strict=True)
        )
        data.calc_loop_triangles = data.update = lambda: None
        data.uv_layers = Items()
        data.uv_layers.kind = self._layer
        data.uv_layers.active = None
        self.data = data
        self.vertex_groups = Items()
        self.vertex_groups.kind = self._group
        if shape.uv is not None and shape.uv_faces is not None:
            data.uv_layers.active = self._layer("UVMap")
            data.uv_layers.active.data.foreach_set("uv", shape.uv[shape.uv_faces])

    def _layer(self, name: str) -> Any:
        return types.SimpleNamespace(name=name, data=rows("uv", np.zeros((len(self.data.loops), 2))))

    def _group(self, name: str) -> Any:
        group = types.SimpleNamespace(name=name, index=len(self.vertex_groups))

        def add(vertices: list[int], weight: float, _: str) -> None:
            for vertex in vertices:
                element = types.SimpleNamespace(group=group.index, weight=weight)
                self.data.vertices[vertex].groups.append(element)

        group.add = add
        return group

    def shape_key_add(self, name: str, from_mix: bool) -> Any:
        assert not from_mix
        key = types.SimpleNamespace(name=name, data=rows("co", [vertex.co for vertex in self.data.vertices]))
        if self.data.shape_keys is None:
            self.data.shape_keys = types.SimpleNamespace(key_blocks=Items(), reference_key=key)
        key.relative_key = self.data.shape_keys.reference_key
        self.data.shape_keys.key_blocks.append(key)
        return key


def blender_object(name: str, shape: MeshFile) -> Any:
    """An object of Blender with quads where two triangles follow each other, which its own triangles cut again."""
    import bpy

    data = bpy.data.meshes.new(name)
    data.from_pydata(shape.mesh.vertices.tolist(), [], shape.mesh.faces.tolist())
    item = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(item)
    if shape.uv is not None and shape.uv_faces is not None:
        layer = data.uv_layers.new(name="UVMap")
        layer.data.foreach_set("uv", shape.uv[shape.uv_faces].astype(np.float32).ravel())
    return item


def made(addon: types.ModuleType, name: str, shape: MeshFile, kind: Any) -> Any:
    """An object with everything that the shape has."""
    item = kind(name, shape)
    if shape.skin is not None:
        addon.write_groups(item, list(shape.skin.names), shape.skin.weights)
    if shape.morphs:
        addon.write_keys(item, shape.morphs)
    return item


@pytest.mark.parametrize("kind", [Thing, *([blender_object] if BLENDER else [])])
def test_groups_keys_and_texture_go_over(addon: types.ModuleType, pair: ExamplePair, kind: Any) -> None:
    shape = character(pair.source)
    assert shape.skin is not None
    source = made(addon, "a", shape, kind)
    target = made(addon, "b", MeshFile(pair.target), kind)
    read = addon.read_object(source)
    np.testing.assert_allclose(read.mesh.vertices, pair.source.vertices, atol=1e-6)
    assert list(read.morphs) == list(shape.morphs)
    np.testing.assert_allclose(read.morphs["nod"], shape.morphs["nod"], atol=1e-6)

    with pytest.raises(ValueError, match="press Match"):
        addon.transfer_objects(source, target, texture=True, groups=True, keys=True)
    addon.found["a", "b"] = as_map(PointMap(pair.truth_faces, pair.truth_weights), pair.source)
    output = addon.transfer_objects(source, target, texture=True, groups=True, keys=True)
    assert output == "carried 12 vertex groups, 2 shape keys, texture coordinates"

    names, weights = addon.read_groups(target)
    assert names == list(shape.skin.names)
    np.testing.assert_allclose(weights.sum(axis=1), 1, atol=2e-3)
    corners = shape.skin.weights[pair.source.faces[pair.truth_faces]]
    np.testing.assert_allclose(weights, np.einsum("ti,tij->tj", pair.truth_weights, corners), atol=2e-4)
    carried = addon.read_object(target)
    assert list(carried.morphs) == list(shape.morphs)
    assert np.linalg.norm(carried.morphs["swell"], axis=1).max() == pytest.approx(0.1, rel=0.3)
    np.testing.assert_allclose(carried.mesh.vertices, pair.target.vertices, atol=1e-6)
    layer = target.data.uv_layers.get("kfmaps")
    uv = addon.numbers(layer.data, "uv", 2)
    assert uv.min() >= 0
    assert uv.max() <= 1
    # Again: nothing is doubled.
    addon.transfer_objects(source, target, texture=True, groups=True, keys=True)
    assert len(target.vertex_groups) == 12
    assert len(target.data.shape_keys.key_blocks) == 3
    addon.found.clear()


def test_a_map_of_other_vertices_is_refused(addon: types.ModuleType, pair: ExamplePair) -> None:
    source, target = (made(addon, n, MeshFile(m), Thing) for n, m in (("a", pair.source), ("b", pair.target)))
    addon.found["a", "b"] = as_map(np.zeros(7, dtype=np.int64))
    with pytest.raises(ValueError, match="other vertices"):
        addon.transfer_objects(source, target, texture=True, groups=True, keys=True)
    addon.found.clear()


def test_loops_whose_triangles_disagree_are_told(addon: types.ModuleType, pair: ExamplePair) -> None:
    """Two triangles of one square: the diagonal's loops lie in both."""
    square = MeshFile(
        pair.source, None, np.array([[0.0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.5]]), np.array([[0, 1, 2], [0, 2, 3]])
    )
    loops = np.array([[0, 1, 2], [0, 2, 3]])
    uv, torn = addon.loop_uv(square, loops, 4)
    np.testing.assert_array_equal(uv, [[0, 0], [1, 0], [1, 1], [0, 1]])
    assert len(torn) == 0
    apart = MeshFile(pair.source, None, square.uv, np.array([[0, 1, 2], [4, 2, 3]]))
    assert addon.loop_uv(apart, loops, 4)[1].tolist() == [0]


@pytest.mark.skipif(not BLENDER, reason="Blender as a module (bpy) is not installed")
def test_the_operators_in_blender(addon: types.ModuleType) -> None:
    import bpy

    addon.register()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
    source = bpy.context.active_object
    bpy.ops.mesh.primitive_uv_sphere_add(segments=40, ring_count=20)
    target = bpy.context.active_object
    for item in (source, target):  # an egg with a nose, so that there is one answer
        places = addon.numbers(item.data.vertices, "co", 3).astype(float)
        places *= [1, 1.4, 2]
        places[:, 1] += 0.8 * np.exp(-8 * ((places[:, 2] - 0.7) ** 2 + places[:, 0] ** 2)) * (places[:, 1] > 0)
        places[:, 0] += 0.5 * np.exp(-6 * ((places[:, 2] + 1.0) ** 2 + places[:, 1] ** 2)) * (places[:, 0] > 0)
        item.data.vertices.foreach_set("co", places.astype(np.float32).ravel())
    while target.data.uv_layers:
        target.data.uv_layers.remove(target.data.uv_layers[0])
    addon.write_picture(source, encode_png(np.full((64, 64, 3), 0.5)))
    source.select_set(True)
    target.select_set(True)
    bpy.context.view_layer.objects.active = target
    before = len(target.data.polygons)
    assert bpy.ops.kfmaps.match() == {"FINISHED"}
    assert bpy.ops.kfmaps.transfer() == {"FINISHED"}
    assert before < len(target.data.polygons) < 1.5 * before
    assert len(target.data.vertices) == len(addon.found[source.name, target.name].target_to_source)
    assert target.data.uv_layers.active.name == "kfmaps"
    assert target.data.materials[0].node_tree.nodes["Image Texture"].image.size[1] > 1024
    addon.unregister()
