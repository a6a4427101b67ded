"""A collection from Python: shapes go in, with or without maps, and maps that agree come out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from kfmaps._arrays import check_count, refuse
from kfmaps._progress import CountProgress
from kfmaps._records import short_repr
from kfmaps._threads import one_blas_thread
from kfmaps.collection.consistency import (
    StoredMap,
    compose_path,
    refine_replacement,
    score_candidates,
    score_stored,
    stored_candidates,
    synchronize_store,
)
from kfmaps.collection.differences import ComponentLimitShape, LimitShape, operators, shape_distances
from kfmaps.collection.pair_graph import signature, signature_graph
from kfmaps.collection.paths import adjacency, best_paths
from kfmaps.collection.repair import CyclePath, Replacement
from kfmaps.collection.scored_map import ScoredMap
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
        Of each pair, with all that is known of it; ``None`` where a map was given and was kept.
    probabilities : tuple of float
        Probability of each map beside all others; NaN of maps of parts.
    replacements : dict of (str, str) to str
        Of each pair whose map others contradict: what replaced it, or "doubted".
    chirality : dict of str to int
        1 and -1: shapes that are mirror images of each other's kind.
    limit_shapes : tuple of ComponentLimitShape
        A common basis of all shapes or, where pairs do not join them all, of each part of three or more, the largest
        first.
    parts : tuple of (str, str)
        Pairs of which one shape is a part of the other: their maps, with −1 where there is no counterpart, are as they
        were given or matched, speak for or against no other, and are no way to a third shape.
    """

    names: tuple[str, ...]
    shapes: tuple[Shape, ...]
    pairs: tuple[tuple[str, str], ...]
    maps: tuple[np.ndarray, ...]
    matches: tuple[Match | None, ...]
    probabilities: tuple[float, ...]
    replacements: dict[tuple[str, str], str]
    chirality: dict[str, int]
    limit_shapes: tuple[ComponentLimitShape, ...] = ()
    parts: tuple[tuple[str, str], ...] = ()

    __repr__ = short_repr

    @property
    def limit_shape(self) -> LimitShape | None:
        """The common basis of all shapes; ``None`` where pairs do not join them all, or there are only two."""
        whole = self.limit_shapes and len(self.limit_shapes[0].members) == len(self.names)
        return self.limit_shapes[0].limit_shape if whole else None

    def map(self, source: str, target: str) -> np.ndarray:
        """Return a vertex of ``source`` for each vertex of ``target``, (n_t,), of any two shapes that maps join.

        It follows the path whose maps are most probably all right: the pair's own map where that is best. Where no path
        leads there it is the pair's own map of a part, if it has one, with −1 where there is no counterpart.

        Parameters
        ----------
        source, target : str
            Names of shapes.

        Raises
        ------
        InvalidInput
            For names that are not there, and shapes that no maps join.
        """
        a, b = self._number(source), self._number(target)
        if a == b:
            return np.arange(len(self.shapes[a].mesh.vertices))
        ways = best_paths(adjacency(len(self.names), self._ends()), self.probabilities, a)
        if b not in ways and (source, target) in self.parts:
            return self.maps[self.pairs.index((source, target))]
        if b not in ways:
            raise refuse("map", "two shapes that maps connect", f"{source} and {target}", "match more pairs")
        steps = []
        for edge, here in zip(ways[b].edges, ways[b].shapes, strict=False):
            first, points = self.names.index(self.pairs[edge][0]), self.maps[edge]
            steps.append(((points, False), None if first == here else self.shapes[first].basis))
        return compose_path(steps)[0]

    def distances(self, kind: str = "area") -> np.ndarray:
        """Return how much the shapes differ, (n, n); NaN where no maps join them.

        Parameters
        ----------
        kind : "area" or "conformal"
            Whether they differ in areas, or in what is left when areas are kept.

        Raises
        ------
        InvalidInput
            Where there is no common basis.
        """
        if not self.limit_shapes:
            raise refuse("distances", "three shapes or more that maps connect", "fewer", "match more pairs")
        found = np.full((len(self.names),) * 2, np.nan)
        np.fill_diagonal(found, 0.0)
        for one in self.limit_shapes:
            values = self.eigenvalues()[one.members]
            found[np.ix_(one.members, one.members)] = shape_distances(operators(one.limit_shape, values, kind))
        return found

    def eigenvalues(self) -> np.ndarray:
        """Return the eigenvalues of each shape at unit area, as many as the common bases need, (n, k)."""
        k = self.limit_shapes[0].limit_shape.maps.shape[1] if self.limit_shapes else 0
        return np.stack([shape.basis.eigenvalues[:k] for shape in self.shapes])

    def _number(self, name: str) -> int:
        if name not in self.names:
            raise refuse("shape", f"one of {', '.join(self.names[:5])}, ...", repr(name), "check the spelling")
        return self.names.index(name)

    def _ends(self) -> list[tuple[int, int]]:
        return [(self.names.index(a), self.names.index(b)) for a, b in self.pairs]


_Part = tuple[tuple[int, int], np.ndarray, Match | None]
"""A pair by number, its map, in which some vertices have no counterpart, and its match where one was made here."""


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

    Each pair's map and its alternatives are scored, and set beside compositions through other shapes. A map that the
    others contradict is replaced by an alternative or a composition that they speak for, and that is finished as a
    match is. Maps of parts, in which some vertices have no counterpart, stay as they are and take no part in this
    (:attr:`Collection.parts`). All is done in this process; ``kfmaps batch --consistent`` does it with many, and goes
    on where it stopped.

    Parameters
    ----------
    shapes : mapping of name to shape, or sequence
        As :func:`kfmaps.match` takes them; a sequence gets the names "0", "1", ...
    maps : mapping of (source, target) to map, optional
        Matches, map files, their paths, or a source vertex for each target vertex. Without them pairs are matched.
    graph : "near", "star" or "all"
        Which pairs are matched: each shape with those that are most like it, the one in the middle with all others, or
        all, one way.
    config : Config, optional
        ``Config()`` when not given.
    rng : int
        Seed.
    progress : callable, optional
        Called with what is being done, how much of it is done and how much there is.

    Returns
    -------
    Collection

    Raises
    ------
    InvalidInput
        When a shape or map cannot be used, or there are fewer than two shapes.
    """
    config = config or Config()
    progress = progress or (lambda _what, _done, _of: None)
    names, ready = _prepared(shapes, config, progress)
    store = _MemoryStore(names, ready, config, rng, [scoring_samples(shape, rng) for shape in ready])
    known = {} if maps is None else _checked_maps(maps, names, ready)
    ends = tuple(known) if maps is not None else signature_graph(graph, np.stack([signature(s.basis) for s in ready]))
    parts: list[_Part] = []
    for i, (a, b) in enumerate(ends):
        match_ab = None if (a, b) in known else store.match(a, b)
        file = known[a, b] if match_ab is None else as_map(match_ab)
        progress("pairs", i + 1, len(ends))
        if (check_map(file, name=f"map {names[a]} → {names[b]}", lost=True) < 0).any():
            parts.append(((a, b), file.target_to_source, match_ab))
            continue
        told = match_ab or (maps or {}).get((names[a], names[b]))
        store.add((a, b), file, match_ab, told.orientation == "reversing" if isinstance(told, Match) else None)
    return _collected(store, parts)


def _prepared(
    shapes: Mapping[str, ShapeLike | Shape] | Sequence[ShapeLike | Shape], config: Config, progress: CountProgress
) -> tuple[tuple[str, ...], list[Shape]]:
    """Return the names of the shapes, and the shapes prepared."""
    given = dict(shapes) if isinstance(shapes, Mapping) else {str(i): shape for i, shape in enumerate(shapes)}
    check_count(len(given), "shapes", low=2)
    ready = []
    for i, (name, shape) in enumerate(given.items()):
        if isinstance(shape, Shape):
            check_prepared(shape, config)
        ready.append(shape if isinstance(shape, Shape) else prepare(as_mesh(shape, name), config, name=name))
        progress("shapes", i + 1, len(given))
    return tuple(given), ready


def _collected(store: _MemoryStore, parts: list[_Part]) -> Collection:
    """Make the maps of a store agree; ``parts`` are the pairs that take no part, their maps and matches."""
    result, names = synchronize_store(store), store.names
    pairs = tuple((names[a], names[b]) for a, b in (*store.ends, *(pair for pair, _, _ in parts)))
    return Collection(
        names,
        tuple(store.shapes),
        pairs,
        (*(several[0][0] for several in store.candidates), *(points for _, points, _ in parts)),
        (*store.matches, *(match_ab for _, _, match_ab in parts)),
        (*result.repaired.probabilities.tolist(), *[float("nan")] * len(parts)),
        {pairs[change.edge]: change.label(names) or "doubted" for change in result.repaired.replacements},
        dict(zip(names, result.repaired.chirality.tolist(), strict=True)),
        result.limit_shapes,
        pairs[len(store.ends) :],
    )


@dataclass(eq=False)
class _MemoryStore:
    """A :class:`~kfmaps.collection.consistency.MapStore` of shapes and maps in memory."""

    names: tuple[str, ...]
    shapes: list[Shape]
    config: Config
    seed: int
    samples: list[ShapeSamples]
    ends: list[tuple[int, int]] = field(default_factory=list)
    matches: list[Match | None] = field(default_factory=list)
    candidates: list[list[StoredMap]] = field(default_factory=list)
    scores: list[list[ScoredMap]] = field(default_factory=list)

    def match(self, a: int, b: int) -> Match:
        return match(*self._pair((a, b)), self.config, rng=self.seed, probes=(self.samples[a], self.samples[b]))

    def add(self, ends: tuple[int, int], file: Match, match_ab: Match | None, reversed: bool | None) -> None:
        """Take the map of a pair, scored."""
        self.ends.append(ends)
        self.matches.append(match_ab)
        self.candidates.append(stored_candidates(file, reversed))
        with one_blas_thread():
            self.scores.append(score_stored(file, self._pair(ends), self._samples(ends), reversed))

    def compose(self, asked: list[tuple[int, CyclePath]]) -> list[ScoredMap]:
        with one_blas_thread():
            return [
                score_candidates([self._along(path)], self._pair(self.ends[i]), self._samples(self.ends[i]))[0]
                for i, path in asked
            ]

    def replace(self, replacements: Sequence[Replacement]) -> None:
        new = []
        for change in replacements:
            composition = None if change.path is None else self._along(change.path)
            shapes, label = self._pair(self.ends[change.edge]), change.label(self.names)
            candidates = self.candidates[change.edge]
            made = refine_replacement(change, candidates, composition, shapes, self.config, label, self.seed)
            new.append((change.edge, made))
        for edge, made in new:
            self.matches[edge] = made
            self.candidates[edge] = [(made.target_to_source, made.orientation == "reversing")]

    def shape(self, number: int) -> Shape:
        return self.shapes[number]

    def _pair(self, ends: tuple[int, int]) -> tuple[Shape, Shape]:
        return self.shapes[ends[0]], self.shapes[ends[1]]

    def _samples(self, ends: tuple[int, int]) -> tuple[ShapeSamples, ShapeSamples]:
        return self.samples[ends[0]], self.samples[ends[1]]

    def _along(self, path: CyclePath) -> StoredMap:
        steps = []
        for step in path.steps:
            basis = None if step.forward else self.shapes[self.ends[step.edge][0]].basis
            steps.append((self.candidates[step.edge][step.candidate], basis))
        return compose_path(steps)


def _checked_maps(
    maps: Mapping[tuple[str, str], MapLike], names: Sequence[str], shapes: Sequence[Shape]
) -> dict[tuple[int, int], Match]:
    found = {}
    for (source, target), one in maps.items():
        for name in (source, target):
            if name not in names:
                raise refuse("maps", f"names of shapes ({', '.join(names[:5])}, ...)", repr(name), "check the spelling")
        a, b = names.index(source), names.index(target)
        file = as_map(one)
        sizes = len(shapes[a].mesh.vertices), len(shapes[b].mesh.vertices)
        points = check_map(file, *sizes, name=f"map {source} → {target}", lost=True)
        found[a, b] = replace(file, target_to_source=points)
    if not found:
        raise refuse("maps", "at least one", "none", "leave them out, and pairs are matched")
    return found
