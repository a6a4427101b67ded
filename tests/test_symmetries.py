"""Near-symmetries of a shape, exchanged limbs, and that no map is chosen without a look at what it is mistaken for."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from conftest import NO_LANDMARKS, SMALL
from kfmaps import Config, Mesh
from kfmaps.datasets import posed_pair, symmetric_creature, two_poses
from kfmaps.datasets.creature import SYMMETRIC, WAVE
from kfmaps.datasets.skeleton import Body, Limb
from kfmaps.datasets.surface import closed_mesh
from kfmaps.fmap.convert import to_points
from kfmaps.geometry.mesh import mirror_mesh, vertex_normals
from kfmaps.geometry.sampling import SpectralSamples
from kfmaps.matching import candidates as candidates_module
from kfmaps.matching import orientation, search, search_result
from kfmaps.matching import self_maps as self_maps_module
from kfmaps.matching.candidates import candidates, distinct_maps, has_clear_map, refine_coarse, score_maps
from kfmaps.matching.extremity_matching import (
    ExtremityMatch,
    asymmetry,
    extremity_difference,
    match_of_map,
    similar_matches,
)
from kfmaps.matching.finish import _doubt_exchanged
from kfmaps.matching.initial_maps import Start, symmetry_inits
from kfmaps.matching.limb_exchange import _MAX_DIFFERENCE, compare_exchanged, exchange_limbs, exchanged_matches
from kfmaps.matching.quality import _reflection_error, map_quality, mirror_samples, sample_for_scoring, subsample
from kfmaps.matching.ranking import ranking
from kfmaps.matching.sample_pair import mirrored_pair, two_level_samples
from kfmaps.matching.score import SCORE, Candidate, Quality
from kfmaps.matching.search import scoring_samples, search_map
from kfmaps.matching.search_result import _margin, alternative_maps, calibrated_evidence
from kfmaps.matching.self_maps import (
    _MAX_DISTORTION,
    _MIN_DISPLACEMENT,
    _opposite,
    find_reflection,
    find_self_maps,
    self_images,
    self_maps,
    with_self_maps,
)
from kfmaps.shape import prepare

GUARDS = ("kfmaps.matching",)


@pytest.fixture(scope="module")
def on(symmetric):
    return symmetric.samples.coarse


def kept_seed():
    return int(np.random.default_rng(0).integers(2**31))


def moved(C, of):
    k = len(C)
    basis = of.samples.basis.functions[:, :k]
    points = ((basis @ C.T) ** 2).sum(axis=1)[None, :] - 2 * basis @ (basis @ C.T).T
    return np.linalg.norm(of.positions[points.argmin(axis=1)] - of.positions, axis=1).mean()


def test_a_body_is_nearly_its_own_mirror_image(on):
    found = find_self_maps(on.source, 100)
    assert len(found) >= 1
    first = map_quality(found[0], on.source, on.source)
    assert first.orientation < -0.9
    assert first.distortion < 0.1 < _MAX_DISTORTION
    assert moved(found[0], on.source) > 0.15 > _MIN_DISPLACEMENT
    # Done twice it is the identity.
    assert moved((found[0] @ found[0])[:15, :15], on.source) < 0.08


@pytest.fixture(scope="module")
def reflected(symmetric):
    return scoring_samples(symmetric.source)


def test_the_reflection_takes_a_point_to_its_mirror_image_and_back(reflected):
    there = reflected.reflection
    displacement = np.linalg.norm(reflected.positions[there] - reflected.positions, axis=1)
    back = np.linalg.norm(reflected.positions[there[there]] - reflected.positions, axis=1)
    assert displacement.mean() > 0.15
    assert back.mean() < 0.03
    partner = reflected.reflected_extremities
    assert np.array_equal(partner[partner], np.arange(len(partner)))
    assert 2 <= (partner != np.arange(len(partner))).sum() < len(partner)
    assert mirror_samples(reflected).reflection == pytest.approx(there)
    assert replace(reflected, reflection_map=None).reflection is None
    assert not reflected.has_rotation


def test_extremities_alone_find_a_reflection_unless_functions_are_few(on):
    C: Any = find_reflection(on.source, [])
    assert map_quality(C, on.source, on.source).orientation < -0.9
    few = SpectralSamples(on.source.samples.vertices, on.source.samples.basis.truncate(29))
    assert find_reflection(replace(on.source, samples=few), []) is None
    assert find_reflection(replace(on.source, orientation=None), []) is None


def test_a_map_that_does_not_commute_with_the_reflections_is_found(reflected):
    same = np.arange(len(reflected.positions))
    assert _reflection_error(reflected, reflected, same) == 0.0
    assert _reflection_error(reflected, reflected, reflected.reflection) < 0.02
    partner, extremities = reflected.reflected_extremities, reflected.extremities
    one = int(np.flatnonzero(partner != np.arange(len(partner)))[0])
    near = extremities.unit * extremities.distances[one] < 0.3
    wrong = np.where(near, extremities.points[partner[one]], same)
    share = reflected.areas[near].sum()
    assert share < _reflection_error(reflected, reflected, wrong) < 2.2 * share
    assert map_quality(np.eye(30), reflected, reflected, wrong).reflection_error > 0.4 * share
    unknown = replace(reflected, reflection_map=None)
    assert _reflection_error(unknown, reflected, wrong) == _reflection_error(reflected, unknown, wrong) == 0.0


def test_extremities_are_matched_as_the_reflections_say():
    """0 and 1 are a pair of legs on both shapes, 2 is a tail."""
    partner = np.array([1, 0, 2])
    targets = np.array([[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0]])
    assert asymmetry(np.array([0, 1, 2]), targets, partner, partner).tolist() == [0.0, 0.0, 1.0, 1.0]
    assert asymmetry(np.array([0, 2]), np.array([[1, 2], [2, 1]]), partner, partner).tolist() == [0.0, 1.0]
    assert asymmetry(np.array([0, 1, 2]), targets, partner, None).tolist() == [0.0] * 4
    four = np.array([1, 0, 3, 2])  # two pairs: partners must stay partners
    mixed = np.array([[0, 1, 2, 3], [0, 2, 1, 3]])
    assert asymmetry(np.arange(4), mixed, four, four).tolist() == [0.0, 1.0]


def test_those_that_change_distances_early_are_none(monkeypatch, on):
    some = find_self_maps(on.source, 100)
    monkeypatch.setattr(self_maps_module, "_MAX_CANDIDATES", 99)
    for one, other in zip(some, find_self_maps(on.source, 100), strict=True):
        np.testing.assert_array_equal(one, other)
    same, lost = np.eye(10), np.diag([1.0] + [0.0] * 9)
    changed, moved_by = self_maps_module._changes(np.stack([same, lost]), on.source)
    assert changed[0] == moved_by[0] == 0.0
    assert moved_by[1] > _MIN_DISPLACEMENT
    # All that are taken to one point lose all of their distance.
    assert changed[1] == pytest.approx(on.source.distances.mean())


def test_cached_samples_have_self_maps(symmetric):
    kept: Any = scoring_samples(symmetric.source)
    few = subsample(sample_for_scoring(symmetric.source, rng=kept_seed()), 400)
    for C, again in zip(self_maps(subsample(kept, 400), 100), find_self_maps(few, 100), strict=True):
        np.testing.assert_array_equal(C, again)
    np.testing.assert_array_equal(mirror_samples(kept).self_maps, kept.self_maps)
    # Those of fewer functions are others.
    assert [len(C) for C in self_maps(subsample(kept, 400), 30)] == [30] * len(find_self_maps(few, 30))


def test_one_function_has_none(on):
    assert find_self_maps(on.source, 1) == []


@pytest.mark.parametrize("of_target", [False, True])
def test_a_map_is_compared_with_what_it_is_mistaken_for(symmetric, on, of_target):
    """Of nothing but the mirrored map the true one is found: it could not be sure for want of a rival."""
    C = symmetric.C
    S = find_self_maps(on.target if of_target else on.source, 40)[0]
    right = score_maps([Start("truth", C)], on)[0]
    mirrored = score_maps([Start("mirrored", S @ C if of_target else C @ S)], on)[0]
    assert len(distinct_maps([right, mirrored], on.source, 0.12)) == 2
    starts = symmetry_inits([mirrored], on, 60)
    assert {start.uses_descriptors for start in starts} == {True}
    found = sorted(refine_coarse(starts, on, 60), key=lambda c: c.score, reverse=True)
    assert len(distinct_maps([right, found[0]], on.source, 0.08)) == 1


def test_a_map_is_composed_before_and_after(symmetric, on):
    whole = score_maps([Start("truth", symmetric.C)], on)[0]
    made = [start.functional_map for start in symmetry_inits([whole], on, 60)]
    S, T = find_self_maps(on.source, 60)[0], find_self_maps(on.target, 60)[0]
    k = min(len(S), len(symmetric.C))
    for expected in (symmetric.C[:k, :k] @ S[:k, :k], T[:k, :k] @ symmetric.C[:k, :k]):
        assert any(np.array_equal(one, expected) for one in made)


def test_a_symmetric_body_is_not_taken_for_a_mirror_image(symmetric, unmarked, monkeypatch):
    source, truth = symmetric.source, symmetric.truth
    state: Any = unmarked._search
    whole = state.samples.fine

    def error(one):
        true = source.mesh.vertices[truth[whole.target.samples.vertices]]
        return np.linalg.norm(whole.source.positions[one.points] - true, axis=1).mean()

    assert error(state.ranked[0]) < 0.05
    S, C = self_maps(state.samples.coarse.target, 40)[0], state.ranked[0].functional_map
    mirrored = S @ C[: len(S), : len(S)]
    image = score_maps([Start("image", mirrored)], mirrored_pair(whole))[0]
    missed = [one for one in state.candidates if error(one) > 0.1]
    blind = replace(state, candidates=missed, ranked=ranking(missed, whole, state.proxies))
    assert image.score > blind.ranked[0].score
    monkeypatch.setattr(orientation, "mirror_candidates", lambda *_: [image])
    chosen = orientation.choose_orientation(blind, deforms_too_much=True)
    assert chosen.orientation == "preserving"
    assert error(chosen.ranked[0]) < 0.05
    monkeypatch.setattr(orientation, "compose_with_symmetries", lambda *_: [])
    assert orientation.choose_orientation(blind, deforms_too_much=True).orientation == "reversing"
    led = orientation.choose_orientation(replace(blind, may_reverse=False), deforms_too_much=True)
    assert led.orientation == "preserving"
    assert [one.name for one, margin in led.doubts if margin < 0.0] == ["image"]


@pytest.fixture(scope="module")
def walk():
    """A symmetric body in two poses, the second the mirror image of the first, and their prepared shapes."""
    posed = posed_pair("walk", Body(SYMMETRIC), WAVE, WAVE, (1500, 1600), np.random.default_rng(0), mirror=True)
    return posed, prepare(posed.source, SMALL), prepare(mirror_mesh(posed.target), SMALL)


def test_a_symmetric_body_in_the_mirrored_pose_is_not_taken_for_a_mirror_image(walk, monkeypatch):
    """As in the two halves of a walk: the map that exchanges left and right hardly deforms the body."""
    posed, source, target = walk
    ways, verdicts = [], []
    for margin in (SCORE.isometry_margin, 0.0):
        numbers = replace(SCORE, mirror_margin=0.0, isometry_margin=margin)
        monkeypatch.setattr(orientation, "SCORE", numbers)
        found = search_map(source, target, SMALL)
        ways.append(found.orientation)
        verdicts.append(found.verdict)
        points = to_points(found.functional_map, source.basis, target.basis)
        true = posed.mirrored if found.orientation == "preserving" else posed.truth
        error = np.linalg.norm(source.mesh.vertices[points] - source.mesh.vertices[true], axis=1).mean()
        assert error < 0.05
    assert ways == ["preserving", "reversing"]
    assert verdicts[0] == "ambiguous"


def test_landmarks_decide_between_a_mirrored_pose_and_a_mirror_image(walk, monkeypatch):
    """Without them the map that keeps orientation is "ambiguous" with one to the mirror image, which fits better."""
    monkeypatch.setattr(orientation, "SCORE", replace(SCORE, mirror_margin=100.0))  # as if it were hardly better
    posed, source, target = walk
    places, rng = posed.source.vertices, np.random.default_rng(3)
    apart = np.linalg.norm(places[posed.truth] - places[posed.mirrored], axis=1)

    def outcome(ends, where):
        """Of a search with landmarks at target vertices ``where`` and at source vertices ``ends`` there."""
        distinct = np.unique(ends, return_index=True)[1]
        some = rng.choice(distinct[where[distinct]], 8, replace=False)
        found = search_map(source, target, SMALL, landmarks=np.column_stack([ends[some], some]))
        return found.orientation, found.verdict, len(found.rejected_landmarks)

    assert outcome(posed.truth, apart > 0.3) == ("reversing", "sure", 0)
    assert outcome(posed.mirrored, apart > 0.3) == ("preserving", "sure", 0)
    assert outcome(posed.truth, apart < 0.04) == ("preserving", "ambiguous", 0), "these say nothing"


@pytest.mark.parametrize(("advantage", "verdict"), [(0.9, "ambiguous"), (1.3, "ambiguous"), (3.0, "sure")])
def test_only_a_mirror_image_that_is_much_more_isometric_is_sure(walk, monkeypatch, advantage, verdict):
    monkeypatch.setattr(orientation, "SCORE", replace(SCORE, mirror_margin=0.0))
    monkeypatch.setattr(orientation, "_isometry_advantage", lambda *_: advantage)
    _, source, target = walk
    found = search_map(source, target, SMALL)
    assert (found.orientation, found.verdict) == ("reversing", verdict)
    state: Any = found._search
    assert state.doubts[0][1] == pytest.approx(SCORE.isometry_factor * (advantage - SCORE.isometry_margin))


def test_landmarks_alone_put_no_mirror_image_first_and_cast_no_doubt(unmarked, monkeypatch):
    """With left and right exchanged they agree with one, which fits the surfaces less well."""
    state: Any = unmarked._search
    best, missed = state.ranked[0], np.full(10, SCORE.max_landmark_error)
    worse = replace(best.quality, distortion=best.quality.distortion + 1.0)
    image = replace(best, name="image", quality=worse, landmark_errors=np.zeros(10))
    free = [replace(one, landmark_errors=missed) for one in state.ranked]
    landmark_vertices = np.zeros((10, 2), dtype=np.int64)
    led = replace(state, landmarks=landmark_vertices, candidates=free, ranked=free, without_landmarks=free, doubts=())
    assert image.score > free[0].score + SCORE.mirror_margin
    monkeypatch.setattr(orientation, "mirror_candidates", lambda *_: [image])
    monkeypatch.setattr(orientation, "ranking", lambda found, *_: found)
    for may_reverse in (False, True):
        chosen = orientation.choose_orientation(replace(led, may_reverse=may_reverse), deforms_too_much=True)
        assert (chosen.orientation, chosen.doubts) == ("preserving", ())
        assert chosen.candidates is free


ARMS = 5


def starfish_body(n_arms=ARMS):
    trunk = Limb("trunk", None, ((0, 0, -0.05, 0.2), (0, 0, 0, 0.22), (0, 0, 0.05, 0.2)))
    arms = []
    for i, a in enumerate(2 * np.pi * np.arange(n_arms) / n_arms):
        balls = ((r * np.cos(a), r * np.sin(a), 0, thick) for r, thick in ((0.1, 0.14), (0.4, 0.11), (0.8, 0.05)))
        arms.append(Limb(f"arm {i}", "trunk", tuple(balls)))
    return Body((trunk, *arms))


def test_a_starfish_is_turned_onto_itself():
    vertices, faces = closed_mesh(starfish_body(), starfish_body().box(), 1500, np.random.default_rng(0))
    of = subsample(sample_for_scoring(prepare(Mesh(vertices, faces), SMALL)), 400)
    self_maps_found = find_self_maps(of, 60)
    found = [C for C in self_maps_found if map_quality(C, of, of).orientation > 0.9]
    assert found
    assert find_reflection(of, self_maps_found) is None  # one of five
    turned = [Rotation.from_rotvec([0, 0, 2 * np.pi * i / ARMS]).as_matrix() for i in range(ARMS)]
    around = [*turned[1:], *(R @ np.diag([1, -1, -1]) for R in turned)]  # or turned over
    for C in found:
        images = of.positions[images_of(C, of)]
        off = [np.linalg.norm(images - of.positions @ R, axis=1).mean() for R in around]
        assert min(off) < 0.06 < 0.3 < max(off)


def test_all_nine_arms_are_exchanged_and_the_seven_farthest_matched():
    body = starfish_body(9)
    vertices, faces = closed_mesh(body, body.box(), 1500, np.random.default_rng(0))
    of = subsample(sample_for_scoring(prepare(Mesh(vertices, faces), SMALL)), 400)
    assert len(of.extremities.points) == 9
    matches = similar_matches(of, of)
    assert {len(one.source) for one in matches} == {6, 7}
    assert max(max(one.source.max(), one.target.max()) for one in matches) == 6
    everywhere: Any = match_of_map(np.arange(400), of, of)
    alone = [one for one in exchanged_matches(everywhere, of, of) if (one.source != everywhere.source).sum() == 2]
    assert len(alone) == 10
    assert any(one.source[8] != 8 or one.source[7] != 7 for one in alone)


def table_body():
    """A table on four legs: two mirrorings, and half a turn, which keeps the orientation."""
    limbs = [Limb("trunk", None, ((0, 0.7, -0.55, 0.1), (0, 0.7, 0, 0.12), (0, 0.7, 0.55, 0.1)))]
    for x in (-1, 1):
        limbs.append(Limb(f"side {x}", "trunk", tuple((x * a, 0.7, 0, 0.1) for a in (0.05, 0.2, 0.4))))
        for z in (-1, 1):
            balls = ((0.1, 0.68, 0.5, 0.08), (0.35, 0.5, 0.6, 0.06), (0.4, 0, 0.65, 0.055))
            limbs.append(Limb(f"leg {x} {z}", "trunk", tuple((x * a, b, z * c, r) for a, b, c, r in balls)))
    return Body(tuple(limbs))


def table_mesh():
    return closed_mesh(table_body(), table_body().box(), 1500, np.random.default_rng(0))


def images_of(C, of):
    """The sample that each sample of a shape is taken to by a self-map."""
    basis = of.samples.basis.functions[:, : len(C)]
    return KDTree(basis @ C.T).query(basis)[1]


def test_a_table_is_turned_onto_itself_by_its_extremities(monkeypatch):
    table = prepare(Mesh(*table_mesh()), SMALL)
    of = subsample(sample_for_scoring(table), 400)

    def turns():
        """Distances of the self-maps that keep the orientation from half a turn."""
        found = [C for C in find_self_maps(of, 60) if map_quality(C, of, of).orientation > 0.9]
        images = [of.positions[images_of(C, of)] for C in found]
        return [np.linalg.norm(at - of.positions * [-1, 1, -1], axis=1).mean() for at in images]

    assert min(turns()) < 0.05
    assert find_reflection(of, find_self_maps(of, 60)) is None  # one of two
    assert with_self_maps(of).has_rotation
    some = np.arange(0, len(table.mesh.vertices), 3)
    positions = table.mesh.vertices[some]
    images = [np.linalg.norm(positions[at] - positions * [-1, 1, -1], axis=1).mean() for at in self_images(table, some)]
    assert len(images) == len(turns())
    assert min(images) < 0.05
    monkeypatch.setattr(self_maps_module, "_keeps_shot", lambda quality, _shape: quality.orientation < 0.5)
    assert not turns()


def test_a_flat_candelabra_is_rotated_though_that_hardly_differs_from_its_reflection():
    limbs = [Limb("trunk", None, ((0, 0, 0, 0.2), (0, 0.2, 0, 0.1), (0, 0.8, 0, 0.08), (0, 1.5, 0, 0.06)))]
    for x in (-1, 1):
        inner = ((0, 0.7, 0, 0.07), (0.3 * x, 0.8, 0, 0.055), (0.33 * x, 1.3, 0, 0.05))
        outer = ((0, 0.45, 0, 0.07), (0.55 * x, 0.55, 0, 0.055), (0.65 * x, 1.3, 0, 0.05))
        limbs += [Limb(f"inner {x}", "trunk", inner), Limb(f"outer {x}", "trunk", outer)]
    body = Body(tuple(limbs))
    mesh = Mesh(*closed_mesh(body, body.box(), 1500, np.random.default_rng(0)))
    of = with_self_maps(sample_for_scoring(prepare(mesh, Config())))
    few, found = subsample(of, 400), {}
    assert of.self_maps is not None
    for C in of.self_maps:
        orientation = map_quality(C, few, few).orientation
        if abs(orientation) > 0.9:
            found[orientation > 0] = few.positions[images_of(C, few)]
    assert np.linalg.norm(found[True] - found[False], axis=1).mean() < self_maps_module._MIN_DIFFERENCE
    assert of.has_rotation
    assert of.reflection_map is None  # one of two


def test_a_rotation_moves_the_whole_shape_and_keeps_all(monkeypatch):
    of = subsample(sample_for_scoring(prepare(Mesh(*table_mesh()), SMALL)), 400)
    qualities = [(C, map_quality(C, of, of)) for C in find_self_maps(of, 60)]
    S, good = next((C, quality) for C, quality in qualities if quality.orientation > 0.9)

    def is_rotation(C: Any = S, **changes: Any) -> bool:
        monkeypatch.setattr(self_maps_module, "map_quality", lambda *_: replace(good, **changes))
        return self_maps_module._is_rotation(C, of)

    for least, descriptors in zip(self_maps_module._MIN_ROTATION_SCORES, (0.9, 0.8), strict=True):
        changes = {"descriptors": descriptors * of.neighbor_difference}
        lost = replace(good, **changes).score - least
        assert is_rotation(coverage=good.coverage - lost + 0.1, **changes)
        assert not is_rotation(coverage=good.coverage - lost - 0.1, **changes)
    assert not is_rotation(C=np.eye(40))
    assert not is_rotation(orientation=0.4, coverage=9.0)
    assert not is_rotation(distortion=1.01 * self_maps_module._MAX_ROTATION_DISTORTION, coverage=9.0)
    monkeypatch.setattr(self_maps_module, "_MIN_ROTATION", 0.9)
    assert not is_rotation()


def test_what_is_seen_from_the_front_is_turned_to_the_back():
    """Half a turn of a body that is its own mirror image: each vertex to what lies behind its reflection."""
    pair = symmetric_creature(1500, rng=0)
    body = prepare(pair.source, SMALL)
    assert pair.mirrored is not None
    _, first = np.unique(pair.truth, return_index=True)
    some, mirrored = pair.truth[first], pair.mirrored[first]
    plain, turned = self_images(body, some), self_images(body, some, turned=True)
    assert len(turned) == len(plain) + 1
    points, normals = body.mesh.vertices, vertex_normals(body.mesh)
    images = some[turned[-1]]
    facing = np.einsum("ij,ij->i", normals[images], normals[mirrored])
    off = np.linalg.norm(points[images] - points[mirrored], axis=1)
    assert np.mean(facing < 0) > 0.8
    assert 0.02 < np.median(off) < 0.2


def test_the_other_side_is_the_nearest_one_that_faces_away():
    x = np.array([[0.0, 0, 0], [0, 0, -0.2], [0.5, 0, -0.1], [0, 0, 0.1]])
    away = np.array([[0.0, 0, 1], [0, 0, -1], [0, 0, -1], [0, 0, 1]])
    assert _opposite(x, away).tolist() == [1, 0, 0, 1]


def test_a_worm_is_turned_about_its_axis():
    balls = ((0, 0, -1.2, 0.03), (0, 0, -0.6, 0.08), (0, 0, 0, 0.1), (0, 0, 0.6, 0.09), (0, 0, 1.1, 0.1))
    worm = Body((Limb("trunk", None, balls),))
    vertices, faces = closed_mesh(worm, worm.box(), 1500, np.random.default_rng(0))
    of = subsample(sample_for_scoring(prepare(Mesh(vertices, faces), SMALL)), 400)
    found = [C for C in find_self_maps(of, 60) if map_quality(C, of, of).orientation > 0.9]
    assert found
    for C in found:
        off = of.positions[images_of(C, of)] - of.positions
        assert np.linalg.norm(off[:, :2], axis=1).mean() > 0.1 > 0.05 > np.abs(off[:, 2]).mean()


@pytest.mark.parametrize("seed", range(3))
def test_two_equal_components_may_be_exchanged(seed):
    one = two_poses(1500).source
    vertices = np.vstack([one.vertices, one.vertices + np.array([3.0, 0, 0])])
    # Every eigenvalue is double: rounding errors decide which functions of its eigenspace are taken.
    vertices *= 1 + 1e-13 * np.random.default_rng(seed).standard_normal(vertices.shape)
    both = Mesh(vertices, np.vstack([one.faces, one.faces + len(one.vertices)]))
    of = subsample(sample_for_scoring(prepare(both, SMALL)), 400)
    is_first = of.positions[:, 0] < np.median(of.positions[:, 0])
    changes = [(is_first != is_first[images_of(C, of)]).mean() for C in find_self_maps(of, 60)]
    assert max(changes) > 0.9


def test_neighbors_differ_by_a_share_of_random_samples(on):
    of = on.source
    apart = np.linalg.norm(of.positions[:, None] - of.positions, axis=2) + np.diag(np.full(len(of.positions), np.inf))
    squares = ((of.descriptors[:, None] - of.descriptors) ** 2).sum(axis=2)
    near = squares[np.arange(len(squares)), apart.argmin(axis=1)] @ of.areas
    assert of.neighbor_difference == pytest.approx(near / squares.mean(), rel=1e-4)


def test_a_self_map_keeps_orientation_and_shot(on):
    kept = Quality(0.98, 0.05, 0.15, 0.8 * on.source.neighbor_difference, 0.01, 0.9, 0.05)
    assert self_maps_module._keeps_shot(kept, on.source)
    assert not self_maps_module._keeps_shot(replace(kept, orientation=-0.98), on.source)
    assert not self_maps_module._keeps_shot(replace(kept, descriptors=0.9 * on.source.neighbor_difference), on.source)


def test_a_map_that_is_found_only_by_composition_is_composed_too(monkeypatch, symmetric):
    composed = []

    def starts(best, pair, functions):
        composed.append(best)
        return symmetry_inits(best, pair, functions)

    def gains(gain):
        def coarse_map(begun, pair, _functions):
            far = begun[0].name.startswith("self-map") and len(composed) == 1
            found = [score_maps([Start(one.name, symmetric.C)], pair)[0] for one in begun[:1]]
            return [replace(c, quality=replace(c.quality, coverage=c.quality.coverage + gain * far)) for c in found]

        composed.clear()
        with monkeypatch.context() as patch:
            patch.setattr(candidates_module, "symmetry_inits", starts)
            patch.setattr(candidates_module, "refine_coarse", coarse_map)
            patch.setattr(candidates_module, "refine_fine", lambda few, *_: few)
            candidates(symmetric.source, symmetric.target, SMALL, symmetric.samples, 0)
        return [len(best) for best in composed]

    assert gains(0.9) == [1]
    assert gains(1.1) == [1, 1]
    assert composed[1][0].name.startswith("self-map")


def test_every_alternative_may_be_the_symmetric_one(unmarked):
    state: Any = unmarked._search
    best = state.ranked[0]
    usual = np.exp(-3.6 - 0.233 * best.quality.score)
    worse, like = (replace(best, deformation_energy=x * usual, strain=9.0) for x in (1.01, 0.99))
    assert search_result.build_result(state, best, [worse]).verdict == "sure"
    assert search_result.build_result(state, best, [worse, like]).verdict == "ambiguous"


def test_a_symmetric_rival_is_compared_by_its_quality_alone(on):
    best = score_maps([Start("best", np.eye(20))], on)[0]
    best = replace(best, deformation_energy=0.01, strain=-0.1)
    usual = np.exp(-3.6 - 0.233 * best.quality.score)
    bends_less, bends_more = (replace(best, deformation_energy=usual * x, strain=0.1) for x in (0.99, 1.01))
    assert _margin(best, bends_less, False) == 0.0
    assert _margin(best, bends_more, False) == pytest.approx(best.score - bends_more.score) != 0.0
    better = replace(bends_more, quality=replace(best.quality, coverage=best.quality.coverage + 0.1))
    assert _margin(best, better, False) == pytest.approx(SCORE.rotation_margin * (best.score - better.score))
    worse = replace(bends_less, quality=replace(best.quality, coverage=best.quality.coverage - 0.31))
    assert _margin(best, worse, False) == pytest.approx(best.score - worse.score)
    # Landmarks tell a shape from its turned image: those that are missed count as in the score.
    met, missed = (np.full(3, error) for error in (0.0, SCORE.max_landmark_error / 2))
    led, turned = replace(best, landmark_errors=met), replace(bends_less, landmark_errors=missed)
    assert _margin(led, turned, False) == pytest.approx(1.5 * SCORE.w_landmark)
    assert _margin(turned, replace(led, deformation_energy=usual * 0.99), False) == pytest.approx(
        -1.5 * SCORE.w_landmark
    )
    # A turn that keeps a shape may deform one pose less than the right map, so no such energy counts.
    assert _margin(best, bends_more, True) == 0.0
    assert _margin(best, worse, True) == pytest.approx(0.31 * SCORE.w_coverage)
    unknown = replace(best, deformation_energy=None, strain=None)
    assert _margin(best, unknown, False) == best.score - unknown.score


def test_a_margin_counts_less_between_shapes_that_a_turn_may_keep(unmarked):
    state: Any = unmarked._search
    best, fine = state.ranked[0], state.samples.fine
    rival = replace(best, quality=replace(best.quality, coverage=best.quality.coverage - 1.0))
    some, none = np.eye(20)[None], np.zeros((0, 20, 20))
    reflection = np.eye(20)

    def margin(source, target, rotated=(False, False)):
        sides = (
            replace(side, self_maps=maps, reflection_map=C, has_rotation=turn)
            for side, (maps, C), turn in zip((fine.source, fine.target), (source, target), rotated, strict=True)
        )
        pair = replace(fine, **dict(zip(("source", "target"), sides, strict=True)))
        return calibrated_evidence(replace(state, samples=replace(state.samples, fine=pair)), best, [rival])[1]

    whole = best.score - rival.score
    assert whole > 0
    assert margin((some, None), (some, None)) == pytest.approx(SCORE.rotation_margin * whole)
    for rotated in ((True, False), (False, True)):
        assert margin((some, reflection), (some, None), rotated) == pytest.approx(SCORE.rotation_margin * whole)
        assert margin((some, reflection), (none, None), rotated) == pytest.approx(whole)
    for sides in (
        ((some, reflection), (some, None)),
        ((some, None), (some, reflection)),
        ((none, None), (some, None)),
        ((some, None), (none, None)),
        ((some, None), (None, None)),
    ):
        assert margin(*sides) == pytest.approx(whole)


def wrong_area(one, symmetric):
    """Share of the target's samples that go far from where they should."""
    true = symmetric.source.mesh.vertices[symmetric.truth[symmetric.fine.target.samples.vertices]]
    off = np.linalg.norm(symmetric.fine.source.positions[one.points] - true, axis=1)
    return float(symmetric.fine.target.areas[off > SCORE.moved_distance].sum())


@pytest.fixture(scope="module")
def exchanged(symmetric):
    """The worst of the maps with two limbs exchanged."""
    return max(exchange_limbs(symmetric.right, symmetric.fine), key=lambda one: wrong_area(one, symmetric))


def test_alike_extremities_are_exchanged_two_at_a_time(symmetric):
    match: Any = match_of_map(symmetric.right.points, symmetric.fine.source, symmetric.fine.target)
    unlike = extremity_difference(symmetric.fine.source, symmetric.fine.source)
    assert np.diag(unlike) == pytest.approx(0.0)
    some = exchanged_matches(match, symmetric.fine.source, symmetric.fine.target)
    assert some
    for one in some:
        i, j = np.flatnonzero(one.source != match.source)
        assert (one.source[i], one.source[j]) == (match.source[j], match.source[i])
        assert np.array_equal(one.target, match.target)
        assert unlike[one.source[i], one.source[j]] <= _MAX_DIFFERENCE


def test_limbs_of_one_side_are_exchanged_together_with_their_mirror_images(reflected):
    same = np.arange(len(reflected.extremities.points))
    partner, match = reflected.reflected_extremities, ExtremityMatch(same, same)
    between = reflected.extremities.distances[:, reflected.extremities.points]

    def exchanged_together(match, source, target):
        return [one for one in exchanged_matches(match, source, target) if (one.source != match.source).sum() > 2]

    paired, bare = (partner != same).sum() // 2, replace(reflected, reflection_map=None)
    both = exchanged_together(match, reflected, bare)
    assert len(both) == paired * (paired - 1) // 2 > 0
    for images in (one.source for one in both):
        limbs = np.flatnonzero(images != same)
        assert len(limbs) == 4
        assert np.array_equal(images[images], same)
        assert np.array_equal(images[partner], partner[images])
        assert (between[limbs, images[limbs]] < between[limbs, partner[images[limbs]]]).all()
    assert len({tuple(one.source) for one in both}) == len(both)
    # Of a target whose extremities have other numbers, the same limbs by its reflection alone.
    others = np.roll(same, 1)
    by_target = exchanged_together(ExtremityMatch(others, same), bare, reflected)
    assert [one.source.tolist() for one in by_target] == [others[one.source].tolist() for one in both]
    assert not exchanged_together(match, bare, bare)
    left = np.flatnonzero(partner > same)
    assert not exchanged_together(ExtremityMatch(left, left), reflected, reflected)


def test_only_the_limbs_are_exchanged(symmetric, exchanged):
    assert wrong_area(symmetric.right, symmetric) < 0.02
    assert 0.05 < wrong_area(exchanged, symmetric) < 0.5
    assert exchanged.score < symmetric.right.score


def test_exchanged_maps_are_refined_from_a_quarter_of_the_functions_on(symmetric, monkeypatch):
    """From half of them on they stay torn."""
    seen, size = [], len(symmetric.right.functional_map)
    monkeypatch.setattr("kfmaps.matching.limb_exchange.refine_batch", lambda _, __, sizes: seen.append(sizes) or [])
    exchange_limbs(symmetric.right, symmetric.fine)
    assert seen == [(size // 4, size // 2, 3 * size // 4, size)]


def test_exchanged_limbs_are_found_out(symmetric, exchanged, monkeypatch):
    monkeypatch.setattr("kfmaps.matching.limb_exchange.SCORE", replace(SCORE, max_exchange_behind=99.0))
    for begun in (symmetric.right, exchanged):
        order = compare_exchanged(begun, symmetric.fine, symmetric.proxies)
        assert len(order) == 2
        assert wrong_area(order[0], symmetric) < 0.03 < wrong_area(order[1], symmetric)
        assert order[0].score > order[1].score + SCORE.close_margin
    # Nearer than this it is no rival, unless it scores better.
    few = replace(SCORE, max_exchange_behind=99.0, min_exchange_distance=1.0)
    monkeypatch.setattr("kfmaps.matching.limb_exchange.SCORE", few)
    assert compare_exchanged(symmetric.right, symmetric.fine, symmetric.proxies) == [symmetric.right]
    (mended,) = compare_exchanged(exchanged, symmetric.fine, symmetric.proxies)
    assert wrong_area(mended, symmetric) < 0.03
    # Nor is it one farther behind, whatever its registration.
    behind = symmetric.right.unregistered.score - max(c.score for c in exchange_limbs(symmetric.right, symmetric.fine))
    for limit, count in ((behind - 0.1, 1), (behind + 0.1, 2)):
        monkeypatch.setattr("kfmaps.matching.limb_exchange.SCORE", replace(SCORE, max_exchange_behind=limit))
        assert len(compare_exchanged(symmetric.right, symmetric.fine, symmetric.proxies)) == count


def test_pairs_of_exchanged_limbs_are_mended_one_after_the_other(symmetric, exchanged, monkeypatch):
    monkeypatch.setattr("kfmaps.matching.limb_exchange._mirrored_pairs", lambda *_: [])
    twice = max(exchange_limbs(exchanged, symmetric.fine), key=lambda one: wrong_area(one, symmetric))
    assert wrong_area(twice, symmetric) > wrong_area(exchanged, symmetric) + 0.05
    mended = compare_exchanged(twice, symmetric.fine, symmetric.proxies)[0]
    assert wrong_area(mended, symmetric) < 0.03


def test_limbs_are_exchanged_as_long_as_the_score_rises(symmetric, exchanged, monkeypatch):
    gains, begun = iter((1.0, 2.0, 3.0, 2.5)), []

    def exchanged_once(one, _pair):
        begun.append(one.score - exchanged.score)
        better = exchanged.quality.descriptors - next(gains) / SCORE.w_descriptors
        return [replace(exchanged, quality=replace(exchanged.quality, descriptors=better))]

    monkeypatch.setattr("kfmaps.matching.limb_exchange.exchange_limbs", exchanged_once)
    compare_exchanged(exchanged, symmetric.fine, symmetric.proxies)
    assert begun == pytest.approx([0.0, 1.0, 2.0, 3.0])


def test_exchanged_limbs_with_a_close_score_cast_a_doubt(symmetric, exchanged, monkeypatch):
    monkeypatch.setattr(search, "candidates", lambda *_what, **_how: [symmetric.right])
    plain = search_map(symmetric.source, symmetric.target, SMALL)
    assert plain.doubts == ()

    def searched(margin):
        def near(best):
            worse = replace(best.quality, descriptors=best.quality.descriptors + margin / SCORE.w_descriptors)
            same = {name: getattr(best, name) for name in ("deformation_energy", "strain", "shot_error")}
            return [best, replace(exchanged, quality=worse, **same)]

        monkeypatch.setattr(search, "compare_exchanged", lambda best, *_: near(best))
        return search_map(symmetric.source, symmetric.target, SMALL)

    assert searched(2.6).doubts == ()
    assert searched(1.7).doubts == pytest.approx((1.7,))
    found = searched(0.12)
    assert found.doubts == pytest.approx((0.12,))
    assert (plain.verdict, found.verdict) == ("sure", "ambiguous")
    assert found.scores[0] - found.scores[1] == pytest.approx(0.12)
    trust = np.full(len(symmetric.truth), 0.9)
    doubted = _doubt_exchanged(trust, symmetric.truth, found, symmetric.source.mesh)
    moved = doubted < 0.5
    assert 0.05 < moved.mean() < 0.5
    assert doubted[~moved] == pytest.approx(0.9)
    assert _doubt_exchanged(trust, symmetric.truth, plain, symmetric.source.mesh) == pytest.approx(0.9)
    elsewhere = replace(found, alternatives=(np.random.default_rng(0).permutation(symmetric.truth),))
    assert _doubt_exchanged(trust, symmetric.truth, elsewhere, symmetric.source.mesh) == pytest.approx(0.9)


def names(monkeypatch, pair, easy, on=None, landmarks=NO_LANDMARKS, descriptors=None):
    """Kinds of rough maps that are tried, weights of the signs, and how many are refined further."""
    tried, finalists = [], []

    def coarse_map(starts, *rest):
        tried.extend(start.name.split()[0] for start in starts)
        tried.extend(start.weights[0] for start in starts if start.name.startswith("signs"))
        return original(starts[::5], *rest)

    def fine(few, *_rest):
        finalists.append(len(few))
        return few

    original = candidates_module.refine_coarse
    with monkeypatch.context() as patch:
        patch.setattr(candidates_module, "SCORE", replace(SCORE, early_exit_score=easy))
        patch.setattr(candidates_module, "refine_coarse", coarse_map)
        patch.setattr(candidates_module, "refine_fine", fine)
        candidates(pair.source, pair.target, SMALL, on or pair.samples, 0, landmarks=landmarks, descriptors=descriptors)
    return set(tried), finalists[0]


def test_a_clear_map_is_compared_with_near_symmetries_alone(monkeypatch, symmetric):
    tried, finalists = names(monkeypatch, symmetric, -np.inf)
    assert tried == {"signs", "self-map", 0.0, 12.0}
    assert finalists <= candidates_module._N_CLEAR_FINALISTS
    tried, finalists = names(monkeypatch, symmetric, np.inf)
    assert {"signs", "self-map", "SHOT", 0.0, 4.0, 12.0} < tried
    assert finalists > candidates_module._N_CLEAR_FINALISTS


def test_descriptors_and_landmarks_of_the_user_take_part(monkeypatch, symmetric):
    shapes = symmetric.source, symmetric.target
    given = [np.random.default_rng(i).normal(size=(len(shape.mesh.vertices), 2)) for i, shape in enumerate(shapes)]
    assert "SHOT" in names(monkeypatch, symmetric, -np.inf, descriptors=tuple(given))[0]
    landmark_vertices = np.stack([symmetric.truth[:2], np.arange(2)], axis=1)
    both = [sample_for_scoring(shape) for shape in shapes]
    led = two_level_samples(*shapes, (both[0], both[1]), landmark_vertices)
    assert "SHOT" in names(monkeypatch, symmetric, -np.inf, led, landmark_vertices)[0]


def test_rivals_make_nothing_clear():
    def of(distortion, guided):
        quality = Quality(1.0, distortion, 0.0, 0.0, 0.0, 1.0, 0.0)
        return Candidate("", np.eye(2), np.zeros(1, dtype=np.int64), quality, guided)

    assert not has_clear_map([])
    assert has_clear_map([of(1.0, True)])
    assert not has_clear_map([of(1.0, False), of(2.0, True)])  # 2 - 6 · 2 is below


def test_maps_passed_over_of_large_shapes_name_few_vertices(monkeypatch, symmetric):
    source, target, C = symmetric.source, symmetric.target, symmetric.C
    whole = to_points(C, source.basis, target.basis)
    np.testing.assert_array_equal(alternative_maps([C], source.basis, target.basis)[0], whole)
    monkeypatch.setattr(search_result, "MAX_CANDIDATES", 500)
    few = alternative_maps([C], source.basis, target.basis)[0]
    assert len(np.unique(few)) <= 500
    off = np.linalg.norm(source.mesh.vertices[few] - source.mesh.vertices[whole], axis=1)
    assert 0 < off.mean() < 2 / np.sqrt(500)
