"""GLB files and their trees, and a character made from formulas.

It is the creature with a skeleton, skinning weights, shape keys and a texture in two charts, front and back, whose
picture has no visible seam.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from typing import Any

import numpy as np

from kfmaps.datasets.creature import CREATURE
from kfmaps.datasets.skeleton import Body
from kfmaps.geometry.mesh import Mesh, face_normals, vertex_normals
from kfmaps.io.bake import encode_png
from kfmaps.io.record import MeshFile, Picture, Skin


def tree_of(glb: bytes) -> dict[str, Any]:
    """The JSON part of a GLB file."""
    return json.loads(glb[20 : 20 + int.from_bytes(glb[12:16], "little")])


def changed(glb: bytes, edit: Callable[[Any], object]) -> bytes:
    """A GLB file whose JSON part ``edit`` has altered."""
    tree, rest = tree_of(glb), glb[20 + int.from_bytes(glb[12:16], "little") :]
    edit(tree)
    head = json.dumps(tree).encode()
    head += b" " * (-len(head) % 4)
    return b"glTF" + struct.pack("<III4s", 2, 20 + len(head) + len(rest), len(head), b"JSON") + head + rest


LIMBS, BODY = CREATURE, Body(CREATURE)


def skin(vertices: np.ndarray) -> Skin:
    """A joint at the root of each limb of the unbent creature; a vertex follows the limbs close to it."""
    names = tuple(limb.name for limb in LIMBS)
    parents = np.array([-1 if limb.parent is None else names.index(limb.parent) for limb in LIMBS])
    matrices = np.tile(np.eye(4), (len(LIMBS), 1, 1))
    matrices[:, :3, 3] = [limb.balls[0][:3] for limb in LIMBS]
    away = np.stack([BODY._distances(vertices, i)[0].min(axis=1) for i in range(len(LIMBS))], axis=1)
    weights = np.exp((away.min(axis=1, keepdims=True) - away) / 0.03)
    return Skin(names, parents, matrices, weights / weights.sum(axis=1, keepdims=True))


def morphs(mesh: Mesh) -> dict[str, np.ndarray]:
    """Cheeks that swell, and a nod of the whole head."""
    x, y, z = mesh.vertices.T
    near = np.exp(-((x - 0.12) ** 2 + (y - 1.45) ** 2 + (z - 0.15) ** 2) / 0.02)
    head = 1 / (1 + np.exp(-(y - 1.3) / 0.03))
    return {
        "swell": 0.1 * near[:, None] * vertex_normals(mesh),
        "nod": head[:, None] * np.stack([0 * x, -0.2 * z, 0.3 * (y - 1.25)], axis=1),
    }


def painted(points: np.ndarray) -> np.ndarray:
    """A colour (n, 3) for places on the creature that goes on around it."""
    x, y, _ = points.T
    rings = 0.5 + 0.5 * np.sign(np.sin(40 * y))
    return np.stack([0.25 + 0.6 * rings, 0.5 + 0.45 * np.sin(6 * x), 0.8 - 0.5 * rings], axis=1)


def texture(mesh: Mesh, size: int = 512) -> tuple[np.ndarray, np.ndarray, Picture]:
    """The front in the left half of the picture and the back in the right half: ``uv``, ``uv_faces``, picture."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    flat = 0.02 + 0.96 * (mesh.vertices - low)[:, :2] / (high - low)[:2] * [0.5, 1]
    back = face_normals(mesh)[:, 2] < 0
    uv = np.vstack([flat, flat + np.array([0.5, 0])])
    across, down = np.meshgrid((np.arange(size) + 0.5) / size, (np.arange(size) + 0.5) / size)
    places = np.zeros((size * size, 3))
    for axis, along in ((0, 2 * (across % 0.5 - 0.02)), (1, 1 - down - 0.02)):
        places[:, axis] = low[axis] + along.ravel() / 0.96 * (high - low)[axis]
    return uv, mesh.faces + len(mesh.vertices) * back[:, None], encode_png(painted(places).reshape(size, size, 3))


def character(mesh: Mesh) -> MeshFile:
    """The creature in the pose it was made in, with all that a character has."""
    return MeshFile(mesh, None, *texture(mesh), morphs(mesh), skin(mesh.vertices))
