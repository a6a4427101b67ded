"""GLB files written: one surface, with colours or a texture, and another shape to morph into."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np

from kfmaps.geometry.mesh import Mesh, vertex_normals
from kfmaps.io.record import bytes_of

_FLOAT, _BYTE, _INT = 5126, 5121, 5125
_ARRAY, _ELEMENT = 34962, 34963


class _Chunks:
    """The binary part of a GLB, and what the JSON part says of it."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def view(self, content: bytes, target: int | None = None) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(content)}
        self.views.append(view if target is None else {**view, "target": target})
        self.data += content
        return len(self.views) - 1

    def array(self, values: np.ndarray, kind: int, shape: str, target: int = _ARRAY, **more: Any) -> int:
        at = self.view(np.ascontiguousarray(values).tobytes(), target)
        self.accessors.append({"bufferView": at, "componentType": kind, "count": len(values), "type": shape, **more})
        return len(self.accessors) - 1

    def places(self, values: np.ndarray) -> int:
        """Positions or differences of them, whose bounds the format wants said."""
        single = values.astype("<f4")
        return self.array(single, _FLOAT, "VEC3", min=single.min(axis=0).tolist(), max=single.max(axis=0).tolist())


def format_glb(
    mesh: Mesh,
    colors: np.ndarray | None = None,
    *,
    uv: np.ndarray | None = None,
    uv_faces: np.ndarray | None = None,
    picture: tuple[bytes, str] | None = None,
    morph: np.ndarray | None = None,
) -> bytes:
    """Write ``mesh`` as GLB, positions in single precision.

    Parameters
    ----------
    mesh : Mesh
    colors : (n, 3) float64, optional
        sRGB from 0 to 1, one per vertex.
    uv : (m, 2) float64, optional
        Texture coordinates, with ``uv_faces`` (f, 3); (0, 0) is the lower left corner. A vertex with several, along
        seams, is written once for each.
    picture : (bytes, str), optional
        The texture's file and its media type, embedded.
    morph : (n, 3) float64, optional
        The same vertices elsewhere: a morph target, from weight 0 to 1.

    References
    ----------
    Khronos Group, glTF 2.0, https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html.
    """
    chunks = _Chunks()
    rows, faces = np.arange(len(mesh.vertices)), mesh.faces
    at_uv = None
    if uv is not None and uv_faces is not None:
        pairs, corner = np.unique(np.stack([mesh.faces.ravel(), uv_faces.ravel()], axis=1), axis=0, return_inverse=True)
        rows, faces, at_uv = pairs[:, 0], corner.reshape(-1, 3), pairs[:, 1]
    attributes: dict[str, int] = {"POSITION": chunks.places(mesh.vertices[rows])}
    if len(mesh.faces):
        attributes["NORMAL"] = chunks.array(_directions(vertex_normals(mesh))[rows].astype("<f4"), _FLOAT, "VEC3")
    if colors is not None:
        linear = np.where(colors <= 0.04045, colors / 12.92, ((colors + 0.055) / 1.055) ** 2.4)
        four = np.hstack([bytes_of(linear), np.full((len(colors), 1), 255, dtype=np.uint8)])
        attributes["COLOR_0"] = chunks.array(four[rows], _BYTE, "VEC4", normalized=True)
    material: dict[str, Any] = {"pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.9}}
    tree: dict[str, Any] = {}
    if uv is not None and at_uv is not None:
        flipped = np.stack([uv[at_uv, 0], 1 - uv[at_uv, 1]], axis=1)
        attributes["TEXCOORD_0"] = chunks.array(flipped.astype("<f4"), _FLOAT, "VEC2")
        if picture is not None:
            material["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}
            tree |= {"textures": [{"source": 0}], "images": [{"bufferView": 0, "mimeType": picture[1]}]}
    part: dict[str, Any] = {"attributes": attributes, "material": 0}
    if len(faces):
        part["indices"] = chunks.array(faces.ravel().astype("<u4"), _INT, "SCALAR", _ELEMENT)
    else:
        part["mode"] = 0
    node: dict[str, Any] = {"primitives": [part]}
    if morph is not None:
        part["targets"] = [{"POSITION": chunks.places((morph - mesh.vertices)[rows])}]
        node |= {"weights": [0.0], "extras": {"targetNames": ["target"]}}
    if "images" in tree and picture is not None:
        tree["images"][0]["bufferView"] = chunks.view(picture[0])
    tree |= {
        "asset": {"version": "2.0", "generator": "kfmaps"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [node],
        "materials": [material],
        "accessors": chunks.accessors,
        "bufferViews": chunks.views,
        "buffers": [{"byteLength": len(chunks.data)}],
    }
    text = json.dumps(tree, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary = bytes(chunks.data) + b"\0" * (-len(chunks.data) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary))
    return head + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary


def _directions(normals: np.ndarray) -> np.ndarray:
    """Normals of length 1 throughout, as the format wants: upwards where there is none."""
    bare = np.linalg.norm(normals, axis=1) == 0
    return np.where(bare[:, None], [0.0, 0.0, 1.0], normals)
