"""Maps over a graph of pairs that agree over its cycles, and which pairs contradict them.

Each shape gets an orthogonal map from one common latent space, so that all maps through it agree over all cycles
(Huang, Wang and Guibas, Functional map networks for analyzing and exploring large shape collections, 2014; orthogonal
maps as in Kovnatsky, Glashoff and Bronstein, MADMM, 2016, and in the synchronisation of rotations). Each pair has
several candidates, of which at most one is right. What is best for the latent maps is found together with the
probability of each candidate, by expectation and maximisation: a candidate counts by how well it fits the latent
maps and by what speaks for it alone, and the latent maps fit the candidates that count. The tolerance is lowered
slowly, so that at first the majority decides.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from kfmaps._arrays import check_count, refuse
from kfmaps.collection.pair_graph import bridges
from kfmaps.collection.sync_init import SAY, along_tree, orthogonal, spectral
from kfmaps.geometry.topology import connected

FUNCTIONS = 20
"""Of the maps that are compared: enough to tell flips of limbs, and few enough to fit other bodies."""
LEVELS = 8
"""Of the tolerance, from all to that of the maps that fit; ..."""
SWEEPS = 6
"""... over how many sweeps the latent maps settle at each."""
SPARE = (0.15, 0.7)
"""Least and largest misfit from which a candidate is rather wrong. A random map has 1 to 2, a flipped one 0.8 and more,
right ones between near-isometric bodies 0.02 to 0.1."""
FAR = 4.0
"""Of the typical misfit of the maps that fit, from which one is rather wrong."""
RECONSIDERED = 5
"""Times that shapes may take what one of their links says instead of the mean of all."""
REJOINED = 3
"""Times that parts of the graph which agree within may be turned against each other as wholes."""


@dataclass(frozen=True, eq=False)
class Choice:
    """One candidate map of a pair.

    Attributes
    ----------
    map : (k, k) float64
        Functional map source → target of at least :data:`FUNCTIONS` functions.
    odds : float
        Logarithm of the odds that it is right, by what speaks for it alone.
    reversed : bool
        Whether it is a map to the target's mirror image.
    """

    map: np.ndarray
    odds: float = 0.0
    reversed: bool = False


@dataclass(frozen=True, eq=False)
class Link:
    """A pair of shapes, by number, with its candidates; the first is the one in use."""

    source: int
    target: int
    choices: tuple[Choice, ...]


@dataclass(frozen=True, eq=False)
class Agreement:
    """What :func:`agree` finds.

    Attributes
    ----------
    latent : (n, k, k) float64
        Orthogonal; of each shape, from the common latent space to its functions.
    chances : tuple of arrays (c + 1,)
        Of each link: the probability of each of its candidates, and last that none is right.
    misfits : tuple of arrays (c,)
        Of each link: ``‖C Y_s − Y_t‖² / k`` of each candidate; 0 where all agrees, 2 for unrelated maps.
    limit : float
        Misfit from which a candidate is rather wrong.
    component : (n,) int64
        Shapes with the same number are joined by pairs; others have nothing to say about each other.
    """

    latent: np.ndarray
    chances: tuple[np.ndarray, ...]
    misfits: tuple[np.ndarray, ...]
    limit: float
    component: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))


def agree(count: int, links: list[Link], functions: int = FUNCTIONS) -> Agreement:
    """Latent maps of ``count`` shapes, and how probable each candidate of each link is beside all the others.

    The result depends neither on the order of the links nor, but for the basis of the latent space, on the numbers of
    the shapes. A link on no cycle keeps the probability that its own evidence gives.

    Raises
    ------
    InvalidInput
        When a link names shapes that are not there, or a map has fewer functions.
    """
    check_count(count, "shapes", low=2)
    check_count(functions, "functions", low=2)
    for link in links:
        if not (0 <= link.source < count and 0 <= link.target < count and link.source != link.target):
            raise refuse("pairs", f"two of the shapes 0 to {count - 1}", f"{link.source} and {link.target}", "check")
        if not link.choices or any(min(c.map.shape) < functions for c in link.choices):
            raise refuse("maps", f"{functions} functions or more", "fewer, or none", "take larger maps")
    maps = [np.stack([c.map[:functions, :functions] for c in link.choices]) for link in links]
    odds = [np.clip([c.odds for c in link.choices], -SAY, SAY) for link in links]
    found = _solved(count, links, maps, odds, functions)
    for _ in range(REJOINED):
        turned = _rejoined(found, links, maps, odds)
        if turned is None:
            break
        found = turned
    return replace(found, component=_components(count, links))


def _solved(count: int, links: list[Link], maps: list[np.ndarray], odds: list[np.ndarray], functions: int) -> Agreement:
    """The best of the agreements that are reached from different starts.

    A spanning tree may begin with a wrong pair, and eigenvectors may live on parts that hang together loosely.
    """
    ends = [(link.source, link.target) for link in links]
    starts = [start(count, ends, maps, odds, functions) for start in (along_tree, spectral)]
    reached = [_annealed(start, links, maps, odds) for start in starts]
    limit = max(one.limit for one in reached)
    return reached[int(np.argmax([round(_total(one.misfits, odds, limit), 6) for one in reached]))]


def _annealed(latent: np.ndarray, links: list[Link], maps: list[np.ndarray], odds: list[np.ndarray]) -> Agreement:
    """The agreement that is reached from ``latent (n, k, k)`` as the tolerance falls."""
    limit = SPARE[1]
    chances = [_chances(np.zeros(len(o)), o, limit, 1.0) for o in odds]
    for level in range(LEVELS):
        misfits = _all_misfits(latent, links, maps)
        typical = [float(m[p[:-1].argmax()]) for m, p in zip(misfits, chances, strict=True) if p[-1] < 0.5]
        limit = float(np.clip(FAR * np.median(typical), *SPARE)) if typical else SPARE[1]
        # At first the tolerance is that of any map, at last a third of the limit.
        spread = limit / 3 + (1.0 - limit / 3) * (1 - level / (LEVELS - 1)) ** 2
        chances = [_chances(m, o, limit, spread) for m, o in zip(misfits, odds, strict=True)]
        latent = _settled(latent, links, _means(chances, maps))
    return _refined(latent, links, maps, odds, limit)


def _refined(
    latent: np.ndarray, links: list[Link], maps: list[np.ndarray], odds: list[np.ndarray], limit: float
) -> Agreement:
    """The agreement that is reached from ``latent (n, k, k)`` when only maps within ``limit`` count."""
    for _ in range(RECONSIDERED):
        latent, moved = _reconsidered(latent, links, maps, odds, limit)
        if not moved:
            break
        misfits = _all_misfits(latent, links, maps)
        chances = [_chances(m, o, limit, limit / 3) for m, o in zip(misfits, odds, strict=True)]
        latent = _settled(latent, links, _means(chances, maps))
    misfits = _all_misfits(latent, links, maps)
    chances = [_chances(m, o, limit, limit / 3) for m, o in zip(misfits, odds, strict=True)]
    return Agreement(latent, tuple(chances), tuple(misfits), limit)


def _rejoined(found: Agreement, links: list[Link], maps: list[np.ndarray], odds: list[np.ndarray]) -> Agreement | None:
    """Parts of the graph that agree within turned against each other, each as one shape; ``None`` if nothing gains.

    One wrong pair of the tree sets all behind it apart, and no shape alone can come back over the border: the pairs
    with its own side hold it. A part turned as a whole, ``Y_v Z`` for all its shapes, keeps its own pairs as they are.
    A part is what hangs together by pairs that are believed, without those that are the only way to anywhere.
    """
    count, limit = len(found.latent), found.limit
    believed = [(a.source, a.target) for a, p in zip(links, found.chances, strict=True) if p[-1] < 0.5]
    single = bridges(count, believed)
    own = np.array([pair for pair in believed if pair not in single], dtype=np.int64).reshape(-1, 2)
    parts, part = connected(count, own[:, 0], own[:, 1])
    across = [i for i, link in enumerate(links) if part[link.source] != part[link.target]]
    if parts == 1 or not across:
        return None
    between = [replace(links[i], source=int(part[links[i].source]), target=int(part[links[i].target])) for i in across]
    turns = [found.latent[links[i].target].T @ maps[i] @ found.latent[links[i].source] for i in across]
    whole = _solved(parts, between, turns, [odds[i] for i in across], found.latent.shape[-1])
    latent, before = found.latent @ whole.latent[part], _total(found.misfits, odds, limit) + 1e-6
    if _total(_all_misfits(latent, links, maps), odds, limit) <= before:
        return None
    turned = _refined(latent, links, maps, odds, limit)
    return turned if _total(turned.misfits, odds, limit) > before else None


def _all_misfits(latent: np.ndarray, links: list[Link], maps: list[np.ndarray]) -> list[np.ndarray]:
    return [misfits_of(C, latent[a.source], latent[a.target]) for C, a in zip(maps, links, strict=True)]


def _means(chances: Sequence[np.ndarray], maps: list[np.ndarray]) -> list[np.ndarray]:
    """Of each link its candidates' mean, weighted by how probable they are, (k, k)."""
    return [np.tensordot(p[:-1], C, axes=1) for p, C in zip(chances, maps, strict=True)]


def _total(misfits: Sequence[np.ndarray], odds: list[np.ndarray], limit: float) -> float:
    return sum(_worth(m, o, limit) for m, o in zip(misfits, odds, strict=True))


def _reconsidered(
    latent: np.ndarray, links: list[Link], maps: list[np.ndarray], odds: list[np.ndarray], limit: float
) -> tuple[np.ndarray, bool]:
    """Each shape in turn takes the map that one candidate of its links says, where that explains its links better."""
    latent, moved = latent.copy(), False
    around: list[list[int]] = [[] for _ in latent]
    for i, link in enumerate(links):
        around[link.source].append(i)
        around[link.target].append(i)

    def worth(v: int, Y: np.ndarray) -> float:
        total = 0.0
        for i in around[v]:
            ends = (Y, latent[links[i].target]) if links[i].source == v else (latent[links[i].source], Y)
            total += _worth(misfits_of(maps[i], *ends), odds[i], limit)
        return total

    for v, near in enumerate(around):
        best, most = latent[v], worth(v, latent[v])
        for i in near:
            other = latent[links[i].source if links[i].target == v else links[i].target]
            for C in maps[i]:
                said = orthogonal((C if links[i].target == v else C.T) @ other)
                if (value := worth(v, said)) > most + 1e-6:
                    best, most = said, value
        moved = moved or best is not latent[v]
        latent[v] = best
    return latent, moved


def _worth(misfits: np.ndarray, odds: np.ndarray, limit: float) -> float:
    """How well a link is explained: what :func:`_chances` is divided by, as a logarithm."""
    return float(np.logaddexp.reduce(np.append(odds - 3 * (misfits - limit) / limit, 0.0)))


def _chances(misfits: np.ndarray, odds: np.ndarray, limit: float, spread: float) -> np.ndarray:
    """Probability of each candidate and of none, (c + 1,): of one alone at ``limit``, its own odds."""
    say = np.append(odds - (misfits - limit) / spread, 0.0)
    grown = np.exp(say - say.max())
    return grown / grown.sum()


def misfits_of(maps: np.ndarray, source: np.ndarray, target: np.ndarray) -> np.ndarray:
    """``‖C Y_s − Y_t‖² / k`` for each of ``maps (c, k, k)``: (c,)."""
    return ((maps @ source - target) ** 2).sum(axis=(1, 2)) / len(source)


def _settled(latent: np.ndarray, links: list[Link], mean: list[np.ndarray]) -> np.ndarray:
    """Sweeps over the shapes: each takes the orthogonal map that fits its neighbours' best, (n, k, k)."""
    latent = latent.copy()
    around: list[list[tuple[int, np.ndarray]]] = [[] for _ in latent]
    for link, C in zip(links, mean, strict=True):
        around[link.target].append((link.source, C))
        around[link.source].append((link.target, C.T))
    for _ in range(SWEEPS):
        for v, neighbours in enumerate(around):
            if neighbours:
                pull = sum(C @ latent[other] for other, C in neighbours)
                if np.linalg.norm(pull) > 1e-9:
                    latent[v] = orthogonal(np.asarray(pull))
    return latent


def _components(count: int, links: list[Link]) -> np.ndarray:
    ends = np.array([(a.source, a.target) for a in links], dtype=np.int64).reshape(-1, 2)
    return connected(count, ends[:, 0], ends[:, 1])[1].astype(np.int64)
