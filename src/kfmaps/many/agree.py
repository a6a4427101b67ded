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

from dataclasses import dataclass, field, replace

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import breadth_first_order, connected_components, minimum_spanning_tree
from scipy.sparse.linalg import eigsh

from kfmaps._arrays import check_count, refuse

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
DENSE = 1500
"""Unknowns up to which eigenvectors are worked out densely."""
SAY = 4.0
"""What a candidate's own evidence can count at most, as a logarithm of odds."""


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
    # A spanning tree may begin with a wrong pair, and eigenvectors may live on parts that hang together loosely.
    starts = [_along_tree(count, links, maps, odds, functions), _spectral(count, links, maps, odds, functions)]
    ends = [_annealed(start, links, maps, odds) for start in starts]
    limit = max(end.limit for end in ends)
    worth = [sum(_worth(m, o, limit) for m, o in zip(end.misfits, odds, strict=True)) for end in ends]
    best = ends[int(np.argmax(np.round(worth, 6)))]
    return replace(best, component=_components(count, links))


def _annealed(latent: np.ndarray, links: list[Link], maps: list[np.ndarray], odds: list[np.ndarray]) -> Agreement:
    """The agreement that is reached from ``latent (n, k, k)``."""
    limit = SPARE[1]
    chances = [_chances(np.zeros(len(o)), o, limit, 1.0) for o in odds]
    for level in range(LEVELS):
        misfits = [misfits_of(C, latent[a.source], latent[a.target]) for C, a in zip(maps, links, strict=True)]
        typical = [float(m[p[:-1].argmax()]) for m, p in zip(misfits, chances, strict=True) if p[-1] < 0.5]
        limit = float(np.clip(FAR * np.median(typical), *SPARE)) if typical else SPARE[1]
        # At first the tolerance is that of any map, at last a third of the limit.
        spread = limit / 3 + (1.0 - limit / 3) * (1 - level / (LEVELS - 1)) ** 2
        chances = [_chances(m, o, limit, spread) for m, o in zip(misfits, odds, strict=True)]
        mean = [np.tensordot(p[:-1], C, axes=1) for p, C in zip(chances, maps, strict=True)]
        latent = _settled(latent, links, mean)
    for _ in range(RECONSIDERED):
        latent, moved = _reconsidered(latent, links, maps, odds, limit)
        misfits = [misfits_of(C, latent[a.source], latent[a.target]) for C, a in zip(maps, links, strict=True)]
        chances = [_chances(m, o, limit, limit / 3) for m, o in zip(misfits, odds, strict=True)]
        if not moved:
            break
        mean = [np.tensordot(p[:-1], C, axes=1) for p, C in zip(chances, maps, strict=True)]
        latent = _settled(latent, links, mean)
    misfits = [misfits_of(C, latent[a.source], latent[a.target]) for C, a in zip(maps, links, strict=True)]
    chances = [_chances(m, o, limit, limit / 3) for m, o in zip(misfits, odds, strict=True)]
    return Agreement(latent, tuple(chances), tuple(misfits), limit)


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


def orthogonal(C: np.ndarray) -> np.ndarray:
    """The orthogonal matrix that is nearest to ``C (k, k)``."""
    left, _, right = np.linalg.svd(C)
    return left @ right


def _components(count: int, links: list[Link]) -> np.ndarray:
    ends = np.array([(a.source, a.target) for a in links], dtype=np.int64).reshape(-1, 2)
    graph = coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(count, count))
    return connected_components(graph, directed=False)[1].astype(np.int64)


def _along_tree(
    count: int, links: list[Link], maps: list[np.ndarray], odds: list[np.ndarray], functions: int
) -> np.ndarray:
    """Latent maps along the spanning tree of the pairs whose best candidate has most for it, (n, k, k)."""
    latent = np.tile(np.eye(functions), (count, 1, 1))
    weight = np.full((count, count), np.inf)
    best: dict[tuple[int, int], np.ndarray] = {}
    for link, C, own in zip(links, maps, odds, strict=True):
        number = int(np.argmax(own))
        cost = 1.0 + SAY - float(own[number])
        a, b = link.source, link.target
        if cost < weight[a, b]:
            weight[a, b] = weight[b, a] = cost
            best[a, b], best[b, a] = C[number], C[number].T
    tree = minimum_spanning_tree(np.where(np.isfinite(weight), weight, 0.0))
    seen = np.zeros(count, dtype=bool)
    for root in range(count):
        if seen[root]:
            continue
        order, before = breadth_first_order(tree, root, directed=False)
        for v in order:
            seen[v] = True
            if v != root:
                latent[v] = orthogonal(best[before[v], v] @ latent[before[v]])
    return latent


def _spectral(
    count: int, links: list[Link], maps: list[np.ndarray], odds: list[np.ndarray], functions: int
) -> np.ndarray:
    """Latent maps from the leading eigenvectors of all pairs' maps together, each rounded, (n, k, k).

    Of ``D^{-1/2} W D^{-1/2}`` with blocks ``Σ_c p_c C`` and the shapes' degrees ``D``.
    """
    blocks: dict[tuple[int, int], np.ndarray] = {}
    degree = np.zeros(count)
    for link, C, own in zip(links, maps, odds, strict=True):
        p = _chances(np.zeros(len(own)), own, 0.0, 1.0)[:-1]
        mean = np.tensordot(p, C, axes=1)
        for a, b, one in ((link.target, link.source, mean), (link.source, link.target, mean.T)):
            blocks[a, b] = blocks.get((a, b), np.zeros_like(one)) + one
        degree[[link.source, link.target]] += p.sum()
    root = 1.0 / np.sqrt(np.maximum(degree, 1e-9))
    size = count * functions
    whole = csr_array((size, size))
    if blocks:
        rows, columns = (np.array(side) for side in zip(*blocks, strict=True))
        values = np.stack([root[a] * root[b] * C for (a, b), C in blocks.items()])
        inner = np.arange(functions)
        at_row = rows[:, None, None] * functions + inner[None, :, None] + 0 * inner[None, None, :]
        at_column = columns[:, None, None] * functions + 0 * inner[None, :, None] + inner[None, None, :]
        whole = csr_array((values.ravel(), (at_row.ravel(), at_column.ravel())), shape=(size, size))
    if size <= DENSE:
        vectors = np.linalg.eigh(whole.toarray())[1][:, -functions:]
    else:
        start = np.random.default_rng(0).normal(size=size)
        vectors = eigsh(whole, k=functions, which="LA", v0=start, tol=1e-3)[1]  # pyright: ignore[reportArgumentType]
    parts = vectors.reshape(count, functions, functions)
    return np.stack([orthogonal(part) for part in parts])
