"""Match the extremities of two shapes, and find the rough map that follows.

All ways to pair the extremities are tried, and those kept whose extremities lie alike. Then, for each, the distances to
them and the sense in which these grow are compared at all points, which tells limbs apart and left from right.
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

FEWEST = 3
"""Least number of extremities that tell limbs apart."""
TRIED = 200
"""Matches that are compared at samples."""
THIN = 150
"""Samples at which they are compared."""
SHOT = 0.02
"""Weight of SHOT beside distances from extremities."""


@dataclass(frozen=True, eq=False)
class ExtremityMatch:
    """Extremities of one shape, ``source (m,)``, and in the same order those of the other, ``target (m,)``."""

    source: np.ndarray
    target: np.ndarray

    def pairs(self) -> set[tuple[int, int]]:
        """Return the pairs of the extremities' numbers."""
        return set(zip(self.source.tolist(), self.target.tolist(), strict=True))

    def within(self, other: ExtremityMatch) -> bool:
        """Return whether ``other`` has all of its pairs."""
        return self.pairs() <= other.pairs()

    def contradicts(self, other: ExtremityMatch) -> bool:
        """Return whether an extremity of either shape goes to different ones."""
        return any((i == k) != (j == n) for i, j in self.pairs() for k, n in other.pairs())

    def __str__(self) -> str:
        return f"extremities {'-'.join(map(str, self.source))} to {'-'.join(map(str, self.target))}"


def unused_matches(likely: list[ExtremityMatch], known: list[ExtremityMatch], most: int) -> list[ExtremityMatch]:
    """Return the first ``most`` of ``likely`` that contradict each other, without parts of those ``known``."""
    first = select_distinct(likely, ExtremityMatch.contradicts, most)
    whole = [complete_match(one, likely) for one in first]
    return [one for one in whole if not any(one.within(other) for other in known)]


def complete_match(pairing: ExtremityMatch, likely: list[ExtremityMatch]) -> ExtremityMatch:
    """Return the first of ``likely`` with all pairs of ``pairing`` and more, else ``pairing`` itself.

    With one extremity left out less can differ, so parts of a right match of all extremities come before it.
    """
    return next((one for one in likely if pairing.within(one) and len(one.source) > len(pairing.source)), pairing)


def match_extremities(source: ShapeSamples, target: ShapeSamples, shot: np.ndarray | None) -> list[ExtremityMatch]:
    """Return the likeliest matches, best first; none where a shape has fewer than three extremities.

    ``shot (q_t, q_s)``: half the squared differences of descriptors, see
    :func:`kfmaps.matching.sample_pair.descriptor_cost`.
    """
    a, b = source.extremities, target.extremities
    if min(len(a.points), len(b.points)) < FEWEST:
        return []
    tried = extremity_similarity(source, target)[:TRIED]
    thin = a.subsample(THIN), b.subsample(THIN)
    less = None if shot is None else shot[:THIN, :THIN]
    left = [float(extremity_cost(*thin, pairing, less).min(axis=1).mean()) for pairing in tried]
    return [tried[i] for i in np.argsort(left, kind="stable")[:32]]  # matches that are refined


def extremity_similarity(source: ShapeSamples, target: ShapeSamples) -> list[ExtremityMatch]:
    """Return all matches of as many extremities as both shapes have, or of one less, the most alike first.

    Their distances from each other and from the rest are compared, and the heat kernel signature, which knows a tail
    from a leg.
    """
    a, b = source.extremities, target.extremities
    between_s, between_t = a.distances[:, a.points], b.distances[:, b.points]
    apart = extremity_difference(source, target)
    both = min(len(a.points), len(b.points))
    costs, found = [], []
    # Cost of leaving out all extremities; that of one is its share. An ear of a dog has no partner on a cat.
    left_out = 0.15
    for size in (both, both - 1) if both >= 5 else (both,):  # number of extremities from which one may be left out
        images = np.array(list(permutations(range(len(b.points)), size)))
        for chosen in combinations(range(len(a.points)), size):
            ours = between_s[np.ix_(chosen, chosen)]
            theirs = between_t[images[:, :, None], images[:, None, :]]
            cost = np.abs(theirs - ours).sum(axis=(1, 2)) / (size * (size - 1))
            cost = cost + apart[np.array(chosen), images].mean(axis=1) + left_out * (both - size) / both
            best = np.argsort(cost, kind="stable")[:TRIED]
            costs.append(cost[best])
            found += [ExtremityMatch(np.array(chosen), images[i]) for i in best]
    order = np.argsort(np.concatenate(costs), kind="stable")
    return [found[i] for i in order]


def extremity_difference(source: ShapeSamples, target: ShapeSamples) -> np.ndarray:
    """Return how much each extremity of one shape differs from each of another by itself, (m_s, m_t).

    Its mean distance from the rest and the logarithm of its heat kernel signature are compared.
    """
    a, b = source.extremities, target.extremities
    heat = source.heat[a.points][:, None] - target.heat[b.points][None, :]
    return np.abs(a.mean_distance[:, None] - b.mean_distance[None, :]) + np.sqrt((heat**2).mean(axis=2))


def extremity_cost(
    a: Extremities, b: Extremities, pairing: ExtremityMatch, shot: np.ndarray | None = None
) -> np.ndarray:
    """Return the squared differences of the features of samples, ``(q_t, q_s)`` (:func:`extremity_features`)."""
    there, here = extremity_features(b, pairing.target), extremity_features(a, pairing.source)
    cost = -2 * there @ here.T
    cost += (there**2).sum(axis=1)[:, None]
    cost += (here**2).sum(axis=1)
    if shot is not None:
        cost += SHOT * shot
    return cost


def match_of_map(points: np.ndarray, source: ShapeSamples, target: ShapeSamples) -> ExtremityMatch | None:
    """Return the extremities that a map ``points (q_t,)`` takes near each other; ``None`` for fewer than three."""
    a, b = source.extremities, target.extremities
    if min(len(a.points), len(b.points)) < FEWEST:
        return None
    # From each extremity of the source to the image of each of the target.
    off = a.distances[:, points[b.points]]
    nearest_s, nearest_t = off.argmin(axis=0), off.argmin(axis=1)
    # Largest distance of an extremity's image from the extremity that it goes to, over the mean distance of points.
    near = 0.5
    theirs = np.flatnonzero((off.min(axis=0) < near) & (nearest_t[nearest_s] == np.arange(len(b.points))))
    return ExtremityMatch(nearest_s[theirs], theirs) if len(theirs) >= FEWEST else None


@dataclass(frozen=True, eq=False)
class ExtremityVertices:
    """Matched extremities as vertices, ``source (m,)`` and ``target (m,)``, and the unit of distance of each shape."""

    source: np.ndarray
    target: np.ndarray
    units: tuple[float, float]

    def guide(
        self, source: Mesh, target: Mesh, graphs: tuple[csr_array | None, csr_array | None] = (None, None)
    ) -> DescriptorGuidance:
        """Return the features of all vertices, whose squared differences are twice :func:`extremity_cost`.

        ``graphs``: geodesic graphs of both meshes, of depth 1, where they are there already.
        """
        everything = np.arange(len(self.source))
        sides = zip((source, target), (self.source, self.target), self.units, graphs, strict=True)
        return DescriptorGuidance(
            *(np.sqrt(2.0) * extremity_features(at_all_vertices(*side), everything) for side in sides)
        )


def extremity_vertices(points: np.ndarray, source: ShapeSamples, target: ShapeSamples) -> ExtremityVertices | None:
    """Return the extremities that a map of samples matches (:func:`match_of_map`), as vertices."""
    found = match_of_map(points, source, target)
    return None if found is None else vertices_of_match(found, source, target)


def vertices_of_match(found: ExtremityMatch, source: ShapeSamples, target: ShapeSamples) -> ExtremityVertices:
    """Return the extremities of a match as vertices of both shapes."""
    at = source.extremities.points[found.source], target.extremities.points[found.target]
    units = source.extremities.unit, target.extremities.unit
    return ExtremityVertices(source.samples.vertices[at[0]], target.samples.vertices[at[1]], units)


def extremity_features(found: Extremities, chosen: np.ndarray) -> np.ndarray:
    """Return distances from the ``chosen`` extremities and their gradients' turns at each sample, each 1 on average."""
    upper = np.triu_indices(len(chosen), 1)
    turn = found.gradient_cross[np.ix_(chosen, chosen)][upper]
    return np.vstack([found.distances[chosen] / np.sqrt(len(chosen)), turn / np.sqrt(max(len(turn), 1))]).T
