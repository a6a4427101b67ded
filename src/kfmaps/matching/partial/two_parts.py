"""Evidence for the placement of two parts, of which each may lack what the other has: what both have must be alike."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from kfmaps.geometry.connectivity import renumbering
from kfmaps.matching.partial.registration import Overlap, PartRegistration, find_overlap
from kfmaps.matching.partial.samples import PartPair

_RADII = (0.09, 0.14)
"""Radii of SHOT of the overlap, in √area of the whole."""


def consistent_trust(fits: np.ndarray, near: np.ndarray, trust: np.ndarray, n_landmarks: int) -> np.ndarray:
    """Return how well each sample of a part agrees with those that agree with each other, (q,), from 0 to 1.

    Samples without a place on the other part do not. This is a power iteration as by Leordeanu and Hebert (2005), with
    means in place of sums, so that samples with few neighbours count as much.

    ``fits``, ``near``: of :meth:`PartPair.pair_consistency`; ``trust (q,)``: to begin with; the first ``n_landmarks``
    samples are landmarks.
    """
    least = 0.8  # mean consistency with the others, over that of the best tenth, from which a sample is trusted
    trust = np.minimum(trust, 1.0)
    for _ in range(6):
        mean = fits @ trust / np.maximum(near @ trust, 1e-12)
        best = max(float(np.quantile(mean, 0.9)), 1e-12)
        trust = np.clip((mean / best - least) / (1 - least), 0.0, 1.0)
    trust[:n_landmarks] = 1.0
    return trust


def overlap_evidence(found: PartRegistration, pair: PartPair) -> tuple[float, float]:
    """Return how well distances on two parts agree in their overlap, 0 to 1, and the rank of SHOT there, at most 0."""
    part, whole, overlap = pair.part, pair.whole, find_overlap(found, pair.whole)
    match = np.asarray(KDTree(whole.mesh.vertices[whole.samples]).query(found.vertices[part.samples])[1])
    fits, near = pair.pair_consistency(found.scale, match)
    on = overlap.part[part.samples]
    agreement = float(on @ fits @ on / max(on @ near @ on, 1e-12))
    trust = consistent_trust(fits, near, np.ones(len(match)), part.n_landmarks)
    return agreement, _overlap_rank(overlap, match, trust, found.scale, pair)


def _overlap_rank(overlap: Overlap, match: np.ndarray, trust: np.ndarray, scale: float, pair: PartPair) -> float:
    """Return the mean logarithm of the share of samples in an overlap that are more similar to a sample than its place.

    Both parts are cut to the overlap, so that SHOT of both ends at the same places. Samples count as far as their
    distances agree with those of the others.

    ``match (q,)``: the other part's sample of each of the part's; ``trust (q,)``: weights of the samples.
    """
    part, whole = pair.part, pair.whole
    faces = [
        np.asarray((common > 0.5)[one.mesh.faces].all(axis=1))
        for common, one in ((overlap.part, part), (overlap.whole, whole))
    ]
    if not (faces[0].any() and faces[1].any()):
        return 0.0
    own = [part.shot_of_faces(faces[0], radius / scale) for radius in _RADII]
    other = [whole.shot_of_faces(faces[1], radius) for radius in _RADII]
    similarity = np.sum([a @ b.T for (_, a), (_, b) in zip(own, other, strict=True)], axis=0)
    samples, number = own[0][0], renumbering(other[0][0], len(whole.samples))
    place = number[match[samples]]
    on = np.flatnonzero(place >= 0)  # samples that lie on a sample of the overlap
    if len(on) == 0:
        return 0.0
    at_place = similarity[on, place[on]]
    n_better = (similarity[on] > at_place[:, None]).sum(axis=1)
    least_weight = 1e-3
    return float(np.average(np.log((n_better + 1) / similarity.shape[1]), weights=trust[samples[on]] + least_weight))
