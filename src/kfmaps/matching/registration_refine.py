"""Repair the best candidates between unlike shapes by registration, and rank them again.

Between shapes that differ much ZoomOut leaves limbs torn. :mod:`kfmaps.registration.alternating_registration` repairs a
map by rounds of registration and refinement on proxies. This module

1. chooses the candidates that are worth a repair, and adds maps of likely extremity matches that none of them has;
2. repairs all by one round, and those that are not too far behind then by a second one;
3. ranks the repaired candidates by their scores, with the evidence of a longer registration.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array

from kfmaps._arrays import NotConverged
from kfmaps._progress import Progress
from kfmaps._threads import parallel
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance
from kfmaps.geometry.geodesic_graph import bridged_graph
from kfmaps.matching.candidates import FINE_FUNCTIONS, distinct_maps, score_maps
from kfmaps.matching.extremity_matching import (
    ExtremityVertices,
    complete_match,
    match_extremities,
    match_of_map,
    unused_matches,
    vertices_of_match,
)
from kfmaps.matching.initial_maps import Start
from kfmaps.matching.landmark_evidence import LANDMARK_WEIGHT_UNLIKE, build_guidance
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.ranking import (
    N_REGISTERED,
    ProxyCache,
    by_preference,
    normalize_errors,
    reference_values,
    score_registered,
)
from kfmaps.matching.sample_pair import EXTREMITY_FUNCTIONS, SamplePair, paired_map
from kfmaps.matching.score import SCORE, Candidate
from kfmaps.registration.alternating_registration import AlternatingResult, ProxyPair, alternating_registration
from kfmaps.registration.evidence import registered_shot_error

N_REPAIRED = 2
"""First candidates that are repaired, whether or not they differ."""
N_MATCHES = 3
"""Likeliest extremity matches that are repaired, unless a candidate has the same."""


@dataclass(frozen=True, eq=False)
class RepairSetting:
    """What the repairs of all candidates of a pair share."""

    proxies: ProxyPair
    samples: SamplePair
    landmarks: np.ndarray
    shot: DescriptorGuidance | None
    graphs: tuple[csr_array, csr_array]  # geodesic graphs of both meshes, of depth 1

    def with_shot_error(self, candidate: Candidate) -> Candidate:
        """Return a candidate with its SHOT error after registration."""
        return replace(candidate, shot_error=registered_shot_error(candidate.functional_map, self.proxies))


@dataclass(frozen=True, eq=False)
class Repair:
    """A map to be repaired."""

    setting: RepairSetting
    start: Candidate
    extremities: ExtremityVertices | None  # those that the map matches, which the repair keeps to
    is_candidate: bool = True  # whether the map was a candidate before; else an extremity match gives it

    def rounds(self, swapped: bool = True) -> Iterator[Candidate | None]:
        """Register and refine the map; yields the candidate of each round, ``None`` as the last where it fails.

        ``swapped``: whether the target is registered onto the source.
        """
        setting, pair = self.setting, self.setting.proxies
        shapes, landmarks = (pair.source, pair.target), setting.landmarks
        limbs = self.extremities and self.extremities.guidance(pair.source.mesh, pair.target.mesh, setting.graphs)
        guidance = build_guidance(*shapes, landmarks, limbs, setting.shot, LANDMARK_WEIGHT_UNLIKE)
        for result in register_map_on_proxies(self.start.functional_map, pair, guidance, landmarks, swapped):
            if result is None:
                yield None
                return
            C, before = result.functional_map[:FINE_FUNCTIONS, :FINE_FUNCTIONS], self.start
            candidate = score_maps([Start(before.name, C, before.uses_descriptors, fit=before.fit)], setting.samples)
            yield replace(candidate[0], registered_vertices=result.registered_vertices, swapped=swapped)

    def finish(self, first: Candidate | None, rest: Iterator[Candidate | None]) -> Candidate | None:
        """Return the best result after the ``first`` round and the ``rest`` of them; ``None`` where there is none.

        Where the repair has made a candidate worse, the candidate before and the repair with the source registered onto
        the target are compared with it: where a body touches itself the right map may be lost in one direction only.
        """
        *_, last = first, *rest
        if last is None and self.is_candidate:
            return self.start
        if last is None:
            return first and score_registered(first, self.setting.proxies)
        results = [last]
        if self.is_candidate and _quality(last) < _quality(self.start):
            *_, opposite = self.rounds(swapped=False)
            results += [self.start] if opposite is None else [self.start, opposite]
        least = max(map(_quality, results)) - SCORE.repair_lag
        scored = [score_registered(c, self.setting.proxies) for c in results if _quality(c) >= least]
        return max(scored, key=lambda c: c.score)


@dataclass(frozen=True, eq=False)
class SwappedRepair:
    """A repair that was not made yet: the source registered onto the target.

    ``reference``: values of :data:`~kfmaps.matching.ranking.RELATIVE_EVIDENCE` that its own are compared with.
    """

    repair: Repair
    reference: tuple[float, ...]

    def make(self) -> Candidate | None:
        """Return the repaired candidate; ``None`` where the registration fails."""
        *_, made = self.repair.rounds(swapped=False)
        if made is None:
            return None
        setting = self.repair.setting
        return normalize_errors(setting.with_shot_error(score_registered(made, setting.proxies)), self.reference)


def refine_by_registration(
    ranked: list[Candidate],
    samples: SamplePair,
    proxies: ProxyCache,
    landmarks: np.ndarray,
    progress: Progress | None = None,
    *,
    only_best: bool = False,
) -> tuple[list[Candidate], tuple[Candidate | SwappedRepair, ...]]:
    """Repair the best candidates between unlike shapes, or with ``only_best`` the first alone, and rank them again.

    A repair registers the target onto the source; the registration on all vertices that follows a search registers the
    source onto the target, so both directions take part.

    Returns the ranked candidates, and those that may turn out better than the first on all vertices: the next repaired
    ones, and the repair of the first in the other direction.
    """
    fine = proxies.fine
    if fine is None:
        return ranked, ()
    graphs = bridged_graph(proxies.source.mesh), bridged_graph(proxies.image.mesh)
    setting = RepairSetting(fine, samples, landmarks, proxies.shot_guidance, graphs)
    near, rest = (ranked[:1], ranked[1:]) if only_best else repairable(ranked, samples.source)
    repairs = _plan_repairs(setting, near, 0 if only_best else N_MATCHES)
    finished, given_up = _run_repairs(repairs, progress)
    repaired = with_shot_errors([*finished.values()], setting.with_shot_error)
    # Those that were given up count as the worst in all that was not computed for them.
    energies = [c.deformation_energy for c in repaired if c.deformation_energy is not None]
    energy, (strain, shot_error) = max(energies, default=None), reference_values(repaired, max)
    lagging = [replace(c, deformation_energy=energy, strain=strain, shot_error=shot_error) for c in given_up.values()]
    both, reference = [*repaired, *lagging], reference_values(repaired, min)
    order = by_preference([normalize_errors(c, reference) for c in both])
    number = dict(zip((id(c.functional_map) for c in both), (*finished, *given_up), strict=True))
    n_retries = 2  # repaired candidates after the best that may turn out better on all vertices
    others = distinct_maps(order, samples.source, SCORE.twin_distance, n_retries + 1)[1:]
    opposite = SwappedRepair(repairs[number[id(order[0].functional_map)]], reference)
    return distinct_maps(order + rest, samples.source, SCORE.distinct_distance), (*others, opposite)


def repairable(ranked: list[Candidate], source: ShapeSamples) -> tuple[list[Candidate], list[Candidate]]:
    """Return the candidates that are worth a repair, the first few and the first few that differ, and the others."""
    chosen = [*ranked[:N_REPAIRED], *distinct_maps(ranked, source, SCORE.distinct_distance, N_REGISTERED)]
    least = ranked[0].score - SCORE.repairable_margin
    is_worth = [any(c is one for one in chosen) and c.score > least for c in ranked]
    near = [c for c, yes in zip(ranked, is_worth, strict=True) if yes]
    return near, [c for c, yes in zip(ranked, is_worth, strict=True) if not yes]


def _plan_repairs(setting: RepairSetting, near: list[Candidate], n_matches: int) -> list[Repair]:
    """Return the repairs of candidates, and of ``n_matches`` maps by likely extremity matches that none of them has."""
    samples = setting.samples
    shapes = samples.source, samples.target
    likely = match_extremities(*shapes, samples.descriptor_cost)
    own = [match_of_map(c.points, *shapes) for c in near]
    own = [match and complete_match(match, likely) for match in own]
    repairs = [
        Repair(setting, c, match and vertices_of_match(match, *shapes)) for c, match in zip(near, own, strict=True)
    ]
    for match in unused_matches(likely, [match for match in own if match], n_matches):
        C = paired_map(match, samples, min(EXTREMITY_FUNCTIONS, len(near[0].functional_map)))
        start = score_maps([Start(f"{match}", C)], samples)[0]
        repairs.append(Repair(setting, start, vertices_of_match(match, *shapes), is_candidate=False))
    return repairs


def _run_repairs(repairs: list[Repair], progress: Progress | None) -> tuple[dict[int, Candidate], dict[int, Candidate]]:
    """Return the repaired candidates and those that are given up, each by the number of its repair.

    A repair is given up after its first round where the better of its result and of the candidate before lags behind
    the best of all.
    """
    rounds = [repair.rounds() for repair in repairs]
    done = np.zeros(len(repairs))

    def report(i: int, part: float) -> None:
        done[i] = part
        if progress is not None:
            progress("registered and refined in turn", float(done.mean()))

    def begin(i: int) -> Candidate | None:
        made = next(rounds[i])
        report(i, 0.5)
        return made

    def end(i: int) -> Candidate | None:
        made = repairs[i].finish(first[i], rounds[i])
        report(i, 1.0)
        return made

    report(0, 0.0)
    first = parallel(begin, range(len(repairs)))
    better = {}
    for i, (repair, made) in enumerate(zip(repairs, first, strict=True)):
        states = [c for c in (repair.start if repair.is_candidate else None, made) if c is not None]
        if states:
            better[i] = max(states, key=_quality)
    least = max(map(_quality, better.values())) - SCORE.repair_lag
    kept = [i for i, c in better.items() if _quality(c) >= least]
    given_up = {i: c for i, c in better.items() if i not in kept}
    done[:] = 1.0
    done[kept] = 0.5
    finished = zip(kept, parallel(end, kept), strict=True)
    return {i: c for i, c in finished if c is not None}, given_up


def _quality(candidate: Candidate) -> float:
    return candidate.quality.score


def register_map_on_proxies(
    C: np.ndarray,
    pair: ProxyPair,
    guidance: DescriptorGuidance | None,
    landmarks: np.ndarray,
    swapped: bool = True,
) -> Iterator[AlternatingResult | None]:
    """Yield the rounds of :func:`alternating_registration` of a map, ``None`` as the last where it fails.

    ``C (k_t, k_s)``; ``guidance``: on all vertices; ``landmarks (l, 2)``; ``swapped``: whether the target is
    registered to the source: the vertices of the result are then the target's.
    """
    if swapped:
        C, pair, landmarks = C.T, pair.swapped(), landmarks[:, ::-1]
        guidance = guidance and guidance.swapped()
    try:
        for result in alternating_registration(C, pair, guidance, landmarks):
            yield replace(result, functional_map=result.functional_map.T) if swapped else result
    except NotConverged:
        yield None


def with_shot_errors(found: list[Candidate], with_shot_error: Callable[[Candidate], Candidate]) -> list[Candidate]:
    """Return the repaired candidates with their SHOT errors; those far behind have the worst that is computed."""
    found = [replace(c, shot_error=None) for c in found]
    reference = reference_values(found, min)
    scores = [normalize_errors(c, reference).score for c in found]
    is_near = [score > max(scores) - SCORE.hopeless_margin for score in scores]
    computed = parallel(with_shot_error, [c for c, yes in zip(found, is_near, strict=True) if yes])
    worst = max((c.shot_error for c in computed if c.shot_error is not None), default=None)
    rest = iter(computed)
    return [next(rest) if yes else replace(c, shot_error=worst) for c, yes in zip(found, is_near, strict=True)]
