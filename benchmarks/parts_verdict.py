"""The verdict of parts fitted to candidates whose truth is known, and how well it does on kinds that it has not seen.

    python benchmarks/parts_verdict.py --data DIR [--json ROWS.json]
    python benchmarks/parts_verdict.py --two ROWS.json,ROWS.json

All candidates of a search are bent and compared with the truth (straight-line errors × 100, in √area of the whole), for
the pairs of :data:`PAIRS`, which are all of shapes that settings were chosen on. Of each search a few pools of
candidates are made, the wrong ones alone among them; rivals of the best of each pool are looked for as the search does,
and what the best of all then shows is one example. A pair's examples weigh one together. About a minute a pair.
ROWS.json keeps the examples, and spares what it has. With ``--two`` the examples are two parts, as
benchmarks/part_to_part.py and ``parts.py --both`` have kept them with ``--json``; the fit calls no wrong one sure, and
what is told with the numbers in use stands below, to compare halves.
"""

from __future__ import annotations

import argparse
import json
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from part_to_part import is_right
from parts import Job, read_job
from scipy.optimize import minimize
from scipy.special import expit

import kfmaps
from kfmaps import datasets
from kfmaps.config import Partial
from kfmaps.datasets import largest_piece
from kfmaps.evaluation import read_part_truth
from kfmaps.fmap.precise import PointMap, point_positions
from kfmaps.geometry.mesh import Mesh, surface_area, unit_area
from kfmaps.matching.partial.candidates import PartCandidate, compare_alternatives, make_candidate, margin
from kfmaps.matching.partial.place_part import candidate_placements
from kfmaps.matching.partial.samples import PartPair, part_samples
from kfmaps.matching.partial.scale_search import SCALES, TRIALS, refine_placement, try_scales
from kfmaps.matching.score import SCORE

PAIRS = (
    "cuts cat cuts_cat_03", "cuts horse cuts_horse_08", "holes cat holes_cat_02", "PFAUST_M tr_reg_000 part_006",
    "PFAUST_H tr_reg_000 part_008", "PFAUST_H tr_reg_010 part_016", "partial 1 3000", "two_poses 0 3000",
    "symmetric_creature 0 3000", "two_poses 2 3000",
)  # fmt: skip
"""Of the benchmarks "set whole part"; generated ones "name seed vertices", cut by a random plane but for "partial": the
planes of the creatures with seed 0 cut lengthwise."""
KINDS = {"cuts": "animals", "holes": "animals", "PFAUST_M": "people", "PFAUST_H": "people"}
RIGHT, WRONG = 8.0, 10.0
MOST = 0.885
"""Chance that a wrong example of two parts may have at most: "sure" begins at 0.9."""


def generated(name: str, seed: int, vertices: int) -> tuple[Mesh, Mesh, np.ndarray]:
    """A whole, a part, and the part's places on the whole scaled to unit area."""
    pair = getattr(datasets, name)(vertices, rng=seed)
    part, own = pair.target, np.arange(len(pair.target.vertices))
    if name != "partial":
        rng = np.random.default_rng(100 + seed)
        height, kept = pair.target.vertices @ rng.normal(size=3), rng.uniform(0.35, 0.8)
        part, own = largest_piece(pair.target, height >= np.quantile(height, 1 - kept))
    places = PointMap(pair.truth_faces[own], pair.truth_weights[own])
    return pair.source, part, point_positions(places, unit_area(pair.source))


def measured(job: Job) -> tuple[Mesh, Mesh, np.ndarray]:
    """The same of a benchmark; NaN where the truth is not known."""
    whole, part, truth_file = read_job(job)
    truth = read_part_truth(truth_file, whole, part)
    places = np.full((len(part.vertices), 3), np.nan)
    places[truth.vertices] = point_positions(truth.places, unit_area(whole))
    return whole, part, places


@dataclass(frozen=True, eq=False)
class Search:
    """A part and a whole as a search sees them, and the truth."""

    pair: PartPair
    truth: np.ndarray

    def error(self, one: PartCandidate) -> float:
        return 100 * float(np.nanmean(np.linalg.norm(one.registration.places.points - self.truth, axis=1)))

    def contested(self, some: list[PartCandidate]) -> list[PartCandidate]:
        return compare_alternatives(some, self.pair)


def candidates(pair: str, data: Path) -> tuple[Search, list[tuple[str, PartCandidate]]]:
    """Everything that a search proposes before it looks for rivals."""
    kind, one, two = pair.split()
    whole, part, places = measured(Job(data, kind, one, two)) if kind in KINDS else generated(kind, int(one), int(two))
    ratio = float(np.sqrt(surface_area(part) / surface_area(whole)))
    settings = Partial()
    sides = part_samples(unit_area(part), settings.samples), part_samples(unit_area(whole), settings.whole_samples)
    search = Search(PartPair(*sides), places)
    scales = [*SCALES, ratio]
    rough, beams = candidate_placements(search.pair, try_scales(search.pair, scales), scales, settings.candidates)
    first = TRIALS[0]
    pool = [("relaxation" if one.params is first else "again", one) for one in rough]
    pool += [("beam", one) for one in beams]
    return search, [(origin, make_candidate(refine_placement(search.pair, one), search.pair)) for origin, one in pool]


POOLS: dict[str, Callable[[str, float], bool]] = {
    "all": lambda origin, error: True,  # noqa: ARG005
    "wrong": lambda origin, error: error > RIGHT,  # noqa: ARG005
    "relaxation": lambda origin, error: origin == "relaxation",  # noqa: ARG005
    "again": lambda origin, error: origin == "again",  # noqa: ARG005
    "beam": lambda origin, error: origin == "beam",  # noqa: ARG005
    "no beam": lambda origin, error: origin != "beam",  # noqa: ARG005
}


def examples(pair: str, data: Path) -> list[dict[str, Any]]:
    """What the best shows had the search proposed only some pool of candidates, before it looks for rivals."""
    search, everything = candidates(pair, data)
    errors = [search.error(one) for _, one in everything]
    known: dict[frozenset[int], tuple[list[PartCandidate], float]] = {}
    found = []
    for name, pool in POOLS.items():
        rows = [i for i, (origin, _) in enumerate(everything) if pool(origin, errors[i])]
        if len(rows) < 2:
            continue
        if frozenset(rows) not in known:
            last = search.contested([everything[i][1] for i in rows])
            known[frozenset(rows)] = last, search.error(last[0])
        last, error = known[frozenset(rows)]
        first = max(rows, key=lambda i: everything[i][1].score)
        row = {"case": pair, "pool": name, "score": last[0].score, "bending": last[0].evidence.deformation_energy}
        row |= {"margin": margin(last), "err": error}
        found.append(row | {"first": errors[first], "all": [(one.score, search.error(one)) for one in last]})
    return found


def fitted(
    shown: np.ndarray, right: np.ndarray, weights: np.ndarray, ridge: float = 0.05, most: float = 1.0
) -> np.ndarray:
    """Middle and width of the logistic function of the score, by likelihood; what the margin does is not fitted.

    ``most``: the greatest chance that a wrong example may have.
    """

    def loss(b: np.ndarray) -> float:
        p = np.clip(chances(b, shown), 1e-9, 1 - 1e-9)
        above = max(0.0, float((p * (1 - right)).max()) - most)
        return float(-weights @ (right * np.log(p) + (1 - right) * np.log(1 - p)) + ridge / b[1] ** 2 + 1e4 * above)

    begins = np.array([[16.0, 1.0], [12.0, 2.0], [10.0, 3.0]])
    tried = [minimize(loss, begin, method="Nelder-Mead", options={"maxiter": 2000}) for begin in begins]
    return min(tried, key=lambda one: one.fun).x


def chances(b: np.ndarray, shown: np.ndarray) -> np.ndarray:
    """Of ``shown (e, 2)``, scores and margins; as :func:`kfmaps.matching.score.probability`."""
    fits = 1 / (1 + np.exp(-np.clip((shown[:, 0] - b[0]) / b[1], -700, 700)))
    return fits * (1 - 0.5 * np.exp(-shown[:, 1] / SCORE.part.calibration.tie))


def told(name: str, chance: np.ndarray, error: np.ndarray) -> None:
    sure, right = chance >= SCORE.part.calibration.sure, error < RIGHT
    counts = len(error), right.sum(), (sure & right).sum(), (sure & (error > WRONG)).sum()
    print(f"{name:34s}" + "".join(f"{count:10d}" for count in counts))


def print_fits(
    kinds: np.ndarray, shown: np.ndarray, right: np.ndarray, errors: np.ndarray, weights: np.ndarray, most: float = 1.0
) -> np.ndarray:
    """What is told of each kind by the fit to the others, and the fit to all, which is returned."""
    print(f"{'':34s}" + "".join(f"{word:>10s}" for word in ("examples", "right", "sure", "sure, >10")))
    for kind in sorted(set(kinds)):
        other = kinds != kind
        b = fitted(shown[other], right[other], weights[other], most=most)
        told(f"{kind}, not seen", chances(b, shown[~other]), errors[~other])
    b = fitted(shown, right, weights, most=most)
    told("all, seen", chances(b, shown), errors)
    print("middle and width:", " ".join(f"{value:.2f}" for value in b))
    return b


def print_bins(chance: np.ndarray, right: np.ndarray) -> None:
    for low, high in ((0.0, 0.2), (0.2, 0.5), (0.5, 0.8), (0.8, 0.9), (0.9, 1.0)):
        some = (chance >= low) & (chance < high)
        if some.any():
            print(
                f"told {low:.1f} to {high:.1f}: {some.sum():3d} examples, told {chance[some].mean():.2f}, "
                f"right {right[some].mean():.2f}"
            )


def two_parts(files: list[Path]) -> None:
    rows = [row for file in files for row in json.loads(file.read_text(encoding="utf-8"))]
    numbers = SCORE.part.calibration_of_two
    fits = expit(numbers.slope * (np.array([row["score"] for row in rows]) - numbers.middle))
    chance = np.array([row["confidence"] for row in rows])
    # The margin follows from the probability that was told.
    doubt = np.clip(2 * (1 - chance / fits), np.exp(-SCORE.part.calibration.max_margin / numbers.tie), 1.0)
    shown = np.stack([[row["score"] for row in rows], -numbers.tie * np.log(doubt)], axis=1)
    kinds = np.array([(row.get("pair") or row["name"]).split(" ")[0].strip("0123456789_") for row in rows])
    kinds = np.array([row["set"] if row["set"] != "TOSCA_r" else kind for row, kind in zip(rows, kinds, strict=True)])
    right = np.array([is_right(row) for row in rows], dtype=float)
    errors = np.array([100.0 if row["error"] is None else row["error"] for row in rows])
    print_fits(kinds, shown, right, errors, np.ones(len(rows)), MOST)
    print_bins(chance, right)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--two", help="files of rows, with a comma between")
    arguments = parser.parse_args()
    if arguments.two:
        return two_parts([Path(name) for name in arguments.two.split(",")])
    rows: list[dict[str, Any]] = []
    if arguments.json is not None and arguments.json.exists():
        rows = json.loads(arguments.json.read_text(encoding="utf-8"))
    for pair in PAIRS:
        if any(row["case"] == pair for row in rows):
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", kfmaps.KfmapsWarning)
            rows += examples(pair, arguments.data)
        if arguments.json is not None:
            arguments.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")
    kinds = np.array([KINDS.get(row["case"].split()[0], "generated") for row in rows])
    cases, errors = (np.array([row[key] for row in rows]) for key in ("case", "err"))
    shown = np.array([(row["score"], row["margin"]) for row in rows])
    right = (errors < RIGHT).astype(float)
    weights = np.array([1 / (cases == case).sum() for case in cases])
    b = print_fits(kinds, shown, right, errors, weights)
    print_bins(chances(b, shown), right)


if __name__ == "__main__":
    main()
