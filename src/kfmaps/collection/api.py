"""Match a collection of shapes, or take its maps, and make the maps consistent."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from kfmaps._arrays import check_count, refuse
from kfmaps._progress import CountProgress
from kfmaps._records import short_repr
from kfmaps._threads import one_blas_thread
from kfmaps.collection.consistency import (
    common_bases,
    compose_path,
    refine_replacement,
    score_stored,
    stored_candidates,
)
from kfmaps.collection.differences import LimitShape, shape_distances
from kfmaps.collection.pair_graph import signature, signature_graph
from kfmaps.collection.paths import best_path
from kfmaps.collection.repair import CyclePath, repair_maps
from kfmaps.collection.scored_map import ScoredMap, StoredMap, score_pair_maps
from kfmaps.config import Config
from kfmaps.io import check_map
from kfmaps.io.convert import MapLike, ShapeLike, as_map, as_mesh
from kfmaps.matching.match import match
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.result import Match
from kfmaps.matching.search import scoring_samples
from kfmaps.shape import Shape, check_prepared, prepare


@dataclass(frozen=True, eq=False)
class Collection:
    """Shapes with maps that agree; made by :func:`match_collection`.

    Attributes
    ----------
    names : tuple of str
    shapes : tuple of Shape
        Prepared, in the order given.
    pairs : tuple of (str, str)
        Source and target of each map.
    maps : tuple of (n_t,) int64
        A source vertex for each target vertex of each pair, after the changes.
    matches : tuple of Match or None
        Match of each pair; ``None`` where the caller gave the map and it was kept.
    probabilities : tuple of float
        Probability of each map beside all others; NaN of maps of parts.
    replacements : dict of (str, str) to str
        By pair whose map others contradict: what replaced the map, or "doubted".
    chirality : dict of str to int
        1 and -1: shapes that are mirror images of each other's kind.
    limit_shapes : tuple of LimitShape
        A common basis of all shapes or, where pairs do not connect them all, of each component of three or more, the
        largest first.
    parts : tuple of (str, str)
        Pairs in which one shape is a part of the other. Their maps, with −1 where there is no counterpart, stay as they
        were given or matched. They count neither for nor against other maps, and are on no path to a third shape.

    Examples
    --------
    >>> pair = kfmaps.datasets.two_poses(1500)
    >>> shapes, maps = {"a": pair.source, "b": pair.target}, {("a", "b"): pair.truth}
    >>> kfmaps.match_collection(shapes, maps).pairs
    (('a', 'b'),)
    """

    names: tuple[str, ...]
    shapes: tuple[Shape, ...]
    pairs: tuple[tuple[str, str], ...]
    maps: tuple[np.ndarray, ...]
    matches: tuple[Match | None, ...]
    probabilities: tuple[float, ...]
    replacements: dict[tuple[str, str], str]
    chirality: dict[str, int]
    limit_shapes: tuple[LimitShape, ...] = ()
    parts: tuple[tuple[str, str], ...] = ()

    __repr__ = short_repr

    @property
    def limit_shape(self) -> LimitShape | None:
        """The common basis of all shapes; ``None`` where pairs do not connect them all, or there are only two."""
        whole = self.limit_shapes and len(self.limit_shapes[0].members) == len(self.names)
        return self.limit_shapes[0] if whole else None

    def map(self, source: str, target: str) -> np.ndarray:
        """Return a vertex of ``source`` for each vertex of ``target``, (n_t,), for any two shapes that maps connect.

        It is the composition along the path whose maps are most probably all right, which may be the pair's own map.
        Without a path it is the pair's own map of a part, with −1 where there is no counterpart.

        Parameters
        ----------
        source, target : str
            Names of shapes.

        Raises
        ------
        InvalidInput
            For unknown names, and shapes that no maps connect.
        """
        a, b = self._number(source), self._number(target)
        if a == b:
            return np.arange(len(self.shapes[a].mesh.vertices))
        ends = [(self.names.index(one), self.names.index(other)) for one, other in self.pairs]
        path = best_path(len(self.names), ends, self.probabilities, a, b)
        if path is None and (source, target) in self.parts:
            return self.maps[self.pairs.index((source, target))]
        if path is None:
            raise refuse("map", "two shapes that maps connect", f"{source} and {target}", "match more pairs")
        steps = []
        for edge, shape in zip(path.edges, path.shapes, strict=False):
            first = ends[edge][0]
            steps.append(((self.maps[edge], False), None if first == shape else self.shapes[first].basis))
        return compose_path(steps)[0]

    def distances(self, kind: str = "area") -> np.ndarray:
        """Return how much the shapes differ, (n, n); NaN where no maps connect them.

        Parameters
        ----------
        kind : "area" or "conformal"
            Whether differences in area count, or differences in angles.

        Raises
        ------
        InvalidInput
            Where there is no common basis.
        """
        if not self.limit_shapes:
            raise refuse("distances", "three shapes or more that maps connect", "fewer", "match more pairs")
        matrix = np.full((len(self.names),) * 2, np.nan)
        np.fill_diagonal(matrix, 0.0)
        for limit_shape in self.limit_shapes:
            rows = np.ix_(limit_shape.members, limit_shape.members)
            matrix[rows] = shape_distances(limit_shape.operators(kind))
        return matrix

    def _number(self, name: str) -> int:
        if name not in self.names:
            raise refuse("shape", f"one of {', '.join(self.names[:5])}, ...", repr(name), "check the spelling")
        return self.names.index(name)


@dataclass(frozen=True, eq=False)
class _PairMaps:
    """A pair of shapes with its match, and the scores of its map and alternatives; maps of parts have no scores."""

    ends: tuple[int, int]  # numbers of source and target
    shapes: tuple[Shape, Shape]
    samples: tuple[ShapeSamples, ShapeSamples]
    match: Match
    scores: list[ScoredMap]


def match_collection(
    shapes: Mapping[str, ShapeLike | Shape] | Sequence[ShapeLike | Shape],
    maps: Mapping[tuple[str, str], MapLike] | None = None,
    *,
    graph: str = "near",
    config: Config | None = None,
    rng: int = 0,
    progress: CountProgress | None = None,
) -> Collection:
    """Match a collection over a graph of pairs, or take its ``maps``, and make the maps agree.

    Each pair's map and its alternatives are scored, and compared with compositions through other shapes. A map that the
    others contradict is replaced by an alternative or a composition that they support, which is then refined as a match
    is. Maps of parts, in which some vertices have no counterpart, stay as they are (:attr:`Collection.parts`). All work
    is done in this process; ``kfmaps batch --consistent`` uses many processes, and can be resumed.

    Parameters
    ----------
    shapes : mapping of name to shape, or sequence
        As :func:`kfmaps.match` takes them; the shapes of a sequence are called "0", "1", ...
    maps : mapping of (source, target) to map, optional
        Matches, paths of map files, or a source vertex for each target vertex. Without them pairs are matched.
    graph : "near", "star" or "all"
        Which pairs are matched: each shape with the most similar ones, the medoid with all others, or all pairs, one
        way.
    config : Config, optional
        ``Config()`` when not given.
    rng : int
        Seed.
    progress : callable, optional
        Called with the name of the work, how many items are done, and how many there are.

    Returns
    -------
    Collection

    Raises
    ------
    InvalidInput
        When a shape or map cannot be used, or there are fewer than two shapes.

    Examples
    --------
    >>> shapes = {str(seed): kfmaps.datasets.two_poses(1500, seed).target for seed in (1, 2, 3)}
    >>> collection = kfmaps.match_collection(shapes)
    >>> collection.map("1", "3").shape
    (1200,)
    """
    config = config or Config()
    progress = progress or (lambda _what, _done, _of: None)
    names, prepared = _prepare_shapes(shapes, config, progress)
    samples = [scoring_samples(shape, rng) for shape in prepared]
    given = {} if maps is None else _check_maps(maps, names, prepared)
    ends = tuple(given) or signature_graph(graph, np.stack([signature(shape.basis) for shape in prepared]))
    pairs = []
    for i, (a, b) in enumerate(ends):
        both, both_samples = (prepared[a], prepared[b]), (samples[a], samples[b])
        result = given[a, b] if given else match(*both, config, rng=rng, shape_samples=both_samples)
        progress("pairs", i + 1, len(ends))
        is_part = (result.target_to_source < 0).any()
        with one_blas_thread():
            scores = [] if is_part else score_stored(result, both, both_samples)
        pairs.append(_PairMaps((a, b), both, both_samples, result, scores))
    return _make_consistent(names, prepared, pairs, config, rng, maps is not None)


def _prepare_shapes(
    shapes: Mapping[str, ShapeLike | Shape] | Sequence[ShapeLike | Shape], config: Config, progress: CountProgress
) -> tuple[tuple[str, ...], list[Shape]]:
    """Return the names of the shapes, and the shapes prepared."""
    named_shapes = dict(shapes) if isinstance(shapes, Mapping) else {str(i): shape for i, shape in enumerate(shapes)}
    check_count(len(named_shapes), "shapes", low=2)
    prepared = []
    for i, (name, shape) in enumerate(named_shapes.items()):
        if isinstance(shape, Shape):
            check_prepared(shape, config)
        prepared.append(shape if isinstance(shape, Shape) else prepare(as_mesh(shape, name), config, name=name))
        progress("shapes", i + 1, len(named_shapes))
    return tuple(named_shapes), prepared


def _make_consistent(
    names: tuple[str, ...], shapes: list[Shape], pairs: list[_PairMaps], config: Config, seed: int, has_maps: bool
) -> Collection:
    """Make the maps of whole shapes agree; those of parts stay. ``has_maps``: whether the caller gave all maps."""
    whole = [pair for pair in pairs if pair.scores]
    parts = [pair for pair in pairs if not pair.scores]

    def compose(path: CyclePath) -> StoredMap:
        steps = []
        for step in path.steps:
            pair = whole[step.edge]
            candidate = stored_candidates(pair.match)[step.candidate]
            steps.append((candidate, None if step.forward else pair.shapes[0].basis))
        return compose_path(steps)

    def score(paths: list[tuple[int, CyclePath]]) -> list[ScoredMap]:
        with one_blas_thread():
            return [score_pair_maps([compose(p)], whole[i].shapes, whole[i].samples)[0] for i, p in paths]

    ends, scores = [pair.ends for pair in whole], [pair.scores for pair in whole]
    repaired = repair_maps(len(names), ends, scores, score)
    replaced: dict[int, Match] = {}
    for change in repaired.replacements:
        if change.kind != "none":
            pair, composition = whole[change.edge], None if change.path is None else compose(change.path)
            candidates, label = stored_candidates(pair.match), change.label(names)
            arguments = pair.shapes, config, label, seed
            replaced[change.edge] = refine_replacement(change, candidates, composition, *arguments)
    matches = [*(replaced.get(i, pair.match) for i, pair in enumerate(whole)), *(pair.match for pair in parts)]
    named = tuple((names[pair.ends[0]], names[pair.ends[1]]) for pair in (*whole, *parts))
    return Collection(
        names,
        tuple(shapes),
        named,
        tuple(one.target_to_source for one in matches),
        tuple(None if has_maps and i not in replaced else one for i, one in enumerate(matches)),
        (*repaired.probabilities.tolist(), *[float("nan")] * len(parts)),
        {named[change.edge]: change.label(names) or "doubted" for change in repaired.replacements},
        dict(zip(names, repaired.chirality.tolist(), strict=True)),
        common_bases(repaired, ends, scores, [shape.basis for shape in shapes]),
        named[len(whole) :],
    )


def _check_maps(
    maps: Mapping[tuple[str, str], MapLike], names: Sequence[str], shapes: Sequence[Shape]
) -> dict[tuple[int, int], Match]:
    matches = {}
    for (source, target), map in maps.items():
        for name in (source, target):
            if name not in names:
                raise refuse("maps", f"names of shapes ({', '.join(names[:5])}, ...)", repr(name), "check the spelling")
        a, b = names.index(source), names.index(target)
        match = as_map(map)
        sizes = len(shapes[a].mesh.vertices), len(shapes[b].mesh.vertices)
        points = check_map(match, *sizes, name=f"map {source} → {target}", partial=True)
        matches[a, b] = replace(match, target_to_source=points)
    if not matches:
        raise refuse("maps", "at least one", "none", "leave them out, and pairs are matched")
    return matches
