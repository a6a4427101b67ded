"""Parts of which more than 80 % is missing: how many are placed right, and what is told of them.

    python benchmarks/small_parts.py --data DIR [--sets FAUST_r,TOSCA_r] [--pairs 4] [--half report] [--json FILE]

Of the target of each pair only what is near a point is kept, 10, 15 and 20 % of its area: near two of its extremities
("tip": feet, hands, heads and tails) and near two points at random ("skin"). It is matched to the whole source, another
person or pose. Errors are mean geodesic distances on the source × 100. "Right" is an error below 8, "mirrored" one
below 8 to the mirror image of the truth where that is not right. DIR is as for benchmarks/automatic.py.
"""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from automatic import RIGHT, Job, chosen_pairs, lines, loaded, pair_options

import kfmaps
from kfmaps.datasets import largest_piece
from kfmaps.fmap.precise import nearest_vertices
from kfmaps.geometry.geodesics import farthest_geodesic, geodesic_distances
from kfmaps.geometry.mesh import Mesh, unit_area, vertex_areas

SHARES = (0.1, 0.15, 0.2)
WRONG = 10.0
"""Mean error × 100 above which no map should be called sure."""


def balls(mesh: Mesh, seed: int) -> Iterator[tuple[str, float, Mesh, np.ndarray]]:
    """Where a part lies, its share of the area, the part, and the vertices of the whole that it keeps."""
    rng = np.random.default_rng(seed)
    # The first of the farthest points is drawn at random; those after it are extremities.
    tips, others = rng.permutation(farthest_geodesic(mesh, 6, seed)[1:])[:2], rng.integers(len(mesh.vertices), size=2)
    areas = vertex_areas(mesh)
    for place, centres in ("tip", tips), ("skin", others):
        for away in geodesic_distances(mesh, centres):
            order = np.argsort(away)
            grown = np.cumsum(areas[order]) / areas.sum()
            for share in SHARES:
                keep = np.zeros(len(away), dtype=bool)
                keep[order[grown <= share]] = True
                yield place, share, *largest_piece(mesh, keep)


def parts(job: Job, seed: int) -> Iterator[tuple[dict[str, object], Mesh, Mesh, np.ndarray, np.ndarray, np.ndarray]]:
    """What a part is called, the whole, the part, its vertices with a truth (m,), that truth and its mirror image."""
    source, target, true_s, true_t = loaded(job)
    source, target = unit_area(source), unit_area(target)
    assert job.data is not None
    mirrored = lines(job.data / job.kind, f"{job.source}.sym")
    for number, (place, share, part, kept) in enumerate(balls(target, seed)):
        new = np.full(len(target.vertices), -1)
        new[kept] = np.arange(len(kept))
        some = new[true_t] >= 0
        name = {"set": job.kind, "pair": f"{job.source} {job.target} {number}", "place": place, "share": share}
        yield name, source, part, new[true_t[some]], true_s[some], mirrored[some]


def run(job: Job, seed: int) -> Iterator[dict[str, object]]:
    config = replace(kfmaps.Config(), threads=1)
    config = replace(config, partial=replace(config.partial, part="target"))
    for name, whole, part, rows, true, mirrored in parts(job, seed):
        begun = time.process_time()
        found = kfmaps.match(whole, part, config)
        seconds = time.process_time() - begun
        images = nearest_vertices(found.precise(), whole)[rows]
        errors = [100 * float(kfmaps.geodesic_errors(whole, images, ends).mean()) for ends in (true, mirrored)]
        right = errors[0] < RIGHT
        yield name | {
            "error": errors[0],
            "right": right,
            "mirrored": not right and errors[1] < RIGHT,
            "verdict": found.verdict,
            "confidence": found.confidence,
            "score": found.score.scores[0],
            "scale": found.partial.scale,
            "seconds": seconds,
        }


def main() -> None:
    parser = pair_options(__doc__, "FAUST_r,TOSCA_r", 4, "report")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    rows: list[dict] = []
    for kind in arguments.sets.split(","):
        for seed, pair in enumerate(chosen_pairs(kind, arguments.data, arguments.half, arguments.pairs, seed=1)):
            for row in run(Job(arguments.data, kind, *pair), seed):
                rows.append(row)
                print(json.dumps(row), flush=True)
    words = "right", "mirrored", "sure", "likely", "ambiguous", "unlikely"
    print(f"\n{'':12}{'kept':>6}{'parts':>7}" + "".join(f"{word:>10}" for word in words) + f"{'sure, >10':>11}")
    for place in ("tip", "skin"):
        for share in SHARES:
            here = [r for r in rows if (r["place"], r["share"]) == (place, share)]
            counts = [sum(r[w] if w in r else r["verdict"] == w for r in here) for w in words]
            lies = sum(r["verdict"] == "sure" and r["error"] > WRONG for r in here)
            print(f"{place:12}{share:6.0%}{len(here):7}" + "".join(f"{n:10}" for n in counts) + f"{lies:11}")
    if arguments.json:
        arguments.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
