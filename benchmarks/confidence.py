"""Whether confidence per vertex finds the wrong places: ``python benchmarks/confidence.py --data DIR``.

DIR is the folder FAUST_r (see docs/collections.md). Eight pairs of people 4 to 7, none of whom the measure's radius and
number of samples were chosen on: refined maps with three landmarks, and unrefined ones with two. Each measure is
judged by the chance that a point that is off by more than a limit is ranked as worse than one that is not (the area
under its ROC curve; 0.5 is guessing), averaged over the pairs that have such points.
"""

from __future__ import annotations

import argparse
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.stats import rankdata

import kfmaps
from kfmaps.fmap.convert import nearest

PAIRS = ((41, 57), (52, 68), (63, 44), (75, 59), (48, 71), (66, 73), (54, 42), (79, 61))
LANDMARKS = np.array([200, 1120, 2040])
"""Lines of the truth."""
LIMITS = (0.05, 0.15)


def found(value: np.ndarray, wrong: np.ndarray) -> float:
    """The chance that ``value`` is larger at a wrong point than at a right one; NaN without any of either."""
    bad, good = int(wrong.sum()), int((~wrong).sum())
    if not bad or not good:
        return float("nan")
    return float((rankdata(value)[wrong].sum() - bad * (bad + 1) / 2) / (bad * good))


def measures(result: kfmaps.Match, source: kfmaps.Shape, target: kfmaps.Shape) -> dict[str, np.ndarray]:
    """What is compared, a number for each target vertex, higher where it should be worse."""
    assert result.local_confidence is not None
    k_t, k_s = result.functional_map.shape
    images = source.basis.functions[:, :k_s] @ result.functional_map.T
    own = target.basis.functions[:, :k_t]
    back = nearest(images, own)[result.target_to_source]
    places = target.mesh.vertices
    apart = np.linalg.norm(own - images[result.target_to_source], axis=1) / np.linalg.norm(own, axis=1)
    return {
        "distances to the surroundings": 1 - np.nan_to_num(result.local_confidence),
        "there and back": np.linalg.norm(places[back] - places, axis=1),
        "residual of the search": apart,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True)
    folder = parser.parse_args().data
    warnings.simplefilter("ignore", kfmaps.KfmapsWarning)
    refined = replace(kfmaps.Config.single_fit(), threads=1)
    chances: dict[tuple[str, str], list[list[float]]] = {}
    for numbers in PAIRS:
        names = [f"tr_reg_{i:03d}" for i in numbers]
        source, target = (kfmaps.prepare(kfmaps.read_mesh(folder / f"{n}.ply"), refined, name=n) for n in names)
        true_s, true_t = (np.loadtxt(folder / "corres" / f"{n}.vts", dtype=np.int64) - 1 for n in names)
        marks = np.stack([true_s, true_t], axis=1)[LANDMARKS]
        for kind, config, landmarks in (
            ("refined", refined, marks),
            ("not refined", replace(refined, refinement=None), marks[:2]),
        ):
            result = kfmaps.match(source, target, config, landmarks=landmarks)
            errors = kfmaps.geodesic_errors(source.mesh, result.target_to_source[true_t], true_s)
            share = result.seconds["confidence"] / sum(result.seconds.values())
            print(
                f"{names[0]} {names[1]} {kind}: error x 100 {100 * errors.mean():.2f}, {100 * share:.1f} % of the time"
            )
            for name, value in measures(result, source, target).items():
                chances.setdefault((kind, name), []).append([found(value[true_t], errors > e) for e in LIMITS])
    for (kind, name), rows in chances.items():
        told = ", ".join(f"{c:.2f} (off by {e:g})" for c, e in zip(np.nanmean(rows, axis=0), LIMITS, strict=True))
        print(f"{kind}, {name}: {told}")


if __name__ == "__main__":
    main()
