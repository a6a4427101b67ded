"""Repair the candidates between shapes that differ much: register and refine in turn, and compare them once more.

:mod:`kfmaps.registration.alternating_registration` repairs one map; this module decides which are worth it, with what
each begins, what of it counts, and which comes first then.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.sparse import csr_array

from kfmaps._arrays import NotConverged
from kfmaps._progress import Progress
from kfmaps._threads import parallel
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.matching.candidates import FINE, distinct_maps, score_maps
from kfmaps.matching.extremity_matching import (
    ExtremityVertices,
    complete_match,
    match_extremities,
    match_of_map,
    unused_matches,
    vertices_of_match,
)
from kfmaps.matching.initial_maps import EXTREMITY_FUNCTIONS, Start, paired_map
from kfmaps.matching.landmark_evidence import LANDMARK_WEIGHT_UNLIKE, build_guidance
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.ranking import BENT, ProxyCache, in_order, normalize_errors, reference_values, score_registered
from kfmaps.matching.sample_pair import SamplePair
from kfmaps.matching.score import SCORE, Candidate
from kfmaps.registration.alternating_registration import AlternatingResult, ProxyPair, alternating_registration
from kfmaps.registration.evidence import registered_shot_error

FIRST = 2
"""Maps that are repaired, whether or not they differ."""
PAIRED = 3
"""Likeliest extremity matches that repairs begin with, where no map that is repaired has the same."""


@dataclass(frozen=True, eq=False)
class RepairSetting:
    """What the repairs of all candidates of a pair share."""

    proxies: ProxyPair
    samples: SamplePair
    landmarks: np.ndarray
    shot: DescriptorGuidance | None
    graphs: tuple[csr_array, csr_array]  # geodesic graphs of both meshes, of depth 1


@dataclass(frozen=True, eq=False)
class SwappedRepair:
    """A repair that was not made: of the ``candidate``, the source registered onto the target.

    ``reference``: :data:`RELATIVE` evidence of the best repaired candidates, over which its own counts.
    """

    setting: RepairSetting
    candidate: Candidate
    extremities: ExtremityVertices | None
    reference: tuple[float, ...]

    def make(self) -> Candidate | None:
        """Return the repaired candidate; ``None`` where the registration falls apart."""
        *_, made = _repair_rounds(self.setting, self.candidate, self.extremities, swapped=False)
        if made is None:
            return None
        made = _with_shot_error(self.setting, score_registered(made, self.setting.proxies))
        return normalize_errors(made, self.reference)


def refine_by_registration(
    ranked: list[Candidate],
    samples: SamplePair,
    copies: ProxyCache,
    landmarks: np.ndarray,
    progress: Progress | None = None,
) -> tuple[list[Candidate], tuple[Candidate | SwappedRepair, ...]]:
    """Repair the best candidates between unlike shapes, and rank them again.

    The target is registered onto the source, so that each direction has its say: what follows registers the source onto
    the target. Where that has made a candidate worse, it counts as the best of that, of the source registered onto the
    target, and of what it was. Repairs keep to the extremities that a map takes to each other, so the likeliest matches
    of extremities that none of the maps has begin repairs too.

    Returns ``ranked``; ``retries``: what may turn out better than the first on all vertices: the next that were
    repaired, and the first repaired the other way round.
    """
    finer = copies.fine
    if finer is None:
        return ranked, ()
    graphs = geodesic_graph(copies.source.mesh, 1), geodesic_graph(copies.image.mesh, 1)
    setting = RepairSetting(finer, samples, landmarks, copies.shot_guidance, graphs)
    near, rest = repairable(ranked, samples.source)
    begun = _begin(near, samples)
    ended, behind = _repair_all(setting, begun, near, progress)
    tried = compared([*ended.values()], partial(_with_shot_error, setting))
    # Those that were given up count as bent as badly as the worst.
    energies = [c.deformation_energy for c in tried if c.deformation_energy is not None]
    energy, (strain, shot_error) = max(energies, default=None), reference_values(tried, max)
    given_up = [replace(c, deformation_energy=energy, strain=strain, shot_error=shot_error) for c in behind.values()]
    reference, every = reference_values(tried, min), [*tried, *given_up]
    order = in_order([normalize_errors(c, reference) for c in every])
    which = dict(zip((id(c.functional_map) for c in every), (*ended, *behind), strict=True))
    nexts = distinct_maps(order, samples.source, SCORE.twin_distance, 3)[1:]  # two others that may turn out better
    retries = (*nexts, SwappedRepair(setting, *begun[which[id(order[0].functional_map)]], reference))
    return distinct_maps(order + rest, samples.source, SCORE.distinct_distance), retries


def _repair_all(
    setting: RepairSetting,
    begun: list[tuple[Candidate, ExtremityVertices | None]],
    near: list[Candidate],
    progress: Progress | None,
) -> tuple[dict[int, Candidate], dict[int, Candidate]]:
    """Return the repaired candidates and those that are given up, by the number of what they began with.

    After the first round the better of what that has made and of what was a candidate before, one of ``near``, tells
    whether a second is worth it.
    """
    rounds = [_repair_rounds(setting, *one) for one in begun]
    done = np.zeros(len(begun))

    def report(i: int, part: float) -> None:
        done[i] = part
        if progress is not None:
            progress("bent and matched in turn", float(done.mean()))

    def begin_one(i: int) -> Candidate | None:
        made = next(rounds[i])
        report(i, 0.5)
        return made

    def end_one(i: int) -> Candidate | None:
        made = _best_repair(setting, *begun[i], [first[i], *rounds[i]][-1], i < len(near))
        report(i, 1.0)
        alone = first[i]  # where the second round falls apart, and the repair began with no candidate
        return made if made or alone is None else score_registered(alone, setting.proxies)

    report(0, 0.0)
    first = parallel(begin_one, range(len(begun)))
    states = {i: [c for c in (*near[i : i + 1], made) if c is not None] for i, made in enumerate(first)}
    better = {i: max(some, key=_quality) for i, some in states.items() if some}
    least = max(map(_quality, better.values())) - SCORE.repair_lag
    going = [i for i, c in better.items() if _quality(c) >= least]
    behind = {i: c for i, c in better.items() if i not in going}
    done[:] = 1.0
    done[going] = 0.5
    ended = zip(going, parallel(end_one, going), strict=True)
    return {i: c for i, c in ended if c is not None}, behind


def _quality(one: Candidate) -> float:
    return one.quality.score


def _repair_rounds(
    setting: RepairSetting, old: Candidate, extremities: ExtremityVertices | None, swapped: bool = True
) -> Iterator[Candidate | None]:
    """Register and refine a candidate in turn; yields what each round makes, ``None`` as the last where it fails.

    ``swapped``: whether the target is registered onto the source.
    """
    source, target = setting.proxies.source, setting.proxies.target
    limbs = extremities and extremities.guide(source.mesh, target.mesh, setting.graphs)
    guidance = build_guidance(source, target, setting.landmarks, limbs, setting.shot, LANDMARK_WEIGHT_UNLIKE)
    for found in register_map_on_proxies(old.functional_map, setting.proxies, guidance, setting.landmarks, swapped):
        if found is None:
            yield None
            return
        start = Start(old.name, found.functional_map[:FINE, :FINE], old.uses_descriptors, fit=old.fit)
        new = score_maps([start], setting.samples)[0]
        yield replace(new, registered_vertices=found.registered_vertices, swapped=swapped)


def register_map_on_proxies(
    C: np.ndarray,
    pair: ProxyPair,
    guidance: DescriptorGuidance | None,
    landmarks: np.ndarray,
    swapped: bool = True,
) -> Iterator[AlternatingResult | None]:
    """Yield the rounds of :func:`alternating_registration` of a map, ``None`` as the last where a proxy falls apart.

    ``C (k_t, k_s)``; ``guidance``: on all vertices; ``landmarks (l, 2)``; ``swapped``: whether the target is
    registered to the source: the vertices of the result are then the target's.
    """
    if swapped:
        C, pair, landmarks = C.T, pair.swapped(), landmarks[:, ::-1]
        guidance = guidance and guidance.swapped()
    try:
        for found in alternating_registration(C, pair, guidance, landmarks):
            yield replace(found, functional_map=found.functional_map.T) if swapped else found
    except NotConverged:
        yield None


def _begin(near: list[Candidate], samples: SamplePair) -> list[tuple[Candidate, ExtremityVertices | None]]:
    """Return what repairs begin with: candidates, and maps of likely extremity matches that none of them has."""
    likely = match_extremities(samples.source, samples.target, samples.descriptor_cost)
    found = [match_of_map(one.points, samples.source, samples.target) for one in near]
    known = [one and complete_match(one, likely) for one in found]
    begun = [
        (c, one and vertices_of_match(one, samples.source, samples.target)) for c, one in zip(near, known, strict=True)
    ]
    for one in unused_matches(likely, [match for match in known if match], PAIRED):
        C = paired_map(one, samples, min(EXTREMITY_FUNCTIONS, len(near[0].functional_map)))
        candidate = score_maps([Start(f"{one}", C)], samples)[0]
        begun.append((candidate, vertices_of_match(one, samples.source, samples.target)))
    return begun


def _best_repair(
    setting: RepairSetting, old: Candidate, extremities: ExtremityVertices | None, new: Candidate | None, begun: bool
) -> Candidate | None:
    """Return the repaired candidate ``new``, or the best of both directions and ``old`` where that made it worse.

    Where a body touches itself the right map may go astray one way only. ``begun``: it was a candidate before.
    """
    if new is None:
        return old if begun else None
    states: list[Candidate | None] = [new]
    if begun and _quality(new) < _quality(old):
        *_, other = _repair_rounds(setting, old, extremities, swapped=False)
        states += [old, other]
    made = [c for c in states if c is not None]
    least = max(map(_quality, made)) - SCORE.repair_lag
    scored = [score_registered(c, setting.proxies) for c in made if _quality(c) >= least]
    return max(scored, key=lambda c: c.score)


def _with_shot_error(setting: RepairSetting, one: Candidate) -> Candidate:
    return replace(one, shot_error=registered_shot_error(one.functional_map, setting.proxies))


def compared(found: list[Candidate], with_shot_error: Callable[[Candidate], Candidate]) -> list[Candidate]:
    """Return the repaired candidates with their SHOT errors; those far behind have the worst that is computed."""
    found = [replace(c, shot_error=None) for c in found]
    reference = reference_values(found, min)
    scores = [normalize_errors(c, reference).score for c in found]
    near = [score > max(scores) - SCORE.hopeless_margin for score in scores]
    seen = parallel(with_shot_error, [c for c, yes in zip(found, near, strict=True) if yes])
    worst = max((c.shot_error for c in seen if c.shot_error is not None), default=None)
    rest = iter(seen)
    return [next(rest) if yes else replace(c, shot_error=worst) for c, yes in zip(found, near, strict=True)]


def repairable(ranked: list[Candidate], source: ShapeSamples) -> tuple[list[Candidate], list[Candidate]]:
    """Return the candidates that are worth a repair, the first few and the first few that differ, and the others."""
    wanted = [*ranked[:FIRST], *distinct_maps(ranked, source, SCORE.distinct_distance, BENT)]
    least = ranked[0].score - SCORE.repairable_margin
    worth = [any(c is w for w in wanted) and c.score > least for c in ranked]
    near = [c for c, yes in zip(ranked, worth, strict=True) if yes]
    return near, [c for c, yes in zip(ranked, worth, strict=True) if not yes]
