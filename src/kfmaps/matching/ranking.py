"""Rank the distinct candidates of a search: by their scores, the first few also by registration.

The score of a map alone is intrinsic, and a map that swaps front and back together with left and right may come first
by it. The evidence of a registration (:mod:`kfmaps.registration.evidence`) tells such a map from the right one, but
takes too long to compute for all candidates. So it is computed in two steps:

1. Coarse proxies are registered as each of the first few candidates says, and the deformation energy joins the score.
2. Where the first two are close after that, SHOT of the registered proxies is compared too. Where they are very close,
   they are registered once more with finer proxies.
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
from kfmaps.registration.evidence import FINE_VERTICES, PATIENT, deform, registered_shot_error, shape_proxy
from kfmaps.shape import Shape, mirror_image

N_REGISTERED = 3
"""Distinct candidates that are registered."""
RELATIVE_EVIDENCE = ("strain", "shot_error")
"""Evidence of a candidate that counts only against that of other candidates."""


@dataclass(frozen=True, eq=False)
class ProxyCache:
    """Coarse proxies of two shapes, built when they are first used; ``None`` where a shape has no faces."""

    source: Shape
    target: Shape
    sample_proxies: tuple[CoarseProxy | None, CoarseProxy | None]  # those that the samples have
    mirrored: bool = False  # whether the second is of the target's mirror image

    @classmethod
    def of(cls, source: Shape, target: Shape, samples: SamplePair) -> ProxyCache:
        """Return the cache of two shapes, with the coarse proxies of their samples."""
        return cls(source, target, (samples.source.proxy, samples.target.proxy), samples.target.mirrored)

    @cached_property
    def image(self) -> Shape:
        """The target, mirrored where the candidates are maps to its mirror image."""
        return mirror_image(self.target) if self.mirrored else self.target

    @cached_property
    def shot_guidance(self) -> DescriptorGuidance | None:
        """Guidance by SHOT on all vertices; ``None`` without SHOT."""
        return descriptor_guidance(self.source.shot, self.image.shot)

    @cached_property
    def coarse(self) -> ProxyPair | None:
        """The proxies of the samples."""
        return self._pair(*self.sample_proxies)

    @cached_property
    def fine(self) -> ProxyPair | None:
        """Proxies with more vertices."""
        a, b = shape_proxy(self.source, FINE_VERTICES), shape_proxy(self.target, FINE_VERTICES)
        return self._pair(a, b.mirrored() if b is not None and self.mirrored else b)

    def _pair(self, a: CoarseProxy | None, b: CoarseProxy | None) -> ProxyPair | None:
        return None if a is None or b is None else proxy_pair(self.source, self.image, (a, b))


def ranking(
    found: list[Candidate],
    samples: SamplePair,
    proxies: ProxyCache,
    least: float = -np.inf,
) -> list[Candidate]:
    """Return the distinct ones of the candidates, best first; the first few with their deformation energies.

    SHOT errors after registration count too where the first two are close and the score of the first is above
    ``least``.
    """
    ranked = distinct_candidates(found, samples.source)
    # Where margins count less, a candidate must be farther behind to be none that decides the verdict.
    least_near = ranked[0].score - SCORE.max_behind / samples.margin_factor
    near = [c for c in ranked[:N_REGISTERED] if c.score > least_near]
    registered = with_deformation_energy(near, proxies)
    if not registered:
        return ranked
    # The others count as the worst that is registered, so that none of them comes first.
    worst = max(c.deformation_energy for c in registered if c.deformation_energy is not None)
    order = by_preference([*registered, *(replace(c, deformation_energy=worst) for c in ranked[len(near) :])])
    if len(near) > 1 and order[0].score - order[1].score < SCORE.shot_margin and order[0].score > least:
        return rerank_close(order, proxies)
    return order


def rerank_near_duplicates(
    ranked: list[Candidate],
    found: list[Candidate],
    samples: SamplePair,
    proxies: ProxyCache,
    distance: float = SCORE.rough_distance,
    behind: float = np.inf,
) -> list[Candidate]:
    """Return ``ranked`` with candidates between them that differ from a better one by little more than ``distance``.

    A map with one limb wrong is near the right one, and may come before it by chance. Registration shows which of them
    is torn. Candidates whose scores are farther ``behind`` are left out.
    """
    most = 5  # candidates near a better one that are registered too
    best = distinct_maps(by_preference(found), samples.source, distance, most)
    known = [c.functional_map for c in ranked]
    more = [c for c in best if c.score > best[0].score - behind and not any(c.functional_map is C for C in known)]
    return by_preference([*ranked, *with_deformation_energy(more, proxies)])


def with_deformation_energy(found: list[Candidate], proxies: ProxyCache) -> list[Candidate]:
    """Return candidates with the deformation energies of the coarse proxies; none where a shape has no proxy."""
    pair = proxies.coarse
    if not found or pair is None:
        return []
    energies = parallel(lambda c: deform(c.functional_map, pair).energy, found)
    return [replace(c, deformation_energy=energy) for c, energy in zip(found, energies, strict=True)]


def rerank_close(order: list[Candidate], proxies: ProxyCache) -> list[Candidate]:
    """Return the candidates with the SHOT errors of the first two after registration, best first.

    Where the first two are very close they are registered with finer proxies too. A map that swaps front and back may
    come first by a margin that leaves no doubt to the score.
    """
    pair = proxies.fine
    if pair is None:
        return order
    are_close = order[0].score - order[1].score < SCORE.close_margin

    def with_shot_error(candidate: Candidate) -> Candidate:
        candidate = score_registered(candidate, pair) if are_close else candidate
        return replace(candidate, shot_error=registered_shot_error(candidate.functional_map, pair))

    first = parallel(with_shot_error, order[:2])
    # The lower SHOT error costs nothing: the best is compared with candidates that have no SHOT error.
    reference = reference_values(first, np.mean)[0], reference_values(first, min)[1]
    return by_preference([normalize_errors(c, reference) for c in first]) + order[2:]


def score_registered(candidate: Candidate, pair: ProxyPair) -> Candidate:
    """Return a candidate with the deformation energy and the strain of a longer registration of the proxies."""
    deformed = deform(candidate.functional_map, pair, PATIENT)
    return replace(candidate, deformation_energy=deformed.energy, strain=deformed.strain, shot_error=None)


def reference_values(found: list[Candidate], of: Callable[[list[float]], float]) -> tuple[float, ...]:
    """Return ``of`` the values of each :data:`RELATIVE_EVIDENCE`, by which candidates are compared; 0 without any."""
    known = ([value for c in found if (value := getattr(c, name)) is not None] for name in RELATIVE_EVIDENCE)
    return tuple(float(of(values)) if values else 0.0 for values in known)


def normalize_errors(candidate: Candidate, reference: tuple[float, ...]) -> Candidate:
    """Return a candidate with its :data:`RELATIVE_EVIDENCE`, where it has been computed, less the reference values."""
    values = ((name, getattr(candidate, name), usual) for name, usual in zip(RELATIVE_EVIDENCE, reference, strict=True))
    changed: dict[str, Any] = {name: value - usual for name, value, usual in values if value is not None}
    return replace(candidate, **changed)


def distinct_candidates(found: list[Candidate], source: ShapeSamples) -> list[Candidate]:
    """Return the best candidate, then the best of those that differ from it, and so on."""
    return distinct_maps(by_preference(found), source, SCORE.distinct_distance)


def by_preference(found: list[Candidate]) -> list[Candidate]:
    """Return the candidates by their scores, best first; one with descriptors first where it is nearly the best.

    A candidate that was refined without descriptors comes first only where it is clearly better than all with them.
    """
    order = by_score(found)
    best = next((c for c in order if c.uses_descriptors), None)
    if best is not None and best.score > order[0].score - SCORE.clear_margin:
        order.insert(0, order.pop(next(i for i, c in enumerate(order) if c is best)))
    return order
