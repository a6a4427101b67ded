"""Which pairs of a collection are exchanged, for what and why.

:func:`kfmaps.collection.synchronization.agree` says how probable each candidate of each pair is beside all others.
Where the map
in use is rather wrong, the composition of the maps on the best way round is made another candidate, judged as the
others are, and all is settled once more. A pair is exchanged only where the map in use is improbable and another
probable; where no candidate is, that is said.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from kfmaps.collection.chirality import hands
from kfmaps.collection.paths import Roads, Way, best_way, roads
from kfmaps.collection.scored_map import TURNED, Judged, better, choices, same
from kfmaps.collection.synchronization import FAR, FUNCTIONS, SAY, Agreement, Link, agree, misfits_of

DOUBT = 0.5
"""Probability of the map in use below which a way round is looked for; ..."""
WRONG = 0.1
"""... below which it is exchanged, ..."""
RIGHT = 0.5
"""... for another of at least this one."""
SAFE = 0.3
"""Probability that all maps of a way round are right, below which it is not gone."""
BETTER = 0.3
"""How much better a composition must score to be put in the place of a map that is right on the whole."""
SHORT = 3
"""Ways of two steps by the maps in use that are tried for a doubted pair."""
ROUNDS = 3
"""Times that ways round are looked for: an exchanged pair may open one for others."""


@dataclass(frozen=True)
class Step:
    """One map on a way round.

    Attributes
    ----------
    link, choice : int
        Of which pair, and which of its candidates.
    forth : bool
        Whether the way goes from the pair's source to its target.
    """

    link: int
    choice: int
    forth: bool


@dataclass(frozen=True)
class Round:
    """A way round a pair: its steps from the pair's source to its target, and the shapes between."""

    steps: tuple[Step, ...]
    through: tuple[int, ...]
    chance: float


@dataclass(frozen=True)
class Change:
    """What became of a pair whose map in use is improbable.

    Attributes
    ----------
    link : int
    kind : "runner-up", "composition" or "none"
        What it was exchanged for; "none" where no candidate is probable, and the map stays.
    choice : int
        The runner-up's number, from 1.
    way : Round or None
        Of a composition.
    before, after : float
        Probability of the map that was in use, and of the one that is.
    score_before, score_after : float
        What speaks for each alone, :attr:`kfmaps.matching.quality.Quality.score`.
    misfit_before, misfit_after : float
        How far each is from what the rest of the collection says, see
        :class:`kfmaps.collection.synchronization.Agreement`.
    contradicts : bool
        Whether the map that was in use is of another orientation than it claims, or than the collection agrees on.
    improved : bool
        Whether that map was right on the whole, and a way round merely fits better.
    """

    link: int
    kind: str
    choice: int = 0
    way: Round | None = None
    before: float = 0.0
    after: float = 0.0
    score_before: float = 0.0
    score_after: float = 0.0
    misfit_before: float = 0.0
    misfit_after: float = 0.0
    contradicts: bool = False
    improved: bool = False


@dataclass(frozen=True, eq=False)
class Repaired:
    """What :func:`repaired` finds.

    Attributes
    ----------
    agreement : Agreement
        With the compositions among the candidates.
    changes : tuple of Change
        In the order of the links.
    hands : (n,) int64
        1 and -1: shapes that are mirror images of each other's kind.
    """

    agreement: Agreement
    changes: tuple[Change, ...]
    hands: np.ndarray

    @property
    def in_use(self) -> np.ndarray:
        """Probability of the map of each link after the changes, (l,)."""
        found = np.array([chances[0] for chances in self.agreement.chances])
        for change in self.changes:
            found[change.link] = change.after
        return found


Compose = Callable[[list[tuple[int, Round]]], list[Judged]]
"""Given pairs and ways round them, the compositions, judged; in the same order."""


def repaired(
    count: int, ends: Sequence[tuple[int, int]], maps: Sequence[Sequence[Judged]], compose: Compose
) -> Repaired:
    """Settle which maps of a collection of ``count`` shapes are right.

    Parameters
    ----------
    ends : sequence of (int, int)
        Source and target of each pair.
    maps : sequence of sequences of Judged
        Of each pair the map in use and its runners-up.
    compose : callable
        Makes and judges compositions, all that one round asks for at once.
    """
    known = [list(several) for several in maps]
    ways: list[list[Round]] = [[] for _ in ends]
    tried: set[tuple[int, tuple[Step, ...]]] = set()
    around = roads(count, ends)
    signs, found = _settled(count, ends, known)
    for _ in range(ROUNDS):
        asked, best = [], _best(found, ways)
        for number, chances in enumerate(found.chances):
            if chances[0] >= DOUBT:
                continue
            offered = [way_round(around, ends, best, number), *in_use(around, ends, known, number)]
            for way in offered:
                if way is not None and (number, way.steps) not in tried:
                    tried.add((number, way.steps))
                    asked.append((number, way))
        if not asked:
            break
        for (number, way), made in zip(asked, compose(asked), strict=True):
            _offer(known[number], ways[number], made, way)
        signs, found = _settled(count, ends, known)
    changes = [
        change
        for number in range(len(ends))
        if (change := _change(number, known[number], len(maps[number]), ways[number], found, signs, ends)) is not None
    ]
    changes += _improved(around, ends, known, ways, found, compose, {change.link for change in changes})
    return Repaired(found, tuple(sorted(changes, key=lambda change: change.link)), signs)


def _improved(
    around: Roads,
    ends: Sequence[tuple[int, int]],
    maps: Sequence[Sequence[Judged]],
    ways: Sequence[Sequence[Round]],
    found: Agreement,
    compose: Compose,
    done: set[int],
) -> list[Change]:
    """Maps that are right on the whole and loose in part, exchanged where a way round fits better and scores better.

    Loose are those whose misfit is beyond :data:`kfmaps.collection.synchronization.FAR` times what is usual.
    """
    own = np.array([misfits[0] for misfits in found.misfits])
    usual = float(np.median(own)) if len(own) else 0.0
    asked, likely = [], _best(found, ways)
    for number in np.flatnonzero(own > FAR * usual + 1e-9).tolist():
        if number in done or found.chances[number][0] < DOUBT:
            continue
        offered = [way_round(around, ends, likely, number), *in_use(around, ends, maps, number)]
        seen = {way.steps: way for way in offered if way is not None}
        asked += [(number, way) for way in seen.values()]
    better_ones: dict[int, Change] = {}
    for (number, way), made in zip(asked, compose(asked) if asked else [], strict=True):
        a, b = ends[number]
        size = found.latent.shape[1]
        misfit = float(misfits_of(made.map[None, :size, :size], found.latent[a], found.latent[b])[0])
        first, before = maps[number][0], better_ones.get(number)
        least = first.score + BETTER if before is None else before.score_after
        if made.score > least and misfit < own[number] and made.reversed == first.reversed:
            chance = float(found.chances[number][0])
            better_ones[number] = Change(
                number,
                "composition",
                way=way,
                before=chance,
                after=chance,
                score_before=first.score,
                score_after=made.score,
                misfit_before=float(own[number]),
                misfit_after=misfit,
                improved=True,
            )
    return list(better_ones.values())


def _offer(maps: list[Judged], ways: list[Round], made: Judged, way: Round) -> None:
    """A composition beside the candidates of a pair; where it is nearly one of them, that may have its score."""
    for i, one in enumerate(maps):
        if same(one, made):
            maps[i] = better(one, made)
            return
    maps.append(made)
    ways.append(way)


def in_use(
    around: Roads, ends: Sequence[tuple[int, int]], maps: Sequence[Sequence[Judged]], number: int
) -> list[Round]:
    """Ways of two steps round link ``number`` by the maps in use, those of the best scores; at most :data:`SHORT`.

    What most candidates say may be wrong together. These say what the maps say that a search thought best.
    """
    source, target = ends[number]
    near: dict[int, dict[int, int]] = {source: {}, target: {}}
    for here, others in near.items():
        for other, i in around[here]:
            if i != number and (other not in others or maps[i][0].score > maps[others[other]][0].score):
                others[other] = i
    found = []
    for middle in sorted(near[source].keys() & near[target].keys() - {source, target}):
        first, second = near[source][middle], near[target][middle]
        worth = min(maps[first][0].score, maps[second][0].score)
        steps = (Step(first, 0, ends[first][0] == source), Step(second, 0, ends[second][0] == middle))
        found.append((worth, Round(steps, (middle,), 0.0)))
    found.sort(key=lambda item: -item[0])
    return [way for _, way in found[:SHORT]]


def _best(found: Agreement, ways: Sequence[Sequence[Round]]) -> tuple[list[int], list[float]]:
    """Of each link its best candidate, and how probable that is as a step of a way.

    Links of which a composition is the best are no part of one: they are ways themselves.
    """
    best = [int(chances[:-1].argmax()) for chances in found.chances]
    given = [len(chances) - 1 - len(several) for chances, several in zip(found.chances, ways, strict=True)]
    each = zip(found.chances, best, given, strict=True)
    return best, [float(chances[b]) if b < count else 0.0 for chances, b, count in each]


def way_round(
    around: Roads, ends: Sequence[tuple[int, int]], best: tuple[list[int], list[float]], number: int
) -> Round | None:
    """The best way from the source of link ``number`` to its target through others, each by its ``best`` candidate."""
    candidate, chances = best
    way: Way | None = best_way(around, chances, *ends[number], without=number)
    if way is None or way.chance < SAFE:
        return None
    each = zip(way.links, way.shapes, strict=False)
    steps = tuple(Step(link, candidate[link], ends[link][0] == at) for link, at in each)
    return Round(steps, way.shapes[1:-1], way.chance)


def _settled(count: int, ends: Sequence[tuple[int, int]], maps: list[list[Judged]]) -> tuple[np.ndarray, Agreement]:
    """Hands, and the agreement of candidates that do not contradict them."""
    offered = [choices(several) for several in maps]
    signs = np.ones(count, dtype=np.int64)
    if any(one.reversed for several in maps for one in several):
        first = [several[int(np.argmax([c.odds for c in several]))] for several in offered]
        sure = [1.0 / (1.0 + np.exp(-c.odds)) for c in first]
        signs = hands(count, ends, [not c.reversed for c in first], sure)
        offered = [
            tuple(c if c.reversed == bool(signs[a] != signs[b]) else replace(c, odds=c.odds - 2 * SAY) for c in several)
            for (a, b), several in zip(ends, offered, strict=True)
        ]
    links = [Link(a, b, several) for (a, b), several in zip(ends, offered, strict=True)]
    size = min([FUNCTIONS, *(min(c.map.shape) for several in offered for c in several)])
    return signs, agree(count, links, size)


def _change(
    number: int,
    maps: list[Judged],
    given: int,
    ways: list[Round],
    found: Agreement,
    signs: np.ndarray,
    ends: Sequence[tuple[int, int]],
) -> Change | None:
    chances, misfits = found.chances[number], found.misfits[number]
    before = float(chances[0])
    if before >= WRONG:
        return None
    best = int(chances[:-1].argmax())
    a, b = ends[number]
    turned = maps[0].reversed != bool(signs[a] != signs[b]) or maps[0].orientation < TURNED
    told = {
        "before": before,
        "score_before": maps[0].score,
        "misfit_before": float(misfits[0]),
        "contradicts": turned,
    }
    if best == 0 or chances[best] < RIGHT:
        return Change(number, "none", after=before, score_after=maps[0].score, misfit_after=float(misfits[0]), **told)
    told |= {
        "after": float(chances[best]),
        "score_after": maps[best].score,
        "misfit_after": float(misfits[best]),
    }
    if best >= given:
        return Change(number, "composition", way=ways[best - given], **told)
    return Change(number, "runner-up", choice=best, **told)
