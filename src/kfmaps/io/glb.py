"""Write GLB files: one surface with colours or a texture, morph targets and a skin."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from kfmaps._records import JsonObject
from kfmaps.geometry.mesh import vertex_normals
from kfmaps.io.record import MeshFile, Skin, to_bytes

_FLOAT, _BYTE, _SHORT, _INT = 5126, 5121, 5123, 5125
_ARRAY, _ELEMENT = 34962, 34963
_MAX_JOINTS = 4  # joints of a vertex that every program reads


class _Chunks:
    """The binary part of a GLB, and its views and accessors in the JSON part."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[JsonObject] = []
        self.accessors: list[JsonObject] = []

    def view(self, content: bytes, target: int | None = None) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(content)}
        self.views.append(view if target is None else {**view, "target": target})
        self.data += content
        return len(self.views) - 1

    def array(self, values: np.ndarray, kind: int, shape: str, target: int | None = _ARRAY, **more: Any) -> int:
        at = self.view(np.ascontiguousarray(values).tobytes(), target)
        self.accessors.append({"bufferView": at, "componentType": kind, "count": len(values), "type": shape, **more})
        return len(self.accessors) - 1

    def places(self, values: np.ndarray) -> int:
        """Add positions or differences of them, with the bounds that the format requires, and return their number."""
        single = values.astype("<f4")
        return self.array(single, _FLOAT, "VEC3", min=single.min(axis=0).tolist(), max=single.max(axis=0).tolist())


def format_glb(shape: MeshFile) -> bytes:
    """Write a mesh with its colours, texture, morph targets and skin as GLB, in single precision.

    A vertex with several texture coordinates, along seams, is written once for each. A vertex keeps its four heaviest
    joints.

    Khronos Group, glTF 2.0, https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html.
    """
    mesh, colors, uv, uv_faces, picture = shape.mesh, shape.colors, shape.uv, shape.uv_faces, shape.picture
    chunks = _Chunks()
    rows, faces = np.arange(len(mesh.vertices)), mesh.faces
    attributes: dict[str, int] = {}
    material: JsonObject = {"pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.9}}
    document: JsonObject = {}
    if uv is not None and uv_faces is not None:
        pairs, corner = np.unique(np.stack([mesh.faces.ravel(), uv_faces.ravel()], axis=1), axis=0, return_inverse=True)
        rows, faces = pairs[:, 0], corner.reshape(-1, 3)
        flipped = uv[pairs[:, 1]] * [1, -1] + [0, 1]  # glTF counts from the top of the picture
        attributes["TEXCOORD_0"] = chunks.array(flipped.astype("<f4"), _FLOAT, "VEC2")
        if picture is not None:
            image = {"bufferView": chunks.view(picture.data), "mimeType": picture.kind}
            document = {"textures": [{"source": 0}], "images": [image]}
            material["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}
    attributes["POSITION"] = chunks.places(mesh.vertices[rows])
    if len(mesh.faces):
        normals = vertex_normals(mesh)
        normals[np.linalg.norm(normals, axis=1) == 0] = [0, 0, 1]  # the format requires length 1
        attributes["NORMAL"] = chunks.array(normals[rows].astype("<f4"), _FLOAT, "VEC3")
    if colors is not None:
        linear = np.where(colors <= 0.04045, colors / 12.92, ((colors + 0.055) / 1.055) ** 2.4)
        four = np.hstack([to_bytes(linear), np.full((len(colors), 1), 255, dtype=np.uint8)])
        attributes["COLOR_0"] = chunks.array(four[rows], _BYTE, "VEC4", normalized=True)
    primitive: JsonObject = {"attributes": attributes, "material": 0}
    if len(faces):
        primitive["indices"] = chunks.array(faces.ravel().astype("<u4"), _INT, "SCALAR", _ELEMENT)
    else:
        primitive["mode"] = 0
    mesh_record: JsonObject = {"primitives": [primitive]}
    if shape.morphs:
        primitive["targets"] = [{"POSITION": chunks.places(offsets[rows])} for offsets in shape.morphs.values()]
        mesh_record |= {"weights": [0.0] * len(shape.morphs), "extras": {"targetNames": list(shape.morphs)}}
    if shape.skin is not None:
        order = np.argsort(-shape.skin.weights, axis=1, kind="stable")[:, :_MAX_JOINTS]
        heaviest = np.take_along_axis(shape.skin.weights, order, axis=1)
        heaviest /= np.maximum(heaviest.sum(axis=1, keepdims=True), 1e-300)
        order, heaviest = (np.pad(x, ((0, 0), (0, _MAX_JOINTS - x.shape[1]))) for x in (order, heaviest))
        attributes["JOINTS_0"] = chunks.array(np.where(heaviest > 0, order, 0)[rows].astype("<u2"), _SHORT, "VEC4")
        attributes["WEIGHTS_0"] = chunks.array(heaviest[rows].astype("<f4"), _FLOAT, "VEC4")
    document |= {
        "asset": {"version": "2.0", "generator": "kfmaps"},
        "scene": 0,
        **_nodes(shape.skin, chunks),
        "meshes": [mesh_record],
        "materials": [material],
        "accessors": chunks.accessors,
        "bufferViews": chunks.views,
        "buffers": [{"byteLength": len(chunks.data)}],
    }
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary = bytes(chunks.data) + b"\0" * (-len(chunks.data) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary))
    return head + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary


def _nodes(skin: Skin | None, chunks: _Chunks) -> JsonObject:
    """Return the node of the mesh, and one for each joint of its skin."""
    if skin is None:
        return {"scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}]}
    above = np.where((skin.parents < 0)[:, None, None], np.eye(4), skin.matrices[skin.parents])
    local = np.linalg.pinv(above) @ skin.matrices  # a joint may be scaled to nothing
    nodes: list[JsonObject] = [{"mesh": 0, "skin": 0}]
    for j, (name, matrix) in enumerate(zip(skin.names, local, strict=True)):
        children = (1 + np.flatnonzero(skin.parents == j)).tolist()
        nodes.append({"name": name, **_node_transform(matrix), **({"children": children} if children else {})})
    binds = chunks.array(np.linalg.pinv(skin.matrices).transpose(0, 2, 1).astype("<f4"), _FLOAT, "MAT4", None)
    roots = (1 + np.flatnonzero(skin.parents < 0)).tolist()
    joints = list(range(1, len(nodes)))
    skins = [{"joints": joints, "inverseBindMatrices": binds}]
    return {"scenes": [{"nodes": [0, *roots]}], "nodes": nodes, "skins": skins}


def _node_transform(matrix: np.ndarray) -> JsonObject:
    """Return a node's translation, rotation and scale, which animations need; its matrix where there is shear."""
    scale = np.linalg.norm(matrix[:3, :3], axis=0) * np.sign(np.linalg.det(matrix[:3, :3]))
    rotation = matrix[:3, :3] / np.where(scale == 0, 1, scale)
    if np.abs(rotation.T @ rotation - np.eye(3)).max() > 1e-4:
        return {"matrix": matrix.T.ravel().tolist()}
    quaternion = Rotation.from_matrix(rotation).as_quat().tolist()
    return {"translation": matrix[:3, 3].tolist(), "rotation": quaternion, "scale": scale.tolist()}
