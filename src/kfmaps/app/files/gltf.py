"""glTF and GLB through trimesh, after checks that trimesh leaves out."""

from __future__ import annotations

import io
import json
from typing import Any

import numpy as np
import trimesh
from trimesh.resolvers import FilePathResolver
from trimesh.visual import ColorVisuals, TextureVisuals

from kfmaps._arrays import InvalidInput, refuse
from kfmaps.app.files.record import MeshFile
from kfmaps.app.files.text import REPAIR
from kfmaps.surface.mesh import Mesh

_FLOAT, _UNSIGNED = 5126, {5121, 5123, 5125}
_TRIANGLES, _STRIP, _FAN = 4, 5, 6


def parse_gltf(data: bytes, name: str) -> MeshFile:
    """Read the triangles of a glTF 2.0 file, text (.gltf) or binary (.glb).

    Nothing is merged: where a file repeats a vertex, as exporters do along seams of a texture, it stays
    repeated. Several parts follow one another in the order of the file, each placed by its node.

    Raises
    ------
    InvalidInput
        On a file that is cut short, compressed or sparse data, and triangle fans.
    """
    binary = data[:4] == b"glTF"
    head = _binary_head(data, name) if binary else data
    try:
        tree = json.loads(head)
        parts = [p for m in tree.get("meshes", []) for p in m["primitives"]]
        _check_parts(parts, tree.get("accessors", []), name)
        scene = trimesh.load_scene(
            io.BytesIO(data),
            file_type="glb" if binary else "gltf",
            resolver=FilePathResolver(name),
            process=False,
            maintain_order=True,
        )
        return _joined(scene)
    except InvalidInput:
        raise
    except Exception as error:  # trimesh reports broken files by whatever exception they run into
        got = " ".join(f"{type(error).__name__}: {error}".split())[:100]
        raise refuse(name, "a complete glTF 2.0 file", got, REPAIR) from error


def _binary_head(data: bytes, name: str) -> bytes:
    """The JSON chunk of a GLB file, whose chunks must fill it exactly."""
    version, length, first = (int.from_bytes(data[i : i + 4], "little") for i in (4, 8, 12))
    if version != 2 or data[16:20] != b"JSON":
        raise refuse(name, "a GLB file of version 2", f"version {version}", "export it again")
    if length != len(data) or 20 + first > len(data):
        what = "the file is cut short or damaged: export it again"
        raise refuse(name, f"a file of {length} bytes, as it says", f"{len(data)} bytes", what)
    return data[20 : 20 + first]


def _check_parts(parts: list[dict[str, Any]], accessors: list[dict[str, Any]], name: str) -> None:
    """Refuse what trimesh would read as zeros, skip in silence, or take memory for without bounds."""
    for accessor in accessors:
        if "bufferView" not in accessor or "sparse" in accessor:
            raise refuse(name, "plain data", "compressed or sparse data", "export it without compression")
    for part in parts:
        mode = part.get("mode", _TRIANGLES)
        if mode == _FAN:
            raise refuse(name, "triangles or strips", "a triangle fan", "export it as triangles")
        if mode not in (_TRIANGLES, _STRIP):
            continue
        place = accessors[part["attributes"]["POSITION"]]
        if (place["componentType"], place["type"]) != (_FLOAT, "VEC3"):
            raise refuse(name, "positions as 32-bit numbers", "quantised ones", "export it unquantised")
        if "indices" in part and accessors[part["indices"]]["componentType"] not in _UNSIGNED:
            raise refuse(name, "unsigned vertex numbers", "others", REPAIR)


def _joined(scene: trimesh.Scene) -> MeshFile:
    """All triangle meshes of a scene, one after another in the order of the file."""
    order = {title: i for i, title in enumerate(scene.geometry)}
    nodes = [(order[scene.graph[node][1]], i, node) for i, node in enumerate(scene.graph.nodes_geometry)]
    places, faces, colors, uv, n = [], [], [], [], 0
    for _, _, node in sorted(nodes):
        matrix, title = scene.graph[node]
        part = scene.geometry[title]
        if not isinstance(part, trimesh.Trimesh):
            continue
        # asarray: trimesh's tracked arrays hash themselves at every use
        own = np.asarray(part.vertices, dtype=np.float64)
        places.append(own if np.array_equal(matrix, np.eye(4)) else own @ matrix[:3, :3].T + matrix[:3, 3])
        turned = np.linalg.det(matrix[:3, :3]) < 0
        corners = np.asarray(part.faces, dtype=np.int64)
        faces.append((corners[:, ::-1] if turned else corners) + n)
        look = part.visual
        if isinstance(look, ColorVisuals) and look.kind == "vertex":
            colors.append(np.asarray(look.vertex_colors)[:, :3] / 255.0)
        if isinstance(look, TextureVisuals) and look.uv is not None and len(look.uv) == len(own):
            uv.append(np.asarray(look.uv, dtype=np.float64))
        n += len(own)
    if not places:
        return MeshFile(Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)))
    mesh = Mesh(np.vstack(places), np.vstack(faces))
    whole_uv = np.vstack(uv) if len(uv) == len(places) else None
    return MeshFile(
        mesh,
        np.vstack(colors) if len(colors) == len(places) else None,
        whole_uv,
        None if whole_uv is None else mesh.faces,
    )
