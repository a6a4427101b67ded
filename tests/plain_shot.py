"""SHOT again, slowly: loops over every vertex, support point, volume and bin. The oracle of test_shot.py."""

from __future__ import annotations

import numpy as np

from kfmaps.geometry.mesh import Mesh, face_areas, surface_area, vertex_normals


def plain_support(mesh: Mesh, samples: int) -> list[tuple[np.ndarray, np.ndarray, float]]:
    """(point, unit normal, weight) of every support point."""
    normals = vertex_normals(mesh)
    found = []
    for face, area in zip(mesh.faces, face_areas(mesh), strict=True):
        m = max(1, round(float(np.sqrt(area * samples / surface_area(mesh)))))
        # Every small triangle of the m-fold subdivision, by its three corners.
        for i in range(m):
            for j in range(m - i):
                triangles = [[(i, j), (i + 1, j), (i, j + 1)]]
                if i + j < m - 1:
                    triangles.append([(i + 1, j), (i + 1, j + 1), (i, j + 1)])
                for corners in triangles:
                    a, b = np.mean(corners, axis=0) / m
                    share = np.array([a, b, 1 - a - b])
                    normal = share @ normals[face]
                    found.append((share @ mesh.vertices[face], normal / np.linalg.norm(normal), area / m**2))
    return found


def plain_frame(near: list, radius: float) -> np.ndarray:
    covariance = sum(w * (radius - d) * np.outer(p, p) for p, d, n, w in near)
    normal = np.sum([w * (radius - d) * n for p, d, n, w in near], axis=0)
    middle = np.sum([w * (radius - d) * p for p, d, n, w in near], axis=0)

    def majority(axis: np.ndarray, otherwise: np.ndarray) -> np.ndarray:
        forward = sum(w for p, d, n, w in near if p @ axis > 0)
        backward = sum(w for p, d, n, w in near if p @ axis < 0)
        return axis if (forward > backward if forward != backward else axis @ otherwise > 0) else -axis

    z = normal / np.linalg.norm(normal)
    plane = np.linalg.svd(z[None])[2][1:]  # two unit vectors across z
    x = majority(plane.T @ np.linalg.eigh(plane @ covariance @ plane.T)[1][:, 1], middle)
    return np.array([x, np.cross(z, x), z])


def plain_shot(mesh: Mesh, radius: float, samples: int, at: np.ndarray) -> np.ndarray:
    """The definition in degrees for the vertices ``at``, looking at every volume and every bin of every pair."""
    radius = radius * np.sqrt(surface_area(mesh))
    support = plain_support(mesh, samples)
    rows = []
    for vertex in mesh.vertices[at]:
        near = [(p - vertex, np.linalg.norm(p - vertex), n, w) for p, n, w in support]
        near = [pair for pair in near if 0 < pair[1] <= radius]
        frame = plain_frame(near, radius)
        histogram = np.zeros((8, 2, 2, 11))
        for p, d, n, w in near:
            x, y, z = frame @ p
            azimuth, elevation = np.degrees(np.arctan2(y, x)), np.degrees(np.arccos(z / d))
            fade = min(1, (1 - d / radius) / 0.1)
            for a in range(8):
                turn = abs((azimuth - (45 * a + 22.5) + 180) % 360 - 180) / 45
                for e in range(2):
                    tilt = abs(elevation - (90 * e + 45)) / 90
                    for s in range(2):
                        shell = abs(d / radius - (0.5 * s + 0.25)) / 0.5
                        volume = w * fade * max(0, 1 - turn) * max(0, 1 - tilt) * max(0, 1 - shell)
                        cosines = np.linspace(-1, 1, 11)
                        histogram[a, e, s] += volume * np.maximum(1 - abs(frame[2] @ n - cosines) / 0.2, 0)
        row = np.sqrt(histogram.ravel())
        rows.append(row / np.linalg.norm(row))
    return np.array(rows)
