"""Choose which pairs of a collection get another map, which one, and why.

:func:`kfmaps.collection.synchronization.synchronize` says how probable each candidate of each pair is beside all
others. Where the map in use is rather wrong, the composition of the maps on the best other path becomes one more
candidate, scored as the others are, and all is synchronized once more. A map is replaced only where it is improbable
and another one probable; where no candidate is, that is said.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from kfmaps.collection.paths import best_path
from kfmaps.collection.scored_map import ScoredMap, candidate_maps, is_same_map, with_better_score
from kfmaps.collection.synchronization import (
    MAX_LOG_ODDS,
    N_FUNCTIONS,
    OUTLIER_FACTOR,
    Edge,
    SyncResult,
    map_residuals,
    synchronize,
)
from kfmaps.geometry.connectivity import component_labels
from kfmaps.matching.score import SCORE

_NAMED = 5  # shapes of a composition that its label names
_DOUBT = 0.5  # probability of the map in use below which a composition is sought


@dataclass(frozen=True)
class CycleStep:
    """One map on a path: of edge ``edge`` its candidate number ``candidate``, from its source or (not) ``forward``."""

    edge: int
    candidate: int
    forward: bool


@dataclass(frozen=True)
class CyclePath:
    """A path that closes a cycle with a pair: steps from the pair's source to its target, and the shapes between."""

    steps: tuple[CycleStep, ...]
    through: tuple[int, ...]


@dataclass(frozen=True)
class MapEvidence:
    """What is known of a candidate map."""

    probability: float  # that it is right, beside all other maps
    score: float  # its own evidence, :attr:`kfmaps.matching.score.Quality.score`
    residual: float  # its distance from what the rest of the collection says (:class:`SyncResult`)


@dataclass(frozen=True)
class Replacement:
    """What becomes of a pair whose map in use is improbable."""

    edge: int
    # "alternative", "composition" or "none": what replaces the map; "none" where no candidate is probable, and the map
    # stays.
    kind: str
    before: MapEvidence  # of the map that was in use, and of the one that is
    after: MapEvidence
    candidate: int = 0  # the alternative's number, from 1
    path: CyclePath | None = None  # of a composition
    # Whether the map that was in use is of another orientation than it claims, or than the collection agrees on.
    contradicts: bool = False
    improved: bool = False  # whether that map was right on the whole, and a composition merely fits better

    def label(self, names: Sequence[str]) -> str:
        """Return what the map was replaced by, in words; empty where it stays."""
        if self.path is not None:
            through = [names[i] for i in self.path.through]
            more = [f"{len(through) - _NAMED} more"] if len(through) > _NAMED else []
            return f"composition through {', '.join([*through[:_NAMED], *more])}"
        return f"alternative {self.candidate}" if self.kind == "alternative" else ""

    def reason(self) -> str:
        """Return why, in words."""
        before, after = self.before, self.after
        scores = f"score {before.score:.1f}, now {after.score:.1f}"
        if self.improved:
            residuals = f"by {before.residual:.2f}, and this by {after.residual:.2f}"
            return f"it strays from what other pairs say, {residuals}; {scores}"
        other = "no other map is probable" if self.kind == "none" else f"this {after.probability:.0%}"
        parts = [f"other pairs leave it a probability of {before.probability:.1%}, and {other}"]
        parts += ["it is of another orientation than it claims"] if self.contradicts else []
        parts += [scores] if self.kind != "none" else []
        return "; ".join(parts)


@dataclass(frozen=True, eq=False)
class RepairResult:
    """Result of :func:`repair_maps`."""

    sync: SyncResult  # with the compositions among the candidates
    replacements: tuple[Replacement, ...]  # in the order of the edges
    chirality: np.ndarray  # (n,): 1 and -1: shapes that are mirror images of each other's kind

    @property
    def probabilities(self) -> np.ndarray:
        """Probability of the map of each edge after the replacements, (e,)."""
        result = np.array([chances[0] for chances in self.sync.probabilities])
        for change in self.replacements:
            result[change.edge] = change.after.probability
        return result


Compose = Callable[[list[tuple[int, CyclePath]]], list[ScoredMap]]
"""Given edges and paths, return the scored compositions in the same order."""


def repair_maps(
    count: int, ends: Sequence[tuple[int, int]], maps: Sequence[Sequence[ScoredMap]], compose: Compose
) -> RepairResult:
    """Find which maps of a collection of ``count`` shapes are wrong, and what replaces them.

    ``count``: number of shapes; ``ends``: source and target of each pair; ``maps``: of each pair the map in use and its
    alternatives; ``compose``: makes and scores compositions, all that one round asks for at once.
    """
    return _Repair(count, ends, maps, compose).run()


class _Repair:
    """The candidates of each edge as they grow by compositions, and what their synchronization says."""

    def __init__(
        self, count: int, ends: Sequence[tuple[int, int]], maps: Sequence[Sequence[ScoredMap]], compose: Compose
    ) -> None:
        self.count, self.ends, self.compose = count, ends, compose
        self.maps = [list(several) for several in maps]
        self.given = [len(several) for several in maps]
        self.paths: list[list[CyclePath]] = [[] for _ in ends]  # of the candidates beyond those given
        self.signs, self.sync = _synchronize(count, ends, self.maps)

    def run(self) -> RepairResult:
        tried: set[tuple[int, CyclePath]] = set()
        for _ in range(3):  # rounds of compositions: a replaced map may open a path for others
            doubted = [i for i, chances in enumerate(self.sync.probabilities) if chances[0] < _DOUBT]
            asked = [one for one in self._paths_around(doubted) if one not in tried]
            if not asked:
                break
            tried |= set(asked)
            for (i, path), made in zip(asked, self.compose(asked), strict=True):
                self._offer(i, made, path)
            self.signs, self.sync = _synchronize(self.count, self.ends, self.maps)
        changes = {i: change for i in range(len(self.ends)) if (change := self._replacement(i)) is not None}
        changes |= self._improvements(changes.keys())
        return RepairResult(self.sync, tuple(changes[i] for i in sorted(changes)), self.signs)

    def _paths_around(self, edges: Sequence[int]) -> list[tuple[int, CyclePath]]:
        """For each of the ``edges`` the most probable other path, and those of two steps; each once.

        Edges of which a composition is the best candidate are no part of a path: they are paths themselves.
        """
        best = [int(chances[:-1].argmax()) for chances in self.sync.probabilities]
        each = zip(self.sync.probabilities, best, self.given, strict=True)
        chances = [float(p[b]) if b < given else 0.0 for p, b, given in each]
        found: list[tuple[int, CyclePath]] = []
        min_path_probability = 0.3  # least probability that all maps of a path are right
        for i in edges:
            likely = best_path(self.count, self.ends, chances, *self.ends[i], without=i)
            paths = _two_step_paths(self.ends, self.maps, i)
            if likely is not None and likely.probability >= min_path_probability:
                walk = zip(likely.edges, likely.shapes, strict=False)
                steps = tuple(CycleStep(e, best[e], self.ends[e][0] == at) for e, at in walk)
                paths.insert(0, CyclePath(steps, likely.shapes[1:-1]))
            found += [(i, path) for path in dict.fromkeys(paths)]
        return found

    def _offer(self, edge: int, made: ScoredMap, path: CyclePath) -> None:
        """Add a composition to the candidates; where it is nearly one of them, that one may take its score."""
        for i, one in enumerate(self.maps[edge]):
            if is_same_map(one, made):
                self.maps[edge][i] = with_better_score(one, made)
                return
        self.maps[edge].append(made)
        self.paths[edge].append(path)

    def _evidence(self, edge: int, candidate: int) -> MapEvidence:
        probability, residual = self.sync.probabilities[edge][candidate], self.sync.residuals[edge][candidate]
        return MapEvidence(float(probability), self.maps[edge][candidate].score, float(residual))

    def _replacement(self, edge: int) -> Replacement | None:
        """What replaces a map that is improbable; ``None`` for other maps."""
        chances, given, (a, b) = self.sync.probabilities[edge], self.given[edge], self.ends[edge]
        if chances[0] >= 0.1:  # probability of the map in use below which it is replaced
            return None
        best = int(chances[:-1].argmax())
        best = best if chances[best] >= 0.5 else 0  # least probability of the map that replaces it
        first, composed = self.maps[edge][0], best >= given
        return Replacement(
            edge,
            "none" if best == 0 else "composition" if composed else "alternative",
            self._evidence(edge, 0),
            self._evidence(edge, best),
            candidate=0 if composed else best,
            path=self.paths[edge][best - given] if composed else None,
            contradicts=first.reversed != (self.signs[a] != self.signs[b]) or first.orientation < SCORE.min_orientation,
        )

    def _improvements(self, done: Collection[int]) -> dict[int, Replacement]:
        """Replace maps that are right on the whole and loose in part, where a path fits better and scores better.

        Loose are those whose residual is beyond :data:`OUTLIER_FACTOR` times the median.
        """
        own = np.array([residuals[0] for residuals in self.sync.residuals])
        limit = OUTLIER_FACTOR * float(np.median(own)) + 1e-9 if len(own) else 0.0
        right = [chances[0] >= _DOUBT for chances in self.sync.probabilities]
        asked = self._paths_around([i for i in np.flatnonzero(own > limit).tolist() if i not in done and right[i]])
        found: dict[int, Replacement] = {}
        size, latent = self.sync.latent.shape[1], self.sync.latent
        min_gain = 0.3  # how much better a composition must score to replace a map that is right on the whole
        for (i, path), made in zip(asked, self.compose(asked) if asked else [], strict=True):
            a, b = self.ends[i]
            residual = float(map_residuals(made.map[None, :size, :size], latent[a], latent[b])[0])
            before = self._evidence(i, 0)
            least = found[i].after.score if i in found else before.score + min_gain
            if made.score > least and residual < own[i] and made.reversed == self.maps[i][0].reversed:
                after = MapEvidence(before.probability, made.score, residual)
                found[i] = Replacement(i, "composition", before, after, path=path, improved=True)
        return found


def _two_step_paths(ends: Sequence[tuple[int, int]], maps: Sequence[Sequence[ScoredMap]], edge: int) -> list[CyclePath]:
    """Return at most three paths of two steps around an edge, by the maps in use, best scores first.

    What most candidates say may be wrong together. These say what the maps say that a search thought best.
    """
    source, target = ends[edge]
    near: dict[int, dict[int, int]] = {source: {}, target: {}}
    for i in sorted(range(len(ends)), key=lambda i: maps[i][0].score):  # of several between two shapes the best
        for here, other in (ends[i], ends[i][::-1]):
            if here in near and i != edge:
                near[here][other] = i
    found = []
    for middle in sorted(near[source].keys() & near[target].keys() - {source, target}):
        first, second = near[source][middle], near[target][middle]
        steps = (CycleStep(first, 0, ends[first][0] == source), CycleStep(second, 0, ends[second][0] == middle))
        found.append((min(maps[first][0].score, maps[second][0].score), CyclePath(steps, (middle,))))
    found.sort(key=lambda item: -item[0])
    return [path for _, path in found[:3]]


def _synchronize(
    count: int, ends: Sequence[tuple[int, int]], maps: Sequence[Sequence[ScoredMap]]
) -> tuple[np.ndarray, SyncResult]:
    """Chirality, and the synchronization of candidates; those that contradict the chirality lose their odds."""
    offered = [candidate_maps(several) for several in maps]
    signs = np.ones(count, dtype=np.int64)
    if any(one.reversed for several in maps for one in several):
        first = [several[int(np.argmax([c.log_odds for c in several]))] for several in offered]
        weights = [1.0 / (1.0 + np.exp(-c.log_odds)) for c in first]
        signs = chirality(count, ends, [not c.reversed for c in first], weights)
        offered = [
            tuple(
                c if c.reversed == bool(signs[a] != signs[b]) else replace(c, log_odds=c.log_odds - 2 * MAX_LOG_ODDS)
                for c in several
            )
            for (a, b), several in zip(ends, offered, strict=True)
        ]
    edges = [Edge(a, b, several) for (a, b), several in zip(ends, offered, strict=True)]
    size = min([N_FUNCTIONS, *(min(c.map.shape) for several in offered for c in several)])
    return signs, synchronize(count, edges, size)


def chirality(
    count: int, ends: Sequence[tuple[int, int]], kept: Sequence[bool], weights: Iterable[float]
) -> np.ndarray:
    """Return 1 or -1 for each shape, such that pairs of equal sign keep orientation and others reverse it: (n,) int64.

    The pairs that agree should have the largest sum of ``weights``: the leading eigenvector of the signed graph gives
    first signs (synchronisation over the group of two; Singer 2011), and shapes change theirs while the sum grows.

    ``count``: number of shapes; ``ends``, ``kept`` and ``weights``: of each pair its shapes, whether its map keeps
    orientation, and how sure that is, not negative. Where pairs join shapes, the one with the lowest number has 1.
    """
    signed = np.zeros((count, count))
    for (a, b), same, w in zip(ends, kept, weights, strict=True):
        signed[a, b] += w if same else -w
        signed[b, a] += w if same else -w
    part = component_labels(count, *np.nonzero(signed))[1]
    signs, first = np.ones(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
    for own in (np.flatnonzero(part == number) for number in np.unique(part)):
        leading = np.linalg.eigh(signed[np.ix_(own, own)])[1][:, -1]
        signs[own], first[own] = np.where(leading < -1e-12, -1, 1), own[0]
    for _ in range(100):  # signs that are changed at most
        gain = -signs * (signed @ signs)
        worst = int(gain.argmax())
        if gain[worst] <= 1e-9 * (1.0 + np.abs(signed).max()):
            break
        signs[worst] *= -1
    return signs * signs[first]
