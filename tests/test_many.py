"""Laws of collections: graphs of pairs, agreement over cycles, ways round, hands."""

from __future__ import annotations

import numpy as np
import pytest

from kfmaps._arrays import InvalidInput
from kfmaps.collection.chirality import hands
from kfmaps.collection.pair_graph import bridges, every, medoid, near, signature, star, unlikeness
from kfmaps.collection.paths import best_way, composed, roads, turned_back
from kfmaps.collection.repair import repaired
from kfmaps.collection.scored_map import Judged, better, choices
from kfmaps.collection.synchronization import Choice, Link, agree, orthogonal
from kfmaps.collection.zoomout import ConsistentZoomOut, through_latent
from kfmaps.geometry.basis import Basis

GUARDS = ("kfmaps.collection",)

K = 8


def rotations(count: int, seed: int = 0, size: int = K) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.stack([orthogonal(rng.normal(size=(size, size))) for _ in range(count)])


def consistent_links(latent: np.ndarray, pairs, wrong=(), odds: float = 0.0, seed: int = 1) -> list[Link]:
    """Links whose maps agree exactly, but for those numbered in ``wrong``, which are random."""
    rng = np.random.default_rng(seed)
    links = []
    for number, (a, b) in enumerate(pairs):
        C = latent[b] @ latent[a].T
        links.append(Link(a, b, (Choice(orthogonal(rng.normal(size=C.shape)) if number in wrong else C, odds),)))
    return links


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
    pairs = near(unlikeness(points), each)
    assert list(pairs) == sorted({(min(p), max(p)) for p in pairs})
    assert connected(count, pairs)
    assert len(pairs) <= each * count
    if count > 2:
        assert all(connected(count, [p for p in pairs if p != out]) for out in pairs)
    degree = np.bincount(np.ravel(pairs), minlength=count)
    assert degree.min() >= min(each, count - 1)


def test_near_pairs_of_two_clusters_are_joined_twice() -> None:
    points = np.concatenate([np.zeros((4, 1)), np.full((4, 1), 10.0)]) + 0.01 * np.arange(8)[:, None]
    pairs = near(unlikeness(points), 2)
    across = [p for p in pairs if (p[0] < 4) != (p[1] < 4)]
    assert len(across) == 2


def test_near_pairs_follow_the_numbers() -> None:
    points = np.random.default_rng(3).normal(size=(12, 4))
    order = np.random.default_rng(4).permutation(12)
    pairs = near(unlikeness(points))
    moved = near(unlikeness(points[order]))
    assert {tuple(sorted(order[list(p)])) for p in moved} == set(pairs)


def test_stars_and_all_pairs() -> None:
    assert star(4, 2) == ((2, 0), (2, 1), (2, 3))
    assert every(3) == ((0, 1), (0, 2), (1, 2))
    assert medoid(unlikeness(np.array([[0.0], [1.0], [5.0]]))) == 1
    with pytest.raises(InvalidInput, match="2 or more"):
        near(np.zeros((3, 3)), 1)


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
    few = signature(Basis(values[:10], functions[:, :10], mass))
    assert few.shape == one.shape
    assert np.isfinite(few).all()


# --- agreement ------------------------------------------------------------------------------------------------------


def test_maps_that_agree_are_found_to() -> None:
    latent = rotations(6)
    found = agree(6, consistent_links(latent, every(6)), K)
    assert max(m.max() for m in found.misfits) < 1e-12
    assert min(c[0] for c in found.chances) > 0.7
    for a, b, c in ((0, 1, 2), (3, 1, 5)):  # the law of cycles, for maps through the latent space
        round_trip = through_latent(found.latent, a, b)
        round_trip = through_latent(found.latent, c, a) @ through_latent(found.latent, b, c) @ round_trip
        np.testing.assert_allclose(round_trip, np.eye(K), atol=1e-10)
    np.testing.assert_allclose(through_latent(found.latent, 0, 4), latent[4] @ latent[0].T, atol=1e-10)


def test_planted_wrong_pairs_are_found_by_cycles_alone() -> None:
    latent, pairs = rotations(10), every(10)
    wrong = set(np.random.default_rng(2).permutation(len(pairs))[: len(pairs) // 3].tolist())
    found = agree(10, consistent_links(latent, pairs, wrong), K)
    assert {i for i, c in enumerate(found.chances) if c[0] < 0.5} == wrong


def test_flips_that_agree_with_each_other_are_outvoted() -> None:
    latent, pairs = rotations(9), every(9)
    flip = np.diag([1.0, 1, -1, 1, -1, -1, 1, 1])
    links = consistent_links(latent, pairs)
    wrong = set(np.random.default_rng(3).permutation(len(pairs))[:9].tolist())
    assert np.bincount(np.ravel([pairs[i] for i in wrong]), minlength=9).max() <= 3  # of the 8 of each shape
    links = [
        Link(a.source, a.target, (Choice(latent[a.target] @ flip @ latent[a.source].T),)) if i in wrong else a
        for i, a in enumerate(links)
    ]
    found = agree(9, links, K)
    assert {i for i, c in enumerate(found.chances) if c[0] < 0.5} == wrong


def test_long_cycles_set_no_right_pairs_apart() -> None:
    """On a ring a wrong pair of the tree parts it in two, and over the border right pairs contradict each other."""
    count, rng = 90, np.random.default_rng(2)
    pairs = [(i, (i + step) % count) for i in range(count) for step in (1, 2, 5)]
    wrong = set(rng.permutation(len(pairs))[: len(pairs) // 5].tolist())
    found = agree(count, consistent_links(rotations(count, 2), pairs, wrong), K)
    assert {i for i, c in enumerate(found.chances) if c[0] < 0.5} == wrong


def test_the_right_candidate_is_chosen_and_evidence_decides_where_cycles_cannot() -> None:
    latent = rotations(5)
    bad = orthogonal(np.random.default_rng(7).normal(size=(K, K)))
    links = [
        Link(a, b, (Choice(bad, 0.5), Choice(latent[b] @ latent[a].T, 0.0), Choice(bad.T, 0.2)))
        if (a, b) == (1, 3)
        else one
        for (a, b), one in zip(every(5), consistent_links(latent, every(5)), strict=True)
    ]
    found = agree(5, links, K)
    assert found.chances[every(5).index((1, 3))].argmax() == 1
    lone = [Link(0, 1, (Choice(bad, 1.0), Choice(bad.T, -1.0)))]
    chances = agree(2, lone, K).chances[0]
    assert chances[0] > chances[1]
    assert chances[0] > 0.6


def test_order_and_numbers_do_not_matter() -> None:
    latent, pairs = rotations(7), every(7)
    links = consistent_links(latent, pairs, {0, 5, 11})
    found = agree(7, links, K)
    backwards = agree(7, links[::-1], K)
    np.testing.assert_allclose([c[0] for c in backwards.chances[::-1]], [c[0] for c in found.chances], atol=1e-6)
    new = np.random.default_rng(1).permutation(7)
    renamed = agree(7, [Link(int(new[a.source]), int(new[a.target]), a.choices) for a in links], K)
    np.testing.assert_allclose([c[0] for c in renamed.chances], [c[0] for c in found.chances], atol=1e-6)
    turned = agree(7, [Link(a.target, a.source, (Choice(a.choices[0].map.T),)) for a in links], K)
    np.testing.assert_allclose([c[0] for c in turned.chances], [c[0] for c in found.chances], atol=1e-6)


def test_parts_that_no_pair_joins_stand_alone() -> None:
    latent = rotations(6)
    pairs = [(0, 1), (1, 2), (0, 2), (3, 4), (4, 5), (3, 5)]
    found = agree(6, consistent_links(latent, pairs), K)
    assert len(set(found.component[:3])) == 1
    assert found.component[0] != found.component[3]
    assert max(m.max() for m in found.misfits) < 1e-12


def test_links_that_cannot_be() -> None:
    C = np.eye(K)
    for link in (Link(0, 5, (Choice(C),)), Link(1, 1, (Choice(C),))):
        with pytest.raises(InvalidInput, match="two of the shapes"):
            agree(3, [link], K)
    with pytest.raises(InvalidInput, match="functions or more"):
        agree(3, [Link(0, 1, (Choice(C[:4, :4]),))], K)


# --- ways, repair, hands --------------------------------------------------------------------------------------------


def test_the_best_way_is_the_most_probable() -> None:
    ends = [(0, 3), (0, 1), (1, 3), (0, 2), (3, 2)]
    chances = [0.9, 0.99, 0.99, 0.5, 1.0]
    way = best_way(roads(4, ends), chances, 0, 3)
    assert way is not None
    assert (way.shapes, way.links) == ((0, 1, 3), (1, 2))
    assert way.chance == pytest.approx(0.99**2, rel=1e-3)
    other = best_way(roads(4, ends), chances, 0, 3, without=1)
    assert other is not None
    assert other.links == (0,)
    back = best_way(roads(4, ends), chances, 3, 0)
    assert back is not None
    assert back.shapes == (3, 1, 0)
    assert best_way(roads(5, ends), chances, 0, 4) is None


def test_compositions_of_maps_that_agree_are_the_maps() -> None:
    rng = np.random.default_rng(0)
    a, b = rng.permutation(30), rng.permutation(30)
    np.testing.assert_array_equal(composed([a, b]), a[b])
    np.testing.assert_array_equal(composed([a]), a)
    with pytest.raises(InvalidInput, match="at least one"):
        composed([])
    functions = np.linalg.qr(rng.normal(size=(30, 12)))[0]
    basis = Basis(np.arange(12.0), functions, np.ones(30))
    np.testing.assert_array_equal(turned_back(a, basis, 30)[a], np.arange(30))


def test_a_wrong_pair_is_exchanged_for_the_way_round_and_no_other() -> None:
    latent, pairs = rotations(6, size=20), every(6)
    bad = orthogonal(np.random.default_rng(5).normal(size=(20, 20)))
    maps = [[Judged(bad if p == (1, 4) else latent[p[1]] @ latent[p[0]].T, -5.0, 0.9)] for p in pairs]
    asked = []

    def compose(ways):
        asked.extend(ways)
        made = []
        for number, way in ways:
            C = np.eye(20)
            for step in way.steps:
                one = maps[step.link][step.choice].map
                C = (one if step.forth else one.T) @ C
            made.append(Judged(C, -4.0, 0.9))
            assert pairs[number] == (1, 4)
        return made

    found = repaired(6, pairs, maps, compose)
    assert {number for number, _ in asked} == {pairs.index((1, 4))}
    (change,) = found.changes
    assert (change.link, change.kind) == (pairs.index((1, 4)), "composition")
    assert change.way is not None
    assert len(change.way.through) == 1
    assert change.before < 0.1 < 0.5 < change.after
    assert change.misfit_after < 1e-9 < change.misfit_before
    assert found.in_use.min() > 0.5


def test_a_right_runner_up_comes_before_a_way_round() -> None:
    latent, pairs = rotations(6, size=20), every(6)
    bad = orthogonal(np.random.default_rng(5).normal(size=(20, 20)))
    maps = [[Judged(latent[b] @ latent[a].T, -5.0, 0.9)] for a, b in pairs]
    maps[2] = [Judged(bad, -4.8, 0.9), *maps[2]]
    (change,) = repaired(6, pairs, maps, lambda ways: [Judged(bad, -30.0, 0.0) for _ in ways]).changes
    assert (change.link, change.kind, change.choice) == (2, "runner-up", 1)


def test_what_turns_inside_out_contradicts_itself() -> None:
    C = np.eye(20)
    kept, turned, reversed_one = choices([Judged(C, -5.0, 0.9), Judged(C, -5.0, -0.9), Judged(C, -5.0, 0.9, True)])
    assert turned.odds < kept.odds - 3
    assert reversed_one.odds == kept.odds
    assert reversed_one.reversed


def test_hands_agree_with_most() -> None:
    truth = np.array([1, 1, -1, 1, -1, -1, 1])
    pairs = every(7)
    kept = [truth[a] == truth[b] for a, b in pairs]
    np.testing.assert_array_equal(hands(7, pairs, kept, np.ones(len(pairs))), truth)
    for wrong in (3, 10, 17):
        kept[wrong] = not kept[wrong]
    np.testing.assert_array_equal(hands(7, pairs, kept, np.ones(len(pairs))), truth)
    path = [(i, i + 1) for i in range(6)]
    kept = [truth[a] == truth[b] for a, b in path]
    np.testing.assert_array_equal(hands(7, path, kept, np.linspace(0.5, 1, 6)), truth)
    apart = [(0, 1), (2, 3)]
    np.testing.assert_array_equal(hands(4, apart, [False, False], [1.0, 1.0]), [1, -1, 1, -1])
    with pytest.raises(InvalidInput, match="from 0 on"):
        hands(2, [(0, 1)], [True], [-1.0])


# --- consistent ZoomOut ---------------------------------------------------------------------------------------------


def test_refined_together_equal_shapes_get_the_identity() -> None:
    rng = np.random.default_rng(0)
    functions = np.linalg.qr(rng.normal(size=(120, 30)))[0]
    orders = [rng.permutation(120) for _ in range(4)]
    bases = [Basis(np.arange(30.0), functions[o] * rng.choice([-1, 1], 30), np.ones(120)) for o in orders]
    truth = {(a, b): np.argsort(orders[a])[orders[b]] for a, b in every(4)}
    points = []
    for pair in every(4):
        noisy = truth[pair].copy()
        bad = rng.permutation(120)[:40]
        noisy[bad] = rng.integers(0, 120, 40)
        points.append(noisy)
    refined, latent = ConsistentZoomOut(10, 30, 10)(bases, every(4), points)
    before = np.mean([(p == truth[q]).mean() for p, q in zip(points, every(4), strict=True)])
    after = np.mean([(p == truth[q]).mean() for p, q in zip(refined, every(4), strict=True)])
    assert before < 0.7
    assert after > 0.99
    assert latent.shape == (4, 30, 30)
    with pytest.raises(InvalidInput, match="20 functions or more"):
        ConsistentZoomOut(20, 10)


def test_a_family_of_wrong_candidates_does_not_outvote_better_evidence() -> None:
    """One shape's pairs share a wrong map among their runners-up; only two of four have the right one at all."""
    latent, pairs = rotations(6, size=20), every(6)
    flip = orthogonal(np.random.default_rng(9).normal(size=(20, 20)))
    odd = orthogonal(np.random.default_rng(5).normal(size=(20, 20)))
    maps = []
    for a, b in pairs:
        right, wrong = latent[b] @ latent[a].T, latent[b] @ (flip if b == 5 else np.eye(20)) @ latent[a].T
        if b == 5:
            several = [Judged(right, -8.5, 0.9)] if a < 2 else [Judged(odd, -9.5, 0.9)]
            maps.append([*several, Judged(wrong, -9.8, 0.9)])
        else:
            maps.append([Judged(right, -5.0, 0.9)])

    def compose(ways):
        made = []
        for _, way in ways:
            C = np.eye(20)
            for step in way.steps:
                one = maps[step.link][step.choice].map
                C = (one if step.forth else one.T) @ C
            made.append(Judged(C, -8.8, 0.9))
        return made

    found = repaired(6, pairs, maps, compose)
    changed = {pairs[c.link] for c in found.changes if c.kind == "composition"}
    assert changed == {(2, 5), (3, 5), (4, 5)}
    for change in found.changes:
        assert change.misfit_after < 1e-6


def test_what_is_one_map_is_not_two_candidates() -> None:
    C = rotations(1, size=20)[0]
    one, near = Judged(C, -6.0, 0.5), Judged(C + 1e-3, -5.0, 0.7)
    assert better(one, near).score == -5.0
    assert better(near, one) is near
    assert better(one, Judged(-C, -1.0, 0.9)) is one
    assert better(one, Judged(C, -1.0, 0.9, True)) is one


def test_a_loose_map_is_exchanged_for_a_better_one_alone() -> None:
    latent, pairs = rotations(6, size=20), every(6)
    rng = np.random.default_rng(3)
    maps = [[Judged(latent[b] @ latent[a].T + 0.005 * rng.normal(size=(20, 20)), -5.0, 0.9)] for a, b in pairs]
    loose = orthogonal(maps[4][0].map + 0.08 * rng.normal(size=(20, 20)))
    maps[4] = [Judged(loose, -6.0, 0.9)]
    a, b = pairs[4]

    def compose(score: float):
        return lambda ways: [Judged(latent[b] @ latent[a].T, score, 0.9) for _ in ways]

    (change,) = repaired(6, pairs, maps, compose(-5.2)).changes
    assert (change.link, change.kind, change.improved) == (4, "composition", True)
    assert change.misfit_after < change.misfit_before
    assert change.before == change.after > 0.5
    assert not repaired(6, pairs, maps, compose(-5.9)).changes  # hardly better


def test_left_and_right_specimens_are_told_apart() -> None:
    """A pair that claims to keep orientation against all others is exchanged for its runner-up, which reverses it."""
    latent, pairs = rotations(6, size=20), every(6)
    side = np.array([1, 1, -1, 1, -1, -1])
    bad = orthogonal(np.random.default_rng(2).normal(size=(20, 20)))
    maps = [[Judged(latent[b] @ latent[a].T, -5.0, 0.9, bool(side[a] != side[b]))] for a, b in pairs]
    at = pairs.index((1, 4))
    maps[at] = [Judged(bad, -4.9, 0.9, False), *maps[at]]
    found = repaired(6, pairs, maps, lambda ways: [Judged(bad, -30.0, 0.0) for _ in ways])
    np.testing.assert_array_equal(found.hands, side)
    (change,) = found.changes
    assert (change.link, change.kind, change.choice, change.contradicts) == (at, "runner-up", 1, True)
