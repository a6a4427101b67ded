"""The one call."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np

from kfmaps._arrays import check, refuse, seed_of, to_numpy
from kfmaps._progress import Progress
from kfmaps._stage_timer import StageTimer
from kfmaps._threads import available_cores, parallel
from kfmaps.config import Config
from kfmaps.fmap.convert import check_point_map, to_functional
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance, combine_guidance, descriptor_guidance
from kfmaps.fmap.precise import PointMap, to_precise_map
from kfmaps.fmap.refine import ZoomOut
from kfmaps.fmap.transfer import transfer_functions
from kfmaps.geometry.eigen.eigensolver import THREADED
from kfmaps.geometry.mesh import MIRROR, Mesh, vertex_areas
from kfmaps.matching.fit import Fit, check_landmark_pairs, fit
from kfmaps.matching.landmark_evidence import LEAD, LESS, build_guidance
from kfmaps.matching.memory import check_match_memory
from kfmaps.matching.partial.detect import detect_part
from kfmaps.matching.partial.match_partial import PartialMatch, match_partial, reason
from kfmaps.matching.postprocess import refine_map
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.reindexing import VertexReindexing, reindexing
from kfmaps.matching.score import SCORE, torn_score
from kfmaps.matching.search import SearchResult, adapt_refinement, adapt_registration, near_isometric, retry, search_map
from kfmaps.registration.accept import RegistrationReport, register_map
from kfmaps.registration.alternating_registration import WEIGHT, position_normal_guidance
from kfmaps.shape import Shape, mirror_image, prepare

ONE_FIT = "one fit"
CONTINUED = 80
"""Functions of a map that is finished from its points, as many as a search hands on."""


@dataclass(frozen=True, eq=False)
class Match:
    """The answer of a match.

    Attributes
    ----------
    target_to_source : (n_t,) int64
        A source vertex for each target vertex, refined when the configuration says so; −1 where there is none, which
        only parts have.
    functional_map : (k_t, k_s) float64
        Carries coefficients of functions from source to target; of the refined map.
    eigenvalues_s, eigenvalues_t : (k_s,), (k_t,) float64
        Of the shapes at unit area, as many as ``functional_map`` has columns and rows.
    verdict : "landmarks", "sure", "likely", "ambiguous", "unlikely" or "unchecked"
    config : Config
    seconds : dict of str to float
        Per stage.
    origin : str
        What the refined map started from: "one fit", or the name of a candidate of the search.
    raw_functional_map : (k, k) float64
        What the refinement started from: of one fit the minimiser, of a search the best candidate.
    raw_target_to_source : (n_t,) int64 or None
        Its point map on all vertices; not worked out by a search.
    fit : Fit or None
        The fit that the map started from: that of the configuration, or a small one (``fit.config``) of the search;
        ``None`` where the search's best candidate started from signs of the low functions alone.
    local_confidence : (n_t,) float64
        How well the map keeps distances around each target vertex, 0 to 1, 0 where nothing can be told; see
        :mod:`kfmaps.fmap.confidence`.
    confidence : float or None
        Of a search, the probability that the map is right; see :mod:`kfmaps.matching.score`.
    scores : tuple of float
        Of a search: of the map and of each runner-up, higher is better.
    runners_up : tuple of arrays (n_t,)
        Of a search: the distinct other maps, best first.
    doubted : (d,) int64
        Of a search with landmarks: the numbers, from 0, of those that the map contradicts; they had no say.
    orientation : "kept" or "reversed"
        Whether it is a map to the target or, of a left and a right part say, to its mirror image.
    source_to_target : (n_s,) int64 or None
        A target vertex for each source vertex, where ``config.formulation`` asks for both directions.
    map_back : (k_s, k_t) float64 or None
        Its functional map.
    border : Border or None
        Both shapes, for :meth:`transfer` and :meth:`precise`.
    place : PointMap or None
        A point inside a triangle of the source for each target vertex, where the non-rigid fit was kept.
    bent : (n_s, 3) float64 or None
        The source's vertices in the shape of the target, where that fit was kept: on the target scaled and centred as
        by :func:`kfmaps.geometry.mesh.unit_area`.
    bend : Bend or None
        What that fit tells of the map, whether it was kept or not, and why not; ``None`` where none was made.
    partial : "none", "source", "target" or "both"
        Which shape was taken for a part of the other.
    partial_reason : str
        Why, in words; empty where nobody asked.
    part_scale : float or None
        √area of the part over that of the whole, as found.
    quality : float or None
        Of a search: the score of the map itself, :attr:`kfmaps.matching.score.Quality.score`, 0 at best.
    bending : float or None
        Of a search: how far the shapes must bend to follow it,
        :func:`kfmaps.registration.deformation_energy.deformation_energy`; 0 for a motion.
    overlap_source, overlap_target : (n_s,), (n_t,) float64 or None
        Probability of each vertex to be in the part that both have; ``None`` where both were taken for whole.
    """

    target_to_source: np.ndarray
    functional_map: np.ndarray
    eigenvalues_s: np.ndarray
    eigenvalues_t: np.ndarray
    verdict: str
    config: Config
    seconds: dict[str, float]
    initialization: str
    raw_functional_map: np.ndarray
    raw_target_to_source: np.ndarray | None
    fit: Fit | None
    local_confidence: np.ndarray
    confidence: float | None = None
    scores: tuple[float, ...] = ()
    alternatives: tuple[np.ndarray, ...] = ()
    rejected_landmarks: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    orientation: str = "kept"
    source_to_target: np.ndarray | None = None
    functional_map_back: np.ndarray | None = None
    _reindexing: VertexReindexing | None = None
    precise_map: PointMap | None = None
    registered_vertices: np.ndarray | None = None
    registration: RegistrationReport | None = None
    partial: str = "none"
    partial_reason: str = ""
    part_scale: float | None = None
    overlap_source: np.ndarray | None = None
    overlap_target: np.ndarray | None = None
    quality: float | None = None
    deformation_energy: float | None = None

    def precise(self) -> PointMap:
        """A point inside a triangle of the source for each target vertex: finer than ``target_to_source``.

        Of the non-rigid fit, where it was kept; else the exact nearest point of the source's surface in the spectral
        embedding (:func:`kfmaps.fmap.precise.to_precise_map`), which is found anew with every call.

        Raises
        ------
        InvalidInput
            When one of the shapes is a point cloud.
        """
        if self.precise_map is not None:
            return self.precise_map
        across = self._reindexing
        if across is None:
            raise refuse("precise", "a match with its shapes", "one without", "match them again")
        for shape in (across.source, across.target):
            if len(shape.mesh.faces) == 0:
                raise refuse(shape.name, "a surface with triangles", "a point cloud", "use target_to_source")
        refine, beside = self.config.refinement, None
        mirrored = self.orientation == "reversed"
        if isinstance(refine, ZoomOut) and refine.guidance and not mirrored:
            guiding = descriptor_guidance(across.source.shot, across.target.shot)
            beside = guiding and guiding.embedding_columns(refine.guidance, across.source.basis, across.target.basis)
        bases, faces = (across.source.basis, across.target.basis), across.source.mesh.faces
        return across.place(to_precise_map(self.functional_map, *bases, faces, self.config.threads, beside))

    def transfer(self, values: Any, products: int | None = 20) -> np.ndarray:
        """Functions ``values (n_s, d)`` or ``(n_s,)`` on the source, carried to the target by the functional map.

        Of a part and a whole they go by points inside triangles, and are NaN where there is no counterpart: what is
        outside the common part is in every coefficient.

        ``products`` of the first basis functions with each other are carried too, beyond what the map alone can; see
        :func:`kfmaps.fmap.transfer.transfer_functions`. Labels, which are no functions, go by points:
        ``values[match.target_to_source]``.

        Raises
        ------
        InvalidInput
            When there is not one row per source vertex.
        """
        across = self._reindexing
        if across is None:
            raise refuse("transfer", "a match with its shapes", "one without", "match them again")
        values = np.asarray(values, dtype=np.float64)
        n = len(across.part_s.to_clean)
        check(values, "values", shape=(n, *(None,) * (values.ndim - 1)), remedy="give one row per source vertex")
        if self.partial != "none" and self.precise_map is not None:
            corners = values[across.outside[0].mesh.faces[self.precise_map.faces]]
            mixed = np.einsum("ti,ti...->t...", self.precise_map.weights, corners)
            mixed[self.target_to_source < 0] = np.nan
            return mixed
        bases = (across.source.basis, across.target.basis)
        return transfer_functions(values[across.part_s.to_original], self.functional_map, *bases, products)[
            across.part_t.to_clean
        ]


def match(
    source: Mesh | Shape,
    target: Mesh | Shape,
    config: Config | None = None,
    *,
    landmarks: Any = None,
    descriptors: tuple[Any, Any] | None = None,
    rng: int | np.random.Generator | None = 0,
    progress: Progress | None = None,
    probes: tuple[ShapeSamples, ShapeSamples] | None = None,
) -> Match:
    """Find for each vertex of ``target`` the corresponding vertex of ``source``.

    Many candidate maps are made and compared (:mod:`kfmaps.matching.search`), and the answer says how sure it is.
    Landmarks, as many or few as there are, steer the candidates and help to choose between them; those that are
    contradicted by a map that keeps to most of the others are named and left out. With ``config.search`` of ``None``
    one fit is made, in which landmarks settle which way round a symmetric shape goes.

    Where ``config.partial`` says that one shape is a part of the other, or their boundaries and how one fits into the
    other do, it is placed there by distances and SHOT (:mod:`kfmaps.matching.partial`) and vertices without a
    counterpart have −1.

    Parameters
    ----------
    source, target : Mesh or Shape
        A :class:`Shape` from :func:`prepare` saves the work that depends on one shape alone; it must come from the
        same settings of the basis, SHOT and the numbers of functions.
    config : Config, optional
        ``Config()`` when not given; ``Config.single_fit()``, one fit, with descriptors of the user's own.
    landmarks : (l, 2) whole numbers, optional
        Pairs "source vertex, target vertex", 0-based.
    descriptors : pair of arrays (n_s, d), (n_t, d), optional
        Of the user's own, used beside those that the configuration names.
    rng : seed or Generator
        The same seed gives the same answer.
    progress : callable, optional
        ``progress(stage, done)`` with done from 0 to 1.
    probes : pair of Probe, optional
        What the search with this ``rng`` needs to know of each shape, from
        :func:`kfmaps.matching.search.scoring_samples`: saves
        an eighth of the time where a shape is matched many times, and changes nothing.

    Raises
    ------
    InvalidInput
        When a mesh, the landmarks or the descriptors cannot be used; the message says what to do.
    NotConverged
        When the eigensolver misses its tolerance.
    """
    config = config or default_config(descriptors)
    marks = landmarks if has_landmarks(landmarks) else None
    shapes = prepare_both(source, target, config, progress=progress)
    across = reindexing(shapes[0], shapes[1])
    marks, descriptors = across.landmarks(marks), across.descriptors(descriptors)
    n_s, n_t = (len(shape.mesh.vertices) for shape in shapes)
    check_match_memory(config, n_s, n_t, 0 if marks is None else len(marks))
    shapes = [across.source, across.target]
    clock = StageTimer(progress)
    seed = seed_of(rng)
    more = {"descriptors": descriptors, "rng": seed, "progress": progress}
    which, why = config.partial.which, "as asked for"
    if which == "auto":
        seen = detect_part(shapes[0].mesh, shapes[1].mesh)
        which, why = seen.which, seen.reason
    if which != "none":
        with clock("parts"):
            part = match_partial(shapes[0], shapes[1], config, which, landmarks=marks, rng=seed, progress=progress)
        if config.partial.which != "auto" or (not part.whole and part.verdict != "unlikely"):
            return _parted(part, why, across, shapes, config, clock)
        why = f"taken for whole: {why}, but " + ("each covers all of the other" if part.whole else "it fits nowhere")
    led = None
    if config.search is not None:
        if config.search.orientation == "reversed":
            shapes[1] = mirror_image(shapes[1])
            probes = None  # they are of the shapes as they were given
        with clock("candidates"):
            found = search_map(shapes[0], shapes[1], config, landmarks=marks, probes=probes, **more)
        if found.orientation == "reversed" and config.search.orientation != "reversed":
            shapes[1] = mirror_image(shapes[1])
        led = _guidance(found, shapes)
    else:
        one = fit(shapes[0], shapes[1], config, landmarks=marks, **more)
        clock.seconds.update(one.seconds)
        verdict, pairs = "unchecked" if marks is None else "landmarks", check_landmark_pairs(marks, *shapes)
        found = SearchResult(one.functional_map, ONE_FIT, one, verdict, landmarks=pairs)
    back = None
    if config.formulation.directions == "both":
        # The adjoint, where a search has found the map: its candidates are refined one way.
        back = found.fit.back if found.initialization == ONE_FIT and found.fit is not None else found.functional_map.T
    ended = _refine_and_register(found, across, shapes, config, clock, led, back, seed)
    for i in range(len(found.retries)):
        if (torn_area_fraction(ended) or 0.0) <= SCORE.max_torn_area:
            break
        with clock(f"another way, {i + 1}"):
            # With a lower score it would not be worth more even if nothing of it were torn.
            told = retry(found, i, final_score(ended))
            if told is not None:
                back = None if back is None else told.functional_map.T
                ending = StageTimer(progress)
                ended = better_match(
                    ended,
                    _refine_and_register(told, across, shapes, config, ending, _guidance(told, shapes), back, seed),
                )
    return replace(ended, partial_reason=why) if config.partial.which == "auto" else ended


def _guidance(found: SearchResult, shapes: list[Shape]) -> DescriptorGuidance | None:
    """What leads the refinement of a map that a search has found."""
    tips = found.extremities and found.extremities.guide(shapes[0].mesh, shapes[1].mesh)
    led = build_guidance(shapes[0], shapes[1], found.landmarks, tips, lead=LEAD if near_isometric(found) else LESS)
    if found.registered_vertices is None:
        return led
    meshes = [shape.mesh for shape in shapes]
    moved = 1 if found.swapped else 0
    meshes[moved] = Mesh(found.registered_vertices, meshes[moved].faces)
    return combine_guidance([(1.0, led), (WEIGHT, position_normal_guidance(meshes[0], meshes[1]))])


def better_match(one: Match, other: Match) -> Match:
    """The ``other`` of two matches of the same shapes where it is worth more, else ``one``; with its seconds.

    Between shapes of other proportions distances nearby change everywhere; after the non-rigid fit they are kept badly
    only where a limb is torn or has been sent elsewhere, which no score of the search tells so well. Without that fit
    nothing can be told.
    """
    if torn_area_fraction(one) is None or torn_area_fraction(other) is None or final_score(other) <= final_score(one):
        return one
    return replace(other, seconds=one.seconds)


def final_score(match: Match) -> float:
    """The score of a match that a search has found, less the cost of its torn area."""
    return torn_score(match.scores[0], torn_area_fraction(match))


def torn_area_fraction(match: Match) -> float | None:
    """The share of the target around which a match with a non-rigid fit keeps distances badly, from 0 to 1.

    Where the fit was refused that of the map before it, which is more. ``None`` where none was made, before which
    distances between shapes of other proportions are kept badly everywhere.
    """
    if match.registration is None or match._reindexing is None:
        return None
    areas = vertex_areas(match._reindexing.outside[1].mesh)
    return float(areas[match.local_confidence < SCORE.torn_confidence].sum() / areas.sum())


def _parted(
    part: PartialMatch, why: str, across: VertexReindexing, shapes: list[Shape], config: Config, clock: StageTimer
) -> Match:
    """The match of a part and a whole."""
    overlaps = across.overlap(part.overlap_source, part.overlap_target)
    return _build_result(
        part.target_to_source,
        part.functional_map,
        part.local_confidence,
        across,
        shapes,
        config,
        clock,
        precise_map=part.precise_map,
        registered_vertices=part.registered_vertices,
        verdict=part.verdict,
        initialization="a part bent onto the other",
        raw_functional_map=part.functional_map,
        raw_target_to_source=None,
        fit=None,
        confidence=part.confidence,
        scores=part.scores,
        rejected_landmarks=part.rejected_landmarks,
        partial=part.part,
        partial_reason=reason(part, why),
        part_scale=part.scale,
        overlap_source=overlaps[0],
        overlap_target=overlaps[1],
    )


def match_from_map(
    source: Shape,
    target: Shape,
    points: np.ndarray,
    config: Config | None = None,
    *,
    origin: str,
    orientation: Literal["kept", "reversed"] = "kept",
    verdict: str = "unchecked",
    confidence: float | None = None,
    quality: float | None = None,
    runners_up: tuple[np.ndarray, ...] = (),
    rng: int | np.random.Generator | None = 0,
    progress: Progress | None = None,
) -> Match:
    """A map that is known but for its details, finished as :func:`match` finishes the one that it has found.

    Parameters
    ----------
    source, target : Shape
    points : (n_t,) whole numbers
        A source vertex for each target vertex: of a composition of other maps, say.
    origin : str
        Where it comes from, for :attr:`Match.initialization`.
    orientation : "kept" or "reversed"
        Whether it is a map to the target or to its mirror image.
    verdict, confidence, runners_up
        For the fields of the match.
    quality : float, optional
        :attr:`kfmaps.matching.score.Quality.score` of ``points``: where shapes differ much the refinement ends early.

    Raises
    ------
    InvalidInput
        When the shapes were prepared otherwise, or the points are none of the source.
    """
    config = config or Config()
    for shape in (source, target):
        check_prepared(shape, config)
    points = check_point_map(points, len(source.mesh.vertices), len(target.mesh.vertices))
    across, clock = reindexing(source, target), StageTimer(progress)
    shapes = [across.source, mirror_image(across.target) if orientation == "reversed" else across.target]
    within = across.part_s.to_clean[points[across.part_t.to_original]]
    size = min(CONTINUED, *(len(shape.basis.eigenvalues) for shape in shapes))
    C = to_numpy(to_functional(within, *(shape.basis.truncate(size) for shape in shapes)))
    found = SearchResult(C, origin, None, verdict, confidence, orientation=orientation, quality=quality)
    led = build_guidance(shapes[0], shapes[1], found.landmarks)
    back = C.T if config.formulation.directions == "both" else None
    return replace(
        _refine_and_register(found, across, shapes, config, clock, led, back, seed_of(rng)), alternatives=runners_up
    )


def _refine_and_register(
    found: SearchResult,
    across: VertexReindexing,
    shapes: list[Shape],
    config: Config,
    clock: StageTimer,
    led: DescriptorGuidance | None,
    back: np.ndarray | None,
    seed: int,
) -> Match:
    """The match of a map that is ``found`` between two ``shapes`` inside their border, the target turned as it says."""
    single = found.initialization == ONE_FIT
    ending = replace(
        config, refinement=adapt_refinement(config.refinement, found), finish=adapt_registration(config.finish, found)
    )
    end = refine_map(
        found.functional_map,
        shapes[0],
        shapes[1],
        ending,
        raw=single,
        led=led,
        back=back,
        rng=seed,
        progress=clock.report,
    )
    clock.seconds.update(end.seconds)
    last = register_map(end.target_to_source, shapes[0], shapes[1], ending, clock, found.landmarks)
    bent = last.registered_vertices
    if bent is not None and found.orientation == "reversed":
        bent = bent * MIRROR
    return _build_result(
        last.target_to_source,
        end.functional_map,
        last.local_confidence,
        across,
        shapes,
        config,
        clock,
        precise_map=last.precise_map,
        registered_vertices=bent,
        verdict=found.verdict,
        initialization=found.initialization,
        raw_functional_map=found.functional_map,
        raw_target_to_source=None if end.raw_target_to_source is None else across.points(end.raw_target_to_source),
        fit=found.fit,
        confidence=found.confidence,
        scores=found.scores,
        alternatives=tuple(across.points(points) for points in found.runners_up),
        rejected_landmarks=found.rejected_landmarks,
        orientation=found.orientation,
        source_to_target=None if end.source_to_target is None else across.points_back(end.source_to_target),
        functional_map_back=end.functional_map_back,
        registration=last.fit,
        quality=found.quality,
        deformation_energy=found.deformation_energy,
    )


def _build_result(
    points: np.ndarray,
    C: np.ndarray,
    trust: np.ndarray,
    across: VertexReindexing,
    shapes: list[Shape],
    config: Config,
    clock: StageTimer,
    *,
    precise_map: PointMap | None,
    registered_vertices: np.ndarray | None,
    **more: Any,
) -> Match:
    """The record of a map that was made inside its border: what is given per vertex goes out to the shapes as given."""
    k_t, k_s = C.shape
    return Match(
        target_to_source=across.points(points),
        functional_map=C,
        eigenvalues_s=shapes[0].basis.eigenvalues[:k_s],
        eigenvalues_t=shapes[1].basis.eigenvalues[:k_t],
        config=config,
        seconds=clock.seconds,
        local_confidence=across.trust(trust),
        _reindexing=across,
        precise_map=None if precise_map is None else across.place(precise_map),
        registered_vertices=None if registered_vertices is None else across.bent(registered_vertices),
        **more,
    )


def check_prepared(shape: Shape, config: Config) -> None:
    """Raise :class:`InvalidInput` when ``shape`` was prepared with other settings than ``config`` needs."""
    remedy = "prepare it with the configuration that it is matched with"
    have = shape.basis.functions.shape[1]
    if have < config.eigenfunctions:
        raise refuse(shape.name, f"a shape prepared with {config.eigenfunctions} eigenfunctions", f"{have}", remedy)
    if shape.laplacian != config.basis.laplacian:
        wanted = f"a shape prepared with the {config.basis.laplacian} Laplacian"
        raise refuse(shape.name, wanted, f"the {shape.laplacian} one", remedy)
    if config.descriptors.shot and len(shape.mesh.faces) and shape.shot_radius != config.descriptors.shot_radius:
        wanted = f"a shape prepared with SHOT of radius {config.descriptors.shot_radius:g}"
        got = "one without" if shape.shot_radius is None else f"radius {shape.shot_radius:g}"
        raise refuse(shape.name, wanted, got, remedy)


def prepare_both(
    source: Mesh | Shape,
    target: Mesh | Shape,
    config: Config,
    names: tuple[str, str] = ("source", "target"),
    progress: Progress | None = None,
) -> list[Shape]:
    """Both shapes; side by side where they are small, since one small eigenproblem has no use for several cores.

    What is a :class:`Shape` already is checked against ``config`` and handed on.
    """
    workers = config.threads or available_cores()
    meshes = [part for part in (source, target) if isinstance(part, Mesh)]
    aside = len(meshes) == 2 and max(len(mesh.vertices) for mesh in meshes) < THREADED
    share = replace(config, threads=max(1, workers // 2)) if aside else config

    def ready(part: Mesh | Shape, name: str) -> Shape:
        if isinstance(part, Mesh):
            return prepare(part, share, name=name, progress=progress)
        check_prepared(part, config)
        return part

    both = ((source, names[0]), (target, names[1]))
    return parallel(lambda item: ready(*item), both, min(workers, 2) if aside else 1)


def has_landmarks(landmarks: Any) -> bool:
    """Whether there is at least one pair."""
    return landmarks is not None and np.asarray(landmarks).size > 0


def default_config(descriptors: Any = None) -> Config:
    """What :func:`match` uses when no configuration is given."""
    return Config.single_fit() if descriptors is not None else Config()
