"""Animals and people of a game, artists' meshes that no number was chosen on, but for half of the people.

    python benchmarks/game_animals.py --data DIR [--kinds fox,bear] [--first 0] [--pairs 2]
    python benchmarks/game_animals.py --data DIR --coarse
    python benchmarks/game_animals.py --data DIR --across 60 [--first 0]
    python benchmarks/game_animals.py --data DIR --walking [--first 0]

DIR is the folder ``art`` of the data of 0 A.D. (Wildfire Games, CC BY-SA 3.0; the file ``public.zip`` of Debian's
package 0ad-data 0.0.26, unpacked). Each animal of ``actors/fauna`` has one mesh, of 100 to 1,700 triangles, and poses
of its skeleton. Its largest piece is posed, subdivided (Loop 1987), and simplified where it is an oriented manifold;
otherwise its vertices are shuffled. Poses of one animal have an exact truth. Of every second pair the second pose is
the one of 20 that is farthest from the first, otherwise the median. ``--coarse`` leaves the meshes as they are, with
shuffled vertices.

``--across N``: animals of two kinds instead, whose parts are told by where they are while the animal stands: of the
target's vertices near the ground, for which share the source's vertex is on the same side, and at the same end.

``--walking``: dressed people without heads instead, of ``meshes/skeletal/new``, half a period of a walk or a run apart,
so that the second pose is nearly the mirror image of the first.
"""

from __future__ import annotations

import argparse
import re
import struct
import time
import warnings
from dataclasses import dataclass
from pathlib import Path

import igl
import numpy as np
from automatic import RIGHT
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

import kfmaps
from kfmaps.geometry.connectivity import component_labels, half_edges
from kfmaps.geometry.mesh import Mesh
from kfmaps.geometry.subdivision import loop_matrix

FOUR_LEGGED = [
    "camel",
    "deer_mesh",
    "donkey",
    "elephant_african_bush",
    "elephant_asian_male",
    "fox",
    "giraffe_adult",
    "horse",
    "animal_lion",
    "mastiff_no_spikes",
    "rhino",
    "sanga_cattle_a",
    "sheep",
    "tiger",
    "wildebeest_adult",
    "zebra",
    "zebu",
    "goat",
    "bull_a",
    "pig",
    "bear",
    "wolf",
    "animal_boar",
    "cattle_female_a",
    "animal_lioness",
    "bear_polar",
    "elephant_african_baby",
    "pony",
    "giraffe_infant",
]
GROUND = 0.22
"""Height, of that of the animal, below which a vertex is near the ground."""
FACES = 9000


@dataclass(frozen=True)
class Animal:
    """A mesh with the weights of its bones, and poses of these."""

    vertices: np.ndarray  # (n, 3)
    faces: np.ndarray  # (m, 3)
    weights: np.ndarray  # (n, b)
    rest: np.ndarray  # (b, 7): positions and quaternions of the bones
    poses: dict[str, np.ndarray]  # (f, b, 7) of each animation

    def posed(self, bones: np.ndarray) -> np.ndarray:
        """The vertices with the ``bones (b, 7)``, by linear blend skinning."""
        motion = transforms(bones) @ np.linalg.inv(transforms(self.rest))
        points = np.c_[self.vertices, np.ones(len(self.vertices))]
        return np.einsum("nb,bij,nj->ni", self.weights, motion, points)[:, :3]

    def standing(self) -> np.ndarray:
        """The vertices where the animal idles."""
        idle = [frames for name, frames in self.poses.items() if "idle" in name.lower()]
        return self.posed([*idle, *self.poses.values()][0][0])


def transforms(bones: np.ndarray) -> np.ndarray:
    """The matrices (b, 4, 4) of positions and quaternions (b, 7)."""
    found = np.tile(np.eye(4), (len(bones), 1, 1))
    found[:, :3, :3], found[:, :3, 3] = Rotation.from_quat(bones[:, 3:]).as_matrix(), bones[:, :3]
    return found


def read_animals(data: Path) -> dict[str, tuple[Path, set[str]]]:
    """The mesh and the names of the animations of each animal."""
    found: dict[str, tuple[Path, set[str]]] = {}
    for path in sorted((data / "actors" / "fauna").glob("*.xml")):
        text = path.read_text(encoding="utf-8", errors="replace")
        for name in re.findall(r'variant file="([^"]+)"', text):
            text += (data / "variants" / name).read_text(encoding="utf-8", errors="replace")
        names = set(re.findall(r'<animation [^>]*file="([^"]+)"', text))
        for mesh in re.findall(r"<mesh>([^<]+)</mesh>", text):
            file = data / "meshes" / f"{mesh}.cached.pmd"
            if file.exists():
                found.setdefault(Path(mesh).stem, (file, set()))[1].update(names)
    return found


def read_people(data: Path) -> dict[str, tuple[Path, set[str]]]:
    """The same of people."""
    folder = data / "animation"
    names = {str(p.relative_to(folder)).removesuffix(".cached.psa") for p in (folder / "biped").rglob("*.cached.psa")}
    files = sorted((data / "meshes" / "skeletal" / "new").glob("*.pmd"))
    return {file.name.removesuffix(".dae.cached.pmd"): (file, names) for file in files}


def read_animal(data: Path, file: Path, animations: set[str]) -> Animal:
    """The largest piece of a mesh (PMD 4) with the animations (PSA 1) of its skeleton."""
    content = file.read_bytes()
    _, _, count, textures = struct.unpack_from("<4I", content, 4)
    fields = [("x", "<f4", 3), ("n", "<f4", 3), ("uv", "<f4", 2 * textures), ("bone", "u1", 4), ("weight", "<f4", 4)]
    rows = np.frombuffer(content, np.dtype(fields), count, 20)
    at = 20 + rows.nbytes
    (n_faces,) = struct.unpack_from("<I", content, at)
    faces = np.frombuffer(content, "<u2", 3 * n_faces, at + 4).reshape(-1, 3).astype(np.int64)
    at += 4 + 6 * n_faces
    (n_bones,) = struct.unpack_from("<I", content, at)
    rest = np.frombuffer(content, "<f4", 7 * n_bones, at + 4).reshape(-1, 7).astype(float)
    weights = np.zeros((count, 256))
    for bone, weight in zip(rows["bone"].T, rows["weight"].T, strict=True):
        weights[np.arange(count), bone] += weight
    weights = weights[:, :n_bones] / weights[:, :n_bones].sum(axis=1, keepdims=True)
    kept, faces = largest_manifold_piece(rows["x"].astype(float), faces)
    poses = {}
    for name in sorted(animations):
        content = (data / "animation" / f"{name}.cached.psa").read_bytes()
        at = 16 + struct.unpack_from("<I", content, 12)[0]
        _, bones, frames = struct.unpack_from("<f2I", content, at)
        if bones == n_bones:
            poses[name] = np.frombuffer(content, "<f4", frames * bones * 7, at + 12).reshape(-1, bones, 7).astype(float)
    return Animal(rows["x"][kept].astype(float), faces, weights[kept], rest, poses)


def largest_manifold_piece(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The vertices that are kept and the faces of the largest piece, vertices at one place as one.

    Faces are left out until each edge has two at most.
    """
    places = np.round(vertices / (1e-5 * np.ptp(vertices, axis=0).max()))
    _, first, same = np.unique(places, axis=0, return_index=True, return_inverse=True)
    faces = same.ravel()[faces]
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    faces = faces[np.unique(np.sort(faces, axis=1), axis=0, return_index=True)[1]]
    while True:
        _, edge, count = np.unique(np.sort(half_edges(faces), axis=1), axis=0, return_inverse=True, return_counts=True)
        excess = (count > 2)[edge.ravel()].reshape(3, -1).sum(axis=0)
        if not excess.any():
            break
        faces = np.delete(faces, excess.argmax(), axis=0)
    piece = component_labels(len(first), *half_edges(faces).T)[1][faces[:, 0]]
    kept, renumbered = np.unique(faces[piece == np.bincount(piece).argmax()], return_inverse=True)
    return first[kept], renumbered.reshape(-1, 3)


def meshed(
    animal: Animal, posed: np.ndarray, n_faces: int, rng: np.random.Generator, coarse: bool = False
) -> tuple[Mesh, np.ndarray, np.ndarray, np.ndarray]:
    """A mesh of its own of an animal as it is ``posed (n, 3)``, turned and in another unit.

    Also the positions of its vertices before they are turned; the subdivided pose, (q, 3), whose vertices are those of
    any other pose; and the subdivided standing animal, (q, 3).
    """
    values, faces = np.c_[posed, animal.standing()], animal.faces
    while len(faces) < FACES and not coarse:
        matrix, faces = loop_matrix(faces, len(values))
        values = matrix @ values
    pose, standing = values[:, :3], values[:, 3:]
    own = meshed_anew(Mesh(pose, faces), n_faces, is_oriented_manifold(animal.faces) and not coarse, rng)
    turned = own.vertices @ Rotation.random(rng=rng).as_matrix().T * np.exp(rng.normal(0, 0.5))
    return Mesh(turned, own.faces), own.vertices, pose, standing


def is_oriented_manifold(faces: np.ndarray) -> bool:
    """Whether ``igl.decimate`` can simplify these faces: on others it fails or never ends."""
    directed = half_edges(faces)
    return len(np.unique(directed, axis=0)) == len(directed) and bool(np.all(igl.is_vertex_manifold(faces)))


def meshed_anew(mesh: Mesh, n_faces: int, simplified: bool, rng: np.random.Generator) -> Mesh:
    """A mesh ``simplified`` to ``n_faces``, or with shuffled vertices."""
    if simplified:
        vertices, faces = map(np.asarray, igl.decimate(mesh.vertices, mesh.faces, n_faces)[:2])
        return Mesh(vertices, faces.astype(np.int64))
    order = rng.permutation(len(mesh.vertices))
    return Mesh(mesh.vertices[order], np.argsort(order)[mesh.faces])


def apart(pose: np.ndarray, other: np.ndarray) -> float:
    """How far two poses (n, 3) are from each other, moved and turned to each other."""
    one, two = pose - pose.mean(axis=0), other - other.mean(axis=0)
    return float(np.linalg.norm(Rotation.align_vectors(one, two)[0].apply(two) - one))


def poses(animal: Animal, number: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Two poses of an animal, (n, 3) each."""
    frames = list(animal.poses.values())

    def drawn() -> np.ndarray:
        some = frames[rng.integers(len(frames))]
        return animal.posed(some[rng.integers(len(some))])

    first = drawn()
    others = sorted((drawn() for _ in range(20)), key=lambda pose: apart(first, pose))
    return first, others[-1 if number % 2 else len(others) // 2]


def found_by(source: Mesh, target: Mesh) -> tuple[kfmaps.Match, np.ndarray, str]:
    """The match, which target vertices have a counterpart, and what is told with the CPU seconds."""
    begun = time.process_time()
    with warnings.catch_warnings(), kfmaps.limit_threads(1):
        warnings.simplefilter("ignore", kfmaps.KfmapsWarning)
        found = kfmaps.match(source, target)
    told = f"{found.verdict}, {found.confidence:.3f}"
    return found, found.target_to_source >= 0, f"{told:18} {time.process_time() - begun:6.1f}"


def judged(name: str, source: Mesh, target: Mesh, truth: np.ndarray) -> tuple[bool, bool]:
    """Print how two shapes are matched; return whether that is right, and sure. ``truth (n_t,)``: source vertices."""
    found, known, told = found_by(source, target)
    errors = 100 * kfmaps.geodesic_errors(source, found.target_to_source[known], truth[known])
    missing = 1 - known.mean()
    print(f"{name} {errors.mean():7.2f} {missing:8.0%}   {told}", flush=True)
    return bool(errors.mean() < RIGHT and missing < 0.1), found.verdict == "sure"


def print_summary(rows: list[tuple[bool, bool]]) -> None:
    """Print how many maps are right, sure, and both."""
    right, sure = np.array(rows).T
    print(f"{len(rows)} maps, {right.sum()} right; {sure.sum()} sure, {(sure & ~right).sum()} of them wrong")


def half_a_period(animal: Animal, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Two poses of somebody who walks or runs, (n, 3) each, half a period apart."""
    walks = [frames for name, frames in animal.poses.items() if "walk" in name or "run" in name]
    frames = walks[rng.integers(len(walks))]
    at = rng.integers(len(frames))
    return animal.posed(frames[at]), animal.posed(frames[(at + len(frames) // 2) % len(frames)])


def in_two_poses(name: str, animal: Animal, number: int, arguments: argparse.Namespace) -> tuple[bool, bool]:
    """Print how one animal is matched to itself; return whether that is right, and sure."""
    rng, coarse = np.random.default_rng([number, *name.encode()]), arguments.coarse
    first, second = half_a_period(animal, rng) if arguments.walking else poses(animal, number, rng)
    source, own_s, pose_s, _ = meshed(animal, first, FACES, rng, coarse)
    target, own_t, pose_t, _ = meshed(animal, second, FACES - 1000, rng, coarse)
    truth = KDTree(own_s).query(pose_s[KDTree(pose_t).query(own_t)[1]])[1]
    return judged(f"{name:24} {number:4}", source, target, np.asarray(truth))


def across(names: tuple[str, str], animals: tuple[Animal, Animal], number: int) -> tuple[bool, bool]:
    """Print how animals of two kinds are matched; return whether legs are at their places, and whether that is sure."""
    rng = np.random.default_rng([number, *"".join(names).encode()])
    made = [meshed(animal, poses(animal, number, rng)[0], FACES, rng) for animal in animals]
    is_low, side, end = [], [], []
    for _, own, pose, standing in made:
        height, low = standing[:, 1] - standing[:, 1].min(), standing[:, 1].min() + 0.15 * np.ptp(standing[:, 1])
        feet = standing[standing[:, 1] < low, 2]
        nearest = KDTree(pose).query(own)[1]
        is_low.append((height < GROUND * height.max())[nearest])
        side.append((standing[:, 0] > 0)[nearest])
        end.append((standing[:, 2] > (feet.min() + feet.max()) / 2)[nearest])
    found, known, told = found_by(made[0][0], made[1][0])
    rows: np.ndarray = np.flatnonzero(is_low[1] & known)
    at = found.target_to_source[rows]
    same_side, same_end = (float((one[0][at] == one[1][rows]).mean()) for one in (side, end))
    print(f"{names[0]:22} {names[1]:22} {number:4} {same_side:6.2f} {same_end:6.2f}   {told}", flush=True)
    return min(same_side, same_end) > 0.85, found.verdict == "sure"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument(
        "--kinds", default="", help="names of meshes; all with poses and more than 100 vertices if not given"
    )
    parser.add_argument("--pairs", type=int, default=2, help="of each kind")
    parser.add_argument("--first", type=int, default=0, help="number of the first pair")
    parser.add_argument("--coarse", action="store_true", help="the artists' meshes themselves")
    parser.add_argument("--across", type=int, default=0, help="pairs of two kinds instead")
    parser.add_argument("--walking", action="store_true", help="people instead")
    arguments = parser.parse_args()
    files = read_people(arguments.data) if arguments.walking else read_animals(arguments.data)
    kinds = arguments.kinds.split(",") if arguments.kinds else sorted(files)
    animals = {name: read_animal(arguments.data, *files[name]) for name in kinds}
    animals = {name: animal for name, animal in animals.items() if animal.poses and len(animal.vertices) > 100}
    rows = []
    if arguments.across:
        print(f"{'source':22} {'target':22} pair   side    end   verdict             CPU s")
        some = [name for name in FOUR_LEGGED if name in animals]
        for number in range(arguments.first, arguments.first + arguments.across):
            a, b = np.random.default_rng(number).choice(some, 2, replace=False)
            rows.append(across((a, b), (animals[a], animals[b]), number))
    else:
        print(f"{'animal':24} pair   error  unmatched  verdict             CPU s")
        for name, animal in animals.items():
            for number in range(arguments.first, arguments.first + arguments.pairs):
                rows.append(in_two_poses(name, animal, number, arguments))
    print_summary(rows)


if __name__ == "__main__":
    main()
