"""Each mesh of a folder and a bent copy of it, meshed anew: ``python benchmarks/bent_copies.py DIR [--cut part]``.

Any meshes will do, your own too. A copy is twisted about its longest axis by up to 50 degrees, bent by up to 57, moved
and scaled, and both are divided and simplified to 8,000 and 9,000 faces. The truth is known to an edge's length. Errors
are mean geodesic distances × 100. A shape with a symmetry may be right in several ways, of which the table knows one:
such maps should not be "sure".

``--cut part``: the copy is cut by a random plane; ``--cut both``: both are, at nearly one place. ``--given``: the
meshes themselves, however coarse, up to 3,000 vertices, and copies that are not bent. ``--mirrored``: mirrored copies,
of which a body that is nearly its own mirror image has a map that keeps orientation too; with ``--landmarks 5`` by five
true landmarks, with ``--orientation either`` by that setting.

``--pieces``: the meshes as they are, of 150 to 12,000 vertices in any number of pieces, whose copies have the same
triangles; errors are straight distances then. ``--every 14`` takes every 14th file, ``--first`` says from which on.
"""

from __future__ import annotations

import argparse
import time
import warnings
from dataclasses import dataclass, replace
from pathlib import Path

import igl
import numpy as np
from automatic import RIGHT
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

import kfmaps
from kfmaps.datasets import largest_piece
from kfmaps.geometry.clean import clean_mesh
from kfmaps.geometry.connectivity import half_edges
from kfmaps.geometry.geodesics import farthest_geodesic
from kfmaps.geometry.mesh import Mesh, mirror_mesh, unit_area
from kfmaps.geometry.subdivision import loop_matrix
from kfmaps.io.meshes import READERS

MAX_GIVEN = 3000
"""Vertices up to which ``--given`` takes a mesh."""


@dataclass(frozen=True)
class Side:
    """A mesh, and the places of its vertices on the shape before it was bent and moved."""

    mesh: Mesh
    places: np.ndarray

    def cut(self, normal: np.ndarray, height: float) -> Side:
        """The largest piece above a plane."""
        mesh, kept = largest_piece(self.mesh, self.places @ normal > height)
        return Side(mesh, self.places[kept])


def usable(path: Path, as_given: bool) -> Mesh | None:
    """The cleaned mesh of a file; ``None`` where it cannot be read, is tiny, or is not an oriented manifold."""
    try:
        mesh = kfmaps.read_mesh(path)
        mesh = mesh if as_given else clean_mesh(mesh, specks=True).mesh
    except kfmaps.InvalidInput:
        return None
    edges, least = half_edges(mesh.faces), 100  # faces
    if as_given:
        return unit_area(mesh) if 150 < len(mesh.vertices) < 12_000 else None
    if len(mesh.faces) < least or len(np.unique(edges, axis=0)) < len(edges):
        return None
    return unit_area(mesh) if np.all(igl.is_vertex_manifold(mesh.faces)) else None


def bent(x: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Points (n, 3) twisted about the longest axis and bent along it."""
    centred = x - x.mean(axis=0)
    axes = np.linalg.svd(centred, full_matrices=False)[2]
    axes[2] *= np.linalg.det(axes)
    along, y, z = (centred @ axes.T).T
    length = np.ptp(along)
    twist = rng.uniform(-0.9, 0.9) * along / length
    y, z = y * np.cos(twist) - z * np.sin(twist), y * np.sin(twist) + z * np.cos(twist)
    radius = length / (rng.uniform(0.3, 1.0) * rng.choice([-1, 1]))
    angle = along / radius
    return np.stack([(radius - y) * np.sin(angle), radius - (radius - y) * np.cos(angle), z], axis=1)


def remeshed(mesh: Mesh, moved: np.ndarray, n_faces: int, rng: np.random.Generator) -> Side:
    """The mesh with its vertices ``moved``, divided and simplified to ``n_faces``, then moved rigidly and scaled."""
    x, places, faces = moved, mesh.vertices, mesh.faces
    while len(faces) < 1.1 * n_faces:
        matrix, faces = loop_matrix(faces, len(x))
        x, places = matrix @ x, matrix @ places
    simple, faces = map(np.asarray, igl.decimate(x, faces, n_faces)[:2])
    return rotated(Side(Mesh(simple, faces.astype(np.int64)), places[KDTree(x).query(simple)[1]]), rng)


def rotated(side: Side, rng: np.random.Generator) -> Side:
    """The mesh turned and scaled at random, with its vertices in another order."""
    order = rng.permutation(len(side.places))
    x = side.mesh.vertices[order] @ Rotation.random(rng=rng).as_matrix().T * np.exp(rng.normal(0, 0.3))
    return Side(Mesh(x, np.argsort(order)[side.mesh.faces]), side.places[order])


def made(mesh: Mesh, arguments: argparse.Namespace, rng: np.random.Generator) -> tuple[Side, Side]:
    """Source and target."""
    x = mesh.vertices
    if arguments.pieces:
        return Side(mesh, x), rotated(Side(Mesh(bent(x, rng), mesh.faces), x), rng)
    source = rotated(Side(mesh, x), rng) if arguments.given else remeshed(mesh, x, 8000, rng)
    target = remeshed(mesh, x if arguments.given else bent(x, rng), 9000, rng)
    if arguments.mirrored:
        target = replace(target, mesh=mirror_mesh(target.mesh))
    if arguments.cut:
        normal = rng.normal(size=3)
        normal /= np.linalg.norm(normal)
        heights = source.places @ normal
        at, shift = np.quantile(heights, rng.uniform(0.25, 0.65)), rng.uniform(-0.03, 0.03) * np.ptp(heights)
        target = target.cut(normal, at + shift)
        source = source.cut(normal, at) if arguments.cut == "both" else source
    return source, target


def spread(source: Side, target: Side, count: int) -> np.ndarray | None:
    """True landmarks (count, 2) that are far from each other; ``None`` where there are none."""
    if count == 0:
        return None
    ends = farthest_geodesic(source.mesh, count, 0)
    return np.column_stack([ends, KDTree(target.places).query(source.places[ends])[1]])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--cut", choices=("part", "both"))
    parser.add_argument("--given", action="store_true")
    parser.add_argument("--pieces", action="store_true")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--mirrored", action="store_true")
    parser.add_argument("--orientation", choices=("auto", "preserving", "reversing", "either"), default="auto")
    parser.add_argument("--landmarks", type=int, default=0)
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    config = kfmaps.Config(threads=1)
    assert config.search is not None
    config = replace(config, search=replace(config.search, orientation=arguments.orientation))
    rows = []
    print(f"{'mesh':24} vertices      error  unmatched  verdict             CPU s")
    paths = sorted(p for p in arguments.folder.iterdir() if p.suffix.lower() in READERS)
    for path in paths[arguments.first :: arguments.every]:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            mesh = usable(path, arguments.pieces)
            if mesh is None or (arguments.given and not 100 < len(mesh.vertices) <= MAX_GIVEN):
                continue
            source, target = made(mesh, arguments, np.random.default_rng([arguments.seed, *path.stem.encode()]))
            start = time.process_time()
            try:
                found = kfmaps.match(
                    source.mesh, target.mesh, config, landmarks=spread(source, target, arguments.landmarks)
                )
            except kfmaps.InvalidInput as error:
                print(f"{path.stem:24} {error}", flush=True)
                continue
        seconds, matched = time.process_time() - start, found.target_to_source >= 0
        truth = np.asarray(KDTree(source.places).query(target.places)[1])
        if arguments.pieces:
            errors = np.linalg.norm(source.places[found.target_to_source[matched]] - target.places[matched], axis=1)
        else:
            errors = kfmaps.geodesic_errors(source.mesh, found.target_to_source[matched], truth[matched])
            errors = np.where(np.isfinite(errors), errors, 1.0)  # on another component
        told, sizes = f"{found.verdict}, {found.confidence:.3f}", f"{len(source.places)}, {len(target.places)}"
        off, none = f"{100 * errors.mean():.2f}", f"{1 - matched.mean():.0%}"
        print(f"{path.stem:24} {sizes:12} {off:>6} {none:>10}  {told:18} {seconds:6.1f}", flush=True)
        rows.append((errors.mean() < RIGHT / 100, found.verdict == "sure", seconds))
    right, sure, seconds = np.array(rows, dtype=float).T
    wrong = (sure * (1 - right)).sum()
    print(f"{len(rows)} maps, {right.sum():.0f} right; {sure.sum():.0f} sure, {wrong:.0f} of them wrong; ", end="")
    print(f"CPU s {np.median(seconds):.1f} in the median, {seconds.max():.1f} at most")


if __name__ == "__main__":
    main()
