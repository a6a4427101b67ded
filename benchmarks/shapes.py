"""Shapes of any size, made from a formula, for the benchmarks, and pairs of them or of files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull, KDTree

from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.io.meshes import read_mesh


def bumpy_sphere(n: int, rng: int | np.random.Generator = 0) -> Mesh:
    """A closed surface of exactly ``n`` vertices and unit area: a sphere with limbs and irregular triangles.

    The vertices follow the golden spiral, each moved at random by up to a third of the spacing, and are
    joined by the Delaunay triangulation of the sphere; then eight smooth bumps, some tall, push them outwards,
    so that the triangles are as uneven as those of a scanned shape. The bumps depend on ``rng`` alone, so
    that two sizes with one seed sample (nearly) one surface.
    """
    generator = np.random.default_rng(rng)
    centres = generator.normal(size=(8, 3))
    centres /= np.linalg.norm(centres, axis=1, keepdims=True)
    heights = generator.uniform(0.3, 1.5, size=8)
    widths = generator.uniform(0.15, 0.5, size=8)
    height = 1 - (2 * np.arange(n) + 1) / n
    angle = np.pi * (3 - np.sqrt(5)) * np.arange(n)
    ring = np.sqrt(1 - height**2)
    points = np.stack([ring * np.cos(angle), ring * np.sin(angle), height], axis=1)
    points += generator.uniform(-1, 1, size=(n, 3)) / 3 * np.sqrt(4 * np.pi / n)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    hull = ConvexHull(points)
    faces = hull.simplices.astype(np.int64)
    corners = points[faces]
    inward = np.einsum(
        "fi,fi->f", np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), corners[:, 0]
    )
    faces[inward < 0] = faces[inward < 0][:, [0, 2, 1]]
    radius = np.ones(n)
    for centre, tall, wide in zip(centres, heights, widths, strict=True):
        radius += tall * np.exp(-((points - centre) ** 2).sum(axis=1) / wide**2)
    return unit_area(Mesh(points * radius[:, None], faces))


@dataclass(frozen=True, eq=False)
class Pair:
    """Two shapes with the truth between them: ``target_to_source`` (n_t,) and ``landmarks`` (6, 2)."""

    name: str
    source: Mesh
    target: Mesh
    target_to_source: np.ndarray
    landmarks: np.ndarray


def bumpy_pair(n: int, rng: int = 0) -> Pair:
    """A bumpy sphere of ``n`` vertices, and one of 2 % fewer, meshed anew, stretched and bent.

    The truth is the source vertex in the nearest direction from the centre; six landmarks lie in random directions.
    """
    source, target = bumpy_sphere(n, rng), bumpy_sphere(n - n // 50, rng)
    directions = [m.vertices / np.linalg.norm(m.vertices, axis=1, keepdims=True) for m in (source, target)]
    x = target.vertices * np.array([1.1, 0.95, 1.0])
    bent = unit_area(Mesh(x + 0.05 * np.sin(3 * x[:, [1, 2, 0]]), target.faces))
    truth = np.asarray(KDTree(directions[0]).query(directions[1])[1], dtype=np.int64)
    rays = np.random.default_rng(rng + 1).normal(size=(6, 3))
    marks = np.asarray(KDTree(directions[1]).query(rays)[1], dtype=np.int64)
    return Pair(f"bumpy {n}", source, bent, truth, np.stack([truth[marks], marks], axis=1))


def read_pairs(folder: Path, count: int) -> list[Pair]:
    """Pairs of remeshed scans laid out as FAUST_r is: meshes, ``test_pairs.txt``, and ``corres/NAME.vts``, 1-based.

    The truth of a target vertex is that of the target's nearest vertex that has a correspondence.
    """
    lines = [line.split() for line in (folder / "test_pairs.txt").read_text().splitlines() if line.strip()]
    pairs = []
    for names in lines[5 :: max(1, len(lines) // count)][:count]:
        meshes = [read_mesh(next(p for s in ("ply", "off") if (p := folder / f"{n}.{s}").exists())) for n in names]
        lists = [np.loadtxt(folder / "corres" / f"{n}.vts", dtype=np.int64) - 1 for n in names]
        nearest = np.asarray(KDTree(meshes[1].vertices[lists[1]]).query(meshes[1].vertices)[1], dtype=np.int64)
        rows = np.linspace(0, len(lists[0]) - 1, 8).astype(int)[1:-1]
        marks = np.stack([lists[0][rows], lists[1][rows]], axis=1)
        pairs.append(Pair(" to ".join(names), meshes[0], meshes[1], lists[0][nearest], marks))
    return pairs
