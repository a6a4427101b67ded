"""Evidence for the placement of two parts, of which each may lack what the other has: what both have must be alike."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from kfmaps.matching.partial.registration import PartRegistration, find_overlap
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
    """Return how well distances on two parts agree in their overlap, 0 to 1, and the rank of SHOT there, at most 0.

    Both parts are cut to the overlap, so that SHOT of both ends at the same places. The rank is the mean logarithm of
    the share of the other part's samples that are more similar to a sample than its place. Samples count as far as
    their distances agree with those of the others.
    """
    part, whole, overlap = pair.part, pair.whole, find_overlap(found, pair.whole)
    match = np.asarray(KDTree(whole.mesh.vertices[whole.samples]).query(found.vertices[part.samples])[1])
    fits, near = pair.pair_consistency(found.scale, match)
    on = overlap.part[part.samples]
    agreement = float(on @ fits @ on / max(on @ near @ on, 1e-12))
    weights = consistent_trust(fits, near, np.ones(len(match)), part.n_landmarks)
    common = [common > 0.5 for common in (overlap.part, overlap.whole)]
    faces = [of[one.mesh.faces].all(axis=1) for of, one in zip(common, (part, whole), strict=True)]
    if not (faces[0].any() and faces[1].any()):
        return agreement, 0.0
    number, similarity = np.full(len(whole.samples), -1), 0.0
    for radius in _RADII:
        own, shot_p = part.shot_of_faces(faces[0], radius / found.scale)
        there, shot_w = whole.shot_of_faces(faces[1], radius)
        similarity = similarity + shot_p @ shot_w.T
    number[there] = np.arange(len(there))
    place = number[match[own]]
    own, similarity, place = own[place >= 0], similarity[place >= 0], place[place >= 0]
    n_better = (similarity > similarity[np.arange(len(own)), place][:, None]).sum(axis=1)
    weights = weights[own] + 1e-3
    return agreement, float(np.average(np.log((n_better + 1) / len(there)), weights=weights)) if len(own) else 0.0
