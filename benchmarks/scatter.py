"""How much the error of a match changes with the seed, and what a coarse registration before the finish does to that.

    python benchmarks/scatter.py --data DIR [--sets SMAL_r,catdog] [--half choice] [--pairs 3] [--seeds 0,1] [--again]

Each pair is searched once with each seed, and each map found is finished twice: as in a match ("without"), and "with"
a registration on coarse proxies before that, which a match does not do (research/scatter.md). For a pair and a way
stand there the mean errors × 100, one for each seed; their mean; their standard deviation over it; how far the maps of
the seeds lie apart on average, in % of √area; the error of the consensus of them (of the source points of a target
vertex the one that is nearest to the others together); and CPU seconds of the finish. "candidates" are the maps before
the finish; with ``--again`` "same candidate" is the first one found, finished with all seeds. At the end stands for
each set the change of the mean error with its interval of 95 %, by drawing pairs. DIR is as for
benchmarks/automatic.py. Three seeds of a pair take 15 to 60 CPU seconds.
"""

from __future__ import annotations

import pickle
import time
from dataclasses import dataclass, replace
from pathlib import Path
from unittest.mock import patch

import numpy as np
from automatic import Job, chosen_pairs, loaded, pair_options

import kfmaps
from kfmaps.fmap.convert import nearest
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.matching import match as matching
from kfmaps.matching.registration_refine import register_map_on_proxies
from kfmaps.matching.search import search_map
from kfmaps.matching.search_result import SearchResult

SETS = "FAUST_r,SHREC19_r,TOSCA_r,catdog,TOSCA_nonIsometric_r,SMAL_r,SHREC07,TOPKIDS"
POINTS = 400
"""True pairs that a map is judged by."""
DRAWS = 10_000
WAYS = "without", "with"
WEIGHT = 1.0
"""Of positions and normals after the coarse registration, beside SHOT."""


@dataclass(frozen=True, eq=False)
class Judged:
    """A pair of prepared shapes, true pairs of vertices, and the distances from the true source vertices."""

    source: kfmaps.Shape
    target: kfmaps.Shape
    true_s: np.ndarray
    true_t: np.ndarray
    away: np.ndarray

    def error(self, points: np.ndarray) -> float:
        """Mean error × 100 of the source vertices of the true target vertices, (t,)."""
        return 100 * float(self.away[np.arange(len(points)), points].mean())

    def apart(self, maps: np.ndarray) -> float:
        """Mean distance × 100 between the images of several maps (m, t)."""
        places = self.source.mesh.vertices[maps]
        gaps = np.linalg.norm(places[:, None] - places[None], axis=3).mean(axis=2)
        return 100 * float(gaps[np.triu_indices(len(maps), 1)].mean()) if len(maps) > 1 else 0.0

    def consensus(self, maps: np.ndarray) -> np.ndarray:
        """The image of each vertex in ``maps (m, t)`` that is nearest to the others together, (t,)."""
        places = self.source.mesh.vertices[maps]
        chosen = np.linalg.norm(places[:, None] - places[None], axis=3).sum(axis=1).argmin(axis=0)
        return maps[chosen, np.arange(maps.shape[1])]


def prepared(job: Job, side: int, mesh: kfmaps.Mesh, cache: Path | None) -> kfmaps.Shape:
    name = (job.source, job.target)[side]
    file = cache and cache / f"{job.kind}-{name}.pickle"
    if file and file.exists():
        return pickle.loads(file.read_bytes())
    shape = kfmaps.prepare(mesh, replace(kfmaps.Config(), threads=1), name=name)
    if file:
        file.write_bytes(pickle.dumps(shape))
    return shape


def judged(job: Job, cache: Path | None) -> Judged:
    source, target, true_s, true_t = loaded(job)
    some = np.random.default_rng(0).permutation(len(true_t))[:POINTS]
    shapes = prepared(job, 0, source, cache), prepared(job, 1, target, cache)
    return Judged(*shapes, true_s[some], true_t[some], geodesic_distances(shapes[0].mesh, true_s[some]))


def candidate(found: SearchResult, of: Judged) -> np.ndarray:
    """The source vertices of the true target vertices by the map that a search has found."""
    k_t, k_s = found.functional_map.shape
    rows = np.ascontiguousarray(of.target.basis.functions[of.true_t, :k_t])
    return nearest(rows, of.source.basis.functions[:, :k_s] @ found.functional_map.T)


def registered(found: SearchResult) -> SearchResult:
    """A map found, registered and refined on the proxies that candidates are scored on; the target is registered."""
    state = found._search
    if state is None or state.proxies.coarse is None or found.registered_vertices is not None:
        return found
    shapes = state.source, state.proxies.image
    guidance = matching._search_guidance(found, shapes)
    *_, one = register_map_on_proxies(found.functional_map, state.proxies.coarse, guidance, found.landmarks)
    if one is None:
        return found
    C, vertices = one.functional_map, one.registered_vertices
    return replace(found, functional_map=C, registered_vertices=vertices, swapped=True)


def finished(found: SearchResult, of: Judged, seed: int, way: str) -> tuple[np.ndarray, float]:
    """The map of a search's result, finished, at the true target vertices, and its CPU seconds."""
    start, coarse = time.process_time(), way == "with" and found.registered_vertices is None
    begun = registered(found) if coarse else found
    weight = WEIGHT if coarse else matching.WEIGHT
    with patch.object(matching, "search_map", lambda *_a, **_k: begun), patch.object(matching, "WEIGHT", weight):
        made = matching.match(of.source, of.target, replace(kfmaps.Config(), threads=1), rng=seed)
    return made.target_to_source[of.true_t], time.process_time() - start


def scattered(job: Job, seeds: list[int], cache: Path | None, again: bool) -> dict[str, list[float]]:
    """The errors of each way for each seed, and a line printed for each."""
    of, config = judged(job, cache), replace(kfmaps.Config(), threads=1)
    found = [search_map(of.source, of.target, config, rng=int(seed)) for seed in seeds]
    print(f"{job.kind} {job.source} {job.target}: quality", *(f"{one.quality:.2f}" for one in found))
    maps = {"candidates": ([candidate(one, of) for one in found], 0.0)}
    for way in WAYS:
        made = [finished(one, of, seed, way) for one, seed in zip(found, seeds, strict=True)]
        maps[way] = [points for points, _ in made], float(np.mean([spent for _, spent in made]))
        if again:
            more = [finished(found[0], of, seed, way)[0] for seed in seeds[1:]]
            maps[f"{way}, same candidate"] = [made[0][0], *more], 0.0
    out = {}
    for name, (points, spent) in maps.items():
        errors = np.array([of.error(one) for one in points])
        every, spread = np.array(points), errors.std(ddof=1) / errors.mean() if len(errors) > 1 else 0.0
        print(
            f"    {name:24} {' '.join(f'{e:5.2f}' for e in errors)}   mean {errors.mean():5.2f}"
            f"   sd/mean {100 * spread:3.0f} %   apart {of.apart(every):4.2f}"
            f"   consensus {of.error(of.consensus(every)):5.2f}   CPU {spent:.1f}",
            flush=True,
        )
        out[name] = errors.tolist()
    return out


def interval(change: np.ndarray) -> tuple[float, float]:
    """Interval of 95 % of the mean of ``change (p,)``, by drawing pairs with replacement."""
    drawn = np.random.default_rng(0).integers(0, len(change), (DRAWS, len(change)))
    low, high = np.quantile(change[drawn].mean(axis=1), (0.025, 0.975))
    return float(low), float(high)


def main() -> None:
    parser = pair_options(__doc__, SETS, 3)
    parser.add_argument("--names", default="", help="these pairs of the one set instead: a-b,c-d")
    parser.add_argument("--seeds", default="0,1")
    parser.add_argument("--again", action="store_true", help="finish one candidate with all seeds too")
    parser.add_argument("--cache", type=Path, help="folder that keeps prepared shapes")
    args = parser.parse_args()
    seeds = [int(seed) for seed in args.seeds.split(",")]
    for kind in args.sets.split(","):
        named = [(a, b) for a, _, b in (word.partition("-") for word in args.names.split(",") if word)]
        pairs = named or chosen_pairs(kind, args.data, args.half, args.pairs)
        rows = [scattered(Job(args.data, kind, *pair), seeds, args.cache, args.again) for pair in pairs]
        before, after = (np.array([np.mean(row[way]) for row in rows]) for way in WAYS)
        spread = [
            100 * np.mean([np.std(row[way], ddof=len(seeds) > 1) / np.mean(row[way]) for row in rows]) for way in WAYS
        ]
        low, high = interval(100 * (after - before) / before.mean())
        print(
            f"{kind}, {args.half}, {len(pairs)} pairs: mean {before.mean():.2f} -> {after.mean():.2f}"
            f" ({100 * (after.mean() / before.mean() - 1):+.1f} %, {low:+.1f} to {high:+.1f}),"
            f" sd/mean {spread[0]:.0f} % -> {spread[1]:.0f} %",
            flush=True,
        )


if __name__ == "__main__":
    main()
