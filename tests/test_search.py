"""The parts of a search: many refinements at once, families of fits, landmarks as evidence, coarse surfaces."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from conftest import NO_FACES, NO_LANDMARKS, SMALL, blob, joined
from kfmaps.config import BasisConfig, Search
from kfmaps.fmap.descriptor_guidance import combine_guidance, descriptor_guidance
from kfmaps.fmap.precise import nearest_vertices
from kfmaps.fmap.solvers import CG
from kfmaps.fmap.zoomout import ZoomOut, batched_zoomout
from kfmaps.geometry.coarsen import coarsen
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.mesh import Mesh, face_areas, unit_area, vertex_normals
from kfmaps.geometry.sampling import spectral_samples
from kfmaps.matching import candidates, orientation
from kfmaps.matching.candidates import refine_fine, rerefine, score_maps
from kfmaps.matching.features import sample_pair_for_fit
from kfmaps.matching.finish import adapt_settings
from kfmaps.matching.fit import fit
from kfmaps.matching.initial_maps import FIT_SAMPLES, FitSpec, Start, fit_descriptor_set
from kfmaps.matching.landmark_evidence import heat_features, heat_guidance, landmark_distances, landmark_errors
from kfmaps.matching.match import match
from kfmaps.matching.quality import sample_for_scoring, sample_surface
from kfmaps.matching.sample_pair import (
    TwoLevelSamples,
    build_sample_pair,
    descriptor_cost,
    drop_landmarks,
    two_level_samples,
)
from kfmaps.matching.score import SCORE, rejected_landmarks
from kfmaps.matching.search import search_map
from kfmaps.matching.search_result import SearchResult
from kfmaps.shape import prepare, sample_shape

GUARDS = ("kfmaps.fmap.descriptor_guidance", "kfmaps.geometry.coarsen", "kfmaps.geometry.sampling", "kfmaps.matching")

BLOBS = SMALL, 700, 650


@pytest.mark.parametrize("weight", [0.0, 12.0])
def test_many_maps_at_once_are_refined_as_one_is(shape, other, weight):
    a, b = (spectral_samples(s.basis, 200) for s in (shape, other))
    guided: Any = descriptor_guidance(shape.mesh.vertices[a.vertices], other.mesh.vertices[b.vertices])
    rng = np.random.default_rng(0)
    starts = np.stack([np.diag([1.0, *signs]) for signs in rng.choice([-1.0, 1.0], size=(7, 5))])
    against = np.float32(weight) * descriptor_cost(guided) if weight else None
    maps, points = batched_zoomout(starts, a.basis, b.basis, (6, 14, 22, 30), against)
    for C, here, start in zip(maps, points, starts, strict=True):
        one = ZoomOut(6, 30, 8, descriptor_weight=weight)(start, a.basis, b.basis, guidance=guided)
        np.testing.assert_allclose(C, one.functional_map, atol=2e-3)
        assert (here != one.target_to_source).mean() < 0.02


def test_a_family_makes_the_maps_that_single_fits_make(shape, other):
    settings = replace(
        SMALL,
        descriptors=replace(SMALL.descriptors, n_spectral=30),
        operator_rtol=1e-9,
        solver=CG(rtol=1e-9),
        weights=replace(SMALL.weights, orientation=0.0),
    )
    points = sample_pair_for_fit(shape, other, FIT_SAMPLES, NO_LANDMARKS)
    wanted = [FitSpec("SHOT and waves", k, 0.0) for k in (30, 12)]
    maps = fit_descriptor_set(wanted, points, settings, (None, None), 3)
    for chosen, C in zip(wanted, (made.functional_map for made in maps), strict=True):
        assert C.shape == (chosen.functions, chosen.functions)
        alone = fit(shape, other, replace(settings, basis=BasisConfig(n_eigenfunctions=chosen.functions)), rng=3)
        assert np.linalg.norm(C - alone.functional_map) < 0.03 * np.linalg.norm(C)


def test_the_orientation_of_a_family_turns_its_maps(shape, other):
    points = sample_pair_for_fit(shape, other, FIT_SAMPLES, NO_LANDMARKS)
    shape_samples = sample_for_scoring(shape, 200), sample_for_scoring(other, 200)
    cubes: Any = shape_samples[0].orientation, shape_samples[1].orientation
    maps = [
        fit_descriptor_set([FitSpec("waves", 20, w)], points, SMALL, c, 0)[0].functional_map
        for w, c in ((1.0, cubes), (1.0, (cubes[0], -cubes[1])), (0.0, cubes))
    ]
    on = build_sample_pair(*shape_samples)
    kept, turned, free = (c.quality.orientation for c in score_maps([Start("", C) for C in maps], on))
    assert kept > 0.8
    assert kept > turned + 0.3
    assert kept >= free - 1e-6


def test_heat_from_landmarks_is_one_at_the_landmark_and_nowhere_more(shape):
    at = np.array([3, 77])
    found = heat_features(shape.basis, shape.basis, at)
    assert found.shape == (2, 700, 3)
    np.testing.assert_allclose(found[[0, 1], at], 1.0)
    assert found.max() <= 1 + 1e-12
    places = heat_guidance(found, found)
    gaps = ((places.source[:, None] - places.target[None]) ** 2).sum(axis=2).mean()
    assert gaps == pytest.approx(1.0)


def test_guidances_are_combined_in_proportion_to_their_weights(shape):
    first, second = (heat_guidance(*[heat_features(shape.basis, shape.basis, np.array([v]))] * 2) for v in (5, 300))
    both: Any = combine_guidance([(12.0, first), (3.0, second)])
    gap = ((both.source[1] - both.target[2]) ** 2).sum()
    parts = [((g.source[1] - g.target[2]) ** 2).sum() for g in (first, second)]
    assert gap == pytest.approx(parts[0] + parts[1] / 4)
    assert combine_guidance([(12.0, None), (0.0, second)]) is None


def test_a_landmark_is_rejected_when_a_map_keeps_to_most_of_the_others():
    near, far = 0.02, 0.9
    assert rejected_landmarks(np.array([near, near, far, near, near]), 0.3).tolist() == [
        False,
        False,
        True,
        False,
        False,
    ]
    assert not rejected_landmarks(np.array([far, near]), 0.3).any()
    assert not rejected_landmarks(np.array([far, far, near, near, far]), 0.3).any()


def test_missed_is_the_distance_from_where_a_landmark_belongs(shape):
    at = np.array([10, 200, 400])
    wrong = np.array([10, 200, 5])
    judge = sample_for_scoring(shape, 300)
    on: Any = two_level_samples(shape, shape, (judge, judge), np.stack([at, wrong], axis=1))
    off = landmark_errors(np.eye(60), judge.samples.basis.functions, on.fine.landmark_evidence)
    true = geodesic_distances(shape.mesh, at[2:])[0, 5]
    assert off[:2].max() < 0.1
    assert off[2] == pytest.approx(true, abs=0.1)
    one = score_maps([Start("", np.eye(60))], on.fine)[0]
    assert one.quality.score - one.score == pytest.approx(SCORE.w_landmark, rel=0.3)
    less = drop_landmarks(on, np.array([False, False, True])).fine
    assert drop_landmarks(on, np.ones(3, dtype=bool)).coarse.landmark_cost is None
    assert rerefine([one], less)[0].landmark_errors.shape == (2,)
    assert len(refine_fine([one], TwoLevelSamples(less, less))[0].landmark_errors) == 2


def test_a_map_refined_again_begins_with_half_of_its_functions(shape, monkeypatch):
    """Its points are among the fine samples, those of coarse maps among the coarse ones."""
    side = sample_for_scoring(shape, 300)
    samples: Any = two_level_samples(shape, shape, (side, side))
    functions = min(80, len(shape.basis.eigenvalues))
    assert functions > 50
    one, begun, known = score_maps([Start("", np.eye(50))], samples.fine)[0], [], []
    monkeypatch.setattr(candidates, "match_of_map", lambda _points, a, b: known.append((a, b)))
    monkeypatch.setattr(candidates, "refine_batch", lambda _starts, pair, sizes: begun.append((pair, sizes)) or [])
    refine_fine([one], samples, again=True)
    assert {sizes for _, sizes in begun} == {(*range(40, functions, 5), functions)}
    assert all(pair is samples.fine for pair, _ in begun)
    assert all(a is samples.fine.source and b is samples.fine.target for a, b in known)
    begun.clear(), known.clear()
    refine_fine([one], samples)
    assert {sizes for _, sizes in begun} == {(*range(20, functions, 5), functions)}
    assert all(a is samples.coarse.source and b is samples.coarse.target for a, b in known)
    assert known


def test_a_coarse_surface_has_the_distances_and_the_sides_of_the_fine_one():
    mesh = unit_area(blob(3000))
    basis = prepare(mesh, replace(SMALL, descriptors=replace(SMALL.descriptors, shot=False))).basis
    vertices = np.sort(spectral_samples(basis, 500).vertices)
    few = coarsen(mesh, vertices)
    np.testing.assert_array_equal(few.vertices, mesh.vertices[vertices])
    assert face_areas(few).sum() == pytest.approx(1.0, rel=0.05)
    true = geodesic_distances(mesh, vertices[:20])[:, vertices]
    found = geodesic_distances(few, np.arange(20))
    assert np.abs(found - true).mean() < 0.03 * true.mean()
    sides = (vertex_normals(few) * vertex_normals(mesh)[vertices]).sum(axis=1)
    assert sides.min() > 0.5
    cloud = Mesh(mesh.vertices, NO_FACES)
    assert len(coarsen(cloud, vertices).faces) == 0


def test_a_large_shape_is_scored_on_a_coarse_proxy(monkeypatch):
    shape = prepare(blob(1500), SMALL)
    whole: Any = sample_for_scoring(shape, 200)
    samples = whole.samples.vertices
    from_landmarks = [landmark_distances(shape, whole, np.array([7, samples[3]]))]
    monkeypatch.setattr("kfmaps.matching.quality.MAX_SURFACE_VERTICES", 900)
    assert len(sample_surface(shape, np.arange(10))[0].vertices) < 950
    less: Any = sample_for_scoring(shape, 200)
    np.testing.assert_array_equal(less.samples.vertices, samples)
    from_landmarks.append(landmark_distances(shape, less, np.array([7, samples[3]])))
    np.testing.assert_array_equal([distances[1, 3] for distances in from_landmarks], 0.0)
    for a, b in ((less.distances, whole.distances), from_landmarks):
        assert np.abs(a - b).mean() < 0.03 * b.mean()
    change = np.linalg.norm(less.orientation - whole.orientation) / np.linalg.norm(whole.orientation)
    assert change < 0.2


def test_a_landmark_on_a_small_component_is_far_from_the_others():
    """As one on an eyeball is from the head: as far as the farthest samples are from each other."""
    body, eye = blob(600), blob(60)
    shape = prepare(
        joined(body, Mesh(0.2 * eye.vertices + 3.0, eye.faces)),
        replace(SMALL, descriptors=replace(SMALL.descriptors, shot=False)),
    )
    samples = sample_for_scoring(shape, 200)
    found = landmark_distances(shape, samples, np.array([610]))[0]
    on_eye = samples.samples.vertices >= 600
    assert 0 < found[on_eye].max() < 0.5 < samples.distances.max()
    np.testing.assert_array_equal(found[~on_eye], samples.distances.max())


def test_a_mirrored_shape_is_told_from_a_kept_one(shape, other, monkeypatch):
    """Left and right bones: the answer says which one was found, and keeps orientation where either would do.

    Unasked, one that is better, but not clearly, makes the map ambiguous.
    """
    image = Mesh(blob(650, twist=0.4).vertices * [1.0, 1.0, -1.0], blob(650).faces[:, ::-1])
    asked, either = (
        replace(SMALL, search=Search(candidates=2, n_sign_functions=3, orientation=way))
        for way in ("reversing", "either")
    )
    mirrored = prepare(image, SMALL, name="image")
    found = match(shape, mirrored, asked)
    moved = shape.mesh.vertices[found.target_to_source] * [1, 1, -1] - unit_area(image).vertices
    assert found.orientation == "reversing"
    # The two are centred on the mean of slightly different vertices.
    assert np.linalg.norm(moved - moved.mean(axis=0), axis=1).mean() < 0.04
    assert [match(shape, one, either).orientation for one in (other, mirrored)] == ["preserving", "reversing"]
    monkeypatch.setattr(orientation, "SCORE", replace(SCORE, congruent_energy=0.0, mirror_margin=100.0))
    kept = search_map(shape, mirrored, SMALL)
    assert (kept.orientation, kept.verdict) == ("preserving", "ambiguous")
    moved = shape.mesh.vertices[kept.alternatives[0]] * [1, 1, -1] - unit_area(image).vertices
    assert kept.scores[1] > kept.scores[0] + SCORE.mirror_gain
    assert np.linalg.norm(moved - moved.mean(axis=0), axis=1).mean() < 0.06
    # It must be more isometric, too.
    for margin, way in ((9.0, "preserving"), (-9.0, "reversing")):
        margins = {"mirror_margin": 0.0, "isometry_margin": margin}
        monkeypatch.setattr(orientation, "SCORE", replace(SCORE, congruent_energy=0.0, **margins))
        assert search_map(shape, mirrored, SMALL).orientation == way


def test_a_refinement_of_unlike_shapes_ends_early():
    zoom = ZoomOut(50, 200, 25, descriptor_weight=36.0)

    def adapted(refinement, quality):
        found = SearchResult(np.eye(80), "signs", None, "sure", quality=quality)
        return adapt_settings(replace(SMALL, refinement=refinement), found, 0).refinement

    assert adapted(zoom, -5.0) == zoom
    assert adapted(zoom, None) == zoom
    assert adapted(None, -12.0) is None
    early = adapted(zoom, -12.0)
    assert isinstance(early, ZoomOut)
    assert (early.start, early.stop, early.descriptor_weight) == (50, 100, 36.0)
    assert adapted(ZoomOut(20, 60, 5), -12.0) == ZoomOut(20, 60, 5)


def test_a_search_without_kernel_fits_has_none(shape, other, monkeypatch):
    monkeypatch.setattr(candidates, "SCORE", replace(SCORE, early_exit_score=np.inf))
    found: Any = search_map(shape, other, replace(SMALL, search=Search(candidates=0, n_sign_functions=3)), rng=0)
    assert all(c.fit is None for c in found._search.candidates)
    assert found.verdict == "sure"


def test_a_candidate_knows_the_fit_that_it_began_with(shape, other, monkeypatch):
    """All that began with small kernel fits have theirs, whatever was refined and scored since; no other has one."""
    asked = []

    def spy(*arguments):
        asked.append(arguments[-1])
        return sample_pair_for_fit(*arguments)

    monkeypatch.setattr(candidates, "sample_pair_for_fit", spy)
    monkeypatch.setattr(candidates, "SCORE", replace(SCORE, early_exit_score=np.inf))
    found: Any = search_map(shape, other, SMALL, rng=7)
    assert asked == [7]  # the points of the fits come from the seed
    expected = sample_shape(shape, 300, NO_LANDMARKS[:, 0], 7).shape.mesh.vertices
    sampled = sample_pair_for_fit(shape, other, 300, NO_LANDMARKS, None, 7)
    np.testing.assert_array_equal(sampled.shapes[0].mesh.vertices, expected)
    began = {c.name: c.fit for c in found._search.candidates}
    fitted = {name: one for name, one in began.items() if name.startswith(("SHOT", "waves"))}
    assert fitted
    assert {name for name, one in began.items() if one is not None} == set(fitted)
    for name, one in fitted.items():
        size = int(name.split(", ")[1].split()[0])
        assert one.functional_map.shape == (size, size)
        assert set(one.energies) >= {"laplacian", "descriptors", "commutativity"}
    assert found.fit is began[found.initialization]


def test_points_inside_triangles_use_the_guidance_of_the_map(shape, other, monkeypatch):
    monkeypatch.setattr("kfmaps.shape.MIN_SEARCH_VERTICES", 0)  # points of divided meshes are rounded to corners twice
    shape, other = replace(shape), replace(other)
    found = match(shape, other, replace(SMALL, registration=None))
    assert found.precise_map is None
    near = nearest_vertices(found.precise(), shape.mesh)
    assert (near == found.target_to_source).mean() > 0.95
