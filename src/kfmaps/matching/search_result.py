"""The result of a search: a map before it is refined on all vertices, with its alternatives and its verdict."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from kfmaps.fmap.approximate_nearest import N_PROBE_FAST
from kfmaps.fmap.convert import to_points
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance
from kfmaps.fmap.zoomout import MAX_CANDIDATES, MAX_EXACT_PAIRS
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.sampling import SampledBasis, stratified_vertices
from kfmaps.matching.extremity_matching import ExtremityVertices, extremity_vertices
from kfmaps.matching.landmark_conflicts import contradicted_by, support_of_landmarks
from kfmaps.matching.registration_refine import SwappedRepair
from kfmaps.matching.score import (
    SCORE,
    Candidate,
    is_near_isometric,
    landmark_cost,
    probability,
    verdict,
)
from kfmaps.matching.search_state import SearchState
from kfmaps.matching.solve import Fit


@dataclass(frozen=True, eq=False)
class SearchResult:
    """A map that a search or a fit has found, before it is refined on all vertices."""

    functional_map: np.ndarray  # (k, k)
    initialization: str  # the initial map of the candidate
    fit: Fit | None  # the kernel fit that the map started from, if any
    verdict: str  # "sure", "likely", "ambiguous" or "unlikely" of a search; "landmarks" or "unchecked" of one fit
    confidence: float | None = None  # probability that the map is right, see :func:`kfmaps.matching.score.probability`
    scores: tuple[float, ...] = ()  # of the map and of each alternative, higher is better
    alternatives: tuple[np.ndarray, ...] = ()  # (n_t,) each: the distinct other maps, best first
    # Margins of the map over the first alternatives, those that cast a doubt on it (:attr:`SearchState.doubts`).
    # Negative where the alternative is better, as a map to the mirror image or one that contradicts landmarks may be.
    doubts: tuple[float, ...] = ()
    # (l, 2): those that were not rejected.
    landmarks: np.ndarray = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))
    # (d,): numbers, from 0, of the given landmarks that the map contradicts.
    rejected_landmarks: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    orientation: str = "preserving"  # or "reversing": whether it is a map to the target or to its mirror image
    quality: float | None = None  # :attr:`kfmaps.matching.score.Quality.calibrated_score` of the map of a search
    deformation_energy: float | None = None  # see :class:`kfmaps.registration.evidence.DeformationEnergy`
    extremities: ExtremityVertices | None = None  # guide the refinement between unlike shapes
    # (n_s, 3): the source's vertices roughly on the target, which guide the refinement between unlike shapes too.
    registered_vertices: np.ndarray | None = None
    swapped: bool = False  # whether ``registered_vertices`` are the target's vertices on the source instead, (n_t, 3)
    # Candidates that may turn out better on all vertices; :func:`kfmaps.matching.search.retry` makes results of them.
    retries: tuple[Candidate | SwappedRepair, ...] = ()
    _search: SearchState | None = None

    @property
    def is_near_isometric(self) -> bool:
        """Whether the high functions of the shapes correspond; without a search they are taken to."""
        return self.quality is None or is_near_isometric(self.quality)

    @property
    def shot_guidance(self) -> DescriptorGuidance | None:
        """Guidance by SHOT on all vertices, where a search has computed it."""
        return self._search and self._search.proxies.shot_guidance


def build_result(state: SearchState, best: Candidate, rest: list[Candidate]) -> SearchResult:
    """Return ``best`` as the result of a search; ``rest`` are its alternatives, best first."""
    config, samples = state.config, state.samples.fine
    assert config.search is not None
    doubts = _close_doubts(state)
    alternatives = [*(c for c, _ in doubts), *rest][: config.search.n_alternatives]
    scores = [best.score, *(best.score - margin for _, margin in doubts), *(c.score for c in rest)]
    evidence, quality = calibrated_evidence(state, best, rest), best.quality.calibrated_score
    # A landmark that a rough map contradicts, on a tail say, may be right by the registered map made without it. One
    # that the final map contradicts would tear it in the refinement on all vertices.
    rejected = state.rejected if state.rejected.all() else contradicted_by(best, state)
    bases, maps = (state.source.basis, state.target.basis), [c.functional_map for c in alternatives]
    unlike = not is_near_isometric(quality)
    return SearchResult(
        functional_map=best.functional_map,
        initialization=best.name,
        fit=best.fit,
        confidence=probability(*evidence),
        verdict=verdict(*evidence),
        scores=tuple(float(score) for score in scores[: len(alternatives) + 1]),
        alternatives=alternative_maps(maps, *bases),
        doubts=tuple(margin for _, margin in doubts)[: len(alternatives)],
        landmarks=state.landmarks[~rejected],
        rejected_landmarks=np.flatnonzero(rejected),
        orientation=state.orientation,
        quality=quality,
        deformation_energy=best.deformation_energy,
        extremities=extremity_vertices(best.points, samples.source, samples.target) if unlike else None,
        registered_vertices=best.registered_vertices,
        swapped=best.swapped,
        _search=state,
    )


def calibrated_evidence(
    state: SearchState, best: Candidate, rest: list[Candidate]
) -> tuple[float, float, float | None, float]:
    """Return what :func:`kfmaps.matching.score.probability` and ``verdict`` take of ``best``, in their order.

    ``rest``: its alternatives.
    """
    has_rotation = state.samples.fine.has_rotation
    margins = [*(margin for _, margin in _close_doubts(state)), *(_margin(best, other, has_rotation) for other in rest)]
    if not state.samples.fine.are_surfaces and (~state.rejected).sum() < 3:
        margins.append(0.0)  # nothing tells the map from its mirror image
    margin = state.samples.fine.margin_factor * max(min(margins, default=np.inf), 0.0)
    support = support_of_landmarks(best, state.samples.fine) if state.trust_landmarks else 0.0
    return best.quality.calibrated_score, margin, best.deformation_energy, support


def _close_doubts(state: SearchState) -> list[tuple[Candidate, float]]:
    """Return the maps that cast a doubt with a small margin, with it."""
    return [(c, margin) for c, margin in state.doubts if margin < SCORE.shot_margin]


def _margin(best: Candidate, other: Candidate, has_rotation: bool) -> float:
    """Return the margin of ``best`` over another candidate, as the calibration takes it.

    A candidate that preserves distances and descriptors as well, and deforms the shape no more than right maps do, is
    the best map after a symmetry of the shape. Which of the two deforms the shape less depends on the poses alone, so
    their deformation energies are left out, as wherever a rotation keeps a shape (``has_rotation``); landmarks still
    tell them apart. Where the other is the better map but for its registration, the margin counts less, too.
    """
    margin = best.quality.score - other.quality.score
    if has_rotation or (margin < SCORE.clear_margin and other.excess_deformation < 0.0):
        return margin + landmark_cost(other.landmark_errors) - landmark_cost(best.landmark_errors)
    is_better = other.unregistered.score > best.unregistered.score
    return (SCORE.rotation_margin if is_better else 1.0) * (best.score - other.score)


def alternative_maps(maps: list[np.ndarray], source: Basis, target: Basis) -> tuple[np.ndarray, ...]:
    """Return point maps ``(n_t,)`` of functional maps that are not refined on all vertices.

    Images on a large source are chosen among :data:`~kfmaps.fmap.zoomout.MAX_CANDIDATES` of its vertices, which lie
    nearer to each other than so few functions can resolve: this takes a quarter of the time.
    """
    exact = False if len(source.mass) * len(target.mass) > MAX_EXACT_PAIRS else None
    vertices, sampled = np.arange(len(source.mass)), source
    if len(vertices) > MAX_CANDIDATES:
        vertices = stratified_vertices(source, MAX_CANDIDATES, 0)
        sampled = SampledBasis(source.eigenvalues, source.functions[vertices], source.mass[vertices])
    return tuple(vertices[to_points(C, sampled, target, exact=exact, n_probe=N_PROBE_FAST)] for C in maps)
