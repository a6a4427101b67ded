"""Map synchronization: orthogonal maps from a latent space to each shape that explain the pairwise maps.

Each shape gets an orthogonal map from one common latent space, so that all maps through it agree over all cycles
(Huang, Wang and Guibas, Functional map networks for analyzing and exploring large shape collections, 2014; orthogonal
maps as in Kovnatsky, Glashoff and Bronstein, MADMM, 2016, and in the synchronization of rotations). Each pair has
several candidates, at most one of which is right. Expectation maximization gives the latent maps and the probability
of each candidate. The weight of a candidate depends on how well it fits the latent maps and on its own evidence, and
the latent maps fit the weighted candidates. The tolerance falls slowly, so that at first the majority decides.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, eye_array
from scipy.sparse.csgraph import breadth_first_order, minimum_spanning_tree

from kfmaps.collection.pair_graph import bridges
from kfmaps.fmap.constraints import nearest_orthogonal
from kfmaps.geometry.connectivity import component_labels
from kfmaps.geometry.eigen.eigensolver import smallest_eigenpairs

MAX_LOG_ODDS = 4.0
"""Largest log-odds that a candidate's own evidence counts for."""
N_FUNCTIONS = 20
"""Size of the compared maps: large enough to detect flipped limbs, and small enough for different bodies."""
_RESIDUAL_LIMITS = (0.15, 0.7)
"""Least and largest limit of the residual above which a candidate is probably wrong. Random maps have 1 to 2, flipped
ones 0.8 and more, right ones between near-isometric bodies 0.02 to 0.1."""
OUTLIER_FACTOR = 4.0
"""Multiple of the median residual of the accepted maps that is this limit."""


@dataclass(frozen=True, eq=False)
class CandidateMap:
    """One candidate map of a pair."""

    map: np.ndarray  # (k, k): functional map source → target of at least :data:`N_FUNCTIONS` functions
    log_odds: float = 0.0  # logarithm of the odds that it is right, from its own evidence alone
    reversed: bool = False  # whether it is a map to the target's mirror image


@dataclass(frozen=True, eq=False)
class Edge:
    """A pair of shapes with its candidate maps."""

    source: int  # numbers of the shapes
    target: int
    candidates: tuple[CandidateMap, ...]  # the first is the map in use


@dataclass(frozen=True, eq=False)
class SyncResult:
    """Result of :func:`synchronize`."""

    latent: np.ndarray  # (n, k, k): orthogonal map of each shape, from the latent space to its functions
    # Of each edge: the probability of each of its candidates, and last that none is right.
    probabilities: tuple[np.ndarray, ...]
    # Of each edge: ``‖C Y_s − Y_t‖² / k`` of each candidate; 0 where all agrees, 2 for unrelated maps.
    residuals: tuple[np.ndarray, ...]
    limit: float  # residual above which a candidate is probably wrong
    # (n,): connected component of each shape; shapes of different components say nothing about each other.
    component: np.ndarray


@dataclass(frozen=True, eq=False)
class _Problem:
    """Edges as arrays: the ends, the stacked candidate maps (c, k, k) and the clipped log-odds (c,) of each."""

    count: int
    ends: Sequence[tuple[int, int]]
    maps: Sequence[np.ndarray]
    log_odds: Sequence[np.ndarray]

    def residuals(self, latent: np.ndarray) -> list[np.ndarray]:
        return [map_residuals(C, latent[a], latent[b]) for C, (a, b) in zip(self.maps, self.ends, strict=True)]

    def probabilities(self, residuals: Sequence[np.ndarray], limit: float, spread: float) -> list[np.ndarray]:
        return [_probabilities(r, o, limit, spread) for r, o in zip(residuals, self.log_odds, strict=True)]

    def log_likelihood(self, residuals: Sequence[np.ndarray], limit: float) -> float:
        return sum(_log_likelihood(r, o, limit) for r, o in zip(residuals, self.log_odds, strict=True))

    def incident(self) -> list[list[int]]:
        """Return the edges at each shape."""
        edges: list[list[int]] = [[] for _ in range(self.count)]
        for i, (a, b) in enumerate(self.ends):
            edges[a].append(i)
            edges[b].append(i)
        return edges


def synchronize(count: int, edges: Sequence[Edge], functions: int = N_FUNCTIONS) -> SyncResult:
    """Return latent maps of ``count`` shapes, and the probability of each candidate of each edge given all others.

    The result does not depend on the order of the edges, and only the basis of the latent space depends on the numbers
    of the shapes. An edge on no cycle keeps the probability of its own evidence.

    ``functions``: size ``k`` of the compared maps.
    """
    ends = [(edge.source, edge.target) for edge in edges]
    problem = _Problem(
        count,
        ends,
        [np.stack([c.map[:functions, :functions] for c in edge.candidates]) for edge in edges],
        [np.clip([c.log_odds for c in edge.candidates], -MAX_LOG_ODDS, MAX_LOG_ODDS) for edge in edges],
    )
    result = _solve(problem, functions)
    for _ in range(3):  # rounds in which consistent parts of the graph may change as wholes
        rejoined = _rejoin(problem, result)
        if rejoined is None:
            break
        result = rejoined
    return result


def _solve(problem: _Problem, functions: int) -> SyncResult:
    """Return the more likely of the results from two initialisations.

    A spanning tree may use a wrong pair, and eigenvectors may be confined to loosely connected parts.
    """
    results = [_anneal(problem, start(problem, functions)) for start in (_spanning_tree_init, _spectral_init)]
    limit = max(one.limit for one in results)
    return results[int(np.argmax([round(problem.log_likelihood(one.residuals, limit), 6) for one in results]))]


def _spanning_tree_init(problem: _Problem, functions: int) -> np.ndarray:
    """Return latent maps (n, k, k) along the spanning tree of the pairs with the best odds."""
    count = problem.count
    latent = np.tile(np.eye(functions), (count, 1, 1))
    weight = np.full((count, count), np.inf)
    best: dict[tuple[int, int], np.ndarray] = {}
    for (a, b), C, log_odds in zip(problem.ends, problem.maps, problem.log_odds, strict=True):
        number = int(np.argmax(log_odds))
        cost = 1.0 + MAX_LOG_ODDS - float(log_odds[number])
        if cost < weight[a, b]:
            weight[a, b] = weight[b, a] = cost
            best[a, b], best[b, a] = C[number], C[number].T
    tree = minimum_spanning_tree(np.where(np.isfinite(weight), weight, 0.0))
    is_visited = np.zeros(count, dtype=bool)
    for root in range(count):
        if is_visited[root]:
            continue
        order, before = breadth_first_order(tree, root, directed=False)
        for v in order:
            is_visited[v] = True
            if v != root:
                latent[v] = nearest_orthogonal(best[before[v], v] @ latent[before[v]])
    return latent


def _spectral_init(problem: _Problem, functions: int) -> np.ndarray:
    """Return latent maps (n, k, k) from the leading eigenvectors of all pairs' maps, each made orthogonal.

    The matrix is ``D^{-1/2} W D^{-1/2}`` with blocks ``Σ_c p_c C`` and the shapes' degrees ``D``.
    """
    blocks: dict[tuple[int, int], np.ndarray] = {}
    degree = np.zeros(problem.count)
    for (a, b), C, log_odds in zip(problem.ends, problem.maps, problem.log_odds, strict=True):
        p = np.exp(log_odds) / (1.0 + np.exp(log_odds).sum())
        mean = np.tensordot(p, C, axes=1)
        for row, column, one in ((b, a, mean), (a, b, mean.T)):
            blocks[row, column] = blocks.get((row, column), np.zeros_like(one)) + one
        degree[[a, b]] += p.sum()
    root = 1.0 / np.sqrt(np.maximum(degree, 1e-9))
    size = problem.count * functions
    whole = csr_array((size, size))
    if blocks:
        rows, columns = (np.array(side) for side in zip(*blocks, strict=True))
        values = np.stack([root[a] * root[b] * C for (a, b), C in blocks.items()])
        firsts, inner = np.stack([rows, columns])[:, :, None, None] * functions, np.arange(functions)
        at = np.broadcast_arrays(firsts[0] + inner[:, None], firsts[1] + inner)
        whole = csr_array((values.ravel(), (at[0].ravel(), at[1].ravel())), shape=(size, size))
    if size <= 1500:  # unknowns up to which eigenvectors are worked out densely
        vectors = np.linalg.eigh(whole.toarray())[1][:, -functions:]
    else:
        # Where all maps agree the largest eigenvalue is multiple, and on a long cycle many others are close to it.
        matrix = csr_array(eye_array(size) - whole)
        vectors = smallest_eigenpairs(matrix, np.ones(size), functions, tolerance=1e-6).vectors
    parts = vectors.reshape(problem.count, functions, functions)
    return np.stack([nearest_orthogonal(part) for part in parts])


def _anneal(problem: _Problem, latent: np.ndarray) -> SyncResult:
    """Return the result from the initial ``latent (n, k, k)`` while the tolerance falls."""
    limit = _RESIDUAL_LIMITS[1]
    chances = problem.probabilities([np.zeros(len(o)) for o in problem.log_odds], limit, 1.0)
    n_levels = 8  # steps in which the tolerance falls
    for level in range(n_levels):
        residuals = problem.residuals(latent)
        typical = [float(r[p[:-1].argmax()]) for r, p in zip(residuals, chances, strict=True) if p[-1] < 0.5]
        if typical:
            limit = float(np.clip(OUTLIER_FACTOR * np.median(typical), *_RESIDUAL_LIMITS))
        else:
            limit = _RESIDUAL_LIMITS[1]
        # The tolerance falls from 1, which admits any map, to a third of the limit.
        spread = limit / 3 + (1.0 - limit / 3) * (1 - level / (n_levels - 1)) ** 2
        chances = problem.probabilities(residuals, limit, spread)
        latent = _sweep(problem, latent, chances)
    return _refine(problem, latent, limit)


def _refine(problem: _Problem, latent: np.ndarray, limit: float) -> SyncResult:
    """Return the result from the initial ``latent (n, k, k)`` when only maps within ``limit`` count."""
    for _ in range(5):  # rounds in which a shape may take the proposal of one edge instead of the mean of all
        latent, has_changed = _reassign(problem, latent, limit)
        if not has_changed:
            break
        latent = _sweep(problem, latent, problem.probabilities(problem.residuals(latent), limit, limit / 3))
    residuals = problem.residuals(latent)
    probabilities = tuple(problem.probabilities(residuals, limit, limit / 3))
    component = component_labels(problem.count, *np.array(problem.ends, dtype=np.int64).reshape(-1, 2).T)[1]
    return SyncResult(latent, probabilities, tuple(residuals), limit, component.astype(np.int64))


def _rejoin(problem: _Problem, result: SyncResult) -> SyncResult | None:
    """Change consistent parts of the graph against each other, each as a whole; ``None`` where that gains nothing.

    One wrong pair of the spanning tree can give a whole part of the graph wrong maps. No single shape can change, since
    the pairs within its part hold it. A change ``Y_v Z`` of the whole part does not affect the pairs within. The parts
    are connected components of the accepted pairs, without bridges.
    """
    limit, ends = result.limit, problem.ends
    accepted = [pair for pair, p in zip(ends, result.probabilities, strict=True) if p[-1] < 0.5]
    bridge_pairs = bridges(problem.count, accepted)
    reliable = np.array([pair for pair in accepted if pair not in bridge_pairs], dtype=np.int64).reshape(-1, 2)
    parts, part = component_labels(problem.count, reliable[:, 0], reliable[:, 1])
    across = [i for i, (a, b) in enumerate(ends) if part[a] != part[b]]
    if parts == 1 or not across:
        return None
    between = _Problem(
        parts,
        [(int(part[ends[i][0]]), int(part[ends[i][1]])) for i in across],
        [result.latent[ends[i][1]].T @ problem.maps[i] @ result.latent[ends[i][0]] for i in across],
        [problem.log_odds[i] for i in across],
    )
    latent = result.latent @ _solve(between, result.latent.shape[-1]).latent[part]
    before = problem.log_likelihood(result.residuals, limit) + 1e-6
    if problem.log_likelihood(problem.residuals(latent), limit) <= before:
        return None
    refined = _refine(problem, latent, limit)
    return refined if problem.log_likelihood(refined.residuals, limit) > before else None


def _reassign(problem: _Problem, latent: np.ndarray, limit: float) -> tuple[np.ndarray, bool]:
    """Give each shape in turn the map that a candidate of its edges proposes, where its edges become more likely."""
    latent, has_changed = latent.copy(), False
    ends, maps = problem.ends, problem.maps

    def log_likelihood(v: int, incident: list[int], Y: np.ndarray) -> float:
        total = 0.0
        for i in incident:
            pair = (Y, latent[ends[i][1]]) if ends[i][0] == v else (latent[ends[i][0]], Y)
            total += _log_likelihood(map_residuals(maps[i], *pair), problem.log_odds[i], limit)
        return total

    for v, incident in enumerate(problem.incident()):
        best, best_value = latent[v], log_likelihood(v, incident, latent[v])
        for i in incident:
            forward = ends[i][1] == v
            other = latent[ends[i][0] if forward else ends[i][1]]
            for C in maps[i]:
                proposal = nearest_orthogonal((C if forward else C.T) @ other)
                if (value := log_likelihood(v, incident, proposal)) > best_value + 1e-6:
                    best, best_value = proposal, value
        has_changed = has_changed or best is not latent[v]
        latent[v] = best
    return latent, has_changed


def _sweep(problem: _Problem, latent: np.ndarray, chances: Sequence[np.ndarray]) -> np.ndarray:
    """Return latent maps (n, k, k) after sweeps in which each shape gets the map that best fits its neighbours."""
    latent = latent.copy()
    mean = [np.tensordot(p[:-1], C, axes=1) for p, C in zip(chances, problem.maps, strict=True)]
    incident = problem.incident()
    for _ in range(6):  # sweeps over all shapes at each tolerance
        for v, edges in enumerate(incident):
            target = np.zeros(latent.shape[1:])
            for i in edges:
                a, b = problem.ends[i]
                target += mean[i] @ latent[a] if b == v else mean[i].T @ latent[b]
            if np.linalg.norm(target) > 1e-9:
                latent[v] = nearest_orthogonal(target)
    return latent


def _log_likelihood(residuals: np.ndarray, log_odds: np.ndarray, limit: float) -> float:
    """Return the log-likelihood of an edge: the logarithm of the denominator in :func:`_probabilities`."""
    return float(np.logaddexp.reduce(np.append(log_odds - 3 * (residuals - limit) / limit, 0.0)))


def _probabilities(residuals: np.ndarray, log_odds: np.ndarray, limit: float, spread: float) -> np.ndarray:
    """Return the probability of each candidate and of none, (c + 1,); at residual ``limit`` the own odds count."""
    logits = np.append(log_odds - (residuals - limit) / spread, 0.0)
    weights = np.exp(logits - logits.max())
    return weights / weights.sum()


def map_residuals(maps: np.ndarray, source: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Return ``‖C Y_s − Y_t‖² / k`` for each of ``maps (c, k, k)``: (c,)."""
    return ((maps @ source - target) ** 2).sum(axis=(1, 2)) / len(source)
