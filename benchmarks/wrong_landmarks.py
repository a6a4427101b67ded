"""Landmarks of which some are wrong: errors of the maps, and which landmarks are named.

    python benchmarks/wrong_landmarks.py --data DIR [--half choice|report] [--pairs 2] [--sets FAUST_r,...]
    python benchmarks/wrong_landmarks.py --data DIR --only FAUST_r,tr_reg_003,tr_reg_012 --ways "10, left for right"

DIR as for benchmarks/automatic.py. Every pair is matched without landmarks, with right ones, and with some that are
wrong in one of the ways of :data:`WAYS`, or of those that ``--ways`` names, with semicolons between them. "local" is
the mean error within 0.1 √area of the wrong landmarks.
"""

from __future__ import annotations

import json
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from automatic import Job, chosen_jobs, chosen_landmarks, loaded, pair_options
from scipy.spatial import KDTree

import kfmaps
from kfmaps.geometry.geodesics import geodesic_distances

WAYS = {
    "right 3": (3, "right", 0),
    "right 5": (5, "right", 0),
    "right 10": (10, "right", 0),
    "3, one far": (3, "far", 1),
    "5, one off by 0.15": (5, "near", 1),
    "5, two exchanged": (5, "exchanged", 2),
    "10, two far": (10, "far", 2),
    "10, one off by 0.15": (10, "near", 1),
    "10, all off by 0.04": (10, "shaken", 10),
    "3, left for right": (3, "sides", 3),
    "10, left for right": (10, "sides", 10),
    "25, left for right": (25, "sides", 25),
}
"""Number of landmarks, what is done to how many of them."""


def at_distance(target: kfmaps.Shape, vertex: int, distance: float, rng: np.random.Generator) -> int:
    """A vertex about ``distance`` from another, in √area."""
    away = geodesic_distances(target.mesh, np.array([vertex]))[0]
    return int(rng.choice(np.argsort(abs(away - distance))[:5]))


def spoil(pairs: np.ndarray, way: str, count: int, target: kfmaps.Shape, rng: np.random.Generator) -> np.ndarray:
    """The landmarks with ``count`` of them wrong; unchanged rows are right."""
    made = pairs.copy()
    bad = rng.permutation(len(pairs))[:count]
    if way == "far":
        away = geodesic_distances(target.mesh, pairs[bad, 1])
        made[bad, 1] = [rng.choice(np.flatnonzero(d > 0.4)) for d in away]
    elif way in ("near", "shaken"):
        made[bad, 1] = [at_distance(target, v, 0.15 if way == "near" else 0.04, rng) for v in pairs[bad, 1]]
    elif way == "exchanged":
        made[bad, 1] = np.roll(pairs[bad, 1], 1)
    elif way == "sides":
        config = kfmaps.Config()
        assert config.search is not None
        turned = replace(config, threads=1, search=replace(config.search, orientation="reversing"))
        made[:, 1] = kfmaps.match(target, target, turned).target_to_source[pairs[:, 1]]
    return made


def rows_of(job: Job, ways: tuple[str, ...] = tuple(WAYS)) -> list[dict]:
    """One row without landmarks and one for each way."""
    source, target, true_s, true_t = loaded(job)
    config = replace(kfmaps.Config(), threads=1)
    shapes = [kfmaps.prepare(mesh, config, name=name) for mesh, name in ((source, "source"), (target, "target"))]
    places, rows, alone = shapes[1].mesh.vertices, [], np.zeros(0)
    for name, (count, way, n_bad) in {"none": (0, "right", 0), **{way: WAYS[way] for way in ways}}.items():
        rng = np.random.default_rng(count)
        right = chosen_landmarks(shapes[0], (true_s, true_t), count, 0.0) if count else np.zeros((0, 2), dtype=int)
        pairs = spoil(right, way, n_bad, shapes[1], rng)
        pairs = pairs[np.unique(pairs[:, 1], return_index=True)[1]] if way == "sides" else pairs
        wrong = ~(pairs[:, None] == right).all(axis=2).any(axis=1)
        start = time.process_time()
        found = kfmaps.match(shapes[0], shapes[1], config, landmarks=pairs if count else None)
        seconds = time.process_time() - start
        errors = 100 * kfmaps.geodesic_errors(source, found.target_to_source[true_t], true_s)
        alone = errors if count == 0 else alone
        bad = np.concatenate([places[pairs[wrong, 1]], places[right[~np.isin(right[:, 1], pairs[:, 1]), 1]]])
        near = KDTree(bad).query(places[true_t])[0] < 0.1 if len(bad) else np.zeros(len(true_t), dtype=bool)
        named = found.score.rejected_landmarks
        rows.append(
            {
                "set": job.kind,
                "pair": f"{job.source} {job.target}",
                "way": name,
                "error": float(errors.mean()),
                "local": [float(e[near].mean()) if near.any() else None for e in (alone, errors)],
                "named": int(wrong[named].sum()),
                "wrong": int(wrong.sum()),
                "blamed": int((~wrong)[named].sum()),
                "verdict": found.verdict,
                "confidence": found.confidence,
                "seconds": seconds,
            }
        )
        print(json.dumps(rows[-1]), flush=True)
    return rows


def report(rows: list[dict]) -> None:
    """Print a line for each set and way."""
    print(
        f"\n{'set':12}{'landmarks':22}{'pairs':>6}{'error':>7}{'alone':>7}{'local':>7}{'alone':>7}{'named':>9}{'blamed':>7}"
    )
    for kind in dict.fromkeys(r["set"] for r in rows):
        here = [r for r in rows if r["set"] == kind]
        alone = np.mean([r["error"] for r in here if r["way"] == "none"])
        for way in dict.fromkeys(r["way"] for r in rows):
            made = [r for r in here if r["way"] == way]
            local = [r["local"] for r in made if r["local"][0] is not None]
            both = np.mean(local, axis=0) if local else (np.nan, np.nan)
            named = f"{sum(r['named'] for r in made)} of {sum(r['wrong'] for r in made)}"
            print(
                f"{kind:12}{way:22}{len(made):6}{np.mean([r['error'] for r in made]):7.2f}{alone:7.2f}"
                f"{both[1]:7.2f}{both[0]:7.2f}{named:>9}{sum(r['blamed'] for r in made):7}"
            )


def main() -> None:
    parser = pair_options(__doc__, "FAUST_r,SHREC19_r,TOSCA_r,catdog,SMAL_r", 2, only=True)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--ways", default=";".join(WAYS))
    arguments = parser.parse_args()
    rows: list[dict] = []
    for job in chosen_jobs(arguments, seed=1):
        rows += rows_of(job, tuple(arguments.ways.split(";")))
    report(rows)
    if arguments.json:
        arguments.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
