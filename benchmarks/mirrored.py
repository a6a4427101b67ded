"""What maps to the mirror image score over maps that keep orientation: ``python benchmarks/mirrored.py --data DIR``.

Generated bodies without symmetry against themselves, bent, and against their mirror images, congruent and bent; then
pairs of people and animals, which are their own mirror images nearly. DIR is as for benchmarks/automatic.py; without it
only the generated bodies are matched.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from automatic import Job, loaded, pairs_of
from shapes import bumpy_pair

import kfmaps
from kfmaps.geometry.mesh import Mesh, mirror_mesh
from kfmaps.matching.orientation import mirror_candidates
from kfmaps.matching.ranking import ProxyCache, ranking
from kfmaps.matching.sample_pair import mirrored_pair
from kfmaps.matching.search import search_map

SETS = {"FAUST_r": 3, "SHREC19_r": 3, "TOSCA_r": 3, "catdog": 2}
"""Pairs of each set."""


def line(name: str, source: Mesh, target: Mesh) -> None:
    """Print what is found, and how much better the best map to the mirror image is than the best that is none."""
    config = replace(kfmaps.Config(), threads=1)
    assert config.search is not None
    shapes = kfmaps.prepare(source, config), kfmaps.prepare(target, config)
    found = search_map(*shapes, config)
    state = search_map(*shapes, replace(config, search=replace(config.search, orientation="preserving")))._search
    assert state is not None
    other = mirrored_pair(state.samples.fine)
    images = mirror_candidates(state.candidates, other)
    best = ranking(images, other, ProxyCache.of(*shapes, other))[0]
    gain = best.score - state.ranked[0].score
    print(f"{name:40} {found.orientation:10} {found.verdict:9} {found.confidence:5.2f} {gain:+7.2f}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path)
    data = parser.parse_args().data
    print(f"{'pair':40} {'found':10} verdict   chance   gain of the mirrored map")
    for seed in range(4):
        pair = bumpy_pair(1500, seed)
        line(f"body {seed}, bent", pair.source, pair.target)
        line(f"body {seed}, mirror image", pair.source, mirror_mesh(pair.source))
        line(f"body {seed}, bent mirror image", pair.source, mirror_mesh(pair.target))
    for kind, count in SETS.items() if data else ():
        for names in pairs_of(kind, data, count):
            source, target, *_ = loaded(Job(data, kind, *names))
            line(f"{kind} {' '.join(names)}", source, target)


if __name__ == "__main__":
    main()
