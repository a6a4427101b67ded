"""What one camera sees of people and animals, matched to a whole shape of another one: errors and what is told.

    python benchmarks/one_view.py --data DIR [--sets FAUST_r,SMAL_r,TOSCA_r,catdog] [--pairs 6] [--half report]

The camera is far away, at a random place, and the unit of its scan is drawn at random. Errors are mean geodesic
distances on the source × 100. DIR is as for benchmarks/automatic.py; people of a body model are seen so by
benchmarks/parametric_people.py.
"""

from __future__ import annotations

import numpy as np
from automatic import chosen_jobs, loaded, pair_options
from bent_copies import Side
from game_animals import RIGHT, found_by, print_summary
from parametric_people import seen

import kfmaps
from kfmaps.geometry.mesh import Mesh, unit_area


def main() -> None:
    arguments = pair_options(__doc__, "FAUST_r,SMAL_r,TOSCA_r,catdog", 6, "report", only=True).parse_args()
    rows = []
    for number, job in enumerate(chosen_jobs(arguments)):
        source, target, true_s, true_t = loaded(job)
        rng = np.random.default_rng(number)
        scan = seen(Side(target, np.arange(len(target.vertices))), rng.normal(size=3))
        new = np.full(len(target.vertices), -1)
        new[scan.places] = np.arange(len(scan.places))
        part = Mesh(unit_area(scan.mesh).vertices * np.exp(rng.uniform(-1, 1)), scan.mesh.faces)
        found, known, told = found_by(source, part)
        seen_too = new[true_t] >= 0
        at, ends = new[true_t[seen_too]], true_s[seen_too]
        at, ends = at[known[at]], ends[known[at]]
        if len(at) == 0:  # no vertex with a truth is seen
            continue
        errors = 100 * kfmaps.geodesic_errors(unit_area(source), found.target_to_source[at], ends)
        right = bool(errors.mean() < RIGHT and known.mean() > 0.9)
        rows.append((right, found.verdict == "sure"))
        name, missing = f"{job.kind:8} {job.source:14} {job.target:14}", 1 - known.mean()
        print(f"{name} {errors.mean():7.2f} {missing:8.0%}   {told}", flush=True)
    print_summary(rows)


if __name__ == "__main__":
    main()
