"""The same region of two people, cut off at different places, as scans of heads, hands and feet are.

    python benchmarks/regions.py --data DIR [--regions face,foot] [--half choice] [--pairs 2] [--json PATH]

A region is what lies within a geodesic distance of a point of `FAUST` (registrations, one triangulation). The radius is
drawn anew for each body, by 5, 12 and 25 % up or down at most. Bodies are divided, and regions of more than 9,000 faces
simplified, so that no two are triangulated alike. In every second pair both files use one unit. Errors are mean
geodesic distances in % of the square root of the region's area, where both regions have a point. DIR as for
benchmarks/automatic.py; people 0 and 1 are the choice half, 2 and 3 the report half.
"""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import replace
from pathlib import Path

import igl
import numpy as np
from automatic import RIGHT, read
from bent_copies import Side, rotated
from scipy.spatial import KDTree

import kfmaps
from kfmaps.datasets import largest_piece
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.mesh import Mesh, surface_area, unit_area
from kfmaps.geometry.subdivision import loop_matrix

REGIONS = {
    "face": (331, 0.085),
    "head": (411, 0.22),
    "hand": (2445, 0.15),
    "foot": (3216, 0.2),
    "leg": (3216, 0.65),
    "arm": (2445, 0.5),
    "bust": (411, 0.5),
    "torso": (3506, 0.45),
}
"""Vertex of the template in the middle of each region, and its radius in √area of the body."""
CHANGES = (0.05, 0.12, 0.25)
PEOPLE = {"choice": (0, 1), "report": (2, 3)}
MAX_FACES = 9000


def region(body: Mesh, name: str, change: float, rng: np.random.Generator) -> tuple[Mesh, np.ndarray]:
    """The region of a body, and the nearest vertex of the template to each of its vertices, (n,)."""
    middle, radius = REGIONS[name]
    matrix, faces = loop_matrix(body.faces, len(body.vertices))
    away = matrix @ geodesic_distances(body, np.array([middle]))[0]
    fine = Mesh(matrix @ body.vertices, faces)
    piece, kept = largest_piece(fine, away < radius * np.exp(rng.uniform(-change, change)))
    template = matrix[kept].toarray().argmax(axis=1)
    if len(piece.faces) <= MAX_FACES:
        return piece, template
    simple, faces = map(np.asarray, igl.decimate(piece.vertices, piece.faces, int(rng.integers(8000, MAX_FACES)))[:2])
    return Mesh(simple, faces.astype(np.int64)), template[KDTree(piece.vertices).query(simple)[1]]


def run(data: Path, half: str, name: str, change: float, number: int) -> dict[str, object]:
    rng = np.random.default_rng([number, int(100 * change), list(REGIONS).index(name), half == "choice"])
    poses = [10 * person + int(rng.integers(10)) for person in PEOPLE[half]]
    bodies = [unit_area(read(data / "FAUST" / f"tr_reg_{pose:03d}.ply")) for pose in poses]
    pieces = [region(body, name, change, rng) for body in bodies]
    sides = [rotated(Side(mesh, np.repeat(template[:, None], 3, axis=1)), rng) for mesh, template in pieces]
    meshes = [side.mesh for side in sides]
    areas = [float(surface_area(mesh)) for mesh, _ in pieces]
    if number % 2 == 0:
        meshes = [
            Mesh(mesh.vertices * np.sqrt(area / surface_area(mesh)), mesh.faces)
            for mesh, area in zip(meshes, areas, strict=True)
        ]
    true_s, true_t = (side.places[:, 0].astype(np.int64) for side in sides)
    begun = time.process_time()
    found = kfmaps.match(meshes[0], meshes[1], replace(kfmaps.Config(), threads=1))
    seconds = time.process_time() - begun
    both = np.isin(true_t, true_s)
    given = both & (found.target_to_source >= 0)
    errors = kfmaps.geodesic_errors(bodies[0], true_s[found.target_to_source[given]], true_t[given])
    return {
        "region": name,
        "pair": f"{poses[0]} {poses[1]}",
        "change": change,
        "ratio": float(np.sqrt(areas[1] / areas[0])),
        "error": 100 * float(errors.mean()) / np.sqrt(areas[0]),
        "given": float(given.sum() / both.sum()),
        "part": found.partial.which,
        "verdict": found.verdict,
        "confidence": found.confidence,
        "seconds": seconds,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--regions", default=",".join(REGIONS))
    parser.add_argument("--half", choices=tuple(PEOPLE), default="report")
    parser.add_argument("--pairs", type=int, default=2, help="of each region and change")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    rows: list[dict] = []
    for name in arguments.regions.split(","):
        for change in CHANGES:
            for number in range(arguments.pairs):
                rows.append(run(arguments.data, arguments.half, name, change, number))
                print(json.dumps(rows[-1]), flush=True)
    print(
        f"\n{'region':8}{'pairs':>6}{'error':>8}{'median':>8}{'worst':>8}{'right':>6}{'sure':>6}{'wrong':>6}"
        f"{'CPU s':>8}"
    )
    for name in (*dict.fromkeys(r["region"] for r in rows), "all"):
        here = [r for r in rows if name in (r["region"], "all")]
        errors, sure = np.array([r["error"] for r in here]), np.array([r["verdict"] == "sure" for r in here])
        print(
            f"{name:8}{len(here):6}{errors.mean():8.2f}{np.median(errors):8.2f}{errors.max():8.2f}"
            f"{(errors < RIGHT).sum():6}{sure.sum():6}{(sure & (errors >= RIGHT)).sum():6}"
            f"{np.mean([r['seconds'] for r in here]):8.1f}"
        )
    if arguments.json:
        arguments.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
