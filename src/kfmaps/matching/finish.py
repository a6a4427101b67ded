"""Finish a map that a search, one fit or other maps have found: refine it on all vertices, register, build the match.

ZoomOut refines the functional map on all vertices, guided by SHOT, landmarks and extremities. The point map that comes
of it starts a non-rigid registration of the source onto the target, which gives points inside triangles.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import partial
from itertools import product
from typing import Any, Literal

import numpy as np
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from kfmaps._arrays import Array, like, seed_of, to_numpy
from kfmaps._progress import Progress, StageTimer
from kfmaps._threads import limit_threads, one_blas_thread
from kfmaps.config import Config
from kfmaps.fmap.convert import check_point_map, to_functional, to_points
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance, descriptor_guidance
from kfmaps.fmap.precise import nearest_vertices
from kfmaps.fmap.refine import Refined
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.mesh import MIRROR, Mesh, component_areas, vertex_areas
from kfmaps.matching.candidates import FINE_FUNCTIONS
from kfmaps.matching.landmark_evidence import build_guidance
from kfmaps.matching.reindexing import VertexReindexing, reindexing
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import ONE_FIT, MatchFit, MatchPart, MatchRegistration, MatchScore, ShapeFile
from kfmaps.matching.score import SCORE, deformation_cost, lower_probability, max_landmark_error, torn_score
from kfmaps.matching.search_result import SearchResult
from kfmaps.registration.accept import register_map
from kfmaps.registration.evidence import MIN_ENERGY
from kfmaps.shape import Shape, check_prepared, mirror_image

UNLIKE_FUNCTIONS = 100
"""Functions at the end of the refinement between unlike shapes, whose higher functions do not correspond. With it a
gorilla and a woman have an error of 5.2 instead of 8.5, cats and dogs 10.5 instead of 10.9 on average; people of other
bodies lose nothing."""
UNLIKE_LOCAL_SCALING = 0.01
"""Area over which sizes may change evenly in the registration of unlike shapes."""


@dataclass(frozen=True, eq=False)
class MatchTask:
    """Two shapes to match, and all that every step needs."""

    meshes: tuple[Mesh, Mesh]  # as they were given
    pair: VertexReindexing  # the prepared shapes, as given and cleaned
    config: Config
    landmarks: np.ndarray  # (l, 2): vertices of ``meshes``
    seed: int
    clock: StageTimer
    partial: MatchPart = field(default_factory=MatchPart)  # why the shapes were taken for whole

    @property
    def orientation(self) -> str:
        """The orientation that maps have by the settings; "preserving" unless they say "reversing"."""
        search = self.config.search
        return "reversing" if search is not None and search.orientation == "reversing" else "preserving"

    def shapes(self, orientation: str) -> tuple[Shape, Shape]:
        """Return both cleaned shapes; the target mirrored where the map is to its mirror image."""
        target = self.pair.target
        return self.pair.source, mirror_image(target) if orientation == "reversing" else target

    def result(self, points: np.ndarray, C: np.ndarray, local_confidence: np.ndarray, **fields: Any) -> Match:
        """Return the match of a point map of the cleaned shapes, with its functional map and local confidence."""
        k_t, k_s = C.shape
        points, precise_map = self.pair.given_points(points), fields.get("precise_map")
        if self.pair.is_divided and precise_map is not None:  # rounded once instead of twice
            points = np.where(points < 0, -1, nearest_vertices(precise_map, self.meshes[0]))
        bases = [shape.basis.truncate(k) for shape, k in zip(self.pair.given, (k_s, k_t), strict=True)]
        return Match(
            target_to_source=points,
            functional_map=self.pair.given_functional_map(points, C),
            source=self.meshes[0],
            target=self.meshes[1],
            basis_source=bases[0],
            basis_target=bases[1],
            eigenvalues_source=to_numpy(bases[0].eigenvalues),
            eigenvalues_target=to_numpy(bases[1].eigenvalues),
            local_confidence=self.pair.given_confidence(local_confidence),
            landmarks=self.landmarks,
            config=self.config,
            seed=self.seed,
            seconds=self.clock.seconds,
            source_file=ShapeFile.of(self.meshes[0]),
            target_file=ShapeFile.of(self.meshes[1]),
            _reindexing=self.pair,
            **fields,
        )


def refine_and_register(task: MatchTask, found: SearchResult, guidance: DescriptorGuidance | None) -> Match:
    """Refine the map of a search or of a fit on all vertices, register it, and return the match."""
    pair, config, shapes = task.pair, task.config, task.shapes(found.orientation)
    back = None
    if config.formulation.bidirectional:
        # A search refines its candidates in one direction; the other one starts from the adjoint.
        back = found.functional_map.T if found.fit is None or found.fit.back is None else found.fit.back
    adapted = adapt_settings(config, found, task.seed)
    refined = refine_map(
        found.functional_map,
        *shapes,
        adapted,
        raw=found.initialization == ONE_FIT,
        guidance=guidance,
        back=back,
        progress=task.clock.report,
    )
    task.clock.seconds.update(refined.seconds)
    final = register_map(refined.target_to_source, *shapes, adapted, task.clock, found.landmarks)
    registered, precise_map = final.registered_vertices, final.precise_map
    if registered is not None:
        registered = pair.given_registered(registered * MIRROR if found.orientation == "reversing" else registered)
    if precise_map is not None:
        precise_map = pair.given_precise_map(precise_map) if len(task.meshes[0].faces) else None
    raw, back_points, back_map = refined.raw_target_to_source, refined.source_to_target, refined.functional_map_back
    if back_points is not None:
        back_points = pair.given_points_back(back_points)
        back_map = None if back_map is None else pair.given_functional_map(back_points, back_map, back=True)
    torn_area = 0.0 if final.fit is None else low_confidence_area(shapes[1].mesh, final.local_confidence)
    is_refused = final.fit is not None and not final.fit.accepted
    torn_contacts = torn_contact_share(shapes[0].mesh, shapes[1].mesh, final.target_to_source)
    is_loose = torn_contacts > SCORE.max_torn_contacts or turned_by_symmetries(shapes[0].mesh) > SCORE.max_turned
    confidence, verdict = lower_probability(found.confidence, found.verdict, torn_area, is_refused, is_loose)
    return task.result(
        final.target_to_source,
        refined.functional_map,
        _doubt_exchanged(final.local_confidence, final.target_to_source, found, shapes[0].mesh),
        verdict=verdict,
        confidence=confidence,
        orientation=found.orientation,
        precise_map=precise_map,
        alternatives=tuple(pair.given_points(points) for points in found.alternatives),
        source_to_target=back_points,
        functional_map_back=back_map,
        score=MatchScore(
            found.scores,
            found.quality,
            found.deformation_energy,
            found.initialization,
            _still_contradicted(task, found, final.target_to_source, shapes[0].mesh),
        ),
        registration=MatchRegistration(registered, final.fit),
        partial=task.partial,
        fit=_fit_record(found, None if raw is None else pair.given_points(raw)),
    )


def _still_contradicted(task: MatchTask, found: SearchResult, points: np.ndarray, source: Mesh) -> np.ndarray:
    """Return the rejected landmarks (d,) that the point map on all vertices contradicts too."""
    rejected, pairs = found.rejected_landmarks, task.pair.clean_landmarks(task.landmarks)
    if len(rejected) == 0 or pairs is None or found.quality is None:
        return rejected
    pairs = pairs[rejected]
    errors = geodesic_distances(source, pairs[:, 0])[np.arange(len(pairs)), points[pairs[:, 1]]]
    return rejected[errors > max_landmark_error(found.quality)]


def _doubt_exchanged(confidence: np.ndarray, points: np.ndarray, found: SearchResult, source: Mesh) -> np.ndarray:
    """Return the local confidence (n_t,), lower where an alternative that casts a doubt goes elsewhere.

    An alternative that is better itself, as a map to the mirror image may be, changes nothing. Nor does one that goes
    elsewhere on most of the target: it says nothing of one region, and the map would seem torn.
    """
    for other, margin in zip(found.alternatives, found.doubts, strict=False):
        moved = np.linalg.norm(source.vertices[other] - source.vertices[points], axis=1) > SCORE.moved_distance
        if margin >= 0.0 and moved.mean() < 0.5:
            confidence = confidence * (1.0 - moved * np.exp(-margin / SCORE.calibration.tie))
    return confidence


def _fit_record(found: SearchResult, points: np.ndarray | None) -> MatchFit:
    """Return the record of the map before its refinement, with its point map, and of the fit behind it, if any."""
    fit = found.fit
    if fit is None:
        return MatchFit(found.functional_map, points)
    residuals = np.asarray(fit.solution.residuals, dtype=np.float64)
    residuals = residuals / (residuals[0] if len(residuals) and residuals[0] > 0 else 1.0)
    facts = residuals, fit.energies, fit.kernel, fit.rank, fit.n_operators, fit.weights
    size, status, steps = len(fit.functional_map), fit.solution.status, fit.solution.steps
    return MatchFit(found.functional_map, points, size, status, steps, *facts)


@dataclass(frozen=True, eq=False)
class PostprocessedMap:
    """A map on all vertices; made by :func:`refine_map`."""

    target_to_source: np.ndarray  # (n_t,): a source vertex for each target vertex
    functional_map: np.ndarray  # (k_t, k_s): of the point map
    raw_target_to_source: np.ndarray | None  # (n_t,): the point map before the refinement, if it was computed
    seconds: dict[str, float]
    source_to_target: np.ndarray | None = None  # (n_s,): the other direction, if both were refined
    functional_map_back: np.ndarray | None = None  # (k_s, k_t): its functional map


def refine_map(
    C: Array,
    source: Shape,
    target: Shape,
    config: Config,
    *,
    raw: bool = True,
    guidance: DescriptorGuidance | None = None,
    back: Array | None = None,
    progress: Progress | None = None,
) -> PostprocessedMap:
    """Return the point map of ``C (k_t, k_s)`` on all vertices, refined as ``config.refinement`` says.

    ``raw``: compute the point map before the refinement too. ``guidance``: for a refinement that takes guidance; by
    default that of SHOT, if both shapes have it. ``back (k_s, k_t)``: a map in the other direction to refine too:
    ZoomOut refines both together (:meth:`kfmaps.fmap.zoomout.ZoomOut.bidirectional`), ICP each by itself.
    """
    refine: Any = config.refinement
    clock = StageTimer(progress)
    bases = (source.basis, target.basis)
    if config.device != "cpu":
        bases = (bases[0].to(config.device), bases[1].to(config.device))
    C, points, backward = like(C, bases[0].functions), None, None
    back = None if back is None else like(back, C)
    with limit_threads(config.threads), one_blas_thread():
        if raw or refine is None:
            with clock("point map"):
                points = to_points(C, *bases)
        if refine is None:
            assert points is not None
            forward = Refined(C, points, ())
            if back is not None:
                backward = Refined(back, to_points(back, bases[1], bases[0]), ())
        else:
            report = partial(clock.report, "refinement")
            weight = getattr(refine, "descriptor_weight", 0)
            guided = {"guidance": guidance or descriptor_guidance(source.shot, target.shot)} if weight else {}
            with clock("refinement"):
                if back is not None and hasattr(refine, "bidirectional"):
                    forward, backward = refine.bidirectional(C, back, *bases, progress=report, **guided)
                else:
                    forward = refine(C, *bases, points=points, progress=report, **guided)
                    if back is not None:
                        swapped = {name: one and one.swapped() for name, one in guided.items()}
                        backward = refine(back, bases[1], bases[0], **swapped)
    ends = (None, None) if backward is None else (backward.target_to_source, to_numpy(backward.functional_map))
    return PostprocessedMap(forward.target_to_source, to_numpy(forward.functional_map), points, clock.seconds, *ends)


def adapt_settings(config: Config, found: SearchResult, seed: int) -> Config:
    """Return the settings of refinement and registration for a map; ``seed`` is added to that of the refinement.

    Between unlike shapes the refinement ends with fewer functions, and the registration lets sizes change.
    """
    refinement: Any = config.refinement
    registration: Any = config.registration
    if not found.is_near_isometric:
        if hasattr(refinement, "limited"):
            refinement = refinement.limited(UNLIKE_FUNCTIONS)
        if getattr(registration, "local_scaling", None) == 0:
            registration = replace(registration, local_scaling=UNLIKE_LOCAL_SCALING)
    if hasattr(refinement, "seed"):
        refinement = replace(refinement, seed=refinement.seed + seed)
    return replace(config, refinement=refinement, registration=registration)


@dataclass(frozen=True, eq=False)
class KnownMap:
    """A rough map, as a composition of other maps, with fields of its match."""

    points: np.ndarray  # (n_t,): a source vertex for each target vertex
    initialization: str
    orientation: Literal["preserving", "reversing"] = "preserving"
    verdict: str = "unchecked"
    confidence: float | None = None
    quality: float | None = None  # :attr:`kfmaps.matching.score.Quality.score`: a low one ends the refinement early
    alternatives: tuple[np.ndarray, ...] = ()


def match_from_map(
    source: Shape, target: Shape, known: KnownMap, config: Config | None = None, rng: int | np.random.Generator = 0
) -> Match:
    """Refine and register a ``known`` rough map as :func:`kfmaps.match` does with the map of a search."""
    config = config or Config()
    for shape in (source, target):
        check_prepared(shape, config)
    points = check_point_map(known.points, len(source.mesh.vertices), len(target.mesh.vertices))
    none = np.zeros((0, 2), dtype=np.int64)
    meshes = (source.given_mesh, target.given_mesh)
    task = MatchTask(meshes, reindexing(source, target, divided=True), config, none, seed_of(rng), StageTimer())
    shapes = task.shapes(known.orientation)
    size = min(FINE_FUNCTIONS, *(len(shape.basis.eigenvalues) for shape in shapes))
    bases = [shape.basis.truncate(size) for shape in shapes]
    C = to_numpy(to_functional(task.pair.clean_points(points), *bases))
    name, verdict, confidence = known.initialization, known.verdict, known.confidence
    found = SearchResult(C, name, None, verdict, confidence, orientation=known.orientation, quality=known.quality)
    result = refine_and_register(task, found, build_guidance(*shapes, found.landmarks))
    return replace(result, alternatives=known.alternatives)


def better_match(one: Match, other: Match) -> Match:
    """Return the match with the better :func:`registered_score`, with the seconds of ``one``; ``one`` if it is unknown.

    Between unlike shapes distances nearby change everywhere. After registration they change much only where a limb is
    torn or mapped elsewhere, which the score of a search does not show as well.
    """
    known = torn_area_fraction(one) is not None and torn_area_fraction(other) is not None
    return replace(other, seconds=one.seconds) if known and registered_score(other) > registered_score(one) else one


def final_score(match: Match) -> float:
    """Return the score of the match of a search, less the cost of its torn area."""
    return torn_score(match.score.scores[0], torn_area_fraction(match))


def registered_score(match: Match) -> float:
    """Return :func:`final_score` with the deformation energy of the match's own registration instead of the proxies'.

    A right map of a body with glued parts is torn where these meet, but bends the shape little.
    """
    energy, report = match.score.deformation_energy, match.registration.report
    if energy is None or report is None:
        return final_score(match)
    own = max(report.deformation_energy, MIN_ENERGY)
    return final_score(match) + deformation_cost(energy) - deformation_cost(own)


def torn_area_fraction(match: Match) -> float | None:
    """Return the share of the target where a registered match does not preserve distances nearby, from 0 to 1.

    Return ``None`` for a match without registration: there distances between unlike shapes change everywhere.
    """
    if match.registration.report is None or match._reindexing is None:
        return None
    return low_confidence_area(match._reindexing.given[1].mesh, match.local_confidence)


def torn_contact_share(source: Mesh, target: Mesh, points: np.ndarray) -> float:
    """Return the share of the contacts between pieces of the target that are between torn pieces, from 0 to 1.

    A contact is two near vertices of two pieces. The pieces are torn where the images of hardly any of their contacts
    are near each other, as where pieces that are alike are exchanged, or one is turned in its place. (A hand touches a
    hip in one pose alone, but an arm and a body also where they are joined.) ``points (n_t,)``: the image of each
    target vertex. Both meshes are of unit area.
    """
    label = component_areas(target)[0] if len(target.faces) else np.zeros(1)
    if label.max() == 0:
        return 0.0
    n, most, least, min_kept = len(target.vertices), 5000, 10, 0.1  # vertices, contacts, share of them
    some = np.arange(n) if n <= most else np.linspace(0, n - 1, most).astype(np.int64)
    contacts = some[KDTree(target.vertices[some]).query_pairs(SCORE.contact_distance, output_type="ndarray")]
    contacts = contacts[label[contacts[:, 0]] != label[contacts[:, 1]]]
    if len(contacts) < least:
        return 0.0
    images = source.vertices[points[contacts]]
    is_kept = np.linalg.norm(images[:, 0] - images[:, 1], axis=1) <= SCORE.moved_distance
    pair = np.unique(np.sort(label[contacts], axis=1), axis=0, return_inverse=True)[1].ravel()
    count, kept = np.bincount(pair), np.bincount(pair, is_kept)
    return float(count[kept < min_kept * count].sum() / len(contacts))


def turned_by_symmetries(mesh: Mesh) -> float:
    """Return how far the vertices of a mesh in pieces move on average where each is turned onto itself, in √area.

    Pieces of revolution, and those of two or more equal sides, may lie in several ways, between which little
    decides. Of a mesh in one piece, whose near-symmetries are compared as a whole, it is 0. ``mesh``: of unit area.
    """
    label, areas = component_areas(mesh) if len(mesh.faces) else (np.zeros(0), np.zeros(1))
    return sum(float(areas[i]) * _turned(mesh.vertices[label == i]) for i in np.flatnonzero(areas) if len(areas) > 1)


def _turned(vertices: np.ndarray) -> float:
    """Return the greatest mean distance by which a part of a turn moves ``vertices (n, 3)`` onto themselves, or 0."""
    orders, most, max_gap = (2, 3, 4, 5, 6, 7), 1000, 0.01  # max_gap: of the largest distance from the centre
    centred = vertices - vertices.mean(axis=0)
    axes = np.linalg.eigh(centred.T @ centred)[1].T
    tree, some = KDTree(centred), centred[:: 1 + len(centred) // most]
    max_distance, moved = max_gap * np.linalg.norm(centred, axis=1).max(), 0.0
    for axis, order in product(axes, orders):
        images = some @ Rotation.from_rotvec(2 * np.pi / order * axis).as_matrix()
        if np.asarray(tree.query(images)[0]).mean() <= max_distance:
            moved = max(moved, float(np.linalg.norm(images - some, axis=1).mean()))
    return moved


def low_confidence_area(target: Mesh, local_confidence: np.ndarray) -> float:
    """Return the share of the target's area where the local confidence (n_t,) is low, from 0 to 1."""
    areas = vertex_areas(target)
    return float(areas[local_confidence < SCORE.torn_confidence].sum() / areas.sum())
