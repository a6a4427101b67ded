"""The one call."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np

from kfmaps._arrays import check, refuse, seed_of, to_numpy
from kfmaps._progress import Progress
from kfmaps._stage_timer import Clock
from kfmaps._threads import available_cores, parallel
from kfmaps.config import Config
from kfmaps.fmap.convert import check_point_map, to_functional
from kfmaps.fmap.descriptor_guidance import Guide, guide, joined
from kfmaps.fmap.precise import PointMap, to_places
from kfmaps.fmap.refine import ZoomOut
from kfmaps.fmap.transfer import carried
from kfmaps.geometry.eigen.eigensolver import THREADED
from kfmaps.geometry.mesh import MIRROR, Mesh, vertex_areas
from kfmaps.matching.fit import Fit, checked_landmarks, fit
from kfmaps.matching.landmark_evidence import LEAD, LESS, leading
from kfmaps.matching.memory import check_demand
from kfmaps.matching.partial.detect import suspicion
from kfmaps.matching.partial.match_partial import Partly, partly, reason
from kfmaps.matching.postprocess import finished
from kfmaps.matching.quality import Probe
from kfmaps.matching.reindexing import Border, border
from kfmaps.matching.search import Found, alike, choose, closing, loosened
from kfmaps.registration.accept import Bend, placed
from kfmaps.registration.alternating_registration import WEIGHT, lying
from kfmaps.shape import Shape, mirror_image, prepare

ONE_FIT = "one fit"
CONTINUED = 80
"""Functions of a map that is finished from its points, as many as a search hands on."""
BADLY, TEAR = 0.5, 25.0
"""Confidence of a vertex around which distances are kept badly, and what the score loses where all of the target is so:
with less than 20 a torn map of a dog and a cat stays, with more than 35 front and back of a gorilla may change."""
TORN = 0.04
"""The share from which other maps are tried at all."""


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
    verdict : "landmarks", "sure", "ambiguous", "poor" or "unchecked"
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
        Of a search, the probability that the map is right; see :mod:`kfmaps.matching.calibration`.
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
        Of a search: the score of the map itself, :attr:`kfmaps.matching.quality.Quality.score`, 0 at best.
    bending : float or None
        Of a search: how far the shapes must bend to follow it,
        :func:`kfmaps.registration.deformation_energy.bending`; 0 for a motion.
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
    origin: str
    raw_functional_map: np.ndarray
    raw_target_to_source: np.ndarray | None
    fit: Fit | None
    local_confidence: np.ndarray
    confidence: float | None = None
    scores: tuple[float, ...] = ()
    runners_up: tuple[np.ndarray, ...] = ()
    doubted: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    orientation: str = "kept"
    source_to_target: np.ndarray | None = None
    map_back: np.ndarray | None = None
    border: Border | None = None
    place: PointMap | None = None
    bent: np.ndarray | None = None
    bend: Bend | None = None
    partial: str = "none"
    partial_reason: str = ""
    part_scale: float | None = None
    overlap_source: np.ndarray | None = None
    overlap_target: np.ndarray | None = None
    quality: float | None = None
    bending: float | None = None

    def precise(self) -> PointMap:
        """A point inside a triangle of the source for each target vertex: finer than ``target_to_source``.

        Of the non-rigid fit, where it was kept; else the exact nearest point of the source's surface in the spectral
        embedding (:func:`kfmaps.fmap.precise.to_places`), which is found anew with every call.

        Raises
        ------
        InvalidInput
            When one of the shapes is a point cloud.
        """
        if self.place is not None:
            return self.place
        across = self.border
        if across is None:
            raise refuse("precise", "a match with its shapes", "one without", "match them again")
        for shape in (across.source, across.target):
            if len(shape.mesh.faces) == 0:
                raise refuse(shape.name, "a surface with triangles", "a point cloud", "use target_to_source")
        refine, beside = self.config.refinement, None
        mirrored = self.orientation == "reversed"
        if isinstance(refine, ZoomOut) and refine.guidance and not mirrored:
            guiding = guide(across.source.shot, across.target.shot)
            beside = guiding and guiding.beside(refine.guidance, across.source.basis, across.target.basis)
        bases, faces = (across.source.basis, across.target.basis), across.source.mesh.faces
        return across.place(to_places(self.functional_map, *bases, faces, self.config.threads, beside))

    def transfer(self, values: Any, products: int | None = 20) -> np.ndarray:
        """Functions ``values (n_s, d)`` or ``(n_s,)`` on the source, carried to the target by the functional map.

        Of a part and a whole they go by points inside triangles, and are NaN where there is no counterpart: what is
        outside the common part is in every coefficient.

        ``products`` of the first basis functions with each other are carried too, beyond what the map alone can; see
        :func:`kfmaps.fmap.transfer.carried`. Labels, which are no functions, go by points:
        ``values[match.target_to_source]``.

        Raises
        ------
        InvalidInput
            When there is not one row per source vertex.
        """
        across = self.border
        if across is None:
            raise refuse("transfer", "a match with its shapes", "one without", "match them again")
        values = np.asarray(values, dtype=np.float64)
        n = len(across.part_s.number)
        check(values, "values", shape=(n, *(None,) * (values.ndim - 1)), remedy="give one row per source vertex")
        if self.partial != "none" and self.place is not None:
            corners = values[across.outside[0].mesh.faces[self.place.faces]]
            mixed = np.einsum("ti,ti...->t...", self.place.weights, corners)
            mixed[self.target_to_source < 0] = np.nan
            return mixed
        bases = (across.source.basis, across.target.basis)
        return carried(values[across.part_s.kept], self.functional_map, *bases, products)[across.part_t.number]


def match(
    source: Mesh | Shape,
    target: Mesh | Shape,
    config: Config | None = None,
    *,
    landmarks: Any = None,
    descriptors: tuple[Any, Any] | None = None,
    rng: int | np.random.Generator | None = 0,
    progress: Progress | None = None,
    probes: tuple[Probe, Probe] | None = None,
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
        What the search with this ``rng`` needs to know of each shape, from :func:`kfmaps.matching.search.probed`: saves
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
    across = border(shapes[0], shapes[1])
    marks, descriptors = across.landmarks(marks), across.descriptors(descriptors)
    n_s, n_t = (len(shape.mesh.vertices) for shape in shapes)
    check_demand(config, n_s, n_t, 0 if marks is None else len(marks))
    shapes = [across.source, across.target]
    clock = Clock(progress)
    seed = seed_of(rng)
    more = {"descriptors": descriptors, "rng": seed, "progress": progress}
    which, why = config.partial.which, "as asked for"
    if which == "auto":
        seen = suspicion(shapes[0].mesh, shapes[1].mesh)
        which, why = seen.which, seen.why
    if which != "none":
        with clock("parts"):
            part = partly(shapes[0], shapes[1], config, which, landmarks=marks, rng=seed, progress=progress)
        if config.partial.which != "auto" or (not part.whole and part.verdict != "poor"):
            return _parted(part, why, across, shapes, config, clock)
        why = f"taken for whole: {why}, but " + ("each covers all of the other" if part.whole else "it fits nowhere")
    led = None
    if config.search is not None:
        if config.search.orientation == "reversed":
            shapes[1] = mirror_image(shapes[1])
            probes = None  # they are of the shapes as they were given
        with clock("candidates"):
            found = choose(shapes[0], shapes[1], config, landmarks=marks, probes=probes, **more)
        if found.orientation == "reversed" and config.search.orientation != "reversed":
            shapes[1] = mirror_image(shapes[1])
        led = _led(found, shapes)
    else:
        one = fit(shapes[0], shapes[1], config, landmarks=marks, **more)
        clock.seconds.update(one.seconds)
        verdict, pairs = "unchecked" if marks is None else "landmarks", checked_landmarks(marks, *shapes)
        found = Found(one.functional_map, ONE_FIT, one, verdict, landmarks=pairs)
    back = None
    if config.formulation.directions == "both":
        # The adjoint, where a search has found the map: its candidates are refined one way.
        back = found.fit.back if found.origin == ONE_FIT and found.fit is not None else found.functional_map.T
    ended = _ended(found, across, shapes, config, clock, led, back, seed)
    for i, way in enumerate(found.again, 1):
        if (torn(ended) or 0.0) <= TORN:
            break
        with clock(f"another way, {i}"):
            # With a lower score it would not be worth more even if nothing of it were torn.
            told = way(worth(ended))
            if told is not None:
                back = None if back is None else told.functional_map.T
                ending = Clock(progress)
                ended = worthier(ended, _ended(told, across, shapes, config, ending, _led(told, shapes), back, seed))
    return replace(ended, partial_reason=why) if config.partial.which == "auto" else ended


def _led(found: Found, shapes: list[Shape]) -> Guide | None:
    """What leads the refinement of a map that a search has found."""
    tips = found.limbs and found.limbs.guide(shapes[0].mesh, shapes[1].mesh)
    led = leading(shapes[0], shapes[1], found.landmarks, tips, lead=LEAD if alike(found) else LESS)
    if found.bent is None:
        return led
    meshes = [shape.mesh for shape in shapes]
    moved = 1 if found.backwards else 0
    meshes[moved] = Mesh(found.bent, meshes[moved].faces)
    return joined([(1.0, led), (WEIGHT, lying(meshes[0], meshes[1]))])


def worthier(one: Match, other: Match) -> Match:
    """The ``other`` of two matches of the same shapes where it is worth more, else ``one``; with its seconds.

    Between shapes of other proportions distances nearby change everywhere; after the non-rigid fit they are kept badly
    only where a limb is torn or has been sent elsewhere, which no score of the search tells so well. Without that fit
    nothing can be told.
    """
    if torn(one) is None or torn(other) is None or worth(other) <= worth(one):
        return one
    return replace(other, seconds=one.seconds)


def worth(match: Match) -> float:
    """The score of a match that a search has found, less :data:`TEAR` times what is torn."""
    return match.scores[0] - TEAR * (torn(match) or 0.0)


def torn(match: Match) -> float | None:
    """The share of the target around which a match with a non-rigid fit keeps distances badly, from 0 to 1.

    Where the fit was refused that of the map before it, which is more. ``None`` where none was made, before which
    distances between shapes of other proportions are kept badly everywhere.
    """
    if match.bend is None or match.border is None:
        return None
    areas = vertex_areas(match.border.outside[1].mesh)
    return float(areas[match.local_confidence < BADLY].sum() / areas.sum())


def _parted(part: Partly, why: str, across: Border, shapes: list[Shape], config: Config, clock: Clock) -> Match:
    """The match of a part and a whole."""
    overlaps = across.overlap(part.overlap_source, part.overlap_target)
    return _filled(
        part.target_to_source,
        part.functional_map,
        part.trust,
        across,
        shapes,
        config,
        clock,
        place=part.place,
        bent=part.bent,
        verdict=part.verdict,
        origin="a part bent onto the other",
        raw_functional_map=part.functional_map,
        raw_target_to_source=None,
        fit=None,
        confidence=part.confidence,
        scores=part.scores,
        doubted=part.doubted,
        partial=part.part,
        partial_reason=reason(part, why),
        part_scale=part.scale,
        overlap_source=overlaps[0],
        overlap_target=overlaps[1],
    )


def continued(
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
        Where it comes from, for :attr:`Match.origin`.
    orientation : "kept" or "reversed"
        Whether it is a map to the target or to its mirror image.
    verdict, confidence, runners_up
        For the fields of the match.
    quality : float, optional
        :attr:`kfmaps.matching.quality.Quality.score` of ``points``: where shapes differ much the refinement ends early.

    Raises
    ------
    InvalidInput
        When the shapes were prepared otherwise, or the points are none of the source.
    """
    config = config or Config()
    for shape in (source, target):
        check_prepared(shape, config)
    points = check_point_map(points, len(source.mesh.vertices), len(target.mesh.vertices))
    across, clock = border(source, target), Clock(progress)
    shapes = [across.source, mirror_image(across.target) if orientation == "reversed" else across.target]
    within = across.part_s.number[points[across.part_t.kept]]
    size = min(CONTINUED, *(len(shape.basis.eigenvalues) for shape in shapes))
    C = to_numpy(to_functional(within, *(shape.basis.truncated(size) for shape in shapes)))
    found = Found(C, origin, None, verdict, confidence, orientation=orientation, quality=quality)
    led = leading(shapes[0], shapes[1], found.landmarks)
    back = C.T if config.formulation.directions == "both" else None
    return replace(_ended(found, across, shapes, config, clock, led, back, seed_of(rng)), runners_up=runners_up)


def _ended(
    found: Found,
    across: Border,
    shapes: list[Shape],
    config: Config,
    clock: Clock,
    led: Guide | None,
    back: np.ndarray | None,
    seed: int,
) -> Match:
    """The match of a map that is ``found`` between two ``shapes`` inside their border, the target turned as it says."""
    single = found.origin == ONE_FIT
    ending = replace(config, refinement=closing(config.refinement, found), finish=loosened(config.finish, found))
    end = finished(
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
    last = placed(end.target_to_source, shapes[0], shapes[1], ending, clock, found.landmarks)
    bent = last.bent
    if bent is not None and found.orientation == "reversed":
        bent = bent * MIRROR
    return _filled(
        last.target_to_source,
        end.functional_map,
        last.trust,
        across,
        shapes,
        config,
        clock,
        place=last.place,
        bent=bent,
        verdict=found.verdict,
        origin=found.origin,
        raw_functional_map=found.functional_map,
        raw_target_to_source=None if end.raw_target_to_source is None else across.points(end.raw_target_to_source),
        fit=found.fit,
        confidence=found.confidence,
        scores=found.scores,
        runners_up=tuple(across.points(points) for points in found.runners_up),
        doubted=found.doubted,
        orientation=found.orientation,
        source_to_target=None if end.source_to_target is None else across.points_back(end.source_to_target),
        map_back=end.map_back,
        bend=last.fit,
        quality=found.quality,
        bending=found.bending,
    )


def _filled(
    points: np.ndarray,
    C: np.ndarray,
    trust: np.ndarray,
    across: Border,
    shapes: list[Shape],
    config: Config,
    clock: Clock,
    *,
    place: PointMap | None,
    bent: np.ndarray | None,
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
        border=across,
        place=None if place is None else across.place(place),
        bent=None if bent is None else across.bent(bent),
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
