"""Match the extremities of two shapes.

1. All ways to pair the extremities are compared by their distances from each other, and the best few hundred are kept.
2. Each match makes features of all points: their distances from the matched extremities, and the cross products of the
   gradients of these, which tell left from right. The matches with the most similar features are the likeliest.

The points with the most similar features are the initial map of a match
(:func:`kfmaps.matching.initial_maps.extremity_inits`). The features also guide refinements.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, permutations

import numpy as np
from scipy.sparse import csr_array

from kfmaps.fmap.descriptor_guidance import DescriptorGuidance
from kfmaps.geometry.mesh import Mesh
from kfmaps.matching.extremities import Extremities, at_all_vertices
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.score import select_distinct

_MIN_EXTREMITIES = 3
"""Least number of extremities that tell limbs apart."""
_N_COMPARED = 200
"""Matches whose features are compared."""
_N_SAMPLES = 150
"""Samples at which they are compared."""


@dataclass(frozen=True, eq=False)
class ExtremityMatch:
    """Extremities of one shape, ``source (m,)``, and in the same order those of the other, ``target (m,)``."""

    source: np.ndarray
    target: np.ndarray

    def pairs(self) -> set[tuple[int, int]]:
        """Return the pairs of the extremities' numbers."""
        return set(zip(self.source.tolist(), self.target.tolist(), strict=True))

    def is_within(self, other: ExtremityMatch) -> bool:
        """Return whether ``other`` has all of its pairs."""
        return self.pairs() <= other.pairs()

    def contradicts(self, other: ExtremityMatch) -> bool:
        """Return whether an extremity of either shape goes to different ones."""
        return any((i == k) != (j == n) for i, j in self.pairs() for k, n in other.pairs())

    def __str__(self) -> str:
        return f"extremities {'-'.join(map(str, self.source))} to {'-'.join(map(str, self.target))}"


def unused_matches(likely: list[ExtremityMatch], known: list[ExtremityMatch], most: int) -> list[ExtremityMatch]:
    """Return the first ``most`` of ``likely`` that contradict each other, without those within a ``known`` match."""
    first = select_distinct(likely, ExtremityMatch.contradicts, most)
    complete = [complete_match(one, likely) for one in first]
    return [one for one in complete if not any(one.is_within(other) for other in known)]


def complete_match(match: ExtremityMatch, likely: list[ExtremityMatch]) -> ExtremityMatch:
    """Return the first of ``likely`` with all pairs of ``match`` and more, else ``match`` itself.

    A right match of all extremities often has a slightly larger cost than the same with one extremity left out.
    """
    return next((one for one in likely if match.is_within(one) and len(one.source) > len(match.source)), match)


def match_extremities(
    source: ShapeSamples, target: ShapeSamples, shot: np.ndarray | None, n_compared: int = _N_COMPARED
) -> list[ExtremityMatch]:
    """Return the likeliest matches, best first; none where a shape has fewer than three extremities.

    ``shot (q_t, q_s)``: half the squared differences of descriptors, see
    :func:`kfmaps.matching.sample_pair.descriptor_cost`; ``n_compared``: matches whose features are compared.
    """
    a, b = source.extremities, target.extremities
    if min(len(a.points), len(b.points)) < _MIN_EXTREMITIES:
        return []
    matches = similar_matches(source, target)[:n_compared]
    first = a.subsample(_N_SAMPLES), b.subsample(_N_SAMPLES)
    shot = None if shot is None else shot[:_N_SAMPLES, :_N_SAMPLES]
    reflected = source.reflected_extremities, target.reflected_extremities
    costs = [
        float(extremity_cost(*first, match, shot).min(axis=1).mean())
        * (1.0 + float(asymmetry(match.source, match.target[None], *reflected)[0]))
        for match in matches
    ]
    n_likely = 32  # matches that are returned
    return [matches[i] for i in np.argsort(costs, kind="stable")[:n_likely]]


def similar_matches(source: ShapeSamples, target: ShapeSamples) -> list[ExtremityMatch]:
    """Return matches of as many extremities as both shapes have, or of one less, the most similar first.

    Their distances from each other and from the rest are compared, and the heat kernel signature, which tells a tail
    from a leg.
    """
    a, b = source.extremities, target.extremities
    most = 7  # of each shape, the farthest: all permutations are compared
    points_s, points_t = a.points[:most], b.points[:most]
    between_s, between_t = a.distances[:most, points_s], b.distances[:most, points_t]
    difference = extremity_difference(source, target)
    both = min(len(points_s), len(points_t))
    reflected = source.reflected_extremities, target.reflected_extremities
    costs, matches = [], []
    min_complete = 5  # number of extremities from which one may be left out
    unmatched_cost = 0.15  # of all extremities; that of one is its share. An ear of a dog has no partner on a cat.
    for size in (both, both - 1) if both >= min_complete else (both,):
        images = np.array(list(permutations(range(len(points_t)), size)))
        for chosen in combinations(range(len(points_s)), size):
            distances_s = between_s[np.ix_(chosen, chosen)]
            distances_t = between_t[images[:, :, None], images[:, None, :]]
            cost = np.abs(distances_t - distances_s).sum(axis=(1, 2)) / (size * (size - 1))
            cost = cost + difference[np.array(chosen), images].mean(axis=1) + unmatched_cost * (both - size) / both
            cost = cost * (1.0 + asymmetry(np.array(chosen), images, *reflected))
            best = np.argsort(cost, kind="stable")[:_N_COMPARED]
            costs.append(cost[best])
            matches += [ExtremityMatch(np.array(chosen), images[i]) for i in best]
    return [matches[i] for i in np.argsort(np.concatenate(costs), kind="stable")]


def asymmetry(
    source: np.ndarray, targets: np.ndarray, reflected_s: np.ndarray | None, reflected_t: np.ndarray | None
) -> np.ndarray:
    """Return the share (p,) of pairs that do not fit the reflections of both shapes; 0 where a shape has none.

    Extremities ``source (m,)`` go to each of ``targets (p, m)``. A tail, which its shape's reflection takes to itself,
    does not fit a leg, and the two partners of a leg must be each other's images.
    """
    if reflected_s is None or reflected_t is None:
        return np.zeros(len(targets))
    partner_s, partner_t = reflected_s[source], reflected_t[targets]
    differs = (partner_s == source) != (partner_t == targets)
    for i, partner in enumerate(partner_s):
        for j in np.flatnonzero(source == partner):
            differs[:, i] |= targets[:, j] != partner_t[:, i]
    return differs.mean(axis=1)


def extremity_difference(source: ShapeSamples, target: ShapeSamples) -> np.ndarray:
    """Return how much each extremity of one shape differs from each of another by itself, (m_s, m_t).

    Its mean distance from the rest and the logarithm of its heat kernel signature are compared.
    """
    a, b = source.extremities, target.extremities
    heat = source.heat[a.points][:, None] - target.heat[b.points][None, :]
    return np.abs(a.mean_distance[:, None] - b.mean_distance[None, :]) + np.sqrt((heat**2).mean(axis=2))


def extremity_cost(
    source: Extremities, target: Extremities, match: ExtremityMatch, shot: np.ndarray | None = None
) -> np.ndarray:
    """Return the squared differences of the features of samples, ``(q_t, q_s)`` (:func:`extremity_features`)."""
    F_s, F_t = extremity_features(source, match.source), extremity_features(target, match.target)
    cost = -2 * F_t @ F_s.T
    cost += (F_t**2).sum(axis=1)[:, None]
    cost += (F_s**2).sum(axis=1)
    shot_weight = 0.02  # beside the features of extremities
    if shot is not None:
        cost += shot_weight * shot
    return cost


def match_of_map(points: np.ndarray, source: ShapeSamples, target: ShapeSamples) -> ExtremityMatch | None:
    """Return the extremities that a map ``points (q_t,)`` takes near each other; ``None`` for fewer than three."""
    a, b = source.extremities, target.extremities
    if min(len(a.points), len(b.points)) < _MIN_EXTREMITIES:
        return None
    # From each extremity of the source to the image of each of the target.
    distances = a.distances[:, points[b.points]]
    nearest_s, nearest_t = distances.argmin(axis=0), distances.argmin(axis=1)
    is_mutual = nearest_t[nearest_s] == np.arange(len(b.points))
    max_distance = 0.5  # from another extremity, over the mean distance of points, up to which a map matches the two
    matched = np.flatnonzero((distances.min(axis=0) < max_distance) & is_mutual)
    return ExtremityMatch(nearest_s[matched], matched) if len(matched) >= _MIN_EXTREMITIES else None


@dataclass(frozen=True, eq=False)
class ExtremityVertices:
    """Matched extremities as vertices, ``source (m,)`` and ``target (m,)``, and the unit of distance of each shape."""

    source: np.ndarray
    target: np.ndarray
    units: tuple[float, float]

    def guidance(
        self, source: Mesh, target: Mesh, graphs: tuple[csr_array | None, csr_array | None] = (None, None)
    ) -> DescriptorGuidance:
        """Return the features of all vertices, whose squared differences are twice :func:`extremity_cost`.

        ``graphs``: geodesic graphs of both meshes, of depth 1, if they have been computed.
        """
        everything = np.arange(len(self.source))
        sides = zip((source, target), (self.source, self.target), self.units, graphs, strict=True)
        return DescriptorGuidance(
            *(np.sqrt(2.0) * extremity_features(at_all_vertices(*side), everything) for side in sides)
        )


def extremity_vertices(points: np.ndarray, source: ShapeSamples, target: ShapeSamples) -> ExtremityVertices | None:
    """Return the extremities that a map of samples matches (:func:`match_of_map`), as vertices."""
    match = match_of_map(points, source, target)
    return match and vertices_of_match(match, source, target)


def vertices_of_match(match: ExtremityMatch, source: ShapeSamples, target: ShapeSamples) -> ExtremityVertices:
    """Return the extremities of a match as vertices of both shapes."""
    sides = (source, match.source), (target, match.target)
    vertices = [shape.samples.vertices[shape.extremities.points[chosen]] for shape, chosen in sides]
    return ExtremityVertices(vertices[0], vertices[1], (source.extremities.unit, target.extremities.unit))


def extremity_features(extremities: Extremities, chosen: np.ndarray) -> np.ndarray:
    """Return features at each sample, (q, d): distances from the ``chosen`` extremities and gradient cross products.

    The distances and the cross products are scaled by their numbers, so that both count alike.
    """
    upper = np.triu_indices(len(chosen), 1)
    cross = extremities.gradient_cross[np.ix_(chosen, chosen)][upper]
    return np.vstack([extremities.distances[chosen] / np.sqrt(len(chosen)), cross / np.sqrt(max(len(cross), 1))]).T
