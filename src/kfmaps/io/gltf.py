"""Read the triangles of a glTF 2.0 or GLB scene, strictly and in time linear in its size."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import NamedTuple
from urllib.parse import unquote

import numpy as np
from scipy.spatial.transform import Rotation

from kfmaps._arrays import refuse
from kfmaps._memory import check_memory
from kfmaps._records import JsonObject
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.record import MeshFile, Picture, Skin, picture_in
from kfmaps.io.text import REPAIR, complete_or_refuse, read_bytes, relative_file

_TYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_FLOAT, _UNSIGNED = 5126, {5121, 5123, 5125}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_TRIANGLES, _STRIP, _FAN = 4, 5, 6
_WHOLE = "a complete glTF 2.0 file"
_UNCOMPRESSED = "export it without compression"
_CUT = "the file is cut short or damaged: export it again"
_BYTES_PER_ROW = 250  # memory of a vertex or corner while it is read and checked, measured on a scene of 20 million
_MAX_REPEATED = 4_000_000
"""Vertices and corners that nodes may add by placing a mesh again; else a file of 8 MB could unfold to 8 GB."""
_APPEARANCE = ("KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "KHR_xmp", "MSFT_texture_")
"""Prefixes of extensions that change the appearance of a scene and not its vertices and triangles."""
_COMPRESSION = ("EXT_meshopt_compression", "KHR_meshopt_compression", "KHR_draco_mesh_compression")


class _Part(NamedTuple):
    """A primitive placed by a node."""

    mesh: int  # number of its mesh in the file
    number: int  # of the primitive in its mesh
    node: int
    matrix: np.ndarray  # of the node, (4, 4)
    primitive: JsonObject
    attributes: JsonObject


def parse_gltf(data: bytes, name: str) -> MeshFile:
    """Read the triangles of a glTF 2.0 file, text (.gltf) or binary (.glb), with its .bin beside it.

    Nothing is merged: a vertex that the file repeats, as exporters do along seams of a texture, stays repeated.
    Several parts follow one another in the order of the file, each placed by its node, or by the joints that its
    vertices follow. Morph targets of one name in several parts are one. A picture is read where it is the one colour
    texture of all parts. Specification: Khronos Group, "glTF 2.0",
    https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html.
    """
    return _Scene(data, name).mesh_file()


def buffer_files(data: bytes, name: str) -> list[Path]:
    """Return the files beside a .gltf that hold its buffers."""
    with complete_or_refuse(name, _WHOLE):
        tree, _ = _split(data, name)
        uris = [buffer.get("uri") for buffer in tree.get("buffers", [])]
        return [_relative_file(uri, name) for uri in uris if uri is not None and not uri.startswith("data:")]


def _split(data: bytes, name: str) -> tuple[JsonObject, bytes | None]:
    """Return the JSON tree of a file, and the binary chunk of a GLB."""
    binary = None
    if data[:4] == b"glTF":
        version, length, first = (int.from_bytes(data[i : i + 4], "little") for i in (4, 8, 12))
        if version != 2 or data[16:20] != b"JSON":
            raise refuse(name, "a GLB file of version 2", f"version {version}", "export it again")
        if length != len(data) or 20 + first > len(data):
            raise refuse(name, f"a file of {length} bytes, as it says", f"{len(data)} bytes", _CUT)
        at = 28 + first
        if data[at - 4 : at] == b"BIN\0":
            binary = data[at : at + int.from_bytes(data[at - 8 : at - 4], "little")]
        data = data[20 : 20 + first]
    tree = json.loads(data)
    version = str(tree["asset"]["version"])
    if version.partition(".")[0] != "2":
        raise refuse(name, "glTF of version 2", f"version {version}", "export it again")
    return tree, binary


def _relative_file(uri: str, name: str) -> Path:
    """Return the file of a relative address, which must lie in the folder of ``name`` or below it."""
    path = relative_file(unquote(uri), name)
    if path is None:
        raise refuse(name, "numbers in a file beside it", f"the address {uri[:60]!r}", "export it as .glb")
    return path


def _count(value: object) -> int:
    """Return ``value`` where it is a whole number from 0 on, such as a count or an index."""
    if type(value) is not int or value < 0:
        raise ValueError(f"a whole number is {value!r:.20}")
    return value


class _Scene:
    """A file: its JSON ``tree``, the bytes of its ``buffers``, and its ``name`` in messages."""

    def __init__(self, data: bytes, name: str) -> None:
        self.name = name
        self.tree, binary = _split(data, name)
        self._check_extensions()
        self.buffers = []
        self.parents: dict[int, int] = {}  # the parent of each node of the scene, -1 of roots
        self.matrices: dict[int, np.ndarray] = {}  # from the frame of a node to the scene's
        for buffer in self.tree.get("buffers", []):
            content = self._content(buffer["uri"]) if buffer.get("uri") is not None else binary
            size = _count(buffer["byteLength"])
            if content is None or len(content) < size:
                raise refuse(name, f"a buffer of {size} bytes", "none" if content is None else f"{len(content)}", _CUT)
            self.buffers.append(content[:size])

    def _one(self, kind: str, number: object) -> JsonObject:
        return self.tree[kind][_count(number)]

    def _content(self, uri: str) -> bytes:
        """Return the bytes that an address holds itself, or those of the file that it names."""
        if uri.startswith("data:"):
            return base64.b64decode(uri.partition(",")[2], validate=True)
        return read_bytes(_relative_file(uri, self.name))

    def _check_extensions(self) -> None:
        """Refuse a file whose numbers cannot be read without an extension."""
        views = [extension for view in self.tree.get("bufferViews", []) for extension in view.get("extensions", {})]
        for extension in [*self.tree.get("extensionsRequired", []), *views]:
            if extension in _COMPRESSION:
                raise refuse(self.name, "plain data", f"compressed data ({extension})", _UNCOMPRESSED)
            if not str(extension).startswith((*_APPEARANCE, "KHR_mesh_quantization")):
                raise refuse(self.name, "plain glTF 2.0", f"the extension {extension!s:.60}", "export it without that")

    def parts(self) -> list[_Part]:
        """Return the parts of the scene in the order of the file: by mesh, primitive and node."""
        nodes, scenes = self.tree.get("nodes", []), self.tree.get("scenes", [])
        if scenes:
            roots = scenes[_count(self.tree.get("scene", 0))].get("nodes", [])
        else:
            children = {child for node in nodes for child in node.get("children", [])}
            roots = [i for i in range(len(nodes)) if i not in children]
        waiting, parts = [(_count(root), -1) for root in roots], []
        while waiting:
            i, above = waiting.pop()
            if i in self.parents:
                raise refuse(self.name, "nodes that form a tree", f"node {i} in it twice", REPAIR)
            node = nodes[i]
            matrix = (np.eye(4) if above < 0 else self.matrices[above]) @ _matrix(node)
            self.parents[i], self.matrices[i] = above, matrix
            waiting += [(_count(child), i) for child in node.get("children", [])]
            if "mesh" in node:
                mesh = _count(node["mesh"])
                for j, primitive in enumerate(self.tree["meshes"][mesh]["primitives"]):
                    mode = primitive.get("mode", _TRIANGLES)
                    if mode == _FAN:
                        raise refuse(self.name, "triangles or strips", "a triangle fan", "export it as triangles")
                    if mode in (_TRIANGLES, _STRIP):
                        parts.append(_Part(mesh, j, i, matrix, primitive, primitive["attributes"]))
        return sorted(parts, key=lambda p: p[:3])

    def rows(self, number: object) -> np.ndarray:
        """Return the rows of an accessor, (count, width); a view of the buffer where that is possible."""
        accessor = self._one("accessors", number)
        item, width, count = np.dtype(_TYPES[accessor["componentType"]]), _WIDTHS[accessor["type"]], accessor["count"]
        sparse = accessor.get("sparse")
        if sparse is None and "bufferView" not in accessor:
            raise refuse(self.name, "plain data", "compressed data", _UNCOMPRESSED)
        if sparse is None:
            return self._block(accessor, item, width, count)
        rows = np.zeros((_count(count), width), item)
        if "bufferView" in accessor:
            rows[:] = self._block(accessor, item, width, count)
        at = self._block(sparse["indices"], np.dtype(_TYPES[sparse["indices"]["componentType"]]), 1, sparse["count"])
        rows[at[:, 0]] = self._block(sparse["values"], item, width, sparse["count"])
        return rows

    def _block(self, reference: JsonObject, item: np.dtype, width: int, count: object) -> np.ndarray:
        """Return ``count`` rows of a buffer, from the view and offset that ``reference`` names."""
        view = self._one("bufferViews", reference["bufferView"])
        count, row = _count(count), item.itemsize * width
        step = _count(view.get("byteStride", row))
        offset, first = _count(reference.get("byteOffset", 0)), _count(view.get("byteOffset", 0))
        buffer, size = self.buffers[_count(view["buffer"])], _count(view["byteLength"])
        if step < row or (count and offset + (count - 1) * step + row > size) or first + size > len(buffer):
            raise refuse(self.name, _WHOLE, f"too few bytes for {count * row} of numbers or a picture", _CUT)
        if count == 0:
            return np.zeros((0, width), item)
        return np.ndarray((count, width), item, buffer, first + offset, (step, item.itemsize))

    def numbers(self, number: object) -> np.ndarray:
        """Return :meth:`rows` as float64; normalized whole numbers become fractions."""
        rows = self.rows(number)
        if self.tree["accessors"][number].get("normalized") is True and rows.dtype.kind != "f":
            return rows / np.iinfo(rows.dtype).max
        return rows.astype(np.float64)

    def mesh_file(self) -> MeshFile:
        """Return all parts, one after another."""
        parts = self.parts()
        if not parts:
            return MeshFile(Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)))
        joints = self._joints(parts)
        self._check_parts(parts, joints)
        places, faces, colors, uv, morphs, weights, n = [], [], [], [], [], [], 0
        for part in parts:
            vertices = self.numbers(part.attributes["POSITION"])
            corners = self._triangles(part, len(vertices))
            joint_weights, matrix = self._skin_part(part, joints, len(vertices))
            linear = matrix[..., :3, :3]
            is_identity = np.array_equal(matrix, np.eye(4))
            places.append(vertices if is_identity else _transform(linear, vertices) + matrix[..., :3, 3])
            is_mirrored = np.linalg.det(linear.reshape(-1, 3, 3).mean(axis=0)) < 0
            faces.append((corners[:, ::-1] if is_mirrored else corners) + n)
            weights.append(joint_weights)
            morphs.append({title: _transform(linear, offsets) for title, offsets in self._morphs(part, len(vertices))})
            for title, rows, columns in (("COLOR_0", colors, 3), ("TEXCOORD_0", uv, 2)):
                if title in part.attributes:
                    rows.append(self._attribute(part.attributes, title, len(vertices), columns))
            n += len(vertices)
        mesh = Mesh(np.vstack(places), np.vstack(faces))
        tints = np.clip(np.vstack(colors), 0.0, 1.0) if len(colors) == len(parts) else None
        titles = dict.fromkeys(title for offsets in morphs for title in offsets)
        morph_pairs = list(zip(morphs, places, strict=True))
        all_morphs = {t: np.vstack([offsets.get(t, np.zeros_like(x)) for offsets, x in morph_pairs]) for t in titles}
        skin = self._skin(joints, np.vstack(weights)) if joints else None
        if len(uv) < len(parts):
            return MeshFile(mesh, tints, morphs=all_morphs, skin=skin)
        corner_uv = np.vstack(uv) * [1, -1] + [0, 1]  # glTF counts from the top of the picture
        return MeshFile(mesh, tints, corner_uv, mesh.faces, self._picture(parts), all_morphs, skin)

    def _attribute(self, attributes: JsonObject, title: str, n: int, columns: int) -> np.ndarray:
        """Return the first ``columns`` numbers of each of ``n`` vertices."""
        count = self._one("accessors", attributes[title])["count"]
        values = self.numbers(attributes[title]) if count == n else np.zeros((0, 0))
        if len(values) != n or values.shape[1] < columns:
            raise refuse(f"{self.name}: {title}", f"{columns} numbers for each vertex", f"{count} rows", REPAIR)
        return values[:, :columns]

    def _morphs(self, part: _Part, n: int) -> list[tuple[str, np.ndarray]]:
        """Return name and displacements (n, 3) of each morph target."""
        targets = part.primitive.get("targets", [])
        target_names = self.tree["meshes"][part.mesh].get("extras", {}).get("targetNames", [])
        names = target_names if len(target_names) == len(targets) else [f"morph {i}" for i in range(len(targets))]
        offsets = [self._attribute(t, "POSITION", n, 3) if "POSITION" in t else np.zeros((n, 3)) for t in targets]
        return list(zip(map(str, names), offsets, strict=True))

    def _joints(self, parts: list[_Part]) -> list[int]:
        """Return the nodes that vertices of the parts may follow, in the order of the skins."""
        used = dict.fromkeys(i for i in (self.tree["nodes"][part.node].get("skin") for part in parts) if i is not None)
        joints = list(dict.fromkeys(_count(j) for i in used for j in self._one("skins", i)["joints"]))
        if any(j not in self.matrices for j in joints):
            raise refuse(self.name, "joints that are nodes of the scene", "others", REPAIR)
        return joints

    def _skin_part(self, part: _Part, joints: list[int], n: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the weights of each vertex for ``joints``, (n, j), and its matrix, (4, 4) or (n, 4, 4).

        Joints alone place a vertex that follows them; the node of the part does not count.
        """
        weights, skin = np.zeros((n, len(joints))), self.tree["nodes"][part.node].get("skin")
        if skin is None or "JOINTS_0" not in part.attributes:
            return weights, part.matrix
        own_joints = [_count(j) for j in self._one("skins", skin)["joints"]]
        bind = self._one("skins", skin).get("inverseBindMatrices")
        inverse = np.eye(4).ravel() if bind is None else self.numbers(bind)
        inverse = np.broadcast_to(inverse, (len(own_joints), 16)).reshape(-1, 4, 4).transpose(0, 2, 1)
        joint_matrices = np.stack([self.matrices[j] @ m for j, m in zip(own_joints, inverse, strict=True)])
        own_weights = np.zeros((n, len(own_joints)))
        for title in [title for title in part.attributes if title.startswith("JOINTS_")]:
            at = self._attribute(part.attributes, title, n, 4).astype(np.int64)
            share = self._attribute(part.attributes, title.replace("JOINTS", "WEIGHTS"), n, 4)
            np.add.at(own_weights, (np.arange(n)[:, None], at), share)
        total = own_weights.sum(axis=1, keepdims=True)
        own_weights = np.divide(own_weights, total, out=np.zeros_like(own_weights), where=total > 0)
        weights[:, [joints.index(j) for j in own_joints]] = own_weights
        if (np.abs(joint_matrices - joint_matrices[0]) <= 1e-5 * np.abs(joint_matrices[0]).max()).all():
            return weights, joint_matrices[0]  # the scene shows the mesh at rest
        matrix = (own_weights @ joint_matrices.reshape(-1, 16)).reshape(n, 4, 4)
        return weights, np.where((total > 0)[:, :, None], matrix, part.matrix)

    def _skin(self, joints: list[int], weights: np.ndarray) -> Skin:
        """Return the skeleton as the scene shows it: the parent of a joint is the nearest joint above it."""
        parents = []
        for j in joints:
            above = self.parents[j]
            while above >= 0 and above not in joints:
                above = self.parents[above]
            parents.append(joints.index(above) if above >= 0 else -1)
        names = tuple(str(self.tree["nodes"][j].get("name", f"joint {i}")) for i, j in enumerate(joints))
        return Skin(names, np.array(parents), np.stack([self.matrices[j] for j in joints]), weights)

    def _check_parts(self, parts: list[_Part], joints: list[int]) -> None:
        """Refuse unsupported types of vertices and corners, too many repeated ones, and more than memory holds."""
        used = []
        for part in parts:
            numbers = [part.attributes["POSITION"]]
            numbers += [part.primitive["indices"]] if "indices" in part.primitive else []
            position, *corners = (self._one("accessors", number) for number in numbers)
            if any("sparse" in one for one in (position, *corners)):
                raise refuse(self.name, "plain vertices and triangles", "sparse ones", _UNCOMPRESSED)
            if (position["componentType"], position["type"]) != (_FLOAT, "VEC3"):
                raise refuse(self.name, "positions as 32-bit numbers", "quantised ones", "export it unquantised")
            if any(one["componentType"] not in _UNSIGNED for one in corners):
                raise refuse(self.name, "unsigned vertex numbers", "others", REPAIR)
            used += numbers
        sizes = {a: len(self.rows(a)) for a in set(used)}
        rows = sum(sizes[a] for a in used)
        repeated = rows - sum(sizes.values())
        if repeated > _MAX_REPEATED:
            expected = f"at most {_MAX_REPEATED:,} vertices and corners that nodes repeat"
            got = f"{repeated:,}, with {len(parts):,} placed parts"
            raise refuse(self.name, expected, got, "export each shape once")
        what = f"{rows:,} vertices and corners of {len(parts):,} parts"
        targets = [t["POSITION"] for p in parts for t in p.primitive.get("targets", []) if "POSITION" in t]
        n_displaced = sum(_count(self._one("accessors", a)["count"]) for a in targets)
        n_weights = len(joints) * sum(sizes[p.attributes["POSITION"]] for p in parts)
        check_memory(_BYTES_PER_ROW * rows + 48 * n_displaced + 24 * n_weights, self.name, what, REPAIR)

    def _picture(self, parts: list[_Part]) -> Picture | None:
        """Return the colour texture that all ``parts`` share; ``None`` without one, or when it is of another kind.

        There is also none where the picture's own file is missing: the shape can be read without it.
        """
        images = set()
        for primitive in [part.primitive for part in parts]:
            material = self._one("materials", primitive["material"]) if "material" in primitive else {}
            texture = material.get("pbrMetallicRoughness", {}).get("baseColorTexture")
            is_plain = texture is not None and texture.get("texCoord", 0) == 0 and not texture.get("extensions")
            images.add(self._one("textures", texture["index"]).get("source") if is_plain and texture else None)
        number = images.pop() if len(images) == 1 else None
        if number is None:
            return None
        image = self._one("images", number)
        uri = image.get("uri")
        if uri is not None:
            exists = uri.startswith("data:") or _relative_file(uri, self.name).is_file()
            return picture_in(self._content(uri)) if exists else None
        size = self._one("bufferViews", image["bufferView"])["byteLength"]
        return picture_in(self._block(image, np.dtype("u1"), 1, size).tobytes())

    def _triangles(self, part: _Part, n: int) -> np.ndarray:
        """Return the triangles (t, 3) of a part with ``n`` vertices, 0-based."""
        primitive, name = part.primitive, f"{self.name}: mesh {part.mesh}, part {part.number}"
        indexed = "indices" in primitive
        corners = self.rows(primitive["indices"])[:, 0].astype(np.int64) if indexed else np.arange(n)
        if len(corners) and corners.max() >= n:
            expected = f"corners of faces from 0 to {n - 1}, for it has {n} vertices" if n else "vertices for its faces"
            raise refuse(name, expected, str(corners.max()) if n else "none", REPAIR)
        if primitive.get("mode", _TRIANGLES) == _STRIP:
            strip = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
            strip[1::2] = strip[1::2, [1, 0, 2]]  # every other one runs the other way round
            return strip
        if len(corners) % 3:
            raise refuse(name, "faces of three corners each", f"{len(corners)} corners", REPAIR)
        return corners.reshape(-1, 3)


def _transform(linear: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return points (n, 3) after a linear map, (3, 3) or one for each point, (n, 3, 3)."""
    return np.einsum("...ij,...j->...i", linear, points)


def _matrix(node: JsonObject) -> np.ndarray:
    """Return the 4 × 4 matrix of a node, from its matrix or its translation, rotation (x, y, z, w) and scale."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    linear = np.eye(3)
    if "rotation" in node:
        linear = Rotation.from_quat(np.array(node["rotation"], dtype=np.float64)).as_matrix()
    result = np.eye(4)
    result[:3, :3] = linear * np.array(node.get("scale", [1, 1, 1]), dtype=np.float64).reshape(3)
    result[:3, 3] = np.array(node.get("translation", [0, 0, 0]), dtype=np.float64).reshape(3)
    return result
