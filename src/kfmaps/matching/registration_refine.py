"""The candidates between shapes that differ much: bent and matched in turn, and compared once more.

:mod:`kfmaps.registration.alternating_registration` mends one map; here it is decided which are worth it, with what
each begins, what of it
counts, and which comes first then.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from kfmaps._arrays import NotConverged
from kfmaps._progress import Done, Progress
from kfmaps._threads import parallel
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance, descriptor_guidance
from kfmaps.matching.candidates import FINE, TIP_FUNCTIONS, Candidate, paired_map, score_maps, select_distinct
from kfmaps.matching.extremity_matching import (
    ExtremityVertices,
    complete_match,
    match_extremities,
    match_of_map,
    unused_matches,
    vertices_of_match,
)
from kfmaps.matching.landmark_evidence import LESS, build_guidance
from kfmaps.matching.proxy_cache import ProxyCache
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.ranking import BENT, DISTINCT, in_order, normalize_errors, reference_values, score_registered
from kfmaps.matching.sample_pair import SamplePair
from kfmaps.registration.alternating_registration import alternating_registration, registration_pair, swap_pair
from kfmaps.registration.registered_shot import registered_shot_error

FIRST = 2
"""Maps that are mended, whether or not they differ."""
PAIRED = 3
"""Likeliest pairings of the tips of limbs that mending begins with, where no map that is mended has the same."""
MENDABLE = 6.0
"""How far behind a map may be to be mended: mending has gained up to 10."""
HOPELESS = 5.0
"""How far behind a mended map comes to nothing however it looks."""
NEXT = 2
"""Mended ones after the best that may turn out to be less torn than it, ..."""
TWIN = 0.03
"""... and the mean distance up to which two of them count as one: a limb that lies elsewhere makes 0.05."""


def refine_by_registration(
    ranked: list[Candidate],
    on: SamplePair,
    copies: ProxyCache,
    landmarks: np.ndarray,
    threads: int | None = None,
    progress: Progress | None = None,
) -> list[Candidate]:
    """The best between unlike shapes bent and matched in turn (:mod:`kfmaps.registration.alternating_registration`),
    and ranked again.

    The target is bent onto the source, so that each direction has its say: what follows bends the source onto the
    target. Each counts as it is after that or, where that has made it worse, as the best of that, of the source bent
    onto the target, and of what it was before.

    A refinement may send a leg to the tail, and what is mended keeps to the tips that it has paired. So the likeliest
    pairings of tips (:mod:`kfmaps.matching.extremity_matching`) that none of these maps has are begun with as well.
    """
    finer = copies.fine
    if finer is None:
        return ranked
    source, target = copies.source, copies.image
    both = registration_pair(source, target, finer.on.copies, landmarks)
    shot = descriptor_guidance(source.shot, target.shot)

    near, rest = repairable(ranked, on.source)
    likely = match_extremities(on.source, on.target, on.shot)
    known = [match_of_map(one.points, on.source, on.target) for one in near]
    known = [one and complete_match(one, likely) for one in known]
    begun = [(c, one and vertices_of_match(one, on.source, on.target)) for c, one in zip(near, known, strict=True)]
    for one in unused_matches(likely, [pairing for pairing in known if pairing], PAIRED):
        C = paired_map(one, on, min(TIP_FUNCTIONS, len(near[0].functional_map)))
        begun.append(
            (score_maps([(f"{one}", True)], C[None], None, on, 1)[0], vertices_of_match(one, on.source, on.target))
        )
    done = np.zeros(len(begun))

    def tell(i: int, part: float) -> None:
        done[i] = part
        if progress is not None:
            progress("bent and matched in turn", float(done.mean()))

    def mend(old: Candidate, tips: ExtremityVertices | None, tell: Done, backwards: bool = True) -> Candidate | None:
        led = build_guidance(source, target, landmarks, tips and tips.guide(source.mesh, target.mesh), shot, LESS)
        C, where = old.functional_map, both
        if backwards:
            C, where, led = C.T, swap_pair(both), led and DescriptorGuidance(led.target, led.source)
        try:
            found = alternating_registration(C, where, led, lambda part: tell(0.9 * part))
        except NotConverged:
            tell(1.0)
            return None
        size = min(FINE, len(found.functional_map))
        C = found.functional_map[:size, :size]
        new = score_maps([(old.name, old.uses_descriptors)], (C.T if backwards else C)[None], None, on, 1)[0]
        new = replace(
            score_registered(new, source, target, finer.on),
            registered_vertices=found.registered_vertices,
            swapped=backwards,
        )
        tell(1.0)
        return new

    def better(i: int) -> Candidate | None:
        """Where a body touches itself the right map may go astray; the other way it may not, or is best as it was."""
        old, new = begun[i][0], mend(*begun[i], partial(tell, i))
        if new is None:
            return old if i < len(near) else None
        if i >= len(near) or new.quality.score >= old.quality.score:
            return new
        other = mend(*begun[i], lambda _done: None, backwards=False)
        states = [new, score_registered(old, source, target, finer.on), *([] if other is None else [other])]
        return max(states, key=lambda c: c.score)

    def looked_at(found: Candidate) -> Candidate:
        return replace(found, shot_error=registered_shot_error(found.functional_map, source, target, finer))

    tell(0, 0.0)
    made = parallel(better, range(len(begun)), threads)
    which = [i for i, c in enumerate(made) if c is not None]
    tried = compared([c for c in made if c is not None], looked_at, threads)
    least = reference_values(tried, min)
    order = in_order([normalize_errors(c, least) for c in tried])
    won = begun[which[next(i for i, c in enumerate(tried) if c.functional_map is order[0].functional_map)]]

    def forwards() -> Candidate | None:
        made = mend(*won, lambda _done: None, backwards=False)
        return made and normalize_errors(looked_at(made), least)

    # Others that are as likely, and the one that has won mended the other way round: the source bent onto the target.
    nexts = select_distinct(order, on.source, TWIN, 1 + NEXT)[1:]
    order[0] = replace(order[0], again=(*(partial(_itself, c) for c in nexts), forwards))
    return select_distinct(order + rest, on.source, DISTINCT)


def _itself(found: Candidate) -> Candidate:
    return found


def compared(
    found: list[Candidate], looked_at: Callable[[Candidate], Candidate], threads: int | None = None
) -> list[Candidate]:
    """The mended ones with how they look, those that are far behind anyway with the worst that is seen."""
    found = [replace(c, shot_error=None) for c in found]
    strain = reference_values(found, min)[0]
    scores = [normalize_errors(c, (strain, 0.0)).score for c in found]
    near = [score > max(scores) - HOPELESS for score in scores]
    seen = parallel(looked_at, [c for c, yes in zip(found, near, strict=True) if yes], threads)
    worst = max((c.shot_error for c in seen if c.shot_error is not None), default=None)
    rest = iter(seen)
    return [next(rest) if yes else replace(c, shot_error=worst) for c, yes in zip(found, near, strict=True)]


def repairable(ranked: list[Candidate], source: ShapeSamples) -> tuple[list[Candidate], list[Candidate]]:
    """Those that are worth mending, and the others; a second look may have put the second behind the third.

    The first few, which may be alike, and the first few that differ.
    """
    wanted = [*ranked[:FIRST], *select_distinct(ranked, source, DISTINCT, BENT)]
    worth = [any(c is w for w in wanted) and c.score > ranked[0].score - MENDABLE for c in ranked]
    return [c for c, yes in zip(ranked, worth, strict=True) if yes], [
        c for c, yes in zip(ranked, worth, strict=True) if not yes
    ]
