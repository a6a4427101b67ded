"""The order of candidates: by their scores, and the first few by how far they bend the shapes and how these look then.

The score is intrinsic, and a map that swaps front and back together with left and right may come first by it. What
bending says (:mod:`kfmaps.registration.evidence`) costs too much for all, and so it is asked of those that
may be the best.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from kfmaps._threads import parallel
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance, descriptor_guidance
from kfmaps.geometry.coarsen import CoarseProxy
from kfmaps.matching.candidates import by_score, distinct_maps
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.sample_pair import SamplePair
from kfmaps.matching.score import SCORE, Candidate
from kfmaps.registration.alternating_registration import ProxyPair, proxy_pair
from kfmaps.registration.evidence import FINE_VERTICES, PATIENT, coarse_copy, deform, registered_shot_error
from kfmaps.shape import Shape, mirror_image

BENT = 3
"""Distinct maps that are registered."""
RELATIVE = ("strain", "shot_error")
"""Evidence of a candidate that tells only beside that of others."""


@dataclass(frozen=True, eq=False)
class ProxyCache:
    """Copies of two shapes, made when they are first asked for; ``None`` where a shape has no faces to bend."""

    source: Shape
    target: Shape
    copies: tuple[CoarseProxy | None, CoarseProxy | None]  # of few points, as the samples have them
    mirrored: bool = False  # whether they are of the target's mirror image

    @classmethod
    def of(cls, source: Shape, target: Shape, samples: SamplePair) -> ProxyCache:
        """Return the cache of two shapes, with the coarse copies that their samples have."""
        return cls(source, target, (samples.source.copy, samples.target.copy), samples.target.mirrored)

    @cached_property
    def image(self) -> Shape:
        """The target, or its mirror image where that is meant."""
        return mirror_image(self.target) if self.mirrored else self.target

    @cached_property
    def shot_guidance(self) -> DescriptorGuidance | None:
        """Guidance by SHOT on all vertices; ``None`` without SHOT."""
        return descriptor_guidance(self.source.shot, self.image.shot)

    @cached_property
    def coarse(self) -> ProxyPair | None:
        """The coarse ones."""
        a, b = self.copies
        return None if a is None or b is None else proxy_pair(self.source, self.image, (a, b))

    @cached_property
    def fine(self) -> ProxyPair | None:
        """Finer ones."""
        a, b = coarse_copy(self.source, FINE_VERTICES), coarse_copy(self.target, FINE_VERTICES)
        if a is None or b is None:
            return None
        return proxy_pair(self.source, self.image, (a, b.mirrored() if self.mirrored else b))


def ranking(
    found: list[Candidate],
    samples: SamplePair,
    copies: ProxyCache,
    least: float = -np.inf,
) -> list[Candidate]:
    """Return the distinct ones of ``found``, best first; the first few also by how far the source must bend.

    Of the first two, where they are close and the score of the first is above ``least``, how they look then counts too.
    """
    ranked = distinct(found, samples.source)
    near = [c for c in ranked[:BENT] if c.score > ranked[0].score - SCORE.max_behind]
    tried = with_bending(near, copies)
    if not tried:
        return ranked
    # As bad as the worst, so that none that was not tried comes first.
    worst = max(c.deformation_energy for c in tried if c.deformation_energy is not None)
    order = in_order([*tried, *(replace(c, deformation_energy=worst) for c in ranked[len(near) :])])
    if len(near) > 1 and order[0].score - order[1].score < SCORE.shot_margin and order[0].score > least:
        return rerank_close(order, copies)
    return order


def rerank_near_duplicates(
    ranked: list[Candidate],
    found: list[Candidate],
    samples: SamplePair,
    copies: ProxyCache,
    distance: float = SCORE.rough_distance,
    behind: float = np.inf,
) -> list[Candidate]:
    """Return ``ranked``, and between them the best of ``found`` that hardly differ from a better one: by ``distance``.

    A map with one limb wrong is near the right one, and may come before it by chance: which of them is torn shows when
    both are bent. None that is farther ``behind`` before that.
    """
    closer = 5  # maps that may be closer to each other and are registered too
    best = distinct_maps(in_order(found), samples.source, distance, closer)
    known = [c.functional_map for c in ranked]
    more = [c for c in best if c.score > best[0].score - behind and not any(c.functional_map is C for C in known)]
    return in_order([*ranked, *with_bending(more, copies)])


def with_bending(found: list[Candidate], copies: ProxyCache) -> list[Candidate]:
    """Return ``found`` with how far the coarse copies must bend, unknown where a shape has no copy to bend."""
    if not found or copies.coarse is None:
        return []
    pair = copies.coarse
    energies = parallel(lambda c: deform(c.functional_map, pair).energy, found)
    return [replace(c, deformation_energy=energy) for c, energy in zip(found, energies, strict=True)]


def rerank_close(order: list[Candidate], copies: ProxyCache) -> list[Candidate]:
    """Return the first two with how they look when bent; where they are close, bent with more points and patience too.

    A map that swaps front and back may come first by a margin that leaves no doubt to the score.
    """
    finer = copies.fine
    if finer is None:
        return order
    close = order[0].score - order[1].score < SCORE.close_margin

    def with_shot_error(found: Candidate) -> Candidate:
        found = score_registered(found, finer) if close else found
        return replace(found, shot_error=registered_shot_error(found.functional_map, finer))

    found = parallel(with_shot_error, order[:2])
    # Nothing is added for looks: the best is compared with maps that nobody has looked at.
    middle = reference_values(found, np.mean)[0], reference_values(found, min)[1]
    return in_order([normalize_errors(c, middle) for c in found]) + order[2:]


def score_registered(found: Candidate, pair: ProxyPair) -> Candidate:
    """Return a candidate with what its map says when the copies are bent with more patience."""
    one = deform(found.functional_map, pair, PATIENT)
    return replace(found, deformation_energy=one.energy, strain=one.strain, shot_error=None)


def reference_values(found: list[Candidate], of: Callable[[list[float]], float]) -> tuple[float, ...]:
    """Return what each of :data:`RELATIVE` of candidates is compared with: all depend on the shapes."""
    known = ([value for c in found if (value := getattr(c, name)) is not None] for name in RELATIVE)
    return tuple(float(of(values)) if values else 0.0 for values in known)


def normalize_errors(found: Candidate, usual: tuple[float, ...]) -> Candidate:
    """Return a candidate with its :data:`RELATIVE` evidence, where it is known, less the ``usual``."""
    values = ((name, getattr(found, name), least) for name, least in zip(RELATIVE, usual, strict=True))
    changed: dict[str, Any] = {name: value - least for name, value, least in values if value is not None}
    return replace(found, **changed)


def distinct(found: list[Candidate], source: ShapeSamples) -> list[Candidate]:
    """Return the best of ``found``, then the best of those that differ from it, and so on."""
    return distinct_maps(in_order(found), source, SCORE.distinct_distance)


def in_order(found: list[Candidate]) -> list[Candidate]:
    """Return them best first.

    A rival, which no descriptors speak for, comes first only when it is clearly better than every other candidate.
    """
    order = by_score(found)
    best = next((c for c in order if c.uses_descriptors), None)
    if best is not None and best.score > order[0].score - SCORE.clear_margin:
        order.insert(0, order.pop(next(i for i, c in enumerate(order) if c is best)))
    return order
