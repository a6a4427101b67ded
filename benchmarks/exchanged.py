"""What is said of two limbs exchanged, and of places that are off: ``python benchmarks/exchanged.py --data DIR``.

Pairs of benchmarks/automatic.py, whole matches without landmarks. Of each: the verdict, the mean error, by how much the
map precedes itself with two alike limbs exchanged (:mod:`kfmaps.matching.limb_exchange`; empty where no exchange came
near), the share of true pairs off by more than 0.15 √area, the share of these that has a local confidence below one
half, and the share of the area that has.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from automatic import chosen_jobs, loaded, pair_options

import kfmaps
from kfmaps.matching import search
from kfmaps.matching.finish import low_confidence_area
from kfmaps.matching.limb_exchange import compare_exchanged
from kfmaps.matching.score import SCORE


def main() -> None:
    parser = pair_options(__doc__, "SMAL_r,SHREC07,catdog,TOSCA_nonIsometric_r,SHREC19_r,FAUST_r", 4, "report")
    arguments = parser.parse_args()
    margins: list[float] = []

    def compare(*given):
        order = compare_exchanged(*given)
        margins.append(order[0].score - order[1].score if len(order) > 1 else np.nan)
        return order

    search.compare_exchanged = compare
    config = replace(kfmaps.Config(), threads=1)
    print(f"{'pair':48} {'verdict':10} error  margin  off  found  low")
    for job in chosen_jobs(arguments):
        source, target, true_s, true_t = loaded(job)
        found = kfmaps.match(source, target, config)
        errors = kfmaps.geodesic_errors(source, found.target_to_source[true_t], true_s)
        off = errors > SCORE.moved_distance
        low = found.local_confidence[true_t] < SCORE.torn_confidence
        told = low[off].mean() if off.any() else np.nan
        area = low_confidence_area(target, found.local_confidence)
        print(
            f"{job!s:48} {found.verdict:10} {100 * errors.mean():5.2f} {margins[-1]:7.2f}"
            f" {off.mean():5.3f} {told:5.2f} {area:5.3f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
