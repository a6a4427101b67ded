"""What a search says that has missed the right map: ``python benchmarks/missed.py --data DIR [--pairs 8]``.

Of all rough maps of a search those near the truth are taken out before the near-symmetries of the shapes and random
ones are tried (:func:`kfmaps.matching.candidates.symmetry_inits`). Then the search ends as usual, once with the
near-symmetries and once without. A map that is "sure" and wrong was sure for want of a rival. DIR is as for
benchmarks/automatic.py, and so are the pairs: none of two shapes that settings were chosen on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from unittest.mock import patch

import numpy as np
from automatic import RIGHT, Job, chosen_pairs, loaded, pair_options

import kfmaps
from kfmaps.fmap.convert import nearest
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.matching import candidates as search
from kfmaps.matching.search import search_map

NEAR = 12.0
"""Mean error × 100 below which a rough map is taken out."""
POINTS = 300
"""True pairs that a map is judged by."""


def judge(job: Job, source: kfmaps.Shape, target: kfmaps.Shape) -> Callable[[np.ndarray], float]:
    """The mean error × 100 of a functional map."""
    _, _, true_s, true_t = loaded(job)
    some = np.random.default_rng(0).permutation(len(true_t))[:POINTS]
    away = geodesic_distances(source.mesh, true_s[some])

    def error(C: np.ndarray) -> float:
        k_t, k_s = C.shape
        rows = np.ascontiguousarray(target.basis.functions[true_t[some], :k_t])
        points = nearest(rows, source.basis.functions[:, :k_s] @ C.T)
        return 100 * float(away[np.arange(len(some)), points].mean())

    return error


def searched(job: Job) -> list[tuple[str, float]]:
    """Verdict and error of the search's end without and with near-symmetries, the right rough maps taken out."""
    config = replace(kfmaps.Config(), threads=1)
    source, target = (kfmaps.prepare(mesh, config, name=name) for mesh, name in zip(loaded(job), "st", strict=False))
    error, usual = judge(job, source, target), search.symmetry_inits
    ends = []
    for wanted in (False, True):

        def blind(found: list, *more: object, wanted: bool = wanted) -> list:
            found[:] = [c for c in found if error(c.functional_map) >= NEAR]
            return usual(found, *more) if wanted else []  # type: ignore[arg-type]

        with patch.object(search, "symmetry_inits", blind):
            found = search_map(source, target, config)
        ends.append((found.verdict, error(found.functional_map)))
    return ends


def main() -> None:
    parser = pair_options(__doc__, "FAUST_r,SHREC19_r", 8, "report")
    args = parser.parse_args()
    for kind in args.sets.split(","):
        rows = []
        for a, b in chosen_pairs(kind, args.data, args.half, args.pairs):
            rows.append(searched(Job(args.data, kind, a, b)))
            print(f"{kind} {a} {b}: " + "; ".join(f"{verdict} {error:.1f}" for verdict, error in rows[-1]), flush=True)
        for i, name in enumerate(("without near-symmetries", "with them")):
            right = sum(row[i][1] < RIGHT for row in rows)
            sure = sum(row[i][0] == "sure" for row in rows)
            wrong = sum(row[i][0] == "sure" and row[i][1] >= RIGHT for row in rows)
            print(f"{kind}, {name}: {right} of {len(rows)} right, {sure} sure, {wrong} sure and wrong", flush=True)


if __name__ == "__main__":
    main()
