"""Blender add-on: match two objects, then carry the texture, vertex groups and shape keys of one to the other.

Install kfmaps into Blender's Python, then this file in Preferences > Add-ons > Install from Disk. Select the object
that has everything, then, with Shift, the one that gets it, and press Match in the sidebar's tab "kfmaps" (key N).
"""

from __future__ import annotations

import importlib
import importlib.util
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps import Mesh, match
from kfmaps.io import MeshFile, transfer
from kfmaps.io.character import transfer_character
from kfmaps.io.export import with_source_texture
from kfmaps.io.record import Picture
from kfmaps.matching.result import Match

# pyright: reportInvalidTypeForm=false
# The tests run all but the operators without Blender.
bpy: Any = importlib.import_module("bpy") if importlib.util.find_spec("bpy") else None

bl_info = {
    "name": "kfmaps",
    "author": "The kfmaps developers",
    "version": (0, 1, 0),
    "blender": (4, 2, 0),
    "location": "View3D > Sidebar > kfmaps",
    "description": "Carry textures, vertex groups and shape keys to another mesh of the same kind of thing",
    "category": "Object",
}
LEAST = 1e-4
"""Weights below it are not written."""
NAME = "kfmaps"
"""Of the texture coordinates, the image and the material that are made."""

found: dict[tuple[str, str], Match] = {}
"""The maps of this session, by the names of source and target."""


def numbers(collection: Any, attribute: str, width: int, kind: str = "f4") -> np.ndarray:
    """Return an attribute of all items of a collection of Blender, (n, width)."""
    values = np.zeros(len(collection) * width, dtype=kind)
    collection.foreach_get(attribute, values)
    return values.reshape(-1, width)


def read_mesh(item: Any) -> tuple[Mesh, np.ndarray]:
    """Return an object's mesh, without modifiers, in its own coordinates, and the loops (f, 3) of its triangles."""
    data = item.data
    keys = data.shape_keys
    places = numbers(data.vertices if keys is None else keys.reference_key.data, "co", 3)
    data.calc_loop_triangles()
    faces, loops = (numbers(data.loop_triangles, name, 3, "i4") for name in ("vertices", "loops"))
    return Mesh(places.astype(np.float64), faces.astype(np.int64)), loops.astype(np.int64)


def read_object(item: Any) -> MeshFile:
    """Return an object's mesh with its texture coordinates, the picture of its material, and its shape keys."""
    mesh, loops = read_mesh(item)
    keys = item.data.shape_keys
    blocks = [] if keys is None else [key for key in keys.key_blocks if key != keys.reference_key]
    morphs = {key.name: numbers(key.data, "co", 3) - numbers(key.relative_key.data, "co", 3) for key in blocks}
    layer = item.data.uv_layers.active
    uv = None if layer is None else numbers(layer.data, "uv", 2).astype(np.float64)
    return MeshFile(mesh, None, uv, None if uv is None else loops, picture_of(item), morphs)


def picture_of(item: Any) -> Picture | None:
    """Return the image that the active material's base colour is linked to, as PNG."""
    material = item.active_material
    nodes = [] if material is None or material.node_tree is None else material.node_tree.nodes
    for node in nodes:
        if node.type == "BSDF_PRINCIPLED" and node.inputs["Base Color"].links:
            image = getattr(node.inputs["Base Color"].links[0].from_node, "image", None)
            if image is not None:
                with tempfile.TemporaryDirectory() as folder:
                    copy = image.copy()
                    copy.filepath_raw, copy.file_format = f"{folder}/picture.png", "PNG"
                    copy.save()
                    bpy.data.images.remove(copy)
                    return Picture((Path(folder) / "picture.png").read_bytes(), "image/png")
    return None


def read_groups(item: Any) -> tuple[list[str], np.ndarray]:
    """Return the names of an object's vertex groups and the weights (n, groups)."""
    weights = np.zeros((len(item.data.vertices), len(item.vertex_groups)))
    for vertex in item.data.vertices:
        for element in vertex.groups:
            weights[vertex.index, element.group] = element.weight
    return [group.name for group in item.vertex_groups], weights


def write_groups(item: Any, names: list[str], weights: np.ndarray) -> None:
    """Give an object vertex groups of these names; others of it stay."""
    for name, values in zip(names, weights.T, strict=True):
        group = item.vertex_groups.get(name)
        if group is not None:
            item.vertex_groups.remove(group)
        group = item.vertex_groups.new(name=name)
        for vertex in np.flatnonzero(values > LEAST):
            group.add([int(vertex)], float(values[vertex]), "REPLACE")


def write_keys(item: Any, morphs: dict[str, np.ndarray]) -> None:
    """Give an object shape keys of these names, displacements (n, 3); those of the same names are replaced."""
    if item.data.shape_keys is None:
        item.shape_key_add(name="Basis", from_mix=False)
    keys: Any = item.data.shape_keys
    rest = numbers(keys.reference_key.data, "co", 3)
    for name, moved in morphs.items():
        key = keys.key_blocks.get(name) or item.shape_key_add(name=name, from_mix=False)
        key.data.foreach_set("co", (rest + moved).astype(np.float32).ravel())
    item.data.update()


def loop_uv(made: MeshFile, loops: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return coordinates for each of ``count`` loops, (count, 2), and the loops whose triangles want several."""
    assert made.uv is not None
    assert made.uv_faces is not None
    uv = np.zeros((count, 2))
    wanted = made.uv[made.uv_faces]
    uv[loops] = wanted
    return uv, np.unique(loops[(np.abs(uv[loops] - wanted) > 1e-6).any(axis=2)])


def carry_texture(source: Any, target: Any, points: Match) -> None:
    """Give the target texture coordinates, and an image where the source's material has one.

    Polygons of more than three corners over a seam of the texture are cut into triangles.
    """
    shape = read_object(source)
    made, uv, torn = _dressed(shape, target, points)
    if len(torn):
        triangulate(target.data, torn)
        made, uv, _ = _dressed(shape, target, points)
    layer = target.data.uv_layers.get(NAME) or target.data.uv_layers.new(name=NAME)
    layer.data.foreach_set("uv", uv.astype(np.float32).ravel())
    layer.active = layer.active_render = True
    if shape.picture is not None and made.picture is not None:
        write_picture(target, made.picture)


def _dressed(shape: MeshFile, target: Any, points: Match) -> tuple[MeshFile, np.ndarray, np.ndarray]:
    """The target with the texture of ``shape``, and what :func:`loop_uv` says of it."""
    mesh, loops = read_mesh(target)
    made = with_source_texture(shape, MeshFile(mesh), points)
    return made, *loop_uv(made, loops, len(target.data.loops))


def triangulate(data: Any, loops: np.ndarray) -> None:
    """Cut the polygons that have some of ``loops`` into triangles."""
    import bmesh

    starts = numbers(data.polygons, "loop_start", 1, "i4")[:, 0]
    rows = np.unique(np.searchsorted(starts, loops, side="right") - 1)
    copy = bmesh.new()
    copy.from_mesh(data)
    copy.faces.ensure_lookup_table()
    bmesh.ops.triangulate(copy, faces=[copy.faces[int(row)] for row in rows])
    copy.to_mesh(data)
    copy.free()


def write_picture(item: Any, picture: Picture) -> None:
    """Load a picture, and give it to a material; an object without materials gets that one."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{NAME} {item.name}{picture.suffix}"
        path.write_bytes(picture.data)
        image = bpy.data.images.load(str(path))
        image.pack()
    material = bpy.data.materials.new(f"{NAME} {item.name}")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    node = nodes.new("ShaderNodeTexImage")
    node.image = image
    shader = next(one for one in nodes if one.type == "BSDF_PRINCIPLED")
    material.node_tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
    if len(item.data.materials) == 0:
        item.data.materials.append(material)


def match_objects(source: Any, target: Any) -> str:
    """Match two objects and keep the map; return what is to be said of it."""
    made = match(read_mesh(source)[0], read_mesh(target)[0])
    found[source.name, target.name] = made
    sure = "" if made.confidence is None else f", right with {100 * made.confidence:.0f} %"
    return f"{source.name} to {target.name}: {made.verdict}{sure}"


def transfer_objects(source: Any, target: Any, *, texture: bool, groups: bool, keys: bool) -> str:
    """Carry what is asked for over the map that :func:`match_objects` made; return what was carried."""
    points = found.get((source.name, target.name))
    if points is None:
        raise ValueError("press Match first")
    if (points.n_source, len(points.target_to_source)) != (len(source.data.vertices), len(target.data.vertices)):
        raise ValueError("the objects have other vertices than when they were matched: press Match again")
    shape, done = read_object(source), []
    if groups and len(source.vertex_groups):
        names, weights = read_groups(source)
        write_groups(target, names, transfer(weights, points, shape.mesh.faces, 0.0))
        done.append(f"{len(names)} vertex groups")
    if keys and shape.morphs:
        made = transfer_character(shape, MeshFile(read_mesh(target)[0]), points)
        write_keys(target, made.morphs)
        done.append(f"{len(made.morphs)} shape keys")
    if texture and shape.uv is not None:
        carry_texture(source, target, points)
        done.append("texture coordinates")
    return f"carried {', '.join(done) or 'nothing: the source has none of these'}"


if bpy is not None:

    class _Pair(bpy.types.Operator):
        """What both operators share: the two selected meshes, and refusals as messages."""

        @classmethod
        def poll(cls, context: Any) -> bool:
            chosen = context.selected_objects
            both = len(chosen) == 2 and all(one.type == "MESH" for one in chosen)
            return both and context.mode == "OBJECT" and context.active_object in chosen

        def execute(self, context: Any) -> set[str]:
            target = context.active_object
            source = next(one for one in context.selected_objects if one != target)
            try:
                told = self.work(source, target)
            except ValueError as error:  # what kfmaps refuses is one, too
                self.report({"ERROR"}, str(error))
                return {"CANCELLED"}
            self.report({"INFO"}, told)
            return {"FINISHED"}

    class KFMAPS_OT_match(_Pair):
        """Find for each vertex of the active object the corresponding point of the other selected one."""

        bl_idname, bl_label = "kfmaps.match", "Match"

        def work(self, source: Any, target: Any) -> str:
            return match_objects(source, target)

    class KFMAPS_OT_transfer(_Pair):
        """Carry the texture, vertex groups and shape keys of the selected object to the active one."""

        bl_idname, bl_label, bl_options = "kfmaps.transfer", "Transfer", {"REGISTER", "UNDO"}
        texture: bpy.props.BoolProperty(name="Texture", default=True)
        groups: bpy.props.BoolProperty(name="Vertex groups", default=True)
        keys: bpy.props.BoolProperty(name="Shape keys", default=True)

        def work(self, source: Any, target: Any) -> str:
            return transfer_objects(source, target, texture=self.texture, groups=self.groups, keys=self.keys)

    class KFMAPS_PT_sidebar(bpy.types.Panel):
        """The tab of the sidebar."""

        bl_label, bl_category, bl_space_type, bl_region_type = "kfmaps", "kfmaps", "VIEW_3D", "UI"

        def draw(self, _context: Any) -> None:
            self.layout.label(text="Select the source, then the target.")
            self.layout.operator(KFMAPS_OT_match.bl_idname)
            self.layout.operator(KFMAPS_OT_transfer.bl_idname)

    CLASSES = (KFMAPS_OT_match, KFMAPS_OT_transfer, KFMAPS_PT_sidebar)


def register() -> None:
    """Add the operators and the tab to Blender."""
    for one in CLASSES:
        bpy.utils.register_class(one)


def unregister() -> None:
    """Remove them."""
    found.clear()
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
