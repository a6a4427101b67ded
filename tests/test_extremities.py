"""Tips of limbs, pairings of them, and how far a shape must bend: evidence for bodies of different proportions."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from conftest import SMALL, cloud_of, inside_out, reordered, rotation, sheet
from kfmaps import datasets
from kfmaps._arrays import NotConverged
from kfmaps.config import Search
from kfmaps.fmap.zoomout import batched_zoomout
from kfmaps.geometry.coarsen import CoarseProxy
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh
from kfmaps.matching.candidates import refine_coarse
from kfmaps.matching.extremities import _MIN_DISTANCE, _gradient_cross, extremities
from kfmaps.matching.extremity_matching import (
    _MIN_EXTREMITIES,
    ExtremityMatch,
    ExtremityVertices,
    extremity_cost,
    extremity_features,
    match_extremities,
    match_of_map,
    similar_matches,
)
from kfmaps.matching.initial_maps import extremity_inits
from kfmaps.matching.quality import mirror_samples, sample_for_scoring, subsample
from kfmaps.matching.ranking import ProxyCache, by_preference, ranking
from kfmaps.matching.sample_pair import paired_map, two_level_samples
from kfmaps.matching.search import search_map
from kfmaps.matching.self_maps import find_self_maps
from kfmaps.registration.alternating_registration import proxy_pair
from kfmaps.registration.evidence import _MAX_ENERGY, MIN_ENERGY, PATIENT, deform, shape_proxy
from kfmaps.registration.nonrigid_icp import NonRigid
from kfmaps.shape import mirror_image, prepare

GUARDS = ("kfmaps.matching", "kfmaps.registration.evidence")


@pytest.fixture(scope="module")
def creature():
    """Six limbs, in two poses and with limbs of two lengths."""
    pair = datasets.non_isometric(1500, rng=1)
    return prepare(pair.source, SMALL, name="source"), prepare(pair.target, SMALL, name="target"), pair.truth


@pytest.fixture(scope="module")
def shape_samples(creature):
    return sample_for_scoring(creature[0]), sample_for_scoring(creature[1])


@pytest.fixture(scope="module")
def on(creature, shape_samples):
    return two_level_samples(creature[0], creature[1], shape_samples)


SIGNS = np.diag(np.where(np.arange(40) % 2, -1.0, 1.0))


@pytest.fixture
def itself(creature, shape_samples):
    """Copies of one creature, to be bent onto each other."""
    return proxy_pair(creature[0], creature[0], (shape_samples[0].proxy, shape_samples[0].proxy))


def identity(count):
    return ExtremityMatch(np.arange(count), np.arange(count))


def test_extremities_are_far_from_everything_around_them_and_from_each_other(shape_samples):
    for one in shape_samples:
        between = one.distances[np.ix_(one.extremities.points, one.extremities.points)]
        assert len(one.extremities.points) >= 5
        assert (between[~np.eye(len(between), dtype=bool)] >= _MIN_DISTANCE).all()
        assert (np.diff(one.extremities.mean_distance) <= 0).all()
        assert (one.extremities.mean_distance > 1.0).all()
        assert one.extremities.distances[np.arange(len(between)), one.extremities.points] == pytest.approx(
            0.0, abs=1e-12
        )


def test_extremities_do_not_depend_on_units_position_and_numbering(creature, shape_samples):
    shape, one = creature[0], shape_samples[0]
    order = np.random.default_rng(0).permutation(len(shape.mesh.vertices))
    moved = reordered(Mesh(shape.mesh.vertices @ rotation(1).T + 5.0, shape.mesh.faces), order)
    rows = np.argsort(order)[one.samples.vertices]
    mass = np.ones(len(one.distances))
    before = extremities(one.distances, mass, shape.mesh, one.samples.vertices)
    after = extremities(one.distances, mass, moved, rows)
    assert np.array_equal(before.points, after.points)
    assert after.distances == pytest.approx(before.distances, abs=1e-9)
    assert after.gradient_cross == pytest.approx(before.gradient_cross, abs=1e-6)


def test_turn_is_the_sine_between_two_directions():
    flat = sheet(*2 * [np.linspace(0, 1, 12)])
    angle = 0.7
    x, y, _ = flat.vertices.T
    functions = np.stack([x, x * np.cos(angle) + y * np.sin(angle)])
    found = _gradient_cross(flat, functions)
    assert found[0, 1] == pytest.approx(np.sin(angle))
    assert found[1, 0] == pytest.approx(-np.sin(angle))
    assert _gradient_cross(inside_out(flat), functions) == pytest.approx(-found)
    assert not _gradient_cross(cloud_of(flat), functions).any()


def test_a_shape_is_told_from_its_mirror_image_by_turns_alone(shape_samples):
    one = shape_samples[0].extremities
    m = len(one.points)
    whole = identity(m)
    same, turned = extremity_cost(one, one, whole), extremity_cost(one, one.mirrored(), whole)
    assert np.diag(same) == pytest.approx(0.0, abs=1e-9)
    assert (same.argmin(axis=1) == np.arange(len(same))).mean() > 0.99
    assert np.diag(turned).mean() > 0.1
    assert extremity_features(one, whole.source).shape == (len(one.distances[0]), m + m * (m - 1) // 2)


def test_the_true_extremity_match_is_among_the_first(creature, shape_samples, on):
    found = match_extremities(on.coarse.source, on.coarse.target, on.coarse.descriptor_cost)
    a, b = shape_samples[0], shape_samples[1]
    truth = creature[2]
    images = truth[b.samples.vertices[b.extremities.points]]
    vertices = creature[0].mesh.vertices
    tip = a.samples.vertices[a.extremities.points]
    off = np.linalg.norm(vertices[tip][:, None] - vertices[images][None], axis=2)
    worst = [off[extremity_match.source, extremity_match.target].max() for extremity_match in found]
    assert min(worst[:8]) < 0.2
    assert max(worst) > 0.5
    assert all(len(set(p.target)) == len(p.target) == len(p.source) for p in found)


def test_extremities_of_equal_shapes_match_themselves(shape_samples):
    one = shape_samples[0]
    first = similar_matches(one, one)[0]
    assert np.array_equal(first.source, first.target)
    assert len(first.source) == len(one.extremities.points)
    everywhere = np.arange(len(one.positions))
    back: Any = match_of_map(everywhere, one, one)
    assert np.array_equal(back.source, back.target)
    assert len(back.source) == len(one.extremities.points)
    assert match_of_map(np.zeros_like(everywhere), one, one) is None


@pytest.mark.parametrize(("count", "sizes"), [(4, {4}), (5, {4, 5})])
def test_of_five_extremities_one_may_be_left_out(shape_samples, count, sizes):
    one, ends = shape_samples[0], shape_samples[0].extremities
    few = replace(ends, points=ends.points[:count], mean_distance=ends.mean_distance[:count])
    assert {len(m.source) for m in similar_matches(*[replace(one, extremities=few)] * 2)} == sizes


def test_distances_between_extremities_alone_match_them(shape_samples):
    one = shape_samples[0]
    plain = replace(
        one,
        heat=np.zeros_like(one.heat),
        extremities=replace(one.extremities, mean_distance=np.ones(len(one.extremities.points))),
    )
    order = np.array([3, 0, 5, 1, 4, 2, *range(6, len(one.extremities.points))])
    tips = replace(
        plain.extremities, points=plain.extremities.points[order], distances=plain.extremities.distances[order]
    )
    first = similar_matches(plain, replace(plain, extremities=tips))[0]
    assert np.array_equal(order[first.target], first.source)


def test_shapes_without_extremities_are_not_matched_by_them(shape_samples):
    one = shape_samples[0]
    bare = replace(one, extremities=one.extremities.removed())
    assert match_extremities(one, bare, None) == []
    assert match_of_map(np.arange(len(one.positions)), bare, one) is None
    few = replace(one.extremities, points=one.extremities.points[: _MIN_EXTREMITIES - 1])
    assert match_extremities(replace(one, extremities=few), one, None) == []


def test_the_map_of_an_extremity_match_is_nearly_the_identity(on):
    few = replace(on.coarse, target=on.coarse.source, descriptor_cost=None)
    k = 8
    C = paired_map(identity(len(few.source.extremities.points)), few, k)
    assert np.linalg.norm(C - np.eye(k)) < 0.5


def test_extremity_matches_find_the_map_between_bodies_of_other_proportions(creature, on):
    found = refine_coarse(extremity_inits(40, on.coarse), on.coarse, 40)
    best = max(found, key=lambda c: c.score)
    truth = creature[2][on.coarse.target.samples.vertices]
    where = creature[0].mesh.vertices
    off = np.linalg.norm(where[on.coarse.source.samples.vertices[best.points]] - where[truth], axis=1)
    assert off.mean() < 0.12


def test_each_map_may_have_evidence_of_its_own(on):
    bases = on.coarse.source.samples.basis, on.coarse.target.samples.basis
    pairs = [identity(6), None, ExtremityMatch(np.arange(6), np.arange(6)[::-1].copy())]
    maps = np.repeat(np.eye(10)[None], 3, axis=0)
    cost = on.coarse.matching_cost(4.0, 0.0, 30.0, pairs)
    assert cost.shape == (3, len(on.coarse.target.positions), len(on.coarse.source.positions))
    together = batched_zoomout(maps, *bases, (10, 20, 30), cost)
    for i, extremity_match in enumerate(pairs):
        alone = batched_zoomout(
            maps[:1], *bases, (10, 20, 30), on.coarse.matching_cost(4.0, 0.0, 30.0, [extremity_match])
        )
        assert np.array_equal(together[1][i], alone[1][0])
    assert not np.array_equal(together[1][0], together[1][2])
    speaks: Any = on.coarse.matching_cost(0.0, 0.0, 2.0, pairs[:1])
    assert speaks[0] == pytest.approx(
        2 * extremity_cost(on.coarse.source.extremities, on.coarse.target.extremities, pairs[0]), abs=1e-5
    )


def test_a_shape_deforms_least_onto_itself(itself):
    """Strain is of all places and not of the worst: the mean of logarithms is below the logarithm of the mean."""
    kept, torn = (deform(C, itself) for C in (np.eye(40), SIGNS))
    assert kept.energy == MIN_ENERGY < 0.05 < torn.energy <= _MAX_ENERGY
    assert kept.strain == pytest.approx(np.log(MIN_ENERGY), abs=1e-6)
    assert kept.strain < torn.strain < np.log(torn.energy)


def test_limbs_of_different_lengths_leave_no_symmetry(shape_samples):
    assert find_self_maps(subsample(shape_samples[1], 400), 100) == []


def test_coarse_proxies_have_no_unreferenced_vertices(creature):
    shape = creature[0]
    loose = replace(shape, mesh=Mesh(np.vstack([shape.mesh.vertices, [[9.0, 9.0, 9.0]]]), shape.mesh.faces))
    found = shape_proxy(loose, len(loose.mesh.vertices))
    assert isinstance(found, CoarseProxy)
    assert len(found.mesh.vertices) == len(shape.mesh.vertices)
    fewer = shape_proxy(loose, 500)
    assert isinstance(fewer, CoarseProxy)
    assert len(fewer.mesh.vertices) <= 500
    assert np.array_equal(np.unique(fewer.mesh.faces), np.arange(len(fewer.mesh.vertices)))
    assert shape_proxy(replace(shape, mesh=Mesh(shape.mesh.vertices, shape.mesh.faces[:3]))) is None
    turned = found.mirrored().mesh
    assert turned.vertices[:, 0] == pytest.approx(-found.mesh.vertices[:, 0])
    assert np.array_equal(turned.faces[:, ::-1], found.mesh.faces)


def test_a_candidate_that_deforms_less_comes_first_and_one_not_registered_never(creature, on):
    found = refine_coarse(extremity_inits(40, on.coarse), on.coarse, 40)
    ranked = ranking(found, on.fine, ProxyCache.of(creature[0], creature[1], on.fine))
    scores = [c.score for c in ranked]
    assert scores == sorted(scores, reverse=True)
    equal = [replace(ranked[0], deformation_energy=b) for b in (0.3, 0.1, 0.2)]
    assert [c.deformation_energy for c in by_preference(equal)] == [0.1, 0.2, 0.3]
    assert equal[0].quality == ranked[0].quality
    assert equal[0].score < equal[1].score


def test_samples_of_a_mirror_image_have_the_opposite_orientation(shape_samples):
    turned: Any = mirror_samples(shape_samples[0])
    assert turned.mirrored
    assert np.array_equal(turned.extremities.gradient_cross, -shape_samples[0].extremities.gradient_cross)
    assert turned.proxy.mesh.vertices[:, 0] == pytest.approx(-shape_samples[0].proxy.mesh.vertices[:, 0])


def test_extremities_can_be_left_out(creature):
    plain = replace(SMALL, search=Search(candidates=2, n_sign_functions=3, match_extremities=False))
    assert not search_map(creature[0], creature[1], plain, rng=0).initialization.startswith("extremities")


def test_a_creature_is_matched_to_a_mirror_image_in_another_pose_unasked():
    """A left bone and a right one: the score sees nothing wrong with a map that keeps orientation, bending does."""
    pair = datasets.two_poses(1500, rng=1)
    source, other = (prepare(mesh, SMALL, name="creature") for mesh in (pair.source, pair.target))
    mirrored = mirror_image(other)
    found = search_map(source, mirrored, SMALL, rng=0)
    assert found.orientation == "reversing"
    assert found.verdict == "ambiguous"  # with the same creature in a mirrored pose
    preserving = replace(SMALL, search=Search(candidates=2, n_sign_functions=3, orientation="preserving"))
    kept = search_map(source, mirrored, preserving, rng=0)
    assert kept.orientation == "preserving"
    assert kept.verdict != "sure"


def test_a_proxy_that_falls_apart_says_nothing_about_the_map(creature, shape_samples, monkeypatch):
    """The other direction is believed then; only a map of which both fail has the most."""

    def energy() -> float:  # a pair keeps what it has found
        return deform(
            SIGNS, proxy_pair(creature[0], creature[0], (shape_samples[0].proxy, shape_samples[0].proxy))
        ).energy

    usual, fit = energy(), NonRigid.register_vertices
    failing = [True, False]

    def falls(self, *what):
        if failing.pop(0):
            raise NotConverged("apart")
        return fit(self, *what)

    monkeypatch.setattr(NonRigid, "register_vertices", falls)
    assert 0.3 < energy() / usual < 3.0
    failing = [True, True]
    assert energy() == _MAX_ENERGY


def test_a_map_that_is_scored_again_is_registered_once(itself, monkeypatch):
    fits = []
    kept = lambda _self, pair, points: (fits.append(points) or pair.body.mesh.vertices, 0.0)  # noqa: E731
    monkeypatch.setattr(NonRigid, "register_vertices", kept)
    assert deform(np.eye(40), itself) == deform(np.eye(40), itself)
    assert len(fits) == 2  # forth and back
    deform(np.eye(40), itself, PATIENT)
    assert len(fits) == 4
    assert all(fits[i] is fits[i + 2] for i in range(2))  # and its points are sought once


def test_guidance_by_extremities_is_the_same_with_the_graphs_at_hand(creature):
    source, target = (shape.mesh for shape in creature[:2])
    on_both = ExtremityVertices(np.array([0, 7, 30]), np.array([3, 9, 40]), (0.5, 0.6))
    plain, given = (
        on_both.guidance(source, target, graphs)
        for graphs in ((None, None), (geodesic_graph(source, 1), geodesic_graph(target, 1)))
    )
    assert np.array_equal(plain.source, given.source)
    assert np.array_equal(plain.target, given.target)
