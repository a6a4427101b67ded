"""Noisy point clouds without landmarks against the meshes that they were drawn from: errors and verdicts.

    python benchmarks/clouds.py --data DIR [--sets FAUST_r,TOSCA_r] [--half report] [--pairs 2] [--noise 0,0.003,0.01]

A cloud has the vertices of a shape and, with ``--points``, further points drawn evenly at random, each moved by normal
noise of the given standard deviation in √area in every direction. Errors are mean geodesic distances on the whole
source × 100, of the target's vertices with a truth; the first row of a pair is of the meshes. "least" is the error of a
map that is perfect but knows points by their noisy positions alone. DIR is as for benchmarks/automatic.py.
"""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
from automatic import chosen_jobs, loaded, pair_options
from scipy.spatial import KDTree

import kfmaps
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.mesh import Mesh, face_areas, unit_area


def cloud(mesh: Mesh, count: int, noise: float, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Points near a mesh of unit area, its vertices first, and the vertex that each is nearest to without noise."""
    more = max(count - len(mesh.vertices), 0)
    areas = face_areas(mesh)
    corners = mesh.vertices[mesh.faces[rng.choice(len(areas), more, p=areas / areas.sum())]]
    points = np.concatenate([mesh.vertices, np.einsum("nij,ni->nj", corners, rng.dirichlet(np.ones(3), more))])
    nearest = np.asarray(KDTree(mesh.vertices).query(points)[1])
    return points + noise * rng.normal(size=points.shape), nearest


def least_error(mesh: Mesh, first: np.ndarray, second: np.ndarray, nearest: np.ndarray) -> float:
    """The error × 100 of the nearest points of the ``first`` cloud of a mesh for the vertices of the ``second``."""
    a, b = (closest_points(one, mesh.vertices, mesh.faces).points for one in (first, second[: len(mesh.vertices)]))
    images = nearest[np.asarray(KDTree(a).query(b)[1])]
    return 100 * float(kfmaps.geodesic_errors(mesh, images, np.arange(len(images))).mean())


def main() -> None:
    parser = pair_options(__doc__, "FAUST_r,SHREC19_r,TOSCA_r,SMAL_r", 2, "report")
    parser.add_argument("--noise", default="0,0.003,0.01", help="standard deviations, in √area")
    parser.add_argument("--points", type=int, default=0, help="of a cloud, at least those of the mesh")
    parser.add_argument("--no-meshes", action="store_true", help="only clouds")
    arguments = parser.parse_args()
    config = replace(kfmaps.Config(), threads=1)
    print(f"{'pair':34}{'noise':>7}{'least':>7}{'error':>7}  {'verdict':11}{'told':>6}{'faces':>7}{'CPU s':>7}")
    for job in chosen_jobs(arguments, seed=1):
        source, target, true_s, true_t = loaded(job)
        source, target = unit_area(source), unit_area(target)
        levels = [float(noise) for noise in arguments.noise.split(",")]
        for noise in levels if arguments.no_meshes else [None, *levels]:
            rng = np.random.default_rng(0)
            clouds = [cloud(mesh, arguments.points, noise or 0.0, rng) for mesh in (source, target)]
            given = (source, target) if noise is None else [Mesh(points) for points, _ in clouds]
            begun = time.process_time()
            shapes = [kfmaps.prepare(mesh, config) for mesh in given]
            found = kfmaps.match(shapes[0], shapes[1], config)
            seconds = time.process_time() - begun
            images = found.target_to_source[true_t]
            least = least_error(source, clouds[0][0], cloud(source, 0, noise or 0.0, rng)[0], clouds[0][1])
            images = images if noise is None else clouds[0][1][images]
            error = 100 * float(kfmaps.geodesic_errors(source, images, true_s).mean())
            faces = sum(len(one.mesh.faces) > 0 for one in shapes)
            told = found.confidence or 0.0
            print(
                f"{job!s:34}{'mesh' if noise is None else noise:>7}{least:7.2f}{error:7.2f}  {found.verdict:11}"
                f"{told:6.2f}{faces:7}{seconds:7.1f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
