"""Choose which pairs of a collection get another map, which one, and why.

:func:`kfmaps.collection.synchronization.synchronize` gives the probability of each candidate of each pair. Where the
map in use is doubtful, the composition of the maps on the best other path becomes one more candidate with a score, and
all candidates are synchronized again. A map is replaced only where it is improbable and another one is probable.
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

_MAX_NAMED = 5  # shapes of a composition that its label names
_MIN_PROBABILITY = 0.5  # probability of the map in use below which a composition is sought


@dataclass(frozen=True)
class CycleStep:
    """One map on a path."""

    edge: int
    candidate: int  # number of the edge's candidate
    forward: bool  # whether the step goes from the edge's source to its target


@dataclass(frozen=True)
class CyclePath:
    """A path that closes a cycle with a pair."""

    steps: tuple[CycleStep, ...]  # from the pair's source to its target
    through: tuple[int, ...]  # the shapes between


@dataclass(frozen=True)
class MapEvidence:
    """The evidence about a candidate map."""

    probability: float  # that it is right, given all other maps
    score: float  # :attr:`kfmaps.matching.score.Quality.calibrated_score`
    residual: float  # distance from the synchronized maps, see :class:`SyncResult`


@dataclass(frozen=True)
class Replacement:
    """The replacement of a pair's improbable map, or none."""

    edge: int
    kind: str  # "alternative", "composition" or "none", where no candidate is probable and the map stays
    before: MapEvidence  # of the old map
    after: MapEvidence  # of the new map
    candidate: int = 0  # the alternative's number, from 1
    path: CyclePath | None = None  # of a composition
    contradicts: bool = False  # whether the old map has another orientation than it claims, or than the collection
    improved: bool = False  # whether the old map was right on the whole, and a composition only fits better

    def label(self, names: Sequence[str]) -> str:
        """Return the replacement in words; empty where the map stays."""
        if self.path is not None:
            through = [names[i] for i in self.path.through]
            more = [f"{len(through) - _MAX_NAMED} more"] if len(through) > _MAX_NAMED else []
            return f"composition through {', '.join([*through[:_MAX_NAMED], *more])}"
        return f"alternative {self.candidate}" if self.kind == "alternative" else ""

    def reason(self) -> str:
        """Return the reason of the replacement in words."""
        before, after = self.before, self.after
        scores = f"score {before.score:.1f}, now {after.score:.1f}"
        if self.improved:
            residuals = f"by {before.residual:.2f}, the new one by {after.residual:.2f}"
            return f"it deviates from the other pairs {residuals}; {scores}"
        other = "no other map is probable" if self.kind == "none" else f"the new one {after.probability:.0%}"
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
    """Find which maps of a collection of ``count`` shapes are wrong, and their replacements.

    ``ends``: source and target of each pair; ``maps``: the map in use and the alternatives of each pair; ``compose``:
    makes and scores all compositions of one round.
    """
    return _Repair(count, ends, maps, compose).run()


class _Repair:
    """The candidates of each edge, to which compositions are added, and their synchronization."""

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
            doubted = [i for i, chances in enumerate(self.sync.probabilities) if chances[0] < _MIN_PROBABILITY]
            paths = [pair_path for pair_path in self._paths_around(doubted) if pair_path not in tried]
            if not paths:
                break
            tried |= set(paths)
            for (i, path), composition in zip(paths, self.compose(paths), strict=True):
                self._offer(i, composition, path)
            self.signs, self.sync = _synchronize(self.count, self.ends, self.maps)
        changes = {i: change for i in range(len(self.ends)) if (change := self._replacement(i)) is not None}
        changes |= self._improvements(changes.keys())
        return RepairResult(self.sync, tuple(changes[i] for i in sorted(changes)), self.signs)

    def _paths_around(self, edges: Sequence[int]) -> list[tuple[int, CyclePath]]:
        """Return the most probable other path of each of the ``edges``, and paths of two steps, each once.

        Edges whose best candidate is a composition are left out of paths.
        """
        best = [int(chances[:-1].argmax()) for chances in self.sync.probabilities]
        each = zip(self.sync.probabilities, best, self.given, strict=True)
        chances = [float(p[b]) if b < n_given else 0.0 for p, b, n_given in each]
        alternatives: list[tuple[int, CyclePath]] = []
        min_path_probability = 0.3  # least probability that all maps of a path are right
        for i in edges:
            likely = best_path(self.count, self.ends, chances, *self.ends[i], without=i)
            paths = _two_step_paths(self.ends, self.maps, i)
            if likely is not None and likely.probability >= min_path_probability:
                walk = zip(likely.edges, likely.shapes, strict=False)
                steps = tuple(CycleStep(e, best[e], self.ends[e][0] == at) for e, at in walk)
                paths.insert(0, CyclePath(steps, likely.shapes[1:-1]))
            alternatives += [(i, path) for path in dict.fromkeys(paths)]
        return alternatives

    def _offer(self, edge: int, composition: ScoredMap, path: CyclePath) -> None:
        """Add a composition to the candidates; one that it nearly equals gets its score instead, if that is better."""
        for i, one in enumerate(self.maps[edge]):
            if is_same_map(one, composition):
                self.maps[edge][i] = with_better_score(one, composition)
                return
        self.maps[edge].append(composition)
        self.paths[edge].append(path)

    def _evidence(self, edge: int, candidate: int) -> MapEvidence:
        probability, residual = self.sync.probabilities[edge][candidate], self.sync.residuals[edge][candidate]
        return MapEvidence(float(probability), self.maps[edge][candidate].score, float(residual))

    def _replacement(self, edge: int) -> Replacement | None:
        """Return the replacement of an improbable map; ``None`` for other maps."""
        chances, n_given, (a, b) = self.sync.probabilities[edge], self.given[edge], self.ends[edge]
        if chances[0] >= 0.1:  # probability of the map in use below which it is replaced
            return None
        best = int(chances[:-1].argmax())
        best = best if chances[best] >= 0.5 else 0  # least probability of the map that replaces it
        first, composed = self.maps[edge][0], best >= n_given
        return Replacement(
            edge,
            "none" if best == 0 else "composition" if composed else "alternative",
            self._evidence(edge, 0),
            self._evidence(edge, best),
            candidate=0 if composed else best,
            path=self.paths[edge][best - n_given] if composed else None,
            contradicts=first.reversed != (self.signs[a] != self.signs[b]) or first.orientation < SCORE.min_orientation,
        )

    def _improvements(self, done: Collection[int]) -> dict[int, Replacement]:
        """Return better compositions for maps that are right on the whole but have a large residual.

        A residual is large beyond :data:`OUTLIER_FACTOR` times the median; the composition must fit and score better.
        """
        in_use = np.array([residuals[0] for residuals in self.sync.residuals])
        limit = OUTLIER_FACTOR * float(np.median(in_use)) + 1e-9 if len(in_use) else 0.0
        right = [chances[0] >= _MIN_PROBABILITY for chances in self.sync.probabilities]
        paths = self._paths_around([i for i in np.flatnonzero(in_use > limit).tolist() if i not in done and right[i]])
        replacements: dict[int, Replacement] = {}
        size, latent = self.sync.latent.shape[1], self.sync.latent
        min_gain = 0.3  # how much better a composition must score to replace a map that is right on the whole
        for (i, path), composition in zip(paths, self.compose(paths) if paths else [], strict=True):
            a, b = self.ends[i]
            residual = float(map_residuals(composition.map[None, :size, :size], latent[a], latent[b])[0])
            before = self._evidence(i, 0)
            least = replacements[i].after.score if i in replacements else before.score + min_gain
            if composition.score > least and residual < in_use[i] and composition.reversed == self.maps[i][0].reversed:
                after = MapEvidence(before.probability, composition.score, residual)
                replacements[i] = Replacement(i, "composition", before, after, path=path, improved=True)
        return replacements


def _two_step_paths(ends: Sequence[tuple[int, int]], maps: Sequence[Sequence[ScoredMap]], edge: int) -> list[CyclePath]:
    """Return at most three paths of two steps around an edge, by the maps in use, best scores first.

    Most candidates may be wrong together. These paths use only the maps that a search chose.
    """
    source, target = ends[edge]
    edges_at: dict[int, dict[int, int]] = {source: {}, target: {}}
    for i in sorted(range(len(ends)), key=lambda i: maps[i][0].score):  # of several between two shapes the best
        for shape, other in (ends[i], ends[i][::-1]):
            if shape in edges_at and i != edge:
                edges_at[shape][other] = i
    paths = []
    for middle in sorted(edges_at[source].keys() & edges_at[target].keys() - {source, target}):
        first, second = edges_at[source][middle], edges_at[target][middle]
        steps = (CycleStep(first, 0, ends[first][0] == source), CycleStep(second, 0, ends[second][0] == middle))
        paths.append((min(maps[first][0].score, maps[second][0].score), CyclePath(steps, (middle,))))
    paths.sort(key=lambda item: -item[0])
    return [path for _, path in paths[:3]]


def _synchronize(
    count: int, ends: Sequence[tuple[int, int]], maps: Sequence[Sequence[ScoredMap]]
) -> tuple[np.ndarray, SyncResult]:
    """Return chirality and synchronization; candidates that contradict the chirality lose their odds."""
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
    count: int, ends: Sequence[tuple[int, int]], preserves: Sequence[bool], weights: Iterable[float]
) -> np.ndarray:
    """Return 1 or -1 for each shape, (n,) int64: maps between equal signs keep orientation, others reverse it.

    The sum of ``weights`` over pairs that agree is maximised: the leading eigenvector of the signed graph gives initial
    signs (synchronisation over the group of two; Singer 2011), which change one by one while the sum grows.

    ``count``: number of shapes; ``ends``, ``preserves`` and ``weights``: of each pair its shapes, whether its map keeps
    orientation, and how sure that is, not negative. Where pairs join shapes, the one with the lowest number has 1.
    """
    signed = np.zeros((count, count))
    for (a, b), keeps, w in zip(ends, preserves, weights, strict=True):
        signed[a, b] += w if keeps else -w
        signed[b, a] += w if keeps else -w
    part = component_labels(count, *np.nonzero(signed))[1]
    signs, first = np.ones(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
    for members in (np.flatnonzero(part == number) for number in np.unique(part)):
        leading = np.linalg.eigh(signed[np.ix_(members, members)])[1][:, -1]
        signs[members], first[members] = np.where(leading < -1e-12, -1, 1), members[0]
    for _ in range(100):  # signs that are changed at most
        gain = -signs * (signed @ signs)
        worst = int(gain.argmax())
        if gain[worst] <= 1e-9 * (1.0 + np.abs(signed).max()):
            break
        signs[worst] *= -1
    return signs * signs[first]
