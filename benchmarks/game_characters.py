"""Characters of a game in two frames, artists' meshes of many pieces that no number was chosen on.

    python benchmarks/game_characters.py --data DIR [--half choice|report] [--kinds lower,upper,whole] [--pairs 2]

DIR is a folder with players of OpenArena 0.8.5 (the file ``pak2-players.pk3`` of Debian's package
openarena-081-players, unpacked; files ``.md3``). A character has legs and a torso, both open where they meet, and a
head; each is matched between two frames drawn at random, as the artist left it: in pieces, with seams, 250 to 2,140
vertices, turned, in another unit and with shuffled vertices. ``whole``: the three of them, put together by their tags.
Errors are straight distances on the source, weighted by area. Every second character by name is of the choice half.
"""

from __future__ import annotations

import argparse
import struct
from pathlib import Path

import numpy as np
from game_animals import print_summary
from game_units import judged_whole
from scipy.spatial.transform import Rotation

from kfmaps.geometry.mesh import Mesh

KINDS = ("lower", "upper", "whole")
Placed = tuple[np.ndarray, np.ndarray]


def read_model(path: Path) -> tuple[np.ndarray, np.ndarray, list[dict[str, Placed]]]:
    """The vertices of each frame, (f, n, 3), the faces, and the origin and the axes of each frame's tags (MD3 15)."""
    content = path.read_bytes()
    n_frames, n_tags, n_surfaces = struct.unpack_from("<3i", content, 76)
    tag_start, at = struct.unpack_from("<2i", content, 96)
    fields = [("name", "S64"), ("origin", "<f4", 3), ("axes", "<f4", (3, 3))]
    rows = np.frombuffer(content, np.dtype(fields), n_frames * n_tags, tag_start).reshape(n_frames, n_tags)
    tags = [{row["name"].decode(): (row["origin"], row["axes"]) for row in frame} for frame in rows]
    vertices, faces, n = [], [], 0
    for _ in range(n_surfaces):
        n_own, n_faces, face_start = struct.unpack_from("<3i", content, at + 80)
        vertex_start, end = struct.unpack_from("<2i", content, at + 100)
        faces.append(n + np.frombuffer(content, "<i4", 3 * n_faces, at + face_start).reshape(-1, 3)[:, ::-1])
        own = np.frombuffer(content, "<i2", 4 * n_own * n_frames, at + vertex_start).reshape(n_frames, n_own, 4)
        vertices.append(own[:, :, :3] / 64.0)
        n, at = n + n_own, at + end
    return np.concatenate(vertices, axis=1), np.concatenate(faces).astype(np.int64), tags


def posed(folder: Path, kind: str, frames: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The vertices and faces of a ``kind`` in ``frames (2,)`` of legs and torso, any numbers."""
    (legs, leg_faces, leg_tags), (torso, torso_faces, torso_tags) = (
        read_model(folder / f"{name}.md3") for name in ("lower", "upper")
    )
    leg_frame, torso_frame = frames[0] % len(legs), frames[1] % len(torso)
    if kind == "lower":
        return legs[leg_frame], leg_faces
    if kind == "upper":
        return torso[torso_frame], torso_faces
    head, head_faces, _ = read_model(folder / "head.md3")
    waist, neck = leg_tags[leg_frame]["tag_torso"], torso_tags[torso_frame]["tag_head"]
    upper = put(np.concatenate([torso[torso_frame], put(head[0], neck)]), waist)
    n, m = len(legs[0]), len(torso[0])
    return np.concatenate([legs[leg_frame], upper]), np.concatenate([leg_faces, torso_faces + n, head_faces + n + m])


def put(points: np.ndarray, at: Placed) -> np.ndarray:
    """Points (n, 3) where a tag is."""
    return points @ at[1] + at[0]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--half", choices=("choice", "report"), default="report")
    parser.add_argument("--kinds", default=",".join(KINDS))
    parser.add_argument("--pairs", type=int, default=2, help="of each kind of each character")
    arguments = parser.parse_args()
    folders = sorted(path.parent for path in arguments.data.rglob("upper.md3"))
    print(f"{'character':28}   error  unmatched  verdict             CPU s")
    rows = []
    for folder in folders[arguments.half == "report" :: 2]:
        for kind in arguments.kinds.split(","):
            for number in range(arguments.pairs):
                rng = np.random.default_rng([*folder.name.encode(), *kind.encode(), number])
                (source, faces), (target, _) = (posed(folder, kind, rng.integers(10_000, size=2)) for _ in range(2))
                order = rng.permutation(len(target))
                turned = target[order] @ Rotation.random(rng=rng).as_matrix() * np.exp(rng.normal(0, 0.3))
                pair = Mesh(source, faces), Mesh(turned, np.argsort(order)[faces])
                rows.append(judged_whole(f"{folder.name} {kind} {number}", *pair, order))
    print_summary(rows)


if __name__ == "__main__":
    main()
