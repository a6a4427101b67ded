"""Score, compose and refine the maps of a collection, whether they are in memory or in a folder."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from kfmaps.collection.differences import LimitShape, component_limit_shapes
from kfmaps.collection.paths import compose_maps, invert_map
from kfmaps.collection.repair import RepairResult, Replacement
from kfmaps.collection.scored_map import ScoredMap, StoredMap, candidate_maps, score_pair_maps, with_better_score
from kfmaps.collection.synchronization import Edge
from kfmaps.config import Config
from kfmaps.fmap.convert import to_points
from kfmaps.geometry.basis import Basis
from kfmaps.io import check_map
from kfmaps.matching.finish import KnownMap, match_from_map
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.result import Match
from kfmaps.matching.score import probability_word
from kfmaps.shape import Shape


def common_bases(
    repaired: RepairResult,
    ends: Sequence[tuple[int, int]],
    scores: Sequence[Sequence[ScoredMap]],
    bases: Iterable[Basis],
) -> tuple[LimitShape, ...]:
    """Return the common basis of each connected component of a collection, the largest first.

    ``ends`` and ``scores``: source, target and scored candidates of each pair, as :func:`repair_maps` takes them;
    ``bases``: of each shape, at unit area.
    """
    edges = [Edge(a, b, candidate_maps(several)) for (a, b), several in zip(ends, scores, strict=True)]
    k = repaired.sync.latent.shape[1]
    n_latent = 15  # latent functions of a limit shape: the higher ones are truncation more than shape
    return component_limit_shapes(repaired.sync, edges, np.stack([b.eigenvalues[:k] for b in bases]), n_latent)


def stored_candidates(file: Match) -> list[StoredMap]:
    """Return the map in use and its alternatives."""
    return [(points, file.orientation == "reversing") for points in (file.target_to_source, *file.alternatives)]


def score_stored(
    file: Match, shapes: tuple[Shape, Shape], samples: tuple[ShapeSamples, ShapeSamples]
) -> list[ScoredMap]:
    """Score the map in use and the alternatives of a match.

    The map in use gets the score of its raw map where that is better, since alternatives are not refined on all
    vertices, and that refinement does not optimise the score.
    """
    check_map(file, len(shapes[0].mesh.vertices), len(shapes[1].mesh.vertices))
    maps = stored_candidates(file)
    raw = file.fit.raw_functional_map
    if raw is None:
        return score_pair_maps(maps, shapes, samples)
    source, target = (shape.basis for shape in shapes)
    points = to_points(np.asarray(raw)[: len(target.eigenvalues), : len(source.eigenvalues)], source, target)
    first, before, *others = score_pair_maps([maps[0], (points, maps[0][1]), *maps[1:]], shapes, samples)
    return [with_better_score(first, before), *others]


def compose_path(steps: Sequence[tuple[StoredMap, Basis | None]]) -> StoredMap:
    """Compose the candidates of a path.

    ``steps``: each candidate with ``None``, or with the basis of its source where it is used backwards.
    """
    points = [one if basis is None else invert_map(one, basis, len(one)) for (one, _), basis in steps]
    return compose_maps(points), sum(is_reversed for (_, is_reversed), _ in steps) % 2 == 1


def refine_replacement(
    replacement: Replacement,
    candidates: Sequence[StoredMap],
    composition: StoredMap | None,
    shapes: tuple[Shape, Shape],
    config: Config,
    label: str,
    seed: int,
) -> Match:
    """Refine the map that replaces another as matches are refined; the replaced map is its first alternative.

    ``candidates``: of the pair, the map in use first; ``composition``: the composed map, where one replaces the map in
    use; ``label``: initialization of the new map.
    """
    points, is_reversed = candidates[replacement.candidate] if composition is None else composition
    others = [row for i, (row, _) in enumerate(candidates) if i == 0 or i != replacement.candidate]
    known_map = KnownMap(
        points,
        label,
        orientation="reversing" if is_reversed else "preserving",
        verdict=probability_word(replacement.after.probability),
        confidence=replacement.after.probability,
        quality=replacement.after.score,
        alternatives=tuple(np.asarray(row) for row in others),
    )
    return match_from_map(*shapes, known_map, config, seed)
