"""Laws of collections: graphs of pairs, agreement over cycles, ways round, hands."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from kfmaps.collection.pair_graph import (
    bridges,
    medoid,
    nearest_neighbor_graph,
    signature,
    signature_distances,
    signature_graph,
)
from kfmaps.collection.paths import best_path, compose_maps, invert_map
from kfmaps.collection.repair import CyclePath, _synchronize, chirality, repair_maps
from kfmaps.collection.scored_map import ScoredMap, candidate_maps, with_better_score
from kfmaps.collection.synchronization import (
    _RESIDUAL_LIMITS,
    CandidateMap,
    Edge,
    _Problem,
    _spanning_tree_init,
    _spectral_init,
    synchronize,
)
from kfmaps.descriptors.spectral import log_heat_signature
from kfmaps.fmap.constraints import nearest_orthogonal
from kfmaps.geometry.basis import Basis

GUARDS = ("kfmaps.collection",)

K = 8


def rotations(count: int, seed: int = 0, size: int = K) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.stack([nearest_orthogonal(rng.normal(size=(size, size))) for _ in range(count)])


def consistent_links(latent: np.ndarray, pairs, wrong=(), odds: float = 0.0, seed: int = 1) -> list[Edge]:
    """Links whose maps agree exactly, but for those numbered in ``wrong``, which are random."""
    rng = np.random.default_rng(seed)
    links = []
    for number, (a, b) in enumerate(pairs):
        C = latent[b] @ latent[a].T
        links.append(
            Edge(a, b, (CandidateMap(nearest_orthogonal(rng.normal(size=C.shape)) if number in wrong else C, odds),))
        )
    return links


def complete_graph(count: int) -> tuple[tuple[int, int], ...]:
    return tuple(itertools.combinations(range(count), 2))


def connected(count: int, pairs) -> bool:
    label = np.arange(count)
    for _ in range(count):
        for a, b in pairs:
            label[[a, b]] = min(label[a], label[b])
    return len(set(label)) == 1


# --- graphs ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("count", "each"), [(2, 2), (3, 2), (5, 4), (20, 3), (25, 4)])
def test_near_pairs_join_all_and_none_is_the_only_way(count: int, each: int) -> None:
    points = np.random.default_rng(count).normal(size=(count, 3))
    pairs = nearest_neighbor_graph(signature_distances(points), each)
    assert list(pairs) == sorted({(min(p), max(p)) for p in pairs})
    assert connected(count, pairs)
    assert len(pairs) <= each * count
    if count > 2:
        assert all(connected(count, [p for p in pairs if p != out]) for out in pairs)
    degree = np.bincount(np.ravel(pairs), minlength=count)
    assert degree.min() >= min(each, count - 1)


def test_near_pairs_of_two_clusters_are_joined_twice_whatever_their_numbers() -> None:
    points = np.concatenate([np.zeros((4, 1)), np.full((4, 1), 10.0)]) + 0.01 * np.arange(8)[:, None]
    pairs = nearest_neighbor_graph(signature_distances(points), 2)
    across = [p for p in pairs if (p[0] < 4) != (p[1] < 4)]
    assert len(across) == 2
    # They follow the numbers.
    points = np.random.default_rng(3).normal(size=(12, 4))
    order = np.random.default_rng(4).permutation(12)
    pairs = nearest_neighbor_graph(signature_distances(points))
    moved = nearest_neighbor_graph(signature_distances(points[order]))
    assert {tuple(sorted(order[list(p)])) for p in moved} == set(pairs)


def test_stars_and_all_pairs() -> None:
    places = np.array([[0.0], [9.0], [1.0], [5.0]])
    assert signature_graph("star", places) == ((2, 0), (2, 1), (2, 3))
    assert signature_graph("all", places[:3]) == ((0, 1), (0, 2), (1, 2))
    assert medoid(signature_distances(np.array([[0.0], [1.0], [5.0]]))) == 1


@pytest.mark.parametrize("seed", range(5))
def test_bridges_are_what_the_graph_falls_apart_without(seed: int) -> None:
    rng = np.random.default_rng(seed)
    pairs = [(int(a), int(b)) for a, b in rng.integers(0, 14, (16, 2)) if a != b]

    def parts(some: list[tuple[int, int]]) -> int:
        label = np.arange(14)
        for _ in range(14):
            for a, b in some:
                label[[a, b]] = min(label[a], label[b])
        return len(set(label.tolist()))

    alone = {pair for i, pair in enumerate(pairs) if parts(pairs[:i] + pairs[i + 1 :]) > parts(pairs)}
    assert bridges(14, pairs) == alone
    assert bridges(3, [(0, 1), (1, 0), (1, 2)]) == {(1, 2)}


def test_a_spanning_tree_takes_the_pairs_with_most_for_them() -> None:
    """The wrong map between the ends of a chain has least for it, so the latent maps do not know of it."""
    rng = np.random.default_rng(0)
    true = [np.linalg.qr(rng.normal(size=(4, 4)))[0] for _ in range(3)]
    ends = [(0, 2), (0, 1), (1, 2)]
    maps = [np.stack([true[b] @ true[a].T]) for a, b in ends]
    maps[0] = -maps[0]
    latent = _spanning_tree_init(_Problem(3, ends, maps, [np.array([odds]) for odds in (-2.0, 1.0, 3.0)]), 4)
    for (a, b), C in zip(ends[1:], maps[1:], strict=True):
        np.testing.assert_allclose(C[0] @ latent[a], latent[b], atol=1e-12)


def test_signatures_are_those_of_the_shape() -> None:
    rng = np.random.default_rng(0)
    values = np.sort(rng.uniform(1, 400, 40))
    values[0] = 0
    functions, mass = rng.normal(size=(50, 40)), np.full(50, 0.02)
    one = signature(Basis(values, functions, mass))
    order = rng.permutation(50)
    signs = rng.choice([-1.0, 1.0], 40)
    np.testing.assert_allclose(one, signature(Basis(values, functions[order] * signs, mass[order])), atol=1e-12)
    assert np.abs(one - signature(Basis(1.3 * values, functions, mass))).max() > 0.1
    heat = log_heat_signature(Basis(values, functions, mass))
    np.testing.assert_allclose(one[30:].reshape(7, 8)[[0, 3, 6]], np.percentile(heat, [5, 50, 95], axis=0))
    few = signature(Basis(values[:10], functions[:, :10], mass))
    assert few.shape == one.shape
    assert np.isfinite(few).all()


# --- agreement ------------------------------------------------------------------------------------------------------


def test_maps_that_agree_are_found_to() -> None:
    latent = rotations(6)
    found = synchronize(6, consistent_links(latent, complete_graph(6)), K)
    assert max(m.max() for m in found.residuals) < 1e-12
    assert min(c[0] for c in found.probabilities) > 0.7
    Y = found.latent
    np.testing.assert_allclose(Y @ np.swapaxes(Y, 1, 2), np.tile(np.eye(K), (len(Y), 1, 1)), atol=1e-10)
    np.testing.assert_allclose(Y[4] @ Y[0].T, latent[4] @ latent[0].T, atol=1e-10)


def test_planted_wrong_pairs_are_found_by_cycles_alone() -> None:
    latent, pairs = rotations(10), complete_graph(10)
    wrong = set(np.random.default_rng(2).permutation(len(pairs))[: len(pairs) // 3].tolist())
    found = synchronize(10, consistent_links(latent, pairs, wrong), K)
    assert {i for i, c in enumerate(found.probabilities) if c[0] < 0.5} == wrong


def test_the_limit_is_that_of_right_pairs_even_where_most_are_wrong() -> None:
    latent, pairs = rotations(6), complete_graph(6)
    wrong = set(np.random.default_rng(3).choice(len(pairs), 8, replace=False).tolist())
    found = synchronize(6, consistent_links(latent, pairs, wrong), K)
    assert {i for i, c in enumerate(found.probabilities) if c[0] < 0.5} == wrong
    assert found.limit == _RESIDUAL_LIMITS[0]


def test_flips_that_agree_with_each_other_are_outvoted() -> None:
    latent, pairs = rotations(9), complete_graph(9)
    flip = np.diag([1.0, 1, -1, 1, -1, -1, 1, 1])
    links = consistent_links(latent, pairs)
    wrong = set(np.random.default_rng(3).permutation(len(pairs))[:9].tolist())
    assert np.bincount(np.ravel([pairs[i] for i in wrong]), minlength=9).max() <= 3  # of the 8 of each shape
    links = [
        Edge(a.source, a.target, (CandidateMap(latent[a.target] @ flip @ latent[a.source].T),)) if i in wrong else a
        for i, a in enumerate(links)
    ]
    found = synchronize(9, links, K)
    assert {i for i, c in enumerate(found.probabilities) if c[0] < 0.5} == wrong


def test_long_cycles_set_no_right_pairs_apart() -> None:
    """On a ring a wrong pair of the tree parts it in two, and over the border right pairs contradict each other."""
    count, rng = 90, np.random.default_rng(2)
    pairs = [(i, (i + step) % count) for i in range(count) for step in (1, 2, 5)]
    wrong = set(rng.permutation(len(pairs))[: len(pairs) // 5].tolist())
    found = synchronize(count, consistent_links(rotations(count, 2), pairs, wrong), K)
    assert {i for i, c in enumerate(found.probabilities) if c[0] < 0.5} == wrong


def test_the_right_candidate_is_chosen_and_evidence_decides_where_cycles_cannot() -> None:
    latent = rotations(5)
    bad = nearest_orthogonal(np.random.default_rng(7).normal(size=(K, K)))
    links = [
        Edge(a, b, (CandidateMap(bad, 0.5), CandidateMap(latent[b] @ latent[a].T, 0.0), CandidateMap(bad.T, 0.2)))
        if (a, b) == (1, 3)
        else one
        for (a, b), one in zip(complete_graph(5), consistent_links(latent, complete_graph(5)), strict=True)
    ]
    found = synchronize(5, links, K)
    assert found.probabilities[complete_graph(5).index((1, 3))].argmax() == 1
    lone = [Edge(0, 1, (CandidateMap(bad, 1.0), CandidateMap(bad.T, -1.0)))]
    chances = synchronize(2, lone, K).probabilities[0]
    assert chances[0] > chances[1]
    assert chances[0] > 0.6


def test_order_and_numbers_do_not_matter() -> None:
    latent, pairs = rotations(7), complete_graph(7)
    links = consistent_links(latent, pairs, {0, 5, 11})
    found = synchronize(7, links, K)
    backwards = synchronize(7, links[::-1], K)
    np.testing.assert_allclose(
        [c[0] for c in backwards.probabilities[::-1]], [c[0] for c in found.probabilities], atol=1e-6
    )
    new = np.random.default_rng(1).permutation(7)
    renamed = synchronize(7, [Edge(int(new[a.source]), int(new[a.target]), a.candidates) for a in links], K)
    np.testing.assert_allclose([c[0] for c in renamed.probabilities], [c[0] for c in found.probabilities], atol=1e-6)
    turned = synchronize(7, [Edge(a.target, a.source, (CandidateMap(a.candidates[0].map.T),)) for a in links], K)
    np.testing.assert_allclose([c[0] for c in turned.probabilities], [c[0] for c in found.probabilities], atol=1e-6)


def test_parts_that_no_pair_joins_stand_alone() -> None:
    latent = rotations(6)
    pairs = [(0, 1), (1, 2), (0, 2), (3, 4), (4, 5), (3, 5)]
    found = synchronize(6, consistent_links(latent, pairs), K)
    assert len(set(found.component[:3])) == 1
    assert found.component[0] != found.component[3]
    assert max(m.max() for m in found.residuals) < 1e-12


# --- ways, repair, hands --------------------------------------------------------------------------------------------


def test_the_best_way_is_the_most_probable() -> None:
    ends = [(0, 3), (0, 1), (1, 3), (0, 2), (3, 2)]
    chances = [0.9, 0.99, 0.99, 0.5, 1.0]
    way = best_path(4, ends, chances, 0, 3)
    assert way is not None
    assert (way.shapes, way.edges) == ((0, 1, 3), (1, 2))
    assert way.probability == pytest.approx(0.99**2, rel=1e-3)
    other = best_path(4, ends, chances, 0, 3, without=1)
    assert other is not None
    assert other.edges == (0,)
    back = best_path(4, ends, chances, 3, 0)
    assert back is not None
    assert back.shapes == (3, 1, 0)
    assert best_path(5, ends, chances, 0, 4) is None


def test_compositions_of_maps_that_agree_are_the_maps() -> None:
    rng = np.random.default_rng(0)
    a, b = rng.permutation(30), rng.permutation(30)
    np.testing.assert_array_equal(compose_maps([a, b]), a[b])
    np.testing.assert_array_equal(compose_maps([a]), a)
    functions = np.linalg.qr(rng.normal(size=(30, 12)))[0]
    basis = Basis(np.arange(12.0), functions, np.ones(30))
    np.testing.assert_array_equal(invert_map(a, basis, 30)[a], np.arange(30))


def composed(maps: list[list[ScoredMap]], ways: list[tuple[int, CyclePath]], score: float) -> list[ScoredMap]:
    """The products of the maps on each path, all of one score."""
    made = []
    for _, way in ways:
        C = np.eye(20)
        for step in way.steps:
            one = maps[step.edge][step.candidate].map
            C = (one if step.forward else one.T) @ C
        made.append(ScoredMap(C, score, 0.9))
    return made


def test_a_wrong_pair_is_replaced_for_the_way_round_and_no_other() -> None:
    latent, pairs = rotations(6, size=20), complete_graph(6)
    bad = nearest_orthogonal(np.random.default_rng(5).normal(size=(20, 20)))
    maps = [[ScoredMap(bad if p == (1, 4) else latent[p[1]] @ latent[p[0]].T, -5.0, 0.9)] for p in pairs]
    asked = []

    def compose(ways):
        asked.extend(ways)
        return composed(maps, ways, -4.0)

    found = repair_maps(6, pairs, maps, compose)
    assert {number for number, _ in asked} == {pairs.index((1, 4))}
    (change,) = found.replacements
    assert (change.edge, change.kind) == (pairs.index((1, 4)), "composition")
    assert change.path is not None
    assert len(change.path.through) == 1
    assert change.before.probability < 0.1 < 0.5 < change.after.probability
    assert change.after.residual < 1e-9 < change.before.residual
    assert found.probabilities.min() > 0.5


def test_a_right_alternative_comes_before_a_way_round() -> None:
    latent, pairs = rotations(6, size=20), complete_graph(6)
    bad = nearest_orthogonal(np.random.default_rng(5).normal(size=(20, 20)))
    maps = [[ScoredMap(latent[b] @ latent[a].T, -5.0, 0.9)] for a, b in pairs]
    maps[2] = [ScoredMap(bad, -4.8, 0.9), *maps[2]]
    (change,) = repair_maps(6, pairs, maps, lambda ways: [ScoredMap(bad, -30.0, 0.0) for _ in ways]).replacements
    assert (change.edge, change.kind, change.candidate) == (2, "alternative", 1)


def test_a_map_that_turns_the_surface_inside_out_has_lower_odds() -> None:
    C = np.eye(20)
    kept, turned, reversed_one = candidate_maps(
        [ScoredMap(C, -5.0, 0.9), ScoredMap(C, -5.0, -0.9), ScoredMap(C, -5.0, 0.9, True)]
    )
    assert turned.log_odds < kept.log_odds - 3
    assert reversed_one.log_odds == kept.log_odds
    assert reversed_one.reversed


def test_mirror_decisions_agree_with_most() -> None:
    truth = np.array([1, 1, -1, 1, -1, -1, 1])
    pairs = complete_graph(7)
    kept = [truth[a] == truth[b] for a, b in pairs]
    np.testing.assert_array_equal(chirality(7, pairs, kept, np.ones(len(pairs))), truth)
    for wrong in (3, 10, 17):
        kept[wrong] = not kept[wrong]
    np.testing.assert_array_equal(chirality(7, pairs, kept, np.ones(len(pairs))), truth)
    path = [(i, i + 1) for i in range(6)]
    kept = [truth[a] == truth[b] for a, b in path]
    np.testing.assert_array_equal(chirality(7, path, kept, np.linspace(0.5, 1, 6)), truth)
    apart = [(0, 1), (2, 3)]
    np.testing.assert_array_equal(chirality(4, apart, [False, False], [1.0, 1.0]), [1, -1, 1, -1])


def test_a_probable_pair_decides_on_handedness_against_one_that_is_not() -> None:
    pairs, C = [(0, 1), (1, 2), (0, 2)], np.eye(20)
    maps = [[ScoredMap(C, -5.0, 0.9, True)], [ScoredMap(C, -5.0, 0.9)], [ScoredMap(C, -11.5, 0.9)]]
    np.testing.assert_array_equal(_synchronize(3, pairs, maps)[0], [1, -1, -1])
    maps[0], maps[2] = [ScoredMap(C, -11.5, 0.9, True)], [ScoredMap(C, -5.0, 0.9)]
    np.testing.assert_array_equal(_synchronize(3, pairs, maps)[0], [1, 1, 1])


def test_no_shape_would_gain_by_another_handedness() -> None:
    """Also where pairs contradict each other, and the leading eigenvector's signs are not the best ones."""
    rng = np.random.default_rng(0)
    pairs = list(itertools.combinations(range(9), 2))
    changed = 0
    for _ in range(40):
        kept, weights = rng.random(len(pairs)) < 0.5, rng.random(len(pairs))
        signs = chirality(9, pairs, kept.tolist(), weights)
        signed = np.zeros((9, 9))
        for (a, b), same, w in zip(pairs, kept, weights, strict=True):
            signed[a, b] = signed[b, a] = w if same else -w
        assert (signs * (signed @ signs) >= -1e-9).all()
        leading = np.where(np.linalg.eigh(signed)[1][:, -1] < 0, -1, 1)
        changed += bool((signs * signs[0] != leading * leading[0]).any())
    assert changed  # by those alone some of them would


def test_frames_of_many_shapes_are_those_that_their_maps_agree_on() -> None:
    """More unknowns than eigenvectors are worked out densely for: a chain, closed and crossed by further pairs."""
    rng = np.random.default_rng(1)
    count, k = 90, 20
    frames = np.linalg.qr(rng.normal(size=(count, k, k)))[0]
    ends = [(i, (i + step) % count) for i in range(count) for step in (1, 7)]
    maps = [(frames[b] @ frames[a].T)[None] for a, b in ends]
    found = _spectral_init(_Problem(count, ends, maps, [np.array([3.0])] * len(ends)), k)
    for (a, b), (C,) in zip(ends, maps, strict=True):
        np.testing.assert_allclose(found[b], C @ found[a], atol=1e-4)


def test_a_family_of_wrong_candidates_does_not_outvote_better_evidence() -> None:
    """One shape's pairs share a wrong map among their alternatives; only two of four have the right one at all."""
    latent, pairs = rotations(6, size=20), complete_graph(6)
    flip = nearest_orthogonal(np.random.default_rng(9).normal(size=(20, 20)))
    odd = nearest_orthogonal(np.random.default_rng(5).normal(size=(20, 20)))
    maps = []
    for a, b in pairs:
        right, wrong = latent[b] @ latent[a].T, latent[b] @ (flip if b == 5 else np.eye(20)) @ latent[a].T
        if b == 5:
            several = [ScoredMap(right, -8.5, 0.9)] if a < 2 else [ScoredMap(odd, -9.5, 0.9)]
            maps.append([*several, ScoredMap(wrong, -9.8, 0.9)])
        else:
            maps.append([ScoredMap(right, -5.0, 0.9)])
    found = repair_maps(6, pairs, maps, lambda ways: composed(maps, ways, -8.8))
    changed = {pairs[c.edge] for c in found.replacements if c.kind == "composition"}
    assert changed == {(2, 5), (3, 5), (4, 5)}
    for change in found.replacements:
        assert change.after.residual < 1e-6


def test_equal_maps_are_one_candidate() -> None:
    C = rotations(1, size=20)[0]
    one, near = ScoredMap(C, -6.0, 0.5), ScoredMap(C + 1e-3, -5.0, 0.7)
    assert with_better_score(one, near).score == -5.0
    assert with_better_score(near, one) is near
    assert with_better_score(one, ScoredMap(-C, -1.0, 0.9)) is one
    assert with_better_score(one, ScoredMap(C, -1.0, 0.9, True)) is one


def test_a_loose_map_is_replaced_for_a_better_one_alone() -> None:
    latent, pairs = rotations(6, size=20), complete_graph(6)
    rng = np.random.default_rng(3)
    maps = [[ScoredMap(latent[b] @ latent[a].T + 0.005 * rng.normal(size=(20, 20)), -5.0, 0.9)] for a, b in pairs]
    loose = nearest_orthogonal(maps[4][0].map + 0.08 * rng.normal(size=(20, 20)))
    maps[4] = [ScoredMap(loose, -6.0, 0.9)]
    a, b = pairs[4]

    def compose(score: float):
        return lambda ways: [ScoredMap(latent[b] @ latent[a].T, score, 0.9) for _ in ways]

    (change,) = repair_maps(6, pairs, maps, compose(-5.2)).replacements
    assert (change.edge, change.kind, change.improved) == (4, "composition", True)
    assert change.after.residual < change.before.residual
    assert change.before.probability == change.after.probability > 0.5
    assert not repair_maps(6, pairs, maps, compose(-5.9)).replacements  # hardly better


def test_left_and_right_specimens_are_told_apart() -> None:
    """A pair that claims to keep orientation against all others is replaced by its alternative, which reverses it."""
    latent, pairs = rotations(6, size=20), complete_graph(6)
    side = np.array([1, 1, -1, 1, -1, -1])
    bad = nearest_orthogonal(np.random.default_rng(2).normal(size=(20, 20)))
    maps = [[ScoredMap(latent[b] @ latent[a].T, -5.0, 0.9, bool(side[a] != side[b]))] for a, b in pairs]
    at = pairs.index((1, 4))
    maps[at] = [ScoredMap(bad, -4.9, 0.9, False), *maps[at]]
    found = repair_maps(6, pairs, maps, lambda ways: [ScoredMap(bad, -30.0, 0.0) for _ in ways])
    np.testing.assert_array_equal(found.chirality, side)
    (change,) = found.replacements
    assert (change.edge, change.kind, change.candidate, change.contradicts) == (at, "alternative", 1, True)
