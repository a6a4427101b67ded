"""Laws of shape differences: equal shapes differ by nothing, and what is planted is found."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from kfmaps._arrays import InvalidInput
from kfmaps.collection.differences import component_limit_shapes, components, density, limit_shape, shape_distances
from kfmaps.collection.synchronization import CandidateMap, Edge, synchronize
from kfmaps.fmap.constraints import nearest_orthogonal
from kfmaps.geometry.basis import Basis

GUARDS = ("kfmaps.collection.differences", "kfmaps.collection.pair_graph", "kfmaps.collection.synchronization")

K = 8
VALUES = np.array([0.0, 3, 4, 9, 11, 14, 20, 26])


def collection(stretches: list[np.ndarray], seed: int = 0, isometric: bool = False):
    """Shapes with equal eigenvalues whose maps agree exactly and stretch as told; links, agreement, values."""
    rng = np.random.default_rng(seed)
    turns = [rng.normal(size=(K, K)) for _ in stretches]
    turns = [np.diag(np.sign(np.diag(turn))) if isometric else nearest_orthogonal(turn) for turn in turns]
    own = [turn @ s for turn, s in zip(turns, stretches, strict=True)]
    pairs = list(itertools.combinations(range(len(own)), 2))
    links = [Edge(a, b, (CandidateMap(own[b] @ np.linalg.inv(own[a])),)) for a, b in pairs]
    return own, links, synchronize(len(own), links, K), np.tile(VALUES, (len(own), 1))


def first_maps(edges: list[Edge]) -> list[tuple[int, int, np.ndarray]]:
    return [(edge.source, edge.target, edge.candidates[0].map) for edge in edges]


def test_equal_shapes_do_not_differ() -> None:
    for isometric in (False, True):
        _, links, found, values = collection([np.eye(K)] * 4, isometric=isometric)
        latent = limit_shape(found.latent, first_maps(links), values)
        assert shape_distances(latent.operators("area")).max() < 1e-7
        np.testing.assert_allclose(latent.operators().mean(axis=0), np.eye(K), atol=1e-7)
        assert (np.diff(latent.values) >= -1e-9).all()
    assert shape_distances(latent.operators("conformal")).max() < 1e-6
    np.testing.assert_allclose(latent.values, VALUES, atol=1e-6)


def test_other_eigenvalues_show_in_the_conformal_difference_alone() -> None:
    _, links, found, values = collection([np.eye(K)] * 4, isometric=True)
    values[1] *= 2
    latent = limit_shape(found.latent, first_maps(links), values)
    assert shape_distances(latent.operators()).max() < 1e-7
    D = latent.operators("conformal")
    np.testing.assert_allclose(D[1], 2 * D[0], atol=1e-6)
    np.testing.assert_allclose(D.mean(axis=0), np.eye(K - 1), atol=1e-6)


def test_known_changes_of_area_are_the_distances() -> None:
    one = np.diag([1, 1, 1.2, 1, 1, 1, 1, 1.0])
    own, links, found, values = collection([np.eye(K), one, np.eye(K), one @ one])
    latent = limit_shape(found.latent, first_maps(links), values)
    D = shape_distances(latent.operators())
    assert D[0, 2] < 1e-6
    assert 0 < D[0, 1] < D[0, 3]
    # The same in any order of the shapes.
    order = [2, 0, 3, 1]
    again = [Edge(order.index(a.source), order.index(a.target), a.candidates) for a in links]
    other = limit_shape(synchronize(4, again, K).latent, first_maps(again), values)
    np.testing.assert_allclose(shape_distances(other.operators()), D[np.ix_(order, order)], atol=1e-6)
    # Maps into the latent space agree with those between shapes.
    for link in links:
        np.testing.assert_allclose(
            link.candidates[0].map @ latent.maps[link.source], latent.maps[link.target], atol=1e-6
        )
    assert len(own) == 4


def test_one_way_of_changing_is_one_component() -> None:
    rng = np.random.default_rng(1)
    direction = rng.normal(size=(5, 5))
    direction = (direction + direction.T) / np.linalg.norm(direction + direction.T)
    along = np.array([-2.0, -1.0, 0.0, 1.0, 4.0])
    matrices = np.eye(5) + along[:, None, None] * direction
    found = components(matrices, 3)
    assert found.parts[0] == pytest.approx(1.0)
    assert abs(np.corrcoef(found.scores[:, 0], along)[0, 1]) == pytest.approx(1.0)
    np.testing.assert_allclose(found.scores.mean(axis=0), 0, atol=1e-12)
    rebuilt = found.mean + np.tensordot(found.scores, found.directions, axes=1)
    np.testing.assert_allclose(rebuilt, matrices, atol=1e-12)
    same = components(np.tile(np.eye(3), (4, 1, 1)))
    assert not same.parts.any()
    assert components(matrices[:2], 9).scores.shape == (2, 1)


def test_the_density_of_a_shape_difference_shows_where_area_is_larger() -> None:
    """One function stands for one region; a shape in which it is larger has more area there and nowhere else."""
    own, links, found, values = collection([np.eye(K), np.diag([1, 1, 1, 1, 1, 1, 1, 1.3])])
    latent = limit_shape(found.latent, first_maps(links), values)
    functions = own[0] @ np.eye(K)  # vertex i of shape 0 is the i-th of the planted functions
    basis = Basis(VALUES, functions.T, np.ones(K))
    D = latent.operators()
    ratio = density(D, latent, 0, basis)
    np.testing.assert_allclose(ratio.mean(axis=0), 1.0, atol=1e-6)
    assert ratio[1, 7] / ratio[0, 7] == pytest.approx(1.3**2, rel=1e-3)
    np.testing.assert_allclose(ratio[1, :7] / ratio[0, :7], 1.0, atol=1e-3)
    assert density(D, latent, 0, basis).std(axis=0).argmax() == 7


def test_a_latent_function_that_a_shape_hardly_has_does_not_count_there() -> None:
    """At a twenty-fifth of the others the density is that without it; at a fifteenth it counts as in the inverse."""
    _, links, found, values = collection([np.eye(K), np.diag([1, 1, 1, 1, 1, 1, 1, 1.3])])
    latent = limit_shape(found.latent, first_maps(links), values)
    left, sizes, right = np.linalg.svd(latent.maps[0], full_matrices=False)
    basis = Basis(VALUES, np.random.default_rng(0).normal(size=(40, K)), np.ones(40))
    D = latent.operators()

    def of(last: float) -> np.ndarray:
        maps = ((left * [*sizes[:-1], last * sizes[0]]) @ right, *latent.maps[1:])
        return density(D, replace(latent, maps=maps), 0, basis)

    np.testing.assert_allclose(of(1 / 25), of(0.0), rtol=1e-9)
    inverse = right.T @ np.diag(1 / np.append(sizes[:-1], sizes[0] / 15)) @ left.T
    at = (basis.functions @ inverse.T)[:, latent.maps[0].shape[1] - D.shape[1] :]
    each, whole = (np.einsum("xi,...ij,xj->...x", at, M, at) for M in (D, D.mean(axis=0)))
    np.testing.assert_allclose(of(1 / 15), each / whole, rtol=1e-6)


def test_unconnected_shapes_have_no_common_basis() -> None:
    C = np.eye(K)
    links = [Edge(0, 1, (CandidateMap(C),)), Edge(2, 3, (CandidateMap(C),))]
    found, values = synchronize(4, links, K), np.tile(VALUES, (4, 1))
    assert component_limit_shapes(found, links, values, K) == ()
    latent = limit_shape(found.latent[:2], first_maps(links[:1]), values[:2])
    with pytest.raises(InvalidInput, match="conformal"):
        latent.operators("other")


def test_each_part_has_the_basis_that_it_has_alone() -> None:
    rng = np.random.default_rng(3)
    values = np.sort(rng.uniform(1, 60, (9, K)), axis=1)

    def family(first: int, count: int) -> list[Edge]:
        frames = [np.linalg.qr(rng.normal(size=(K, K)))[0] for _ in range(count)]
        ends = [(i, j) for i in range(count) for j in range(i + 1, count)]
        return [Edge(first + i, first + j, (CandidateMap(frames[j] @ frames[i].T),)) for i, j in ends]

    small, large, rest = family(0, 3), family(3, 4), family(7, 2)
    found = synchronize(9, [*small, *large, *rest], K)
    bases = component_limit_shapes(found, [*small, *large, *rest], values, K - 1)
    assert [b.members.tolist() for b in bases] == [[3, 4, 5, 6], [0, 1, 2]]
    alone = synchronize(3, small, K)
    (own,) = component_limit_shapes(alone, small, values[:3], K - 1)
    for kind in ("area", "conformal"):
        both = [shape_distances(b.operators(kind)) for b in (bases[1], own)]
        np.testing.assert_allclose(both[0], both[1], atol=1e-7)
    assert own.maps.shape == (3, K, K - 1)
    assert component_limit_shapes(synchronize(2, rest[:0], K), [], values[:2], K) == ()
