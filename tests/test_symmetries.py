"""Near-symmetries of a shape, and that no map is chosen without a look at what it is mistaken for."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from kfmaps import Config, Mesh, datasets, match
from kfmaps.datasets.skeleton import Bend, Body, Limb
from kfmaps.datasets.surface import closed_mesh
from kfmaps.fmap.convert import to_functional
from kfmaps.matching import orientation
from kfmaps.matching import self_maps as within
from kfmaps.matching.candidates import distinct_maps, refine_coarse, score_maps
from kfmaps.matching.initial_maps import Start, symmetry_inits
from kfmaps.matching.quality import map_quality, mirror_samples, sample_for_scoring, subsample
from kfmaps.matching.ranking import ranking
from kfmaps.matching.sample_pair import mirrored_pair, two_level_samples
from kfmaps.matching.search import scoring_samples, search_map
from kfmaps.matching.search_result import _margin
from kfmaps.matching.self_maps import _MAX_DISTORTION, _MIN_DISPLACEMENT, find_self_maps, self_maps
from kfmaps.shape import prepare
from test_search import SMALL

GUARDS = ("kfmaps.matching",)


@pytest.fixture(scope="module")
def pair():
    made = datasets.symmetric_creature(1500, rng=1)
    return prepare(made.source, SMALL, name="source"), prepare(made.target, SMALL, name="target"), made.truth


@pytest.fixture(scope="module")
def on(pair):
    return two_level_samples(pair[0], pair[1], (sample_for_scoring(pair[0]), sample_for_scoring(pair[1]))).coarse


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


def test_those_that_change_distances_early_are_none(monkeypatch, on):
    some = find_self_maps(on.source, 100)
    monkeypatch.setattr(within, "_MAX_CANDIDATES", 99)
    for one, other in zip(some, find_self_maps(on.source, 100), strict=True):
        np.testing.assert_array_equal(one, other)
    same, lost = np.eye(10), np.diag([1.0] + [0.0] * 9)
    changed, moved_by = within._changes(np.stack([same, lost]), on.source)
    assert changed[0] == moved_by[0] == 0.0
    assert moved_by[1] > _MIN_DISPLACEMENT
    # All that are taken to one point lose all of their distance.
    assert changed[1] == pytest.approx(on.source.distances.mean())


def test_a_kept_probe_knows_them(pair):
    kept = scoring_samples(pair[0])
    few = subsample(sample_for_scoring(pair[0], rng=kept_seed()), 400)
    for C, again in zip(self_maps(subsample(kept, 400), 100), find_self_maps(few, 100), strict=True):
        np.testing.assert_array_equal(C, again)
    assert kept.self_maps is not None
    np.testing.assert_array_equal(mirror_samples(kept).self_maps, kept.self_maps)
    # Those of fewer functions are others.
    assert [len(C) for C in self_maps(subsample(kept, 400), 30)] == [30] * len(find_self_maps(few, 30))


def test_one_function_has_none(on):
    assert find_self_maps(on.source, 1) == []


@pytest.mark.parametrize("of_target", [False, True])
def test_a_map_is_compared_with_what_it_is_mistaken_for(pair, on, of_target):
    """Of nothing but the mirrored map the true one is found: it could not be sure for want of a rival."""
    source, target, truth = pair
    C = np.asarray(to_functional(truth, source.basis.truncate(40), target.basis.truncate(40)))
    S = find_self_maps(on.target if of_target else on.source, 40)[0]
    right = score_maps([Start("truth", C)], on)[0]
    mirrored = score_maps([Start("mirrored", S @ C if of_target else C @ S)], on)[0]
    assert len(distinct_maps([right, mirrored], on.source, 0.12)) == 2
    starts = symmetry_inits([mirrored], on, 60)
    assert {start.uses_descriptors for start in starts} == {True}
    found = sorted(refine_coarse(starts, on, 60), key=lambda c: c.score, reverse=True)
    assert len(distinct_maps([right, found[0]], on.source, 0.08)) == 1


def test_a_symmetric_body_is_not_taken_for_a_mirror_image(pair, monkeypatch):
    """A search that has missed the right map, but not the mirrored one, finds it by the symmetry of the body."""
    source, target, truth = pair
    state = search_map(source, target, SMALL)._search
    assert state is not None
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


ARMS = 5


def starfish_body():
    trunk = Limb("trunk", None, ((0, 0, -0.05, 0.2), (0, 0, 0, 0.22), (0, 0, 0.05, 0.2)))
    arms = []
    for i, a in enumerate(2 * np.pi * np.arange(ARMS) / ARMS):
        balls = ((r * np.cos(a), r * np.sin(a), 0, thick) for r, thick in ((0.1, 0.14), (0.4, 0.11), (0.8, 0.05)))
        arms.append(Limb(f"arm {i}", "trunk", tuple(balls)))
    return Body((trunk, *arms))


def starfish(seed):
    rng = np.random.default_rng(seed)

    def pose():
        return {f"arm {i}": Bend(tuple(map(tuple, rng.normal(0, 12, (2, 3))))) for i in range(ARMS)}

    return datasets.posed_pair("starfish", starfish_body(), pose(), pose(), (1500, 1500), rng)


def test_a_starfish_is_turned_onto_itself():
    vertices, faces = closed_mesh(starfish_body(), starfish_body().box(), 1500, np.random.default_rng(0))
    of = subsample(sample_for_scoring(prepare(Mesh(vertices, faces), SMALL)), 400)
    found = [C for C in find_self_maps(of, 60) if map_quality(C, of, of).orientation > 0.9]
    assert found
    around = [Rotation.from_rotvec([0, 0, 2 * np.pi * i / ARMS]).as_matrix() for i in range(1, ARMS)]
    for C in found:
        basis = of.samples.basis.functions[:, : len(C)]
        images = of.positions[KDTree(basis @ C.T).query(basis)[1]]
        off = [np.linalg.norm(images - of.positions @ R, axis=1).mean() for R in around]
        assert min(off) < 0.06 < 0.3 < max(off)


def test_a_map_of_a_starfish_is_not_sure():
    pair = starfish(0)
    found = match(pair.source, pair.target, Config())
    assert found.verdict == "ambiguous"


def test_a_symmetric_rival_is_compared_by_its_quality_alone(on):
    best = score_maps([Start("best", np.eye(20))], on)[0]
    best = replace(best, deformation_energy=0.01, strain=-0.1)
    usual = np.exp(-3.6 - 0.233 * best.quality.score)
    bends_less, bends_more = (replace(best, deformation_energy=usual * x, strain=0.1) for x in (0.99, 1.01))
    assert _margin(best, bends_less) == 0.0
    assert _margin(best, bends_more) == pytest.approx(best.score - bends_more.score) != 0.0
    worse = replace(bends_less, quality=replace(best.quality, coverage=best.quality.coverage - 0.31))
    assert _margin(best, worse) == pytest.approx(best.score - worse.score)
    unknown = replace(best, deformation_energy=None, strain=None)
    assert _margin(best, unknown) == best.score - unknown.score
