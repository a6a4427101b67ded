"""Maps between two triangulations of a solid, as CAD programs write them, the second one stretched and moved too.

    python benchmarks/solid_parts.py PARTS
    python benchmarks/solids.py PARTS [--half choice|report] [--names lever,hook] [--open]

Two maps of each part: from its coarse to its fine triangulation, and from the fine one to one in between, which is
stretched by 1.2 and 0.9 along two axes. Errors are straight distances on the source in % of √area, at the target's
vertices, between the map's points and the true ones. A bolt, a flange, a clevis and a gear are nearly symmetric, so
that turned maps of them are as good. With ``--open`` the flat faces at the bottom are left out.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace
from pathlib import Path

import igl
import numpy as np
from automatic import RIGHT
from scipy.spatial.transform import Rotation

import kfmaps
from kfmaps.geometry.mesh import Mesh, surface_area, vertex_areas

PAIRS = (("coarse", "fine", (1.0, 1.0, 1.0)), ("fine", "middle", (1.2, 1.0, 0.9)))


def opened(mesh: Mesh) -> Mesh:
    """What is left without the flat faces at the bottom."""
    heights = mesh.vertices[mesh.faces][:, :, 2]
    faces = mesh.faces[heights.max(axis=1) > mesh.vertices[:, 2].min() + 1e-6]
    kept, numbers = np.unique(faces, return_inverse=True)
    return Mesh(mesh.vertices[kept], numbers.reshape(-1, 3))


def judged(one: Mesh, plain: Mesh, name: str, stretch: tuple[float, ...]) -> tuple[float, str, float]:
    """Match one pair; return its mean error, verdict and CPU seconds."""
    turn = Rotation.random(rng=np.random.default_rng([*name.encode()])).as_matrix()
    other = Mesh(plain.vertices * stretch @ turn, plain.faces)
    begun = time.process_time()
    found = kfmaps.match(one, other, replace(kfmaps.Config(), threads=1))
    seconds = time.process_time() - begun
    true = igl.point_mesh_squared_distance(plain.vertices, one.vertices, one.faces)[2]
    errors = np.linalg.norm(one.vertices[found.target_to_source] - true, axis=1) / np.sqrt(surface_area(one))
    known = found.target_to_source >= 0
    error = 100 * float(np.average(errors[known], weights=vertex_areas(other)[known]))
    counts = f"{len(one.vertices):6}{len(other.vertices):6}"
    told = f"{found.verdict:10}{found.confidence:6.3f}{seconds:7.1f}"
    print(f"{name:15}{counts}{error:8.2f}   {told}", flush=True)
    return error, found.verdict, seconds


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", type=Path)
    parser.add_argument("--half", choices=("choice", "report"), default="report")
    parser.add_argument("--open", action="store_true", help="without the faces at the bottom")
    parser.add_argument("--names", default="", help="parts of names")
    arguments = parser.parse_args()
    folder, some = arguments.parts / arguments.half, arguments.names.split(",")
    names = sorted({path.name.split(".")[0] for path in folder.glob("*.stl")})
    print(f"{'part':15}{'vertices':>12}{'error':>8}   verdict           CPU s")
    rows = []
    for *both, stretch in PAIRS:
        for name in (name for name in names if any(part in name for part in some)):
            meshes = [kfmaps.read_mesh(folder / f"{name}.{mesh}.stl") for mesh in both]
            source, target = map(opened, meshes) if arguments.open else meshes
            try:
                rows.append(judged(source, target, name, stretch))
            except kfmaps.InvalidInput:
                print(f"{name:15} has too few vertices", flush=True)
    right = [error < RIGHT for error, _, _ in rows]
    print(f"\n{len(rows)} maps, {sum(right)} right")
    for word in ("sure", "likely", "ambiguous", "unlikely"):
        some = [is_right for is_right, (_, verdict, _) in zip(right, rows, strict=True) if verdict == word]
        print(f"{word}: {len(some)}, right {sum(some)}")
    print(f"CPU seconds: {np.mean([seconds for *_, seconds in rows]):.1f} each")


if __name__ == "__main__":
    main()
