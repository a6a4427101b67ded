"""A collection from Python: shapes go in, with or without maps, and maps that agree come out."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kfmaps._arrays import check_count, refuse
from kfmaps._threads import one_blas_thread
from kfmaps.collection.differences import (
    ComponentLimitShape,
    LimitShape,
    component_limit_shapes,
    operators,
    shape_distances,
)
from kfmaps.collection.pair_graph import (
    complete_graph,
    medoid,
    nearest_neighbor_graph,
    signature,
    signature_distances,
    star_graph,
)
from kfmaps.collection.paths import MapPath, adjacency, best_paths, compose_maps, invert_map
from kfmaps.collection.repair import CyclePath, Replacement, repair
from kfmaps.collection.scored_map import ScoredMap, candidate_maps, score_maps
from kfmaps.collection.synchronization import Edge
from kfmaps.config import Config
from kfmaps.io import MapFile, check_map
from kfmaps.io.convert import as_map, as_mesh
from kfmaps.matching.calibration import SURE
from kfmaps.matching.match import Match, check_prepared, match, match_from_map
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.reindexing import reindexing
from kfmaps.matching.search import scoring_samples
from kfmaps.shape import Shape, prepare

Told = Callable[[str, int, int], None]
LATENT = 15
"""Functions of the common basis at most."""


@dataclass(frozen=True, eq=False)
class Collection:
    """Shapes with maps that agree; made by :func:`collection`.

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
    chances : tuple of float
        Probability of each map beside all others; NaN of maps of parts.
    changes : dict of (str, str) to str
        Of each pair whose map others contradict: what it was exchanged for, or "doubted".
    hands : dict of str to int
        1 and -1: shapes that are mirror images of each other's kind.
    bases : tuple of Common
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
    chances: tuple[float, ...]
    changes: dict[tuple[str, str], str]
    hands: dict[str, int]
    bases: tuple[ComponentLimitShape, ...] = ()
    parts: tuple[tuple[str, str], ...] = ()

    @property
    def latent(self) -> LimitShape | None:
        """The common basis of all shapes; ``None`` where pairs do not join them all, or there are only two."""
        whole = self.bases and len(self.bases[0].members) == len(self.names)
        return self.bases[0].limit_shape if whole else None

    def map(self, source: str, target: str) -> np.ndarray:
        """A vertex of ``source`` for each vertex of ``target``, (n_t,): of any two shapes that maps join.

        Along the path whose maps are most probably all right: the pair's own map where that is best. Where no path
        leads there, the pair's own map of a part, if it has one: −1 where there is no counterpart.

        Raises
        ------
        InvalidInput
            For names that are not there, and shapes that no maps join.
        """
        a, b = self._number(source), self._number(target)
        if a == b:
            return np.arange(len(self.shapes[a].mesh.vertices))
        ways = best_paths(adjacency(len(self.names), self._ends()), self.chances, a)
        if b not in ways and (source, target) in self.parts:
            return self.maps[self.pairs.index((source, target))]
        if b not in ways:
            raise refuse("map", "shapes that maps join", f"{source} and {target}", "match more pairs")
        return _composed(self, ways[b])

    def distances(self, kind: str = "area") -> np.ndarray:
        """How much the shapes differ, (n, n): in areas, or ("conformal") but for areas; NaN where no maps join them.

        Raises
        ------
        InvalidInput
            Where there is no common basis.
        """
        if not self.bases:
            raise refuse("distances", "three shapes or more that maps join", "fewer", "match more pairs")
        found = np.full((len(self.names),) * 2, np.nan)
        np.fill_diagonal(found, 0.0)
        for one in self.bases:
            values = self.eigenvalues()[one.members]
            found[np.ix_(one.members, one.members)] = shape_distances(operators(one.limit_shape, values, kind))
        return found

    def eigenvalues(self) -> np.ndarray:
        """Of each shape at unit area, as many as the common bases need, (n, k)."""
        k = self.bases[0].limit_shape.maps.shape[1] if self.bases else 0
        return np.stack([shape.basis.eigenvalues[:k] for shape in self.shapes])

    def _number(self, name: str) -> int:
        if name not in self.names:
            raise refuse("shape", f"one of {', '.join(self.names[:5])}, ...", repr(name), "check the spelling")
        return self.names.index(name)

    def _ends(self) -> list[tuple[int, int]]:
        return [(self.names.index(a), self.names.index(b)) for a, b in self.pairs]


def _composed(found: Collection, way: MapPath) -> np.ndarray:
    steps = []
    for link, here in zip(way.edges, way.shapes, strict=False):
        source = found.names.index(found.pairs[link][0])
        points = found.maps[link]
        steps.append(points if source == here else invert_map(points, found.shapes[source].basis, len(points)))
    return compose_maps(steps)


def match_collection(
    shapes: Mapping[str, Any] | Sequence[Any],
    maps: Mapping[tuple[str, str], Any] | None = None,
    *,
    graph: str = "near",
    config: Config | None = None,
    rng: int = 0,
    progress: Told | None = None,
) -> Collection:
    """Match a collection over a graph of pairs, or take its ``maps``, and make the maps agree.

    Each pair's map and its runners-up are judged, and set beside compositions through other shapes. A map that the
    others contradict is exchanged for a runner-up or a composition that they speak for, and that is finished as a match
    is. Maps of parts, in which some vertices have no counterpart, stay as they are and take no part in this
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
        Told what is being done, how much of it is done and how much there is.

    Raises
    ------
    InvalidInput
        When a shape or map cannot be used, or there are fewer than two shapes.
    """
    config = config or Config()
    told = progress or (lambda _what, _done, _of: None)
    given = dict(shapes) if isinstance(shapes, Mapping) else {str(i): shape for i, shape in enumerate(shapes)}
    check_count(len(given), "shapes", low=2)
    names = tuple(given)
    ready = []
    for i, (name, shape) in enumerate(given.items()):
        if isinstance(shape, Shape):
            check_prepared(shape, config)
        ready.append(shape if isinstance(shape, Shape) else prepare(as_mesh(shape, name), config, name=name))
        told("shapes", i + 1, len(given))
    known = _given(maps, names, ready) if maps is not None else {}
    ends = list(known) if maps is not None else _graph(graph, ready)
    work = _Work(names, ready, config, rng, [scoring_samples(shape, rng) for shape in ready])
    matches: list[Match | None] = []
    evidence, points, whole = [], [], []
    apart: dict[tuple[int, int], tuple[np.ndarray, Match | None]] = {}
    for i, (a, b) in enumerate(ends):
        one = known.get((a, b))
        found = work.match(a, b) if one is None else None
        file = as_map(found) if one is None else one
        told("pairs", i + 1, len(ends))
        if (check_map(file, name=f"map {names[a]} → {names[b]}", lost=True) < 0).any():
            apart[a, b] = (file.target_to_source, found)
            continue
        whole.append((a, b))
        matches.append(found)
        points.append([file.target_to_source, *_runners_up(file)])
        told_of = found if one is None else (maps or {}).get((names[a], names[b]))
        turned = isinstance(told_of, Match) and told_of.orientation == "reversed"
        evidence.append(work.judge((a, b), points[-1], turned))
    return _with_parts(work.agreed(whole, points, matches, evidence), apart)


def _with_parts(found: Collection, apart: Mapping[tuple[int, int], tuple[np.ndarray, Match | None]]) -> Collection:
    """The collection with the maps of parts, as they are."""
    pairs = tuple((found.names[a], found.names[b]) for a, b in apart)
    return replace(
        found,
        pairs=found.pairs + pairs,
        maps=found.maps + tuple(points for points, _ in apart.values()),
        matches=found.matches + tuple(match for _, match in apart.values()),
        chances=found.chances + (float("nan"),) * len(apart),
        parts=pairs,
    )


@dataclass(frozen=True, eq=False)
class _Work:
    """Shapes with what is needed to match and judge pairs of them."""

    names: tuple[str, ...]
    shapes: list[Shape]
    config: Config
    seed: int
    probes: list[ShapeSamples]

    def match(self, a: int, b: int) -> Match:
        both = self.probes[a], self.probes[b]
        return match(self.shapes[a], self.shapes[b], self.config, rng=self.seed, probes=both)

    def judge(self, ends: tuple[int, int], maps: Sequence[np.ndarray], turned: bool) -> list[ScoredMap]:
        across = reindexing(self.shapes[ends[0]], self.shapes[ends[1]])
        within = [across.part_s.to_clean[points[across.part_t.to_original]] for points in maps]
        both = self.probes[ends[0]], self.probes[ends[1]]
        with one_blas_thread():
            return score_maps(within, across.source, across.target, both, [turned] * len(maps))

    def agreed(
        self,
        ends: list[tuple[int, int]],
        points: list[list[np.ndarray]],
        matches: list[Match | None],
        evidence: list[list[ScoredMap]],
    ) -> Collection:
        """The collection, its wrong maps exchanged."""

        def along(way: CyclePath) -> np.ndarray:
            steps = []
            for step in way.steps:
                one = points[step.edge][step.candidate]
                basis = self.shapes[ends[step.edge][0]].basis
                steps.append(one if step.forward else invert_map(one, basis, len(one)))
            return compose_maps(steps)

        def turns(way: CyclePath) -> bool:
            return sum(evidence[step.edge][step.candidate].reversed for step in way.steps) % 2 == 1

        def compose(asked: list[tuple[int, CyclePath]]) -> list[ScoredMap]:
            return [self.judge(ends[link], [along(way)], turns(way))[0] for link, way in asked]

        found = repair(len(self.names), ends, evidence, compose)
        maps, matches, changes = [several[0] for several in points], list(matches), {}
        for change in found.replacements:
            pair = tuple(self.names[i] for i in ends[change.edge])
            changes[pair] = self.described(change)
            if change.kind == "none":
                continue
            way = change.path
            better = points[change.edge][change.candidate] if way is None else along(way)
            turned = evidence[change.edge][change.candidate].reversed if way is None else turns(way)
            a, b = ends[change.edge]
            matches[change.edge] = made = match_from_map(
                self.shapes[a],
                self.shapes[b],
                better,
                self.config,
                origin=changes[pair],
                orientation="reversed" if turned else "kept",
                verdict="sure" if change.after >= SURE else "ambiguous",
                confidence=change.after,
                quality=change.score_after,
                runners_up=(points[change.edge][0],),
                rng=self.seed,
            )
            maps[change.edge] = made.target_to_source
        links = [Edge(a, b, candidate_maps(several)) for (a, b), several in zip(ends, evidence, strict=True)]
        values = np.stack([shape.basis.eigenvalues[: found.sync.latent.shape[1]] for shape in self.shapes])
        return Collection(
            self.names,
            tuple(self.shapes),
            tuple((self.names[a], self.names[b]) for a, b in ends),
            tuple(maps),
            tuple(matches),
            tuple(found.probabilities.tolist()),
            changes,
            dict(zip(self.names, found.chirality.tolist(), strict=True)),
            component_limit_shapes(found.sync, links, values, LATENT),
        )

    def described(self, change: Replacement) -> str:
        if change.kind == "runner-up":
            return f"runner-up {change.candidate}"
        if change.path is not None:
            return f"composition through {', '.join(self.names[i] for i in change.path.through)}"
        return "doubted"


def _given(
    maps: Mapping[tuple[str, str], Any], names: Sequence[str], shapes: Sequence[Shape]
) -> dict[tuple[int, int], MapFile]:
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


def _runners_up(file: MapFile) -> list[np.ndarray]:
    others = file.extra.get("runners_up")
    return [] if others is None else list(np.atleast_2d(np.asarray(others)))


def _graph(kind: str, shapes: Sequence[Shape]) -> list[tuple[int, int]]:
    if kind == "all":
        return list(complete_graph(len(shapes)))
    unlike = signature_distances(np.stack([signature(shape.basis) for shape in shapes]))
    if kind == "near":
        return list(nearest_neighbor_graph(unlike))
    if kind == "star":
        return list(star_graph(len(shapes), medoid(unlike)))
    raise refuse("graph", "near, star or all", repr(kind), "choose one of them")
