"""Parts and wholes: what boundaries tell, distances that a cut lengthens, the part placed and registered."""

import warnings
from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from conftest import NO_LANDMARKS, SMALL, blob, cloud_of, rotation
from kfmaps import datasets
from kfmaps._arrays import InvalidInput
from kfmaps._progress import StageTimer
from kfmaps.config import Partial
from kfmaps.datasets import largest_piece
from kfmaps.descriptors.shot import shot
from kfmaps.evaluation import PartTruth, _true_overlap, part_accuracy
from kfmaps.fmap.evaluate import precise_errors
from kfmaps.fmap.precise import PointMap, vertex_point_map
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.mesh import Mesh, boundary_vertices, disc_area, mirror_mesh, surface_area, unit_area
from kfmaps.io import load_map, save_map
from kfmaps.matching import match as match_module
from kfmaps.matching.finish import MatchTask
from kfmaps.matching.match import match
from kfmaps.matching.partial import place_part as place_part_module
from kfmaps.matching.partial.detect import PartDetection, _relative_loops, detect_part
from kfmaps.matching.partial.match_partial import describe_part, file_ratio, match_partial
from kfmaps.matching.partial.place_part import GivenUp, PartTask, PlacedPart, place_part, same_units
from kfmaps.matching.partial.relaxation_labeling import (
    _SLACK,
    Assignment,
    RelaxationParams,
    consistency,
    distance_bounds,
    reassign,
    relax,
)
from kfmaps.matching.partial.samples import PartPair, part_samples
from kfmaps.matching.partial.scale_search import SCALES
from kfmaps.matching.reindexing import reindexing
from kfmaps.matching.result_groups import MatchPart
from kfmaps.matching.score import SCORE, probability, verdict
from kfmaps.shape import prepare

PART = SCORE.part.calibration
GUARDS = ("kfmaps.fmap.evaluate", "kfmaps.matching.partial")


def task_of(source, target, landmarks=None, config=SMALL):
    """Two prepared shapes to match."""
    pairs = NO_LANDMARKS if landmarks is None else landmarks
    return MatchTask((source.mesh, target.mesh), reindexing(source, target), config, pairs, 0, StageTimer())


AUTO = replace(SMALL, partial=Partial("auto", samples=100, whole_samples=300))


@pytest.fixture(scope="module")
def pair():
    return datasets.partial(1500, rng=0)


@pytest.fixture(scope="module")
def small():
    return prepare(blob(200), SMALL, name="small")


@pytest.fixture(scope="module")
def turned(pair):
    """The part in another unit, turned."""
    return Mesh(0.2 * pair.target.vertices @ rotation(3).T, pair.target.faces)


@pytest.fixture(scope="module")
def found(pair, turned):
    """With two scales alone, neither of them the right one: each takes as long as the others."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("kfmaps.matching.partial.place_part.SCALES", SCALES[4::3])
        return match(pair.source, turned, AUTO)


@pytest.fixture(scope="module")
def truth(pair):
    places = PointMap(pair.truth_faces, pair.truth_weights)
    return PartTruth(np.arange(len(pair.target.vertices)), places, True)


def renumbered(kept, count):
    """The number of each of ``count`` vertices among those that are kept, −1 for the others."""
    new = np.full(count, -1)
    new[kept] = np.arange(len(kept))
    return new


def disc(count):
    """A flat one of radius 1, as a fan."""
    angle = np.arange(count) * 2 * np.pi / count
    rim = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    each = np.arange(count)
    return Mesh(
        np.vstack([rim, [[0.0, 0.0, 0.0]]]), np.stack([each, (each + 1) % count, np.full(count, count)], axis=1)
    )


def opening(mesh: Mesh) -> float:
    return disc_area(_relative_loops(mesh))


def test_the_opening_of_a_disc_is_another_disc(pair):
    assert opening(disc(200)) == pytest.approx(1.0, rel=1e-3)
    assert opening(pair.source) == 0.0
    assert opening(Mesh(pair.source.vertices, pair.source.faces[:0])) == 0.0
    assert opening(Mesh(5.0 * disc(200).vertices, disc(200).faces)) == pytest.approx(opening(disc(200)))


def test_boundaries_tell_which_is_a_part(pair):
    whole, part = pair.source, pair.target
    found = detect_part(whole, part)
    assert (found.which, found.opening) == ("target", opening(part))
    for one, other, which in ((part, whole, "source"), (whole, whole, "none"), (part, part, "both")):
        assert detect_part(one, other).which == which
    assert detect_part(whole, whole).opening == 0
    assert detect_part(whole, cloud_of(part)).which == "none"
    # A pinhole is none: a face of many is left out.
    assert not found.both_open
    assert detect_part(part, part).both_open
    pinhole = Mesh(pair.source.vertices, pair.source.faces[1:])
    assert 0.0 < opening(pinhole) < SCORE.part.min_opening
    assert detect_part(pair.source, pinhole).which == "none"


def plates(*radii: float) -> Mesh:
    """Round plates beside each other."""
    meshes = [Mesh(radius * disc(60).vertices + [5.0 * i, 0, 0], disc(60).faces) for i, radius in enumerate(radii)]
    faces = [mesh.faces + 61 * i for i, mesh in enumerate(meshes)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


@pytest.mark.parametrize(
    ("radii", "others", "same"),
    [
        ((1.0, 0.8, 0.6), (0.6, 1.0, 0.8), True),
        ((1.0, 0.8, 0.6), (3.0, 2.4, 1.8), True),  # in another unit
        ((1.0, 0.8, 0.6), (1.0, 0.78, 0.63), True),
        ((1.0, 0.8, 0.6), (1.0, 0.7, 0.7), False),
        ((1.0, 0.8, 0.6), (1.0, 0.8), False),
        ((1.0, 0.8), (1.0, 0.8, 0.6), False),
        ((1.0,), (1.0,), False),  # one loop may be as long by chance
        ((1.0, 0.1, 0.1), (1.0, 0.1, 0.1), False),
    ],
)
def test_several_loops_of_the_same_lengths_are_the_same_boundaries(radii, others, same):
    found = detect_part(plates(*radii), plates(*others))
    assert (found.which, found.same_loops) == ("both", same)


def test_a_loop_more_counts_where_all_vertices_are_on_boundaries():
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    shapes = [
        Mesh(
            np.concatenate([size * corners + [3.0 * i, 0, 0] for i, size in enumerate(sizes)]),
            np.arange(3 * len(sizes)).reshape(-1, 3),
        )
        for sizes in ((1.0, 1.0), (1.0, 1.0, 0.1))
    ]
    assert detect_part(shapes[0], shapes[0]).same_loops
    assert not detect_part(*shapes).same_loops
    assert not detect_part(*shapes[::-1]).same_loops


def test_only_edges_of_one_face_are_a_boundary(pair):
    assert not boundary_vertices(pair.source).any()
    rim = boundary_vertices(disc(30))
    assert rim[:30].all()
    assert not rim[30]


def test_distances_that_may_pass_a_cut_may_be_shorter_on_the_whole():
    """By as much as a detour around the boundary explains; far from every boundary a shorter way counts in full."""
    part = distance_bounds(np.array([[0.0, 0.5], [0.5, 0.0]]), np.array([0.1, 0.1]), 1.0)
    far, low = part.upper[:1, 1:], part.lower[:1, 1:]
    assert low == pytest.approx(0.2)

    def fits(far, low, d):
        return float(consistency(far, low, np.array([[d]]), _SLACK)[0, 0])

    values = [fits(far, low, d) for d in (0.5, 0.49, 0.47, 0.1, 0.51, 0.8)]
    assert values[0] == 1.0
    assert values[0] > values[1] > values[2] > values[3] == values[5] == 0.0
    assert values[4] < values[1]
    assert fits(far, far, 0.47) < values[2]
    assert fits(np.array([[np.inf]]), np.array([[np.inf]]), 1.0) == 0.0


def test_a_gauge_grows_with_the_scale_and_knows_the_way_round_by_the_edge(pair):
    one = part_samples(pair.target, 60)
    small, large = (
        distance_bounds(one.distances, one.boundary_distance, 0.5),
        distance_bounds(one.distances, one.boundary_distance, 1.0),
    )
    assert large.upper == pytest.approx(2 * small.upper)
    assert (large.lower <= large.upper).all()
    assert np.isfinite(one.boundary_distance).all()
    assert not np.isfinite(part_samples(pair.source, 60).boundary_distance).any()


def test_a_part_in_another_unit_and_turned_is_placed(pair, turned, found, truth, tmp_path):
    assert precise_errors(pair.source, found.precise(), truth.places).mean() < 0.03
    assert found.verdict != "unlikely"
    for overlap in (found.partial.overlap_source, found.partial.overlap_target):
        assert 0.0 <= overlap.min() <= overlap.max() <= 1.0
    save_map(tmp_path / "map.npz", found)
    seen: Any = part_accuracy(pair.source, turned, load_map(tmp_path / "map.npz"), truth, "target")
    assert seen.errors.mean < 0.03
    assert seen.overlap > 0.85
    assert seen.matched == pytest.approx((found.target_to_source >= 0).mean())
    assert seen.matched > 0.95
    assert 0.1 < seen.missing < 0.6
    # Constants go to constants.
    C = found.functional_map
    assert C.shape[0] < C.shape[1]
    assert C[0, 0] == pytest.approx(1.0, abs=0.05)
    assert np.abs(C[1:, 0]).max() < 0.2


def test_the_other_way_round_vertices_without_counterpart_are_minus_one(pair, truth):
    """And where units are the same only one scale is tried."""
    back = match(pair.target, pair.source, replace(AUTO, partial=replace(AUTO.partial, scale="fixed")))
    assert back.partial.scale == pytest.approx(np.sqrt(surface_area(pair.target) / surface_area(pair.source)))
    lost = back.target_to_source < 0
    assert (back.target_to_source[lost] == -1).all()
    true = _true_overlap(pair.source, pair.target, truth)
    assert (lost == ~true).mean() > 0.9
    # Where there is a counterpart, going there and by the truth back is no way at all.
    here = np.flatnonzero(~lost)
    ends = pair.source.vertices[pair.truth[back.target_to_source[here]]]
    off = np.linalg.norm(ends - pair.source.vertices[here], axis=1) / np.sqrt(surface_area(pair.source))
    assert off.mean() < 0.05


@pytest.mark.parametrize(("which", "is_told"), [("target", True), ("none", False)])
def test_descriptors_that_take_no_part_are_not_ignored_silently(small, monkeypatch, which, is_told):
    found = fake_match("sure", 0.95)
    found.partial = replace(found.partial, which=which)
    monkeypatch.setattr(match_module, "_match_detected", lambda *_: found)
    own, computed = np.ones((200, 1)), SimpleNamespace(compute=lambda shape: shape)
    monkeypatch.setattr(match_module, "prepare_both", lambda *_, **__: (small, small))
    extra = replace(AUTO.descriptors, extra=(computed,))
    for config, given in ((AUTO, (own, own)), (replace(AUTO, descriptors=extra), None), (AUTO, None)):
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            assert match_module.match(small, small, config, descriptors=given) is found
        is_given = given is not None or config is not AUTO
        assert any("descriptors are not used" in str(one.message) for one in told) == (is_told and is_given)


def test_whole_shapes_are_matched_as_if_nobody_had_thought_of_parts():
    config = replace(AUTO, registration=None)
    source, target = (prepare(blob(500, twist), config) for twist in (0.0, 0.4))
    plain, auto = (match(source, target, replace(config, partial=p)) for p in (Partial("none"), config.partial))
    assert auto.partial.overlap_source is None
    assert np.array_equal(auto.target_to_source, plain.target_to_source)
    assert np.array_equal(auto.functional_map, plain.functional_map)


@pytest.mark.parametrize(
    ("scale", "output"),
    [
        (0.9, "the target is a part, 81% of the other's area; because"),
        (0.97, "the target has holes (6% is missing)"),
        (1.01, "the target has holes (0% is missing)"),
    ],
)
def test_a_part_that_lacks_little_is_a_shape_with_holes(scale, output):
    assert describe_part("target", scale, (np.ones(1), np.ones(1)), "because") == output


@pytest.mark.parametrize(
    ("scale", "ratio", "both", "same"),
    [
        ("auto", 1.9, True, True),
        ("auto", 0.55, True, True),
        ("auto", 2.54, True, False),
        ("auto", 1 / 2.54, True, False),
        ("auto", None, True, False),
        ("auto", 1.0, False, False),
        ("free", 1.0, True, False),
        ("fixed", 1000.0, False, True),
    ],
)
def test_two_parts_of_like_size_are_in_one_unit(scale: str, ratio: float | None, both: bool, same: bool) -> None:
    assert same_units(scale, ratio, both) == same


@pytest.mark.parametrize("which", ["source", "target"])
def test_a_part_is_placed_in_units_of_the_whole(small, monkeypatch, which):
    large = prepare(Mesh(3.0 * blob(200).vertices, blob(200).faces), SMALL, name="large")
    seen = []

    def place(task, **_):
        seen.append(task.ratio)
        raise InvalidInput("that is enough")

    monkeypatch.setattr("kfmaps.matching.partial.match_partial.place_part", place)
    for shapes in ((small, large), (large, small)):
        with pytest.raises(InvalidInput, match="enough"):
            match_partial(task_of(*shapes), which, "because")
    assert seen == pytest.approx([1 / 3, 3] if which == "source" else [3, 1 / 3])


@pytest.mark.parametrize("scale", ["fixed", "free"])
def test_two_parts_are_placed_by_coarse_proxies_and_their_landmarks(pair, monkeypatch, scale):
    """The whole lacks one end, the part the other; copies of few vertices are placed, then both in full are bent."""
    monkeypatch.setattr("kfmaps.matching.partial.place_part._PROXY_FROM", 600)
    monkeypatch.setattr("kfmaps.matching.partial.place_part._PROXY_VERTICES", 500)
    height = pair.source.vertices @ [0.35, 1.0, 0.2]
    whole, kept = largest_piece(pair.source, height <= np.quantile(height, 0.9))
    true = renumbered(kept, len(height))[pair.truth]
    known = np.flatnonzero(true >= 0)
    rows = known[np.linspace(0, len(known) - 1, 4).astype(int)]
    sizes = [np.sqrt(surface_area(mesh)) for mesh in (pair.target, whole)]
    settings = Partial("both", scale, samples=100, whole_samples=300)
    meshes = unit_area(pair.target), unit_area(whole)
    landmark_vertices, ratio = np.stack([rows, true[rows]], axis=1), float(sizes[0] / sizes[1])
    found = place_part(PartTask(*meshes, settings, ratio, both_partial=True), landmark_vertices)
    off = np.linalg.norm(found.registration.vertices - meshes[1].vertices[true], axis=1)
    assert off[known].mean() < 0.06
    assert found.registration.scale == pytest.approx(ratio, rel=1e-9 if scale == "fixed" else 0.1)
    ours = found.overlap.part > 0.5
    assert (ours & (true >= 0)).sum() / (ours | (true >= 0)).sum() > 0.8


@pytest.mark.parametrize(("which", "word"), [("target", "unlikely"), ("both", "likely")])
def test_two_parts_have_a_calibration_of_their_own(small, monkeypatch, which, word):
    """Their right placements score less, and a placement that fits nowhere is sought without landmarks by the same."""
    asked, score = [], SCORE.part.calibration_of_two.middle + 2
    numbers = PART if which == "target" else SCORE.part.calibration_of_two
    assert score < PART.middle - 2
    places, all_ = vertex_point_map(np.arange(200), small.mesh), np.ones(200)
    registered = SimpleNamespace(scale=1.0, vertices=small.mesh.vertices)
    overlap = SimpleNamespace(part=all_, whole=all_, on_whole=places, on_part=places)

    def place(*_, landmarks, **__):
        asked.append(len(landmarks))
        # Errors at the landmarks at which they support nothing.
        far = small.mesh.vertices + np.array([0.0, 0.0, 0.09])
        placed = SimpleNamespace(registration=registered, overlap=overlap, unguided=far)
        return SimpleNamespace(**vars(placed), scores=(score,), margin=3.0, calibration=numbers)

    monkeypatch.setattr("kfmaps.matching.partial.match_partial.place_part", place)
    found = match_partial(task_of(small, small, np.array([[3, 3], [50, 50]])), which, "because")[0]
    assert found.confidence == pytest.approx(probability(score, 3.0, numbers=numbers), abs=1e-3)
    assert found.verdict == word
    assert asked == ([2, 0] if word == "unlikely" else [2])


@pytest.mark.parametrize("scale", ["auto", "free", "fixed"])
def test_two_parts_are_likely_at_most_without_landmarks(small, monkeypatch, scale):
    places, all_ = vertex_point_map(np.arange(200), small.mesh), np.ones(200)
    found: Any = SimpleNamespace(
        registration=SimpleNamespace(scale=1.0, vertices=small.mesh.vertices),
        overlap=SimpleNamespace(part=all_, whole=all_, on_whole=places, on_part=places),
        scores=(99.0,),
        margin=9.0,
        unguided=small.mesh.vertices,
        calibration=SCORE.part.calibration_of_two,
    )
    monkeypatch.setattr("kfmaps.matching.partial.match_partial.place_part", lambda *_, **__: found)
    config = replace(SMALL, partial=Partial("both", scale))
    match = match_partial(task_of(small, small, NO_LANDMARKS, config), "both", "because")[0]
    assert match.verdict == "likely"
    assert (match.confidence or 0.0) < 0.9


def test_landmarks_that_a_placement_keeps_without_them_support_it(small, monkeypatch):
    """As those of whole shapes do, by the share of what is common that lies near them, in the unit of the whole."""
    numbers = SCORE.part.calibration_of_two
    vertices, half, scale = small.mesh.vertices, np.arange(200) < 100, 0.5
    places = vertex_point_map(np.arange(200), small.mesh)
    overlap = SimpleNamespace(part=half * 1.0, whole=half * 1.0, on_whole=places, on_part=places)
    registered = SimpleNamespace(scale=scale, vertices=vertices)
    unguided, landmark_vertices = vertices.copy(), np.array([[3, 3], [50, 50], [90, 90]])
    unguided[50] += [0.0, 0.0, 0.15]  # contradicted, so named; the others are where they belong
    placed = SimpleNamespace(registration=registered, overlap=overlap, unguided=unguided)
    one = SimpleNamespace(**vars(placed), scores=(20.0,), margin=0.0, calibration=numbers)
    monkeypatch.setattr("kfmaps.matching.partial.match_partial.place_part", lambda *_, **__: one)
    found = match_partial(task_of(small, small, landmark_vertices), "both", "because")[0]
    near = (scale * geodesic_distances(small.mesh, landmark_vertices[:, 1]) < SCORE.landmark_radius).any(axis=0)
    areas = small.basis.mass * half
    right = 1 / (1 + np.exp((0.05 - SCORE.landmark_error_middle) / SCORE.landmark_error_width))
    support = (areas[near].sum() / areas.sum()) ** 2 * right
    assert 0.1 < support < 0.8
    assert found.confidence == pytest.approx(probability(20.0, 0.0, support=support, numbers=numbers), rel=1e-6)
    assert found.verdict == verdict(20.0, 0.0, support=support, numbers=numbers)
    assert found.score.rejected_landmarks.tolist() == [1]


def reversing(config, orientation="reversing"):
    """The settings with an orientation."""
    return replace(config, search=replace(config.search, orientation=orientation))


def test_the_mirror_image_of_a_part_is_placed_where_it_is_asked_for(pair, turned, found, truth, monkeypatch):
    """As a fragment of a left bone on a right one: by the same map."""
    monkeypatch.setattr("kfmaps.matching.partial.place_part.SCALES", SCALES[4::3])
    mirrored = match(pair.source, mirror_mesh(turned), reversing(AUTO))
    assert (mirrored.orientation, found.orientation) == ("reversing", "preserving")
    assert precise_errors(pair.source, mirrored.precise(), truth.places).mean() < 0.03


@pytest.mark.parametrize("orientation", ["preserving", "reversing"])
def test_a_registered_part_lies_on_the_given_whole(small, monkeypatch, orientation):
    places, all_ = vertex_point_map(np.arange(200), small.mesh), np.ones(200)

    def place(task, **_):
        registered: Any = SimpleNamespace(scale=1.0, vertices=task.whole.vertices)
        overlap: Any = SimpleNamespace(part=all_, whole=all_, on_whole=places, on_part=places)
        return PlacedPart(registered, overlap, (30.0,), 9.0, task.whole.vertices, PART)

    monkeypatch.setattr("kfmaps.matching.partial.match_partial.place_part", place)
    task = task_of(small, small, NO_LANDMARKS, reversing(SMALL, orientation))
    found = match_partial(task, "source", "because")[0]
    assert (found.orientation, found.verdict) == (orientation, "sure")
    lying: Any = found.registration.registered_vertices
    np.testing.assert_allclose(lying, small.mesh.vertices, atol=1e-9)


def test_the_mirror_image_of_a_part_is_a_rival_where_it_fits_better(pair, turned, found, monkeypatch):
    """As of a left bone's fragment on a right bone: the whole's other half may look alike, and nothing else tells."""
    part, whole = unit_area(mirror_mesh(turned)), unit_area(pair.source)
    samples = part_samples(part, 100), part_samples(whole, 300)
    for radius in (0.1, 0.2):
        samples[0].shot(radius)
        there = shot(mirror_mesh(part), radius, at=samples[0].samples, samples=10_000)
        np.testing.assert_allclose(samples[0].mirrored.shot(radius), there, atol=1e-4)
    pair_of_samples = PartPair(*samples)

    def best(placement: float, score: float) -> Any:
        registered, placed = SimpleNamespace(scale=found.partial.scale), SimpleNamespace(score=placement)
        return SimpleNamespace(registration=registered, placement=placed, score=score)

    image = place_part_module._find_better_mirrored(best(-99.0, -99.0), pair_of_samples)
    assert image is not None
    off = np.linalg.norm(image.registration.vertices - whole.vertices[pair.truth], axis=1)
    assert np.median(off) < 0.05
    # It must fit better both before and after registration.
    own = image.placement.score, image.score - SCORE.mirror_gain
    for behind, is_better in (((0.1, 0.1), True), ((-0.1, 0.1), False), ((0.1, -0.1), False)):
        other = best(own[0] - behind[0], own[1] - behind[1])
        assert (place_part_module._find_better_mirrored(other, pair_of_samples) is not None) == is_better
    monkeypatch.setattr(place_part_module, "SCALES", SCALES[4:5])
    monkeypatch.setattr(place_part_module, "_register_fully", lambda found, *_, **__: found)
    task = PartTask(part, whole, AUTO.partial)
    plain = place_part(task)
    for one, extra, lead in ((image, (image.score,), 0.0), (None, (), plain.margin)):
        monkeypatch.setattr(place_part_module, "_find_better_mirrored", lambda *_, one=one: one)
        assert place_part(task).scores == plain.scores
        seen = place_part(replace(task, may_be_mirrored=True))
        assert (seen.margin, seen.scores) == (lead, (plain.scores[0], *extra, *plain.scores[1:]))


@pytest.mark.parametrize(("orientation", "may_be"), [("auto", True), ("preserving", False), ("reversing", False)])
def test_a_mirror_image_is_no_rival_where_the_orientation_is_stated(small, monkeypatch, orientation, may_be):
    def place(task, **_):
        assert task.may_be_mirrored == may_be
        raise GivenUp

    monkeypatch.setattr("kfmaps.matching.partial.match_partial.place_part", place)
    with pytest.raises(GivenUp):
        match_partial(task_of(small, small, NO_LANDMARKS, reversing(SMALL, orientation)), "source", "because")


def test_distances_decide_between_places_that_look_alike(rng):
    whole = rng.normal(size=(60, 3))
    distances = np.linalg.norm(whole[:, None] - whole, axis=2)
    at = rng.permutation(60)
    true, decoy = at[:20], at[20:40]
    bounds = distance_bounds(distances[np.ix_(true, true)], np.full(20, 9.0), 1.0)
    similarity = np.zeros((20, 60))
    similarity[np.arange(20), true], similarity[np.arange(20), decoy] = 1.0, 1.01
    found = relax(bounds, distances, similarity, RelaxationParams(candidates=3, reach=9.0))
    np.testing.assert_array_equal(found.match, true)
    np.testing.assert_allclose(found.trust, 1.0, atol=0.2)
    assert found.support > 0.9


def test_relaxation_weighs_places_by_their_support(rng):
    """Twelve rounds, written out: a place counts by its prior and its squared support, a sample at most half more."""
    whole = rng.normal(size=(12, 3))
    distances = np.linalg.norm(whole[:, None] - whole, axis=2)
    at = rng.permutation(12)[:7]
    part = distances[np.ix_(at, at)] * np.where(np.arange(7) < 3, 1.3, 1.0)
    bounds, similarity = distance_bounds(np.minimum(part, part.T), rng.uniform(0, 1, 7), 1.0), rng.uniform(size=(7, 12))
    reach, slack = 2.0, (0.02, 0.1)
    found = relax(bounds, distances, similarity, RelaxationParams(first=7, candidates=12, reach=reach))
    prior = np.exp((similarity - similarity.max(axis=1, keepdims=True)) / 0.1)
    share = prior**2 / (prior**2).sum(axis=1, keepdims=True)
    near = (bounds.upper <= reach) & ~np.eye(7, dtype=bool)
    support, most = np.zeros((7, 12)), np.zeros(7)
    for _ in range(12):
        support = np.zeros((7, 12))
        for i, j in zip(*np.nonzero(near), strict=True):
            fits = consistency(bounds.upper[i, j], bounds.lower[i, j], distances, slack)
            support[i] += fits @ share[j]
        share = prior * support**2
        share /= share.sum(axis=1, keepdims=True)
        most = support.max(axis=1)
        share *= np.minimum(most / np.median(most), 1.5)[:, None]
    assert (most > 1.5 * np.median(most)).any()
    best = (prior * support**2).argmax(axis=1)
    last = support[np.arange(7), best]
    np.testing.assert_array_equal(found.match[:7], best)
    expected = np.where(last < 0.5 * np.median(last), 0.0, np.minimum(last / np.median(last), 1.0))
    np.testing.assert_allclose(found.trust, expected, atol=1e-5)
    assert found.support == pytest.approx((last / near.sum(axis=1)).mean(), rel=1e-5)


def test_samples_are_placed_anew_by_their_trusted_neighbours(rng):
    whole = rng.normal(size=(60, 3))
    distances = np.linalg.norm(whole[:, None] - whole, axis=2)
    at = rng.permutation(60)[:11]
    bounds = distance_bounds(distances[np.ix_(at, at)], rng.uniform(0, 1, 11), 1.05)
    bounds.upper[3, 8] = bounds.upper[8, 3] = np.inf
    similarity, trust = rng.uniform(size=(11, 60)), np.where(np.arange(11) % 4 == 2, 0.0, rng.uniform(0.2, 1, 11))
    placed = Assignment(np.roll(at, 1), trust, 0.5)
    found = reassign(bounds, distances, similarity, placed, n_landmarks=2)
    for i in range(11):
        near = [j for j in range(11) if j != i and trust[j] > 0 and np.isfinite(bounds.upper[i, j])]
        weight = np.array([trust[j] / (0.1 + bounds.upper[i, j]) for j in near])
        fits = [
            consistency(bounds.upper[i, [j]], bounds.lower[i, [j]], distances[placed.match[j]], (0.03, 0.08))
            for j in near
        ]
        share = weight @ np.array(fits) / weight.sum()
        best = placed.match[i] if i < 2 else (share + similarity[i]).argmax()
        assert found.match[i] == best
        if i >= 2:
            np.testing.assert_allclose(found.trust[i], max(share[best] - 0.3, 0) / 0.7, rtol=1e-9, atol=1e-12)


def fake_match(word: str, confidence: float, scale: float = 0.85, energy: float | None = None) -> SimpleNamespace:
    score = SimpleNamespace(deformation_energy=energy)
    return SimpleNamespace(verdict=word, confidence=confidence, partial=MatchPart("target", scale=scale), score=score)


@dataclass
class WholeMatch:
    verdict: str = "sure"
    confidence: float | None = 0.99
    partial: MatchPart = field(default_factory=lambda: MatchPart(suspected=True))
    score: Any = field(default_factory=lambda: SimpleNamespace(deformation_energy=0.1))


@dataclass
class OpenMatch:
    """A match of a triangle whose fourth vertex lies ``moved`` away from the first."""

    verdict: str
    confidence: float
    target_to_source: np.ndarray
    moved: float
    partial: MatchPart = field(default_factory=MatchPart)
    score: Any = field(default_factory=lambda: SimpleNamespace(deformation_energy=0.02))

    @property
    def source(self) -> Mesh:
        return Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 2, 0], [self.moved, 0, 0]]), np.array([[0, 1, 2]]))


@pytest.mark.parametrize("stated", ["auto", "none"])
@pytest.mark.parametrize(
    ("which", "opening", "given", "expected"),
    [
        ("target", 0.04, 0.99, (0.9504, "sure")),
        ("target", 0.12, 0.99, (0.8712, "likely")),
        ("source", 2.0, 0.4, (0.0, "unlikely")),
        ("target", 0.1, None, (None, "sure")),
        ("none", 0.12, 0.99, (0.99, "sure")),  # both are open alike
    ],
)
def test_a_match_as_wholes_is_less_probable_by_what_is_missing_of_one_shape(
    monkeypatch, small, which, opening, given, expected, stated
):
    parts_tried(monkeypatch, dict.fromkeys(("target", "source")))
    monkeypatch.setattr(match_module, "_match_wholes", lambda *_: WholeMatch(confidence=given))
    monkeypatch.setattr(match_module, "detect_part", lambda *_: PartDetection(which, "open", opening))
    found = match_module.match(small, small, replace(AUTO, partial=replace(AUTO.partial, part=stated)))
    assert (found.confidence, found.verdict) == (expected[0] and pytest.approx(expected[0]), expected[1])


@pytest.mark.parametrize(("opening", "expected"), [(0.04, (0.9504, "sure")), (0.12, (0.8712, "likely"))])
def test_so_it_is_where_a_part_was_stated_and_wholes_fit_better(monkeypatch, small, opening, expected):
    parts_tried(monkeypatch, {"target": fake_match("ambiguous", 0.4)})
    monkeypatch.setattr(match_module, "_match_wholes", lambda *_: WholeMatch())
    monkeypatch.setattr(match_module, "detect_part", lambda *_: PartDetection("target", "open", opening))
    found = match_module.match(small, small, replace(AUTO, partial=replace(AUTO.partial, part="target")))
    assert (found.confidence, found.verdict) == (pytest.approx(expected[0]), expected[1])


def parts_tried(monkeypatch: pytest.MonkeyPatch, answers: dict[str, Any]) -> list[str]:
    """The parts that are matched from now on, in order, as they are; their matches are the ``answers``."""
    tried = []

    def matched(_task, which, *_, **__):
        tried.append(which)
        return answers[which], False

    monkeypatch.setattr(match_module, "match_partial", matched)
    return tried


@pytest.mark.parametrize(
    ("word", "output", "opening", "asked", "whole", "expected", "steps"),
    [
        ("sure", 0.95, 0.04, "auto", "sure", "part", ["clear"]),
        ("sure", 0.95, 0.09, "auto", "sure", "part", ["clear at any scale"]),
        ("none clear", 0.7, 0.09, "auto", "likely, deformed little", "whole", ["clear at any scale", "whole"]),
        ("none clear", 0.7, 0.04, "auto", "likely", "whole", ["clear", "whole"]),  # a limb is missing at most
        ("unlikely", 0.1, 0.3, "auto", "likely, deformed little", "whole", ["part", "whole"]),
        ("unlikely", 0.61, 0.3, "auto", "unlikely, deformed little", "part", ["part", "whole"]),  # the other is less so
        ("ambiguous", 0.7, 0.3, "none", "ambiguous, deformed little", "whole", ["whole", "part"]),
        ("ambiguous", 0.4, 0.06, "auto", "likely", "whole", ["clear at any scale", "whole"]),
        ("likely", 0.7, 0.06, "auto", "likely", "part", ["clear at any scale", "whole"]),
        ("none clear", 0.7, 0.06, "auto", "sure", "whole", ["clear at any scale", "whole"]),
        ("none clear", 0.7, 0.06, "auto", "likely", "part", ["clear at any scale", "whole", "part"]),
        ("none clear", 0.4, 0.06, "auto", "likely", "whole", ["clear at any scale", "whole", "part"]),
        ("ambiguous", 0.4, 0.3, "auto", "sure", "part", ["part"]),  # too much is missing for a whole
        ("ambiguous", 0.4, 0.05, "target", "sure", "whole", ["part", "whole"]),  # stated, but it has holes at most
        ("ambiguous", 0.4, 0.05, "target", "ambiguous", "part", ["part", "whole"]),
        ("likely", 0.7, 0.05, "target", "sure", "part", ["part", "whole"]),  # more probable
        ("ambiguous", 0.4, 0.3, "target", "sure", "part", ["part"]),  # stated, and the boundaries say so too
        ("sure", 0.95, 0.05, "target", "sure", "part", ["part"]),
        ("ambiguous", 0.4, 0.3, "none", "sure", "whole", ["whole"]),
        ("likely", 0.7, 0.3, "none", "ambiguous", "part", ["whole", "part"]),  # stated, but it is cut
        ("ambiguous", 0.7, 0.3, "none", "ambiguous", "whole", ["whole", "part"]),
        ("likely", 0.7, 0.05, "none", "ambiguous", "whole", ["whole"]),
    ],
)
def test_an_unsure_part_is_matched_as_a_whole_with_holes_too(
    monkeypatch, small, word, output, opening, asked, whole, expected, steps
):
    tried = []
    whole, _, deformed = whole.partition(", ")
    part = fake_match(word, output)
    other = fake_match(whole, 0.6, energy=0.29 if deformed else 0.31)
    opposites = []

    def parts(_task, _which, _why, least_scale=0.0, clear_area=np.inf):
        is_clear = clear_area == SCORE.part.min_whole_area
        tried.append("part" if not is_clear else "clear" if least_scale**2 > 0.69 else "clear at any scale")
        if is_clear and word == "none clear":
            raise GivenUp
        return part, False

    def wholes(*given):
        tried.append("whole")
        if word != "unlikely":  # which fits nowhere
            assert given[-1].reason == ("" if asked == "none" else match_module._FIT_AS_WHOLES)
        return other

    monkeypatch.setattr(match_module, "match_partial", parts)
    monkeypatch.setattr(match_module, "_match_wholes", wholes)
    monkeypatch.setattr(match_module, "_compare_opposite", lambda _task, best, _which: opposites.append(1) or best)
    monkeypatch.setattr(match_module, "detect_part", lambda *_: PartDetection("target", "open", opening))
    config = replace(AUTO, partial=replace(AUTO.partial, part=asked))
    result = match_module.match(small, small, config)
    assert result is {"part": part, "whole": other}[expected]
    assert tried == steps
    if asked == "auto":  # whether the other shape is tried as the part too
        is_whole = opening < 0.05 or (deformed and opening < 0.2)
        assert bool(opposites) == (result.verdict != "sure" and not is_whole)


@pytest.mark.parametrize(
    ("word", "scale", "asked", "as_whole"),
    [
        ("ambiguous", 0.83, "auto", False),  # 69 % of the area
        ("ambiguous", 0.84, "auto", True),
        ("ambiguous", 0.83, "target", False),
        ("ambiguous", 0.84, "target", True),
        ("unlikely", 0.83, "auto", True),
        ("unlikely", 0.83, "target", True),
    ],
)
def test_a_part_with_holes_that_is_too_small_for_a_whole_is_not_matched_as_one(
    monkeypatch, small, word, scale, asked, as_whole
):
    part, tried = fake_match(word, 0.4, scale=scale), []
    monkeypatch.setattr(match_module, "match_partial", lambda *_, **__: (part, False))
    monkeypatch.setattr(match_module, "_match_wholes", lambda *_: tried.append(1) or fake_match("unlikely", 0.1))
    monkeypatch.setattr(match_module, "_compare_opposite", lambda _task, best, _which: best)
    monkeypatch.setattr(match_module, "detect_part", lambda *_: PartDetection("target", "open", 0.1))
    assert match_module.match(small, small, replace(AUTO, partial=replace(AUTO.partial, part=asked))) is part
    assert bool(tried) == as_whole


@pytest.mark.parametrize(
    ("which", "ratio", "scale", "steps"),
    [
        ("target", 0.6, 0.6, ["target"]),
        ("target", 0.6, 0.77, ["target", "whole"]),  # of 0.59 of the area
        ("target", 0.6, 0.79, ["target", "whole", "source"]),  # a factor of 1.3 from the scale of the files
        ("target", 0.6, 0.45, ["target", "whole", "source"]),
        ("target", 0.6, 0.47, ["target"]),
        ("target", 1.1, 0.9, ["target", "whole", "source"]),  # a scan with its floor is larger in the files
        ("target", None, 0.6, ["target", "whole", "source"]),
        ("source", 1 / 0.6, 0.6, ["source"]),
        ("source", 0.6, 0.6, ["source", "whole", "target"]),
    ],
)
def test_a_part_at_the_scale_of_the_files_shows_that_both_are_in_one_unit(
    monkeypatch, small, which, ratio, scale, steps
):
    """So the other shape is no part of it, and with less than half of the area it is no whole with another scale."""
    part, tried = fake_match("unlikely", 0.4, scale=scale), []
    part.partial = replace(part.partial, which=which)

    def matched(_task, side, *_, **__):
        tried.append(side)
        return part if side == which else fake_match("unlikely", 0.1), False

    monkeypatch.setattr(match_module, "match_partial", matched)
    monkeypatch.setattr(match_module, "_match_wholes", lambda *_: tried.append("whole") or fake_match("unlikely", 0.1))
    monkeypatch.setattr(match_module, "file_ratio", lambda *_: ratio)
    monkeypatch.setattr(match_module, "detect_part", lambda *_: PartDetection(which, "open", 0.3))
    assert match_module.match(small, small, AUTO) is part
    assert tried == steps


def test_files_have_a_ratio_of_sizes_unless_one_is_not_known(small):
    larger = replace(small, extent=2.5 * small.extent)
    assert file_ratio(small, larger) == pytest.approx(2.5)
    assert file_ratio(small, replace(small, extent=None)) is None
    assert file_ratio(replace(small, extent=None), small) is None


@pytest.mark.parametrize(
    ("stated", "detected", "opening", "word", "expected", "steps"),
    [
        ("source", "none", 0.0, "sure", "other", ["source", "whole"]),  # two closed shapes
        ("both", "none", 0.05, "likely", "other", ["both", "whole"]),
        ("both", "both", 0.3, "sure", "stated", ["both"]),
        ("both", "both", 0.05, "sure", "stated", ["both"]),
        ("none", "both", 0.3, "sure", "other", ["whole", "both"]),  # two cut shapes
        ("auto", "both", 0.3, "likely", "other", ["whole", "both"]),
        ("auto", "both", 0.3, "ambiguous", "other", ["whole", "both"]),  # nothing is stated
        ("source", "both", 0.3, "sure", "other", ["source", "whole"]),
        ("source", "target", 0.3, "sure", "other", ["source", "target"]),  # exchanged by mistake
        ("source", "target", 0.3, "ambiguous", "stated", ["source", "target"]),
        ("both", "source", 0.3, "sure", "other", ["both", "source"]),
        ("source", "source", 0.3, "sure", "stated", ["source"]),
    ],
)
def test_a_wrong_statement_of_the_part_makes_no_map_worse(
    monkeypatch, small, stated, detected, opening, word, expected, steps
):
    part = fake_match("ambiguous", 0.4)
    other = fake_match(word, 0.6)
    tried = []

    def matched(_task, which, *_, **__):
        tried.append(which)
        return part if which == stated else other, False

    monkeypatch.setattr(match_module, "match_partial", matched)
    as_wholes = part if stated in ("none", "auto") else other
    monkeypatch.setattr(match_module, "_match_wholes", lambda *_: tried.append("whole") or as_wholes)
    monkeypatch.setattr(match_module, "_compare_opposite", lambda _task, best, _which: best)
    monkeypatch.setattr(match_module, "detect_part", lambda *_: PartDetection(detected, "open", opening))
    config = replace(AUTO, partial=replace(AUTO.partial, part=stated))
    result = match_module.match(small, small, config)
    assert result is {"stated": part, "other": other}[expected]
    assert tried == steps


@pytest.mark.parametrize(("energy", "tries_parts"), [(0.09, False), (0.11, True), (None, True)])
def test_two_open_shapes_that_match_as_wholes_without_deformation_are_not_taken_for_parts(
    monkeypatch, small, energy, tries_parts
):
    """As of a fish in two poses whose fins are open sheets, where wrong parts have been more probable."""
    part, whole = fake_match("likely", 0.7), fake_match("ambiguous", 0.6, energy=energy)
    parts_tried(monkeypatch, dict.fromkeys(("source", "target", "both"), part))
    monkeypatch.setattr(match_module, "_match_wholes", lambda *_: whole)
    monkeypatch.setattr(match_module, "detect_part", lambda *_: PartDetection("both", "open", 0.3, True))
    assert match_module.match(small, small, AUTO) is (part if tries_parts else whole)


@pytest.mark.parametrize(
    ("detected", "word", "opening", "ratio", "expected", "steps"),
    [
        ("both", "sure", 0.06, 1.2, "source", ["source"]),
        ("both", "sure", 0.06, 0.9, "target", ["target"]),
        ("both", "sure", 0.06, 3.0, "target", ["target"]),  # another unit, and the target is more open
        ("both", "sure", 0.06, None, "target", ["target"]),
        ("source", "sure", 0.06, 0.9, "target", ["target"]),
        ("both", "likely", 0.06, 1.2, "both", ["source", "target", "both"]),
        ("both", "not clear", 0.06, 1.2, "both", ["source", "target", "both"]),
        ("both", "not clear", 0.06, 0.9, "both", ["target", "source", "both"]),
        ("both", "sure", 0.05, 1.2, "both", ["both"]),  # so little is missing that both are rather whole
    ],
)
def test_of_two_open_shapes_one_may_be_a_clear_part_of_the_other(
    monkeypatch, small, detected, word, opening, ratio, expected, steps
):
    """As two heads are that were cut off at different heights."""
    tried, answers = [], {which: fake_match(word, 0.95) for which in ("source", "target")}
    answers["both"] = fake_match("likely", 0.7)

    def matched(_task, which, _why, least=0.0, clear_area=np.inf):
        tried.append(which)
        # No smaller placement is clear.
        assert (least, clear_area) == ((0.0, np.inf) if which == "both" else (0.5, 0.0))
        if word == "not clear" and which != "both":
            raise GivenUp
        return answers[which], False

    monkeypatch.setattr(match_module, "match_partial", matched)
    monkeypatch.setattr(match_module, "_match_wholes", lambda *_: fake_match("ambiguous", 0.6))
    monkeypatch.setattr(match_module, "_check_by_wholes", lambda part, *_: part)
    monkeypatch.setattr(match_module, "file_ratio", lambda *_: ratio)
    detection = PartDetection(detected, "open", opening, True, "target")
    monkeypatch.setattr(match_module, "detect_part", lambda *_: detection)
    assert match_module.match(small, small, AUTO) is answers[expected]
    assert tried == steps


@pytest.mark.parametrize(
    ("moved", "word", "covers", "expected", "told"),
    [
        (0.07, "sure", True, "whole", "sure"),
        (0.09, "sure", True, "part", "sure"),
        (0.07, "likely", True, "part", "sure"),
        (0.07, "sure", False, "part", "sure"),
        (0.07, "ambiguous", True, "whole", "ambiguous"),
        (0.07, "ambiguous", False, "part", "ambiguous"),  # two legs may be exchanged
        (0.09, "ambiguous", False, "part", "sure"),
    ],
)
def test_a_part_of_an_open_shape_is_compared_with_the_match_as_wholes(
    monkeypatch, small, moved, word, covers, expected, told
):
    """A map as wholes is compared with others that exchange limbs, and goes into collections."""
    part = OpenMatch("sure", 0.95, np.array([0, 0, -1]), moved)
    whole = OpenMatch(word, 0.6, np.array([3, 3, 2]), moved)
    monkeypatch.setattr(match_module, "match_partial", lambda *_, **__: (part, covers))
    reasons = []
    monkeypatch.setattr(match_module, "_match_wholes", lambda *args: reasons.append(args[-1].reason) or whole)
    monkeypatch.setattr(match_module, "detect_part", lambda *_: PartDetection("both", "both open", 0.3, True, "target"))
    found = match_module.match(small, small, AUTO)
    assert found.target_to_source is {"whole": whole, "part": part}[expected].target_to_source
    assert (found.verdict, found.confidence) == (told, 0.95 if expected == "part" and told == "sure" else 0.6)
    assert reasons == ["both open"]
    if expected == "whole":
        assert found.partial.reason == "taken for whole: both open, but each covers all of the other"


@pytest.mark.parametrize(
    ("detected", "word", "energy", "scale", "steps"),
    [
        ("both", "sure", 0.014, 0.9, ["whole"]),  # the cuts are the same
        ("none", "sure", 0.014, 0.9, ["whole"]),
        ("both", "likely", 0.014, 0.9, ["whole", "target"]),
        ("both", "sure", 0.016, 0.9, ["whole", "target"]),
        ("both", "sure", None, 0.9, ["whole", "target"]),
        ("target", "sure", 0.014, 0.9, ["target", "whole"]),  # one is much more open, and more probably a part
        ("target", "sure", 0.014, 0.8, ["target"]),  # as wholes it has another map
    ],
)
def test_neither_a_part_nor_wholes_are_matched_where_the_answer_is_known(
    monkeypatch, small, detected, word, energy, scale, steps
):
    tried, points = [], np.array([0, 0, -1])
    part = OpenMatch("sure", 0.95, points, 0.09, MatchPart(scale=scale))
    whole = OpenMatch(word, 0.93, points, 0.09, score=SimpleNamespace(deformation_energy=energy))
    monkeypatch.setattr(
        match_module, "match_partial", lambda _task, which, *_, **__: tried.append(which) or (part, False)
    )
    monkeypatch.setattr(match_module, "_match_wholes", lambda *_: tried.append("whole") or whole)
    detection = PartDetection(detected, "open", 0.3, True, "target")
    monkeypatch.setattr(match_module, "detect_part", lambda *_: detection)
    assert match_module.match(small, small, AUTO) is (whole if steps == ["whole"] else part)
    assert tried == steps


@pytest.mark.parametrize("stated", ["auto", "none"])
@pytest.mark.parametrize("word", ["sure", "likely", "ambiguous"])
def test_shapes_with_the_same_boundaries_are_whole(monkeypatch, small, word, stated):
    tried = parts_tried(monkeypatch, {})
    whole = WholeMatch(word, 0.6)
    monkeypatch.setattr(match_module, "_match_wholes", lambda *_: whole)
    detection = PartDetection("both", "open", 0.3, True, "target", same_loops=True)
    monkeypatch.setattr(match_module, "detect_part", lambda *_: detection)
    found = match_module.match(small, small, replace(AUTO, partial=replace(AUTO.partial, part=stated)))
    assert (found, tried) == (whole, [])


def test_parts_of_them_are_sought_where_a_match_as_wholes_is_unlikely(monkeypatch, small):
    tried = parts_tried(monkeypatch, dict.fromkeys(("source", "target", "both"), fake_match("likely", 0.88)))
    monkeypatch.setattr(match_module, "_match_wholes", lambda *_: fake_match("unlikely", 0.1, energy=0.2))
    detection = PartDetection("both", "open", 0.3, True, "target", same_loops=True)
    monkeypatch.setattr(match_module, "detect_part", lambda *_: detection)
    assert match_module.match(small, small, AUTO).verdict == "likely"
    assert "both" in tried


@pytest.mark.parametrize(("opening", "expected"), [(0.04, (0.9504, "sure")), (0.12, (0.8712, "likely"))])
def test_two_open_shapes_that_match_as_wholes_have_a_lower_probability(monkeypatch, small, opening, expected):
    """What each has that the other lacks would be squeezed onto it, and scores may hardly tell."""
    tried = parts_tried(monkeypatch, dict.fromkeys(("source", "target", "both"), fake_match("likely", 0.88)))
    whole = WholeMatch(score=SimpleNamespace(deformation_energy=0.2))
    monkeypatch.setattr(match_module, "_match_wholes", lambda *_: whole)
    monkeypatch.setattr(match_module, "detect_part", lambda *_: PartDetection("both", "open", opening, True))
    found = match_module.match(small, small, AUTO)
    assert (found.confidence, found.verdict) == (pytest.approx(expected[0]), expected[1])
    assert "both" not in tried  # two parts are never "sure"


@pytest.mark.parametrize(
    ("both_open", "word", "expected", "steps"),
    [
        (True, "ambiguous", "both", ["target", "source", "target", "source", "both"]),
        (False, "ambiguous", "target", ["target", "source"]),
        (True, "sure", "source", ["target", "source"]),
        (False, "sure", "source", ["target", "source"]),
    ],
)
def test_a_part_of_a_shape_that_is_open_too_is_matched_as_one_of_two_where_both_are_open(
    monkeypatch, small, both_open, word, expected, steps
):
    answers = {which: fake_match("ambiguous", value) for which, value in (("target", 0.4), ("both", 0.45))}
    confidence = 0.95 if word == "sure" else 0.3
    answers["source"] = fake_match(word, confidence)
    tried = parts_tried(monkeypatch, answers)
    monkeypatch.setattr(match_module, "_match_wholes", lambda *_: None)
    monkeypatch.setattr(match_module, "_check_by_wholes", lambda part, *_: part)
    monkeypatch.setattr(match_module, "detect_part", lambda *_: PartDetection("target", "open", 0.3, both_open))
    assert match_module.match(small, small, AUTO) is answers[expected]
    assert tried == steps


def test_two_parts_that_were_stated_are_not_matched_twice(monkeypatch, small):
    answers = {which: fake_match("ambiguous", 0.4) for which in ("source", "target", "both")}
    tried = parts_tried(monkeypatch, answers)
    monkeypatch.setattr(match_module, "detect_part", lambda *_: PartDetection("target", "open", 0.3, True))
    stated = replace(AUTO, partial=replace(AUTO.partial, part="both"))
    assert match_module.match(small, small, stated) is answers["both"]
    assert tried == ["both", "target", "source", "target", "source"]


@pytest.mark.parametrize(
    ("word", "asked", "scale", "output", "scale_of_opposite", "expected"),
    [
        ("ambiguous", "auto", 0.7, 0.7, 0.8, "opposite"),
        ("ambiguous", "auto", 0.7, 0.5, 0.8, "part"),  # less likely than the part
        ("ambiguous", "auto", 0.25, 0.5, 0.8, "opposite"),  # the part has shrunk
        ("ambiguous", "auto", 0.7, 0.7, 0.45, "part"),  # the opposite has shrunk, to a fifth of the area
        ("ambiguous", "auto", 0.25, 0.7, 0.25, "part"),  # both have
        ("ambiguous, marked", "auto", 0.25, 0.5, 0.8, "part"),  # landmarks let a part be that small
        ("ambiguous", "target", 0.25, 0.7, 0.8, "part"),  # as asked for
        ("sure", "auto", 0.25, 0.99, 0.8, "part"),  # the opposite is not even tried
    ],
)
def test_an_open_scan_may_hold_all_of_a_closed_shape(
    monkeypatch, small, word, asked, scale, output, scale_of_opposite, expected
):
    """A scan with its floor holds a whole body, so the closed shape may be the part."""
    word, _, marked = word.partition(", ")
    landmarks = [[0, 0]] if marked else None
    part = fake_match(word, 0.6, scale=scale)
    opposite = fake_match("likely", output, scale=scale_of_opposite)
    answers = {"target": part, "source": opposite}
    tried = parts_tried(monkeypatch, answers)
    monkeypatch.setattr(match_module, "detect_part", lambda *_: PartDetection("target", "open", 0.3))
    config = replace(AUTO, partial=replace(AUTO.partial, part=asked))
    found = match_module.match(small, small, config, landmarks=landmarks)
    assert found is answers["source" if expected == "opposite" else "target"]
    assert tried == ["target"] + ["source"] * (word != "sure" and asked == "auto")


@pytest.mark.parametrize("is_one_view", [False, True])
def test_the_scan_of_one_camera_does_not_hold_all_of_a_closed_shape(monkeypatch, small, is_one_view):
    part, opposites = fake_match("ambiguous", 0.6, scale=0.5), []
    monkeypatch.setattr(match_module, "match_partial", lambda *_, **__: (part, False))
    monkeypatch.setattr(match_module, "_compare_opposite", lambda _task, best, _which: opposites.append(1) or best)
    detected = PartDetection("target", "open", 0.3, is_one_view=is_one_view)
    monkeypatch.setattr(match_module, "detect_part", lambda *_: detected)
    assert match_module.match(small, small, AUTO) is part
    assert len(opposites) == 1 - is_one_view


def test_an_open_scan_stays_the_part_where_the_other_is_given_up(monkeypatch, small):
    part, clocks = fake_match("likely", 0.6, scale=0.5), []

    def matched(task, which, *_, **__):
        clocks.append(task.clock)
        if which == "source":
            raise GivenUp
        return part, False

    monkeypatch.setattr(match_module, "match_partial", matched)
    monkeypatch.setattr(match_module, "detect_part", lambda *_: PartDetection("target", "open", 0.3))
    assert match_module.match(small, small, AUTO) is part
    assert list(clocks[0].seconds)[-2:] == ["parts", "the other as a part"]  # its time counts too


@pytest.mark.parametrize(
    ("word", "confidence", "expected"), [("likely", 0.3, True), ("unlikely", 0.3, False), ("unlikely", 0.5, True)]
)
def test_a_part_that_has_shrunk_gives_way_to_the_other(monkeypatch, word, confidence, expected):
    """One that fits nowhere is no more shrunk than wrong, and gives way to what is more probable alone."""
    best: Any = fake_match(word, 0.4, scale=0.25)
    opposite = fake_match("unlikely", confidence, scale=0.8)
    monkeypatch.setattr(match_module, "match_partial", lambda *_: (opposite, False))
    task: Any = SimpleNamespace(landmarks=(), clock=StageTimer())
    assert (match_module._compare_opposite(task, best, "source") is opposite) == expected


def test_a_stage_that_is_entered_twice_is_measured_as_one(monkeypatch):
    times = iter([1.0, 2.0, 5.0, 9.0])
    monkeypatch.setattr("kfmaps._progress.time.perf_counter", lambda: next(times))
    clock = StageTimer()
    with clock("parts"):
        pass
    with pytest.raises(GivenUp), clock("parts"):
        raise GivenUp
    assert clock.seconds == {"parts": 5.0}
