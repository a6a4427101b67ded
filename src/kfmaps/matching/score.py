"""Score candidate maps without knowing the truth: evidence, weights, thresholds and the calibration.

No single measure is enough. A mirrored map of a symmetric body preserves distances, a map that swaps front and back
*and* left and right even preserves orientation, and a map of everything to one point is smooth.

1. :class:`Quality` has the measures of a map on samples; their weighted sum is the score of the map alone.
2. :class:`Candidate` adds evidence from registration, extremities and landmarks, which :func:`candidate_score` weighs.
3. :func:`probability` turns the score of a map and its margin over the best distinct candidate into the probability
   that the map is right, that is, that its mean geodesic error is below 0.08 √area. :func:`verdict` puts it into words.

Parts are scored likewise (:class:`PartEvidence`, :func:`part_score`). All numbers are fields of :data:`SCORE`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Protocol, TypeVar

import numpy as np
from scipy.special import expit

if TYPE_CHECKING:
    from kfmaps.matching.solve import Fit

T = TypeVar("T")


@dataclass(frozen=True)
class Calibration:
    """Numbers that turn a score and its margin into a probability and a verdict.

    Values for whole shapes come from `benchmarks/calibration.py` (research/verdict.md).
    """

    slope: float = 0.92
    """Slope of the logistic function of the score."""
    middle: float = -11.8
    """Score at which half of all maps would be right by that slope; a wrong map between unlike bodies has had −9.3."""
    steep_slope: float = 4.0
    """Slope of a steeper logistic function, which rises to :attr:`sure` and no further: few maps are wrong above its
    middle, but those that are may lie anywhere."""
    steep_middle: float = -12.0
    """Its middle, between right maps of bodies of different species and maps of shapes that have nothing in common."""
    tie: float = 1.4
    """Margin at which the doubt cast by a different map has fallen to 1/e. A map that swaps front and back has been
    better than the right one by 2.1."""
    max_margin: float = math.inf
    """Largest margin that counts. With it a map is never "ambiguous"."""
    usual_log_deformation: float = -3.6
    """Logarithm of the deformation energy of right maps at a score of 0."""
    log_deformation_per_score: float = -0.233
    """Change of that logarithm with the score."""
    excess_middle: float = 0.78
    """Excess of the logarithm at which half of all maps are wrong: right maps have up to 0.73, those of bodies to their
    mirror images begin at 0.9."""
    excess_width: float = 0.05
    """Width of that logistic function."""
    sure: float = 0.9
    """Probability from which a map is called "sure"; wrong ones have had up to 0.899."""
    likely: float = 0.5
    """Probability from which a map is called "likely"."""
    max_fit: float = 1.0
    """Largest probability unless landmarks raise it."""


def _part_calibration(slope: float, middle: float, tie: float = 1.3, max_fit: float = 1.0) -> Calibration:
    """Return the calibration of parts, which have one logistic function."""
    return Calibration(slope, middle, steep_middle=math.inf, tie=tie, max_margin=3.0, max_fit=max_fit)


@dataclass(frozen=True)
class PartScoring:
    """Numbers that parts are scored by; see research/parts.md for the shapes that they were chosen on."""

    calibration: Calibration = field(default_factory=lambda: _part_calibration(1 / 0.43, 16.2))
    """Fitted by `benchmarks/parts_verdict.py`."""
    calibration_of_two: Calibration = field(default_factory=lambda: _part_calibration(1 / 2.7, 9.9, max_fit=0.89))
    """The same for two parts, which score lower when right; fitted to the pairs of `benchmarks/part_to_part.py`. They
    are never "sure" without landmarks: wrong placements have scored 19.6."""
    calibration_of_view: Calibration = field(default_factory=lambda: _part_calibration(1 / 0.43, 16.2, tie=1.6))
    """The same for scans of one camera, whose wrong placements have had a margin of 2.2."""
    calibration_in_unit: Calibration = field(
        default_factory=lambda: replace(_part_calibration(1 / 0.43, 16.2), steep_slope=0.8, steep_middle=13.0)
    )
    """The same for parts that lie at the scale of the files, of which few are wrong above a score of 14."""
    in_unit: float = 0.26
    """:attr:`PartEvidence.scale_change` up to which a part lies at the scale of the files: a factor of 1.3."""
    w_consistency: float = 4.0
    """Weight of the consistency of all samples with their neighbours."""
    w_pair_consistency: float = 12.0
    """Weight of :attr:`PartEvidence.pair_consistency` over :attr:`usual_pair_consistency`."""
    usual_pair_consistency: float = 0.85
    """Usual consistency of right placements of two parts: they have 0.75 to 0.93, wrong ones 0.5 to 0.78."""
    w_similarity_rank: float = 1.0
    """Weight of :attr:`PartEvidence.similarity_rank`."""
    w_overlap_rank: float = 4.0
    """Weight of :attr:`PartEvidence.overlap_rank` below :attr:`usual_overlap_rank`."""
    usual_overlap_rank: float = -3.3
    """Usual rank of right placements of two parts: they have -2.1 to -5.2, wrong ones -1.5 to -3.9."""
    w_gap: float = 50.0
    """Weight of the root mean squared distance between the surfaces, in √area of the whole."""
    w_flipped: float = 4.0
    """Weight of the share of the area whose normals contradict the whole's."""
    w_doubled: float = 10.0
    """Weight of the share of the area that lies where more of the part lies: right placements have up to 0.01, two legs
    on one 0.2."""
    w_deformation: float = 3.0
    """Weight of the logarithm of the deformation energy. A half of a body placed on the other half, front to back,
    differs from the right placement in nothing else."""
    w_scale: float = 3.0
    """Largest cost of a scale that is not the usual one: a part that shrinks fits nearly everywhere."""
    other_scale: float = 0.47
    """:attr:`PartEvidence.scale_change` from which the scale has this cost: a factor of 1.6. Right parts have up to
    1.16 from one person to another, and 1.3 from one species to another."""
    full_view_scale: float = 0.45
    """Scale from which the scan of one camera may show all of a whole: 21 people have 0.49 to 0.65. Less costs as the
    scale of a small part does."""
    base_deformation: float = 0.005
    """Deformation energy of any part, by its mesh alone."""
    distinct_distance: float = 0.1
    """Median distance between placed samples, in √area of the whole, from which two placements differ."""
    full_area: float = 0.25
    """Area of the part, over that of the whole, from which a margin counts in full (research/parts.md)."""
    hopeless_margin: float = 5.0
    """Score behind the best from which a placement is not refined: refinement has gained at most 2.3."""
    early_exit_score: float = 17.5
    """Score of the best supported placement from which no other is looked for but its alternatives."""
    early_exit_in_unit: float = 14.0
    """The same of a part at the scale of the files: of 60 with this score and the agreement below one was 19.9 off, and
    that would be "sure" otherwise, too (research/parts.md)."""
    early_exit_agreement: float = 0.97
    """Share of the samples on which another relaxation must agree with it: right ones have 0.973 and more, those with a
    limb elsewhere up to 0.963 (research/parts.md)."""
    min_gain: float = 0.2
    """Gain of the score below which a placement is refined no further."""
    min_whole_area: float = 0.7
    """Share of the area of the whole from which a part that is not clear is matched as a whole with holes first. One
    with less is not matched as a whole unless it is "unlikely"."""
    max_fragment_area: float = 0.5
    """Share of the area below which an "unlikely" part at the scale of the files is not matched as a whole either."""
    whole_overlap: float = 0.95
    """Share of the area of both shapes in the overlap from which neither is a part."""
    max_landmark_error: float = 0.1
    """Error of a landmark, in √area of the whole, from which a placement contradicts it."""
    landmark_cost: float = 1.0
    """Cost of a landmark that a placement contradicts: a wrong place of a leg has scored 2.4 more than the right one, a
    place by three landmarks with left for right 3.3 less (research/parts.md)."""
    landmark_cost_of_two: float = 3.0
    """The same between two parts, whose wrong placements have scored up to 3.9 more."""
    min_opening: float = 0.01
    """Opening of the boundary, over the area, from which something may be missing: a round hole of 0.11 √area."""
    max_hole_opening: float = 0.2
    """Opening up to which a shape may be a whole one with holes, unless its match as a part is "sure"."""
    max_small_opening: float = 0.05
    """Opening up to which a shape lacks a limb at most: cuts of people and animals have 0.66 to 0.99 of the area."""
    max_loop_change: float = 0.05
    """Difference of the lengths of the boundary loops of two shapes, over their length, up to which both have the same
    boundaries. Different cuts have 0.066 and more (research/parts.md)."""
    max_loop_share: float = 0.8
    """Share of the longest loop of these, since one loop may be equally long by chance."""
    max_whole_deformation: float = 0.3
    """Deformation energy of a match as wholes up to which a shape with openings like holes is whole: right maps of
    unlike animals have 0.2 to 0.4."""
    max_deformation_of_equal: float = 0.015
    """The same up to which two open shapes have the same cuts if the match is "sure": right maps of regions that are
    cut alike have 0.012 to 0.05, squeezed ones 0.017 and more (research/parts.md)."""
    max_deformation_of_two: float = 0.1
    """The same where both have long boundaries: with parts missing of both it is 0.24 and more."""
    shrunk_scale: float = 0.26
    """Scale up to which a placement without landmarks has shrunk to the least scale, and is mostly wrong."""
    opening_ratio: float = 3.0
    """Least ratio of the opening of a part to that of the other shape."""


@dataclass(frozen=True)
class Scoring:
    """All numbers that maps are scored by. Distances are mean distances in √area unless stated otherwise.

    Weights were chosen on pairs of `FAUST_r`, `SHREC19_r` and generated shapes (research/score.md).
    """

    w_orientation: float = 1.0
    """Weight of :attr:`Quality.orientation`; those of the other measures of a map follow."""
    w_distortion: float = 6.0
    w_local_distortion: float = 10.0
    w_descriptors: float = 12.0
    w_heat: float = 2.0
    w_coverage: float = 1.0
    w_laplacian: float = 2.0
    w_reflection: float = 25.0
    w_extremities: float = 8.0
    """Weight of the descriptor error at hands, feet, faces and tails, which no pose changes."""
    w_deformation: float = 5.0
    """Weight of the logarithm of the deformation energy over :attr:`usual_deformation`."""
    usual_deformation: float = 0.15
    """Deformation energy of a usual pair."""
    w_strain: float = 6.0
    """Weight of the strain over a usual one, where it is known."""
    w_shot: float = 60.0
    """Weight of the SHOT error after registration, where it is known; right and wrong maps differ by 0.02 and more."""
    w_landmark: float = 2.0
    """Cost of a landmark with an error of :attr:`max_landmark_error` or more."""
    w_torn: float = 25.0
    """Cost where all of the target is torn. With less than 20 a torn map of a dog and a cat is kept, with more than 35
    front and back of a gorilla may be exchanged."""
    moved_distance: float = 0.15
    """Distance from which an alternative maps a vertex elsewhere."""
    torn_confidence: float = 0.5
    """Local confidence below which a vertex counts as torn."""
    refused_registration: float = 0.6
    """Factor of the probability of a map whose registration is refused: of seven such maps three were right, of
    416 others nine tenths (research/verdict.md)."""
    loose_pieces: float = 0.6
    """Factor of the probability of a map that tears more than :attr:`max_torn_contacts` of the contacts of pieces, as
    one that was "sure" and exchanged the arms of a robot, or whose pieces may be turned by :attr:`max_turned`."""
    max_turned: float = 0.1
    """Mean distance, in √area, by which symmetries of pieces may move the vertices."""
    contact_distance: float = 0.03
    """Distance, in √area, up to which two vertices of different pieces are a contact."""
    max_torn_contacts: float = 0.25
    """Share of the contacts that are between torn pieces; most right maps have up to 0.15, by contacts of one pose."""
    max_torn_area: float = 0.04
    """Share of torn area from which alternatives are refined and registered too, and a region is called doubtful."""

    local_radius: float = 0.2
    """Distance up to which points are neighbours, whose distance a good map preserves."""
    extremity_radius: float = 0.3
    """Distance from an extremity within which descriptors count once more."""
    reflection_distance: float = 0.3
    """Distance from which a point's image and that of its mirror image are not symmetric."""
    min_heat_variance: float = 0.02
    """Variance of the logarithm of the heat kernel signature below which it is noise: a sphere has 0.0003, bodies 1."""

    max_landmark_error: float = 0.3
    """Error of a landmark, in √area, from which it may be rejected and its cost no longer grows."""
    max_isometric_landmark_error: float = 0.12
    """The error to reject one between near-isometric shapes; right ones have 0.11 at most (research/landmarks.md)."""
    max_mean_landmark_error: float = 0.025
    """Mean landmark error up to which no maps begin with landmarks where none is repaired: people of one source have
    up to 0.021, those of many sources up to 0.046 (research/landmarks.md)."""
    min_kept_landmarks: float = 0.6
    """Share of landmarks that a map must keep to before the others are rejected."""
    landmark_radius: float = 0.2
    """Distance along the surface up to which a landmark supports a map."""
    landmark_error_middle: float = 0.055
    """Mean landmark error at which landmarks support a map by half: a map is right below 0.08."""
    landmark_error_width: float = 0.004
    """Width of that logistic function."""

    rough_distance: float = 0.04
    """Distance from which coarse maps are distinct."""
    distinct_distance: float = 0.08
    """Distance from which candidates are distinct."""
    duplicate_distance: float = 0.005
    """Distance from which maps near the best are registered too: exchanged feet that touch make this difference."""
    twin_distance: float = 0.03
    """Distance up to which two repaired candidates are the same: a limb that lies elsewhere makes 0.05."""
    min_exchange_distance: float = 0.015
    """Distance from which a map with limbs exchanged is a rival: two ears make 0.013, two legs 0.019 to 0.1."""
    early_exit_score: float = -7.0
    """:attr:`Quality.score` of a coarse map from which kernel fits are left out: people have −4 to −10, animals
    of different kinds −8.5 and less."""
    repair_score: float = -7.5
    """:attr:`Quality.score` below which candidates are repaired by registration."""
    min_unrepaired_score: float = -10.0
    """:attr:`Quality.score` below which repairs have made no map "sure": maps that became so had −9.95 and more."""
    non_isometric_score: float = -8.0
    """:attr:`Quality.score` below which the high functions of two shapes do not correspond."""
    clear_margin: float = 0.3
    """Margin from which a candidate without descriptors comes first; also the largest difference in
    :attr:`Quality.score` to a map after a symmetry of the shape: octopuses and stars have 0.2."""
    mirror_margin: float = 5.0
    """Margin from which a map to the mirror image comes first with the setting "auto"; bones have 10."""
    isometry_margin: float = 0.8
    """Difference in :attr:`Quality.isometry_score` between a map to the mirror image and the best that keeps
    orientation below which a shape is nearly its own mirror image: people in mirrored poses have 0.1 to 0.7, in robes
    up to 1.3, mirrored brackets and bodies without symmetry 1.1 and more (research/verdict.md)."""
    isometry_factor: float = 2.0
    """Factor of what exceeds that margin, in the margin of a map to the mirror image over the best other one: the left
    and the right side of a brain exceed it by 1.7 to 2.0 (research/brains.md)."""
    either_margin: float = 1.0
    """Difference of the scores, apart from deformations, up to which a map of the other orientation is a rival with the
    setting "either": wrong ones are up to 0.35 ahead (research/bones.md)."""
    mirror_gain: float = 1.0
    """Margin from which a map to the mirror image is registered and, if it is still as far ahead, casts a doubt."""
    congruent_energy: float = 0.011
    """Deformation energy below which shapes are congruent; values below 0.01 are raised to it."""
    excess_deformation: float = 0.55
    """Excess deformation (:func:`excess_deformation`) from which maps to the mirror image are tried."""
    max_behind: float = 3.0
    """Margin behind which a candidate is not registered."""
    max_exchange_behind: float = 5.0
    """The same of a map with limbs exchanged: between unlike bodies right ones have been 3.5 behind, with half of the
    deformation energy."""
    shot_margin: float = 2.5
    """Margin of the first two candidates below which their SHOT errors are compared; also the margin below which a map
    with limbs exchanged or to the mirror image casts a doubt."""
    close_margin: float = 1.0
    """Margin of the first two candidates below which they are registered again with more points."""
    rotation_margin: float = 0.4
    """Factor of margins between shapes that a rotation may keep (:attr:`SamplePair.margin_factor`), and over candidates
    that are better but for their registration: there poses and proportions decide, and a table was a turn off by a
    margin of 5.3 (research/verdict.md)."""
    turned_deformation: float = 3.0
    """Difference in :func:`deformation_cost` to the best from which a candidate that is close to it otherwise is
    repaired: one limb turned costs 5.9 and 8.5, front and back of a person exchanged up to 2.8."""
    repairable_margin: float = 6.0
    """Margin behind which a candidate is not repaired: repairs have gained up to 10, and decide between front and back
    (research/subtraction.md)."""
    repair_lag: float = 1.5
    """Difference in :attr:`Quality.score` to the best, after one round of repairs, from which a repair is given up:
    after all rounds the difference would be 4 or more (research/speed.md)."""
    hopeless_margin: float = 5.0
    """Margin behind which a repaired candidate loses whatever its SHOT error."""
    min_orientation: float = -0.2
    """:attr:`Quality.orientation` below which a map turns the surface inside out."""
    same_map: float = 0.1
    """Difference ``‖C − C'‖² / k`` below which two maps of a collection are the same."""

    calibration: Calibration = Calibration()
    part: PartScoring = PartScoring()


SCORE = Scoring()
"""The numbers in use."""


@dataclass(frozen=True)
class Quality:
    """Measures of one map on samples; made by :func:`kfmaps.matching.quality.map_quality`."""

    # Correlation of the source's transferred orientation operators with those of the target (Ren et al. 2018), from 1,
    # preserved everywhere, to -1, reversed everywhere. 0 for point clouds.
    orientation: float
    distortion: float  # mean absolute change of geodesic distances, divided by the mean distance; 0 for an isometry
    # The same for points closer than :attr:`Scoring.local_radius`, which shows tears.
    local_distortion: float
    # Mean squared difference of SHOT between matched points, divided by that of random ones, from 0 to about 1; mean of
    # both directions. Smaller where the shapes have hardly any features.
    descriptors: float
    heat: float  # the same for the logarithm of the heat kernel signature, which distinguishes thick from thin
    coverage: float  # share of the area that samples are mapped to, the smaller of both directions
    laplacian: float  # ``‖C Λ_s − Λ_t C‖² / ‖C Λ_s‖²``; 1, as for unrelated shapes, for a map of constants alone
    # ``descriptors`` of points near extremities alone, which does not count in :attr:`score`. 0 without extremities.
    extremity_descriptor_error: float = 0.0
    # Share of the area where the map does not commute with the reflections of both shapes (Ovsjanikov, Sun and Guibas
    # 2008), mean of both directions. 0 where a shape is not nearly its own mirror image.
    reflection_error: float = 0.0

    @property
    def score(self) -> float:
        """The score of the map alone, higher is better; differences below 0.1 mean little."""
        return quality_score(self)

    @property
    def calibrated_score(self) -> float:
        """The score without the reflection error, which depends on how exactly the reflections are known."""
        return quality_score(replace(self, reflection_error=0.0))

    @property
    def isometry_score(self) -> float:
        """The score without orientation, reflection and SHOT, in which a pose and its mirror image differ."""
        return quality_score(replace(self, orientation=0.0, descriptors=0.0, reflection_error=0.0))


@dataclass(frozen=True, eq=False)
class Candidate:
    """One refined map on the samples of a pair, with its evidence."""

    name: str  # of its initial map
    functional_map: np.ndarray  # (k, k)
    points: np.ndarray  # (q_t,): a source sample for each target sample
    quality: Quality
    uses_descriptors: bool = True  # whether descriptors took part in its refinement
    # (l,): distance of each landmark's image from the landmark of the other shape, in √area.
    landmark_errors: np.ndarray = field(default_factory=lambda: np.zeros(0))
    # See :mod:`kfmaps.registration.evidence`; ``None`` where they were not computed. Strain and SHOT error are
    # differences from those of a usual or of the best candidate.
    deformation_energy: float | None = None
    strain: float | None = None
    shot_error: float | None = None
    # (n_s, 3): the source's vertices on the target, roughly; with ``swapped`` the target's (n_t, 3) on the source.
    registered_vertices: np.ndarray | None = None
    swapped: bool = False
    # The kernel fit that it started from; ``None`` where it started from signs, extremities or another candidate.
    fit: Fit | None = None

    @property
    def score(self) -> float:
        """See :func:`candidate_score`."""
        return candidate_score(self)

    @property
    def excess_deformation(self) -> float:
        """:func:`excess_deformation` of the map; 0 where its deformation energy was not computed."""
        energy = self.deformation_energy
        return 0.0 if energy is None else excess_deformation(self.quality.calibrated_score, energy)

    @property
    def unregistered(self) -> Candidate:
        """The same without evidence of a registration."""
        return replace(self, deformation_energy=None, strain=None, shot_error=None)


@dataclass(frozen=True)
class PartEvidence:
    """Measures of one placement of a part."""

    consistency: float  # of all samples with their neighbours, 0 to 1
    # Mean logarithm of the share of the whole's samples that are more similar to a sample than its place: 0 and less.
    similarity_rank: float
    deformation_energy: float = math.inf  # of :class:`kfmaps.matching.partial.registration.PartRegistration`
    gap: float = 0.0
    flipped_area: float = 0.0
    # Consistency of the distances between samples of the overlap, where both shapes are parts; 0 to 1.
    pair_consistency: float = PartScoring.usual_pair_consistency
    # Mean logarithm of the share of the other part's samples in the overlap that are more similar to a sample than its
    # place, where both shapes are parts: 0 and less.
    overlap_rank: float = PartScoring.usual_overlap_rank
    # Absolute logarithm of the ratio of the scale of a part to that of its file, or of one camera's scan to
    # :attr:`PartScoring.full_view_scale`.
    scale_change: float = 0.0
    landmark_cost: float = 0.0  # of landmarks with errors above :attr:`PartScoring.max_landmark_error`
    doubled_area: float = 0.0  # of :class:`kfmaps.matching.partial.registration.PartRegistration`


def quality_score(quality: Quality, numbers: Scoring = SCORE) -> float:
    """Return the score of a map alone, higher is better."""
    return (
        numbers.w_orientation * quality.orientation
        - numbers.w_distortion * quality.distortion
        - numbers.w_local_distortion * quality.local_distortion
        - numbers.w_descriptors * quality.descriptors
        - numbers.w_heat * quality.heat
        + numbers.w_coverage * quality.coverage
        - numbers.w_laplacian * quality.laplacian
        - numbers.w_reflection * quality.reflection_error
    )


def candidate_score(candidate: Candidate, numbers: Scoring = SCORE) -> float:
    """Return the score of a candidate from its map, extremities, registration and landmarks, each of bounded cost.

    It is rounded to nine digits, so that scores are equal that differ by rounding errors.
    """
    deformation = 0.0
    if candidate.deformation_energy is not None:
        deformation = -deformation_cost(candidate.deformation_energy, numbers)
    strain = -numbers.w_strain * (candidate.strain or 0.0)
    shot = -numbers.w_shot * (candidate.shot_error or 0.0)
    extremities = numbers.w_extremities * candidate.quality.extremity_descriptor_error
    evidence = quality_score(candidate.quality, numbers) - extremities + deformation + strain + shot
    return round(evidence - landmark_cost(candidate.landmark_errors, numbers), 9)


def landmark_cost(errors: np.ndarray, numbers: Scoring = SCORE) -> float:
    """Return the cost in the score of a candidate of landmarks with ``errors (l,)``, in √area."""
    return numbers.w_landmark * float(np.minimum(errors / numbers.max_landmark_error, 1.0).sum())


def deformation_cost(energy: float, numbers: Scoring = SCORE) -> float:
    """Return the cost of a deformation energy in the score of a candidate; negative below the usual energy."""
    return numbers.w_deformation * math.log(energy / numbers.usual_deformation)


def torn_score(score: float, torn_area: float | None, numbers: Scoring = SCORE) -> float:
    """Return the score of a map on all vertices: the ``score`` of its candidate less the cost of its torn area."""
    return score - numbers.w_torn * (torn_area or 0.0)


def placement_score(evidence: PartEvidence, numbers: PartScoring = SCORE.part) -> float:
    """Return the part of :func:`part_score` that needs no registration."""
    score = numbers.w_consistency * evidence.consistency - numbers.w_similarity_rank * evidence.similarity_rank
    return score - scale_cost(evidence, numbers)


def scale_cost(evidence: PartEvidence, numbers: PartScoring = SCORE.part) -> float:
    """Return the cost of a scale that is not the usual one."""
    return numbers.w_scale * min((evidence.scale_change / numbers.other_scale) ** 2, 1.0)


def part_score(evidence: PartEvidence, numbers: PartScoring = SCORE.part) -> float:
    """Return the score of a placement of a part, higher is better."""
    score = placement_score(evidence, numbers) - numbers.w_gap * evidence.gap
    score -= numbers.w_flipped * evidence.flipped_area + numbers.w_doubled * evidence.doubled_area
    score += numbers.w_pair_consistency * (evidence.pair_consistency - numbers.usual_pair_consistency)
    score -= numbers.w_overlap_rank * (evidence.overlap_rank - numbers.usual_overlap_rank)
    score -= evidence.landmark_cost
    deformation = math.log(max(evidence.deformation_energy, 0.0) + numbers.base_deformation)
    return score + numbers.w_deformation * -deformation


def part_landmark_cost(errors: np.ndarray, two: bool) -> float:
    """Return the cost of the landmarks that a placement of a part, or of ``two`` parts, contradicts.

    ``errors (l,)``: of its landmarks, in √area of the whole.
    """
    missed = float((errors > SCORE.part.max_landmark_error).sum())
    return missed * (SCORE.part.landmark_cost_of_two if two else SCORE.part.landmark_cost)


def excess_deformation(score: float, deformation_energy: float, numbers: Calibration = SCORE.calibration) -> float:
    """Return the excess of the logarithm of the deformation energy over that of right maps with this ``score``."""
    return math.log(deformation_energy) - numbers.usual_log_deformation - numbers.log_deformation_per_score * score


def landmark_support(errors: np.ndarray, distances: np.ndarray, areas: np.ndarray, numbers: Scoring = SCORE) -> float:
    """Return how well landmarks support a map, from 0 to 1.

    It is the squared share of the source within :attr:`Scoring.landmark_radius` of a landmark, times a logistic
    function of the mean error. So few landmarks, or many in one place, support it little.

    ``errors (l,)``: of the landmarks, in √area, by a map that was refined without them; ``distances (l, q_s)``: from
    each of the source's landmarks to its samples; ``areas (q_s,)``: of these samples.
    """
    if len(errors) == 0:
        return 0.0
    covered = (distances < numbers.landmark_radius).any(axis=0)
    share = float(areas[covered].sum() / areas.sum())
    error = float(np.minimum(errors, numbers.max_landmark_error).mean())
    return share**2 * float(expit((numbers.landmark_error_middle - error) / numbers.landmark_error_width))


def deforms_too_much(candidate: Candidate) -> bool:
    """Return whether a map deforms the shapes much more than right maps of its score do, so that it may be wrong."""
    return candidate.excess_deformation > SCORE.excess_deformation


def is_close_but_deformed(candidate: Candidate, best: Candidate, factor: float = 1.0) -> bool:
    """Return whether a map is about as good as the best except for its much greater deformation energy.

    ``factor``: of the margin without that energy (:attr:`~kfmaps.matching.sample_pair.SamplePair.margin_factor`).
    """
    if candidate.deformation_energy is None or best.deformation_energy is None:
        return False
    more = deformation_cost(candidate.deformation_energy) - deformation_cost(best.deformation_energy)
    behind = factor * (best.unregistered.score - candidate.unregistered.score)
    return more > SCORE.turned_deformation and behind < SCORE.close_margin


def is_near_isometric(score: float) -> bool:
    """Return whether a :attr:`Quality.score` is that of near-isometric shapes, whose high functions correspond."""
    return score >= SCORE.non_isometric_score


def max_landmark_error(score: float) -> float:
    """Return the error from which a landmark contradicts a map of this :attr:`Quality.score`, in √area."""
    return SCORE.max_isometric_landmark_error if is_near_isometric(score) else SCORE.max_landmark_error


def rejected_landmarks(errors: np.ndarray, limit: float) -> np.ndarray:
    """Return which landmarks ``(l,)`` contradict a map that agrees with most of them; none of fewer than three."""
    wrong = errors > limit
    few = len(errors) < 3 or (~wrong).mean() < SCORE.min_kept_landmarks
    return np.zeros(len(errors), dtype=bool) if few else wrong


def probability(
    score: float,
    margin: float,
    deformation_energy: float | None = None,
    support: float = 0.0,
    numbers: Calibration = SCORE.calibration,
) -> float:
    """Return the probability that a map is right.

    ``score``: :attr:`Quality.score` of whole shapes, :func:`part_score` of a part; ``margin``: over the best distinct
    candidate, with which it is equally likely at a margin of 0; ``deformation_energy``: lowers the probability where it
    exceeds that of right maps by far; ``support``: :func:`landmark_support`, which raises the probability.
    """
    steep = numbers.sure * float(expit(numbers.steep_slope * (score - numbers.steep_middle)))
    fits = max(float(expit(numbers.slope * (score - numbers.middle))), steep)
    if deformation_energy is not None:
        excess = excess_deformation(score, deformation_energy, numbers)
        fits *= float(expit((numbers.excess_middle - excess) / numbers.excess_width))
    alone = min(fits, numbers.max_fit) * (1.0 - 0.5 * math.exp(-max(margin, 0.0) / numbers.tie))
    return alone + (1.0 - alone) * support


def verdict(
    score: float,
    margin: float,
    deformation_energy: float | None = None,
    support: float = 0.0,
    numbers: Calibration = SCORE.calibration,
) -> str:
    """Return "sure", "likely" or "unlikely" by the :func:`probability`, or "ambiguous".

    A map is "ambiguous" if it would have a better verdict without another candidate that is nearly as good.
    """
    margins = margin, math.inf if margin < numbers.max_margin else margin
    word, alone = (
        probability_word(probability(score, one, deformation_energy, support, numbers), numbers) for one in margins
    )
    return word if word == alone else "ambiguous"


def probability_word(chance: float, numbers: Calibration = SCORE.calibration) -> str:
    """Return "sure", "likely" or "unlikely" for a probability."""
    return "sure" if chance >= numbers.sure else "likely" if chance >= numbers.likely else "unlikely"


def lower_probability(
    chance: float | None, word: str, area: float, is_refused: bool = False, is_loose: bool = False
) -> tuple[float | None, str]:
    """Return the probability and the verdict of a map on all vertices, lowered by what is wrong with it.

    ``area``: share of the area that is torn, of which right maps that are "sure" have 5 % at most
    (research/verdict.md), or that is missing of one shape; ``is_refused``: whether the registration would have made the
    map worse; ``is_loose``: whether pieces may be exchanged or turned.
    """
    if chance is None:
        return chance, word
    chance *= (1.0 - area) * (SCORE.refused_registration if is_refused else 1.0)
    chance *= SCORE.loose_pieces if is_loose else 1.0
    return chance, word if word == "ambiguous" else probability_word(chance)


class Scored(Protocol):
    """Whatever has a score."""

    @property
    def score(self) -> float: ...


S = TypeVar("S", bound=Scored)


def by_score(found: Iterable[S]) -> list[S]:
    """Return candidates or placements, best first."""
    return sorted(found, key=lambda one: one.score, reverse=True)


def select_distinct(order: Iterable[T], differ: Callable[[T, T], bool], most: int | None = None) -> list[T]:
    """Return the first of ``order``, then the first that differs from all before, and so on: at most ``most``."""
    kept: list[T] = []
    for one in order:
        if len(kept) == most:
            break
        if all(differ(one, other) for other in kept):
            kept.append(one)
    return kept
