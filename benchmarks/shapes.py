"""Shapes of any size, made from a formula, for the benchmarks."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull

from kfmaps.mesh import Mesh, unit_area


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
