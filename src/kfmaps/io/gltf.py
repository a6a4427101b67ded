"""glTF 2.0 and GLB: the triangles of a scene, read strictly and in time linear in what they hold."""

from __future__ import annotations

import base64
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np

from kfmaps._arrays import refuse
from kfmaps._memory import check_memory
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.record import MeshFile, Picture, picture_in
from kfmaps.io.text import REPAIR, beside, complete, read_bytes

_TYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_FLOAT, _UNSIGNED = 5126, {5121, 5123, 5125}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_TRIANGLES, _STRIP, _FAN = 4, 5, 6
_WHOLE = "a complete glTF 2.0 file"
_CUT = "the file is cut short or damaged: export it again"
_BYTES_PER_ROW = 250
"""What a vertex or a corner takes while it is read and checked, measured on a scene of 20 million."""
_MOST_REPEATED = 4_000_000
"""Vertices and corners that nodes may add by placing a mesh again: a file of 8 MB could mean a thousandfold."""
_LOOKS = ("KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "KHR_xmp", "MSFT_texture_")
"""How the names of extensions begin that change the look of a scene and not its vertices and triangles."""
_COMPRESSION = ("EXT_meshopt_compression", "KHR_meshopt_compression", "KHR_draco_mesh_compression")


@dataclass(frozen=True)
class _Part:
    """A primitive as it is placed by a node: its numbers in the file, and the node's 4 × 4 matrix."""

    mesh: int
    primitive: int
    node: int
    matrix: np.ndarray


def parse_gltf(data: bytes, name: str) -> MeshFile:
    """Read the triangles of a glTF 2.0 file, text (.gltf) or binary (.glb), with its .bin beside it.

    Nothing is merged: where a file repeats a vertex, as exporters do along seams of a texture, it stays repeated.
    Several parts follow one another in the order of the file, each placed by its node. A picture is read
    when it is the one colour texture of all parts; else there is none.
    Specification: Khronos Group, "glTF 2.0", https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html.

    Raises
    ------
    InvalidInput
        On a file that is cut short, compressed or sparse data, extensions that are needed and not known, triangle
        fans, nodes that are no tree, and too many copies of a part.
    """
    with complete(name, _WHOLE):
        tree, binary = _split(data, name)
        _check_extensions(tree, name)
        buffers = _buffers(tree, binary, name)
        parts = [p for m in tree.get("meshes", []) for p in m["primitives"]]
        _check_parts(parts, tree.get("accessors", []), name)
        return _joined(tree, buffers, name)


def buffer_files(data: bytes, name: str) -> list[Path]:
    """The files beside a .gltf that it takes its numbers from.

    Raises
    ------
    InvalidInput
        When ``data`` is no glTF.
    """
    with complete(name, _WHOLE):
        tree, _ = _split(data, name)
        uris = [buffer.get("uri") for buffer in tree.get("buffers", [])]
        return [_beside(uri, name) for uri in uris if uri is not None and not uri.startswith("data:")]


def _check_extensions(tree: dict[str, Any], name: str) -> None:
    """Refuse a file whose numbers are not what they seem without an extension."""
    views = [extension for view in tree.get("bufferViews", []) for extension in view.get("extensions", {})]
    for extension in [*tree.get("extensionsRequired", []), *views]:
        if extension in _COMPRESSION:
            raise refuse(name, "plain data", f"compressed data ({extension})", "export it without compression")
        if not str(extension).startswith((*_LOOKS, "KHR_mesh_quantization")):
            raise refuse(name, "plain glTF 2.0", f"the extension {extension!s:.60}", "export it without that")


def _split(data: bytes, name: str) -> tuple[dict[str, Any], bytes | None]:
    """The JSON tree of a file, and the binary chunk of a GLB, whose chunks must fill it exactly."""
    binary = None
    if data[:4] == b"glTF":
        version, length, first = (int.from_bytes(data[i : i + 4], "little") for i in (4, 8, 12))
        if version != 2 or data[16:20] != b"JSON":
            raise refuse(name, "a GLB file of version 2", f"version {version}", "export it again")
        if length != len(data) or 20 + first > len(data):
            raise refuse(name, f"a file of {length} bytes, as it says", f"{len(data)} bytes", _CUT)
        at = 20 + first
        size = int.from_bytes(data[at : at + 4], "little")
        if data[at + 4 : at + 8] == b"BIN\0":
            if at + 8 + size > len(data):
                raise refuse(name, f"{size} bytes of numbers", f"{len(data) - at - 8}", _CUT)
            binary = data[at + 8 : at + 8 + size]
        data = data[20 : 20 + first]
    tree = json.loads(data)
    version = str(tree["asset"]["version"])
    if version.partition(".")[0] != "2":
        raise refuse(name, "glTF of version 2", f"version {version}", "export it again")
    return tree, binary


def _buffers(tree: dict[str, Any], binary: bytes | None, name: str) -> list[bytes]:
    """The bytes of each buffer: in the GLB, in the text itself, or beside the file."""
    found = []
    for buffer in tree.get("buffers", []):
        uri = buffer.get("uri")
        if uri is None:
            content = binary
        elif uri.startswith("data:"):
            content = base64.b64decode(uri.partition(",")[2], validate=True)
        else:
            content = read_bytes(_beside(uri, name))
        size = _count(buffer["byteLength"])
        if content is None or len(content) < size:
            got = "none" if content is None else f"{len(content)}"
            raise refuse(name, f"a buffer of {size} bytes", got, _CUT)
        found.append(content[:size])
    return found


def _beside(uri: str, name: str) -> Path:
    """The file that a relative address names, which must lie in the folder of ``name`` or below it."""
    path = beside(unquote(uri), name)
    if path is None:
        raise refuse(name, "numbers in a file beside it", f"the address {uri[:60]!r}", "export it as .glb")
    return path


def _check_parts(parts: list[dict[str, Any]], accessors: list[dict[str, Any]], name: str) -> None:
    """Refuse what would be read as zeros or skipped in silence."""
    for accessor in accessors:
        if "bufferView" not in accessor or "sparse" in accessor:
            raise refuse(name, "plain data", "compressed or sparse data", "export it without compression")
    for part in parts:
        mode = part.get("mode", _TRIANGLES)
        if mode == _FAN:
            raise refuse(name, "triangles or strips", "a triangle fan", "export it as triangles")
        if mode not in (_TRIANGLES, _STRIP):
            continue
        place = accessors[_count(part["attributes"]["POSITION"])]
        if (place["componentType"], place["type"]) != (_FLOAT, "VEC3"):
            raise refuse(name, "positions as 32-bit numbers", "quantised ones", "export it unquantised")
        if "indices" in part and accessors[_count(part["indices"])]["componentType"] not in _UNSIGNED:
            raise refuse(name, "unsigned vertex numbers", "others", REPAIR)


def _count(value: Any) -> int:
    """A number of things, or the number of one."""
    if type(value) is not int or value < 0:
        raise ValueError(f"a whole number is {value!r:.20}")
    return value


def _placed(tree: dict[str, Any], name: str) -> list[_Part]:
    """The parts of the scene in the order of the file: by mesh, primitive and node."""
    nodes, meshes = tree.get("nodes", []), tree.get("meshes", [])
    scenes = tree.get("scenes", [])
    if scenes:
        roots = scenes[_count(tree.get("scene", 0))].get("nodes", [])
    else:
        children = {child for node in nodes for child in node.get("children", [])}
        roots = [i for i in range(len(nodes)) if i not in children]
    waiting, seen, parts = [(_count(root), np.eye(4)) for root in roots], set(), []
    while waiting:
        i, above = waiting.pop()
        if i in seen:
            raise refuse(name, "nodes that form a tree", f"node {i} in it twice", REPAIR)
        seen.add(i)
        node = nodes[i]
        matrix = above @ _matrix(node)
        waiting += [(_count(child), matrix) for child in node.get("children", [])]
        if "mesh" in node:
            mesh = _count(node["mesh"])
            for j, part in enumerate(meshes[mesh]["primitives"]):
                if part.get("mode", _TRIANGLES) in (_TRIANGLES, _STRIP):
                    parts.append(_Part(mesh, j, i, matrix))
    return sorted(parts, key=lambda p: (p.mesh, p.primitive, p.node))


def _matrix(node: dict[str, Any]) -> np.ndarray:
    """The 4 × 4 matrix of a node, from its matrix or its translation, rotation (x, y, z, w) and scale."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    result = np.eye(4)
    if "rotation" in node:
        x, y, z, w = np.array(node["rotation"], dtype=np.float64) / np.linalg.norm(node["rotation"])
        result[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    if "scale" in node:
        result[:3, :3] *= np.array(node["scale"], dtype=np.float64).reshape(3)
    if "translation" in node:
        result[:3, 3] = np.array(node["translation"], dtype=np.float64).reshape(3)
    return result


def _numbers(tree: dict[str, Any], buffers: list[bytes], number: Any, name: str) -> np.ndarray:
    """The rows of an accessor, (count, width) float64; whole numbers that stand for fractions are made those."""
    rows = _rows(tree, buffers, number, name)
    if tree["accessors"][number].get("normalized") is True and rows.dtype.kind != "f":
        return rows / np.iinfo(rows.dtype).max
    return rows.astype(np.float64)


def _rows(tree: dict[str, Any], buffers: list[bytes], number: Any, name: str) -> np.ndarray:
    """The rows of an accessor as they stand in their buffer, (count, width), not copied."""
    accessor = tree["accessors"][_count(number)]
    view = tree["bufferViews"][_count(accessor["bufferView"])]
    item, width = np.dtype(_TYPES[accessor["componentType"]]), _WIDTHS[accessor["type"]]
    count, row = _count(accessor["count"]), item.itemsize * width
    step = _count(view.get("byteStride", row))
    offset, first = _count(accessor.get("byteOffset", 0)), _count(view.get("byteOffset", 0))
    buffer, size = buffers[_count(view["buffer"])], _count(view["byteLength"])
    if step < row or (count and offset + (count - 1) * step + row > size) or first + size > len(buffer):
        raise refuse(name, _WHOLE, f"too few bytes for {count} rows of numbers", _CUT)
    if count == 0:
        return np.zeros((0, width), item)
    return np.ndarray((count, width), item, buffer, first + offset, (step, item.itemsize))


def _joined(tree: dict[str, Any], buffers: list[bytes], name: str) -> MeshFile:
    """All parts, one after another."""
    parts = _placed(tree, name)
    primitives = [tree["meshes"][part.mesh]["primitives"][part.primitive] for part in parts]
    used = [a for p in primitives for a in (p["attributes"]["POSITION"], p.get("indices")) if a is not None]
    sizes = {a: len(_rows(tree, buffers, a, name)) for a in set(used)}
    rows = sum(sizes[a] for a in used)
    repeated = rows - sum(sizes.values())
    if repeated > _MOST_REPEATED:
        got = f"{repeated:,}, with {len(parts):,} placed parts"
        remedy = "export each shape once"
        raise refuse(name, f"at most {_MOST_REPEATED:,} vertices and corners that nodes repeat", got, remedy)
    check_memory(_BYTES_PER_ROW * rows, name, f"{rows:,} vertices and corners of {len(parts):,} parts", REPAIR)
    places, faces, colors, uv, n = [], [], [], [], 0
    for part, primitive in zip(parts, primitives, strict=True):
        attributes = primitive["attributes"]
        own = _numbers(tree, buffers, attributes["POSITION"], name)
        corners = _triangles(tree, buffers, primitive, len(own), f"{name}: mesh {part.mesh}, part {part.primitive}")
        turn, shift = part.matrix[:3, :3], part.matrix[:3, 3]
        places.append(own if np.array_equal(part.matrix, np.eye(4)) else own @ turn.T + shift)
        faces.append((corners[:, ::-1] if np.linalg.det(turn) < 0 else corners) + n)
        for title, found, columns in (("COLOR_0", colors, 3), ("TEXCOORD_0", uv, 2)):
            if title in attributes:
                values = _numbers(tree, buffers, attributes[title], name)
                if len(values) != len(own) or values.shape[1] < columns:
                    raise refuse(f"{name}: {title}", f"{columns} numbers for each vertex", f"{values.shape}", REPAIR)
                found.append(values[:, :columns])
        n += len(own)
    if not parts:
        return MeshFile(Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)))
    mesh = Mesh(np.vstack(places), np.vstack(faces))
    whole_uv = np.vstack(uv) if len(uv) == len(parts) else None
    if whole_uv is not None:
        whole_uv[:, 1] = 1 - whole_uv[:, 1]  # glTF counts from the top of the picture
    tints = np.clip(np.vstack(colors), 0.0, 1.0) if len(colors) == len(parts) else None
    if whole_uv is None:
        return MeshFile(mesh, tints)
    return MeshFile(mesh, tints, whole_uv, mesh.faces, _picture(tree, buffers, primitives, name))


def _picture(tree: dict[str, Any], buffers: list[bytes], primitives: list[dict[str, Any]], name: str) -> Picture | None:
    """The colour texture that all ``primitives`` share; ``None`` when there is no such one, or it is of another kind.

    A picture beside the file that is not there is none either: who wants the shape alone need not have it.
    """
    images = set()
    for primitive in primitives:
        material = tree["materials"][_count(primitive["material"])] if "material" in primitive else {}
        texture = material.get("pbrMetallicRoughness", {}).get("baseColorTexture")
        plain = texture is not None and texture.get("texCoord", 0) == 0 and not texture.get("extensions")
        images.add(tree["textures"][_count(texture["index"])].get("source") if plain and texture else None)
    number = images.pop() if len(images) == 1 else None
    if number is None:
        return None
    image = tree["images"][_count(number)]
    uri = image.get("uri")
    if uri is None:
        view = tree["bufferViews"][_count(image["bufferView"])]
        buffer, first, size = buffers[_count(view["buffer"])], _count(view.get("byteOffset", 0)), view["byteLength"]
        if first + _count(size) > len(buffer):
            raise refuse(name, f"a picture of {size} bytes", f"{max(len(buffer) - first, 0)}", _CUT)
        data = buffer[first : first + size]
    elif uri.startswith("data:"):
        data = base64.b64decode(uri.partition(",")[2], validate=True)
    else:
        path = _beside(uri, name)
        data = read_bytes(path) if path.is_file() else b""
    return picture_in(data)


def _triangles(tree: dict[str, Any], buffers: list[bytes], primitive: dict[str, Any], n: int, name: str) -> np.ndarray:
    """The triangles (t, 3) of a primitive with ``n`` vertices, 0-based."""
    if "indices" in primitive:
        corners = _rows(tree, buffers, primitive["indices"], name)[:, 0].astype(np.int64)
    else:
        corners = np.arange(n)
    if len(corners) and corners.max() >= n:
        wanted = f"corners of faces from 0 to {n - 1}, for it has {n} vertices" if n else "vertices for its faces"
        raise refuse(name, wanted, str(corners.max()) if n else "none", REPAIR)
    if primitive.get("mode", _TRIANGLES) == _STRIP:
        strip = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
        strip[1::2] = strip[1::2, [1, 0, 2]]  # every other one runs the other way round
        return strip
    if len(corners) % 3:
        raise refuse(name, "faces of three corners each", f"{len(corners)} corners", REPAIR)
    return corners.reshape(-1, 3)
