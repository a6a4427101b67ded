"""A part bent onto a whole, and what they have in common, where both are known: a piece of a hilly plane."""

from dataclasses import replace

import numpy as np
import pytest

from conftest import inside_out, rotation, sheet
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.coarsen import coarse_proxy, spread_vertices
from kfmaps.geometry.mesh import Mesh, boundary_vertices, surface_area, unit_area, vertex_normals
from kfmaps.matching.partial.registration import (
    _BEYOND,
    _OVERLAP_WIDTH,
    _doubled_area,
    _is_inside,
    _measure_registration,
    find_overlap,
    overlap_probability,
    refine_registration,
    register_part,
    scale_mesh,
)
from kfmaps.matching.partial.samples import PartPair, PartSamples
from kfmaps.registration.deformable import deformable_mesh

GUARDS = ("kfmaps.geometry.closest_points", "kfmaps.matching.partial", "kfmaps.registration.deformable")

TURN = rotation(3)
COUNT = 21
X = np.array([1.0, 0.0, 0.0])


def hills(x, y, bend=0.0):
    z = 0.1 * np.sin(5 * x) * np.cos(4 * y + 1) + 0.05 * np.sin(9 * x + 2 * y) + bend * x**2
    return np.stack([x, y, z], axis=1)


def grid(x, y):
    flat = sheet(x, y)
    return Mesh(hills(*flat.vertices.T[:2]), flat.faces)


def sampled(mesh, samples=()):
    """A mesh with some samples, whose distances nothing here asks for."""
    none = np.zeros(0)
    return PartSamples(mesh, np.asarray(samples, dtype=np.int64), none, none)


@pytest.fixture(scope="module")
def shapes():
    """The whole, at unit area, and its half, which vertices these are."""
    sides = np.linspace(-0.5, 0.5, COUNT)
    whole = unit_area(grid(sides, sides))
    own = np.arange(len(whole.vertices)).reshape(COUNT, COUNT)[:12].ravel()
    number = np.full(len(whole.vertices), -1)
    number[own] = np.arange(len(own))
    faces = number[whole.faces]
    return whole, Mesh(whole.vertices[own], faces[(faces >= 0).all(axis=1)]), own


@pytest.fixture(scope="module")
def laid(shapes):
    """Its half in another unit and place, bent back by all but a few samples, which are said to be elsewhere."""
    whole, half, own = shapes
    size = float(np.sqrt(surface_area(half)))
    part = Mesh(half.vertices @ TURN.T / size + 1.0, half.faces)
    samples = np.arange(0, len(own), 5)
    places, trust = whole.vertices[own[samples]].copy(), np.ones(len(samples))
    places[::6] += [0.3, -0.2, 0.1]
    trust[::6] = 1e-6
    on = sampled(whole)
    normals = on.surface.normals[own[samples]]

    def lay(factor=1.0, more=part):
        return register_part(PartPair(sampled(more, samples), on), factor * size, places, normals, trust)

    return lay, on, part, size


def test_a_part_that_was_moved_lies_where_it_was_cut(shapes, laid):
    _, half, _ = shapes
    lay, _, _, size = laid
    found = lay()
    assert np.linalg.norm(found.vertices - half.vertices, axis=1).max() < 5e-3
    assert found.scale == size
    assert found.deformation_energy < 1e-4
    assert found.gap < 1e-3
    assert found.flipped_area == 0.0
    assert found.edge_ratio == pytest.approx(1.0, abs=5e-3)
    assert found.inside.all()


def test_all_vertices_follow_a_coarse_proxy(shapes, laid):
    whole, half, own = shapes
    _, on, part, size = laid
    proxy = coarse_proxy(part, spread_vertices(part, len(own) // 3))
    at = own[proxy.vertices]
    pair = PartPair(sampled(proxy.mesh, np.arange(len(at))), on)
    coarse = register_part(pair, size, whole.vertices[at], on.surface.normals[at], np.ones(len(at)))
    found = refine_registration(coarse, proxy, part, on, np.zeros((0, 2), dtype=int))
    assert len(coarse.vertices) < len(own) // 2
    assert np.linalg.norm(found.vertices - half.vertices, axis=1).mean() < 2e-3
    assert found.gap < 1e-3
    assert found.scale == size
    assert found.rest.vertices == pytest.approx(size * part.vertices)


@pytest.mark.parametrize(("off", "least", "most"), [(0.03, 0.2, 1.0), (0.4, 0.0, 0.05)])
def test_a_landmark_takes_the_part_along_unless_it_is_far_off(shapes, laid, off, least, most):
    whole, half, own = shapes
    _, on, part, size = laid
    away = np.linalg.norm(half.vertices - half.vertices[40], axis=1)
    end, at = int(abs(away - off).argmin()), np.arange(len(own))
    pair = PartPair(replace(sampled(part, np.roll(at, -40)), n_landmarks=1), on)
    pair = replace(pair, whole=replace(on, samples=own[[end]], n_landmarks=1))
    rows = own[pair.part.samples]
    placed = size, whole.vertices[rows], on.surface.normals[rows], np.ones(len(rows))
    for one, low, high in ((pair, least, most), (pair.unmarked, -0.02, 0.02)):
        way = half.vertices[end] - half.vertices[40]
        moved = (register_part(one, *placed).vertices[40] - half.vertices[40]) @ way / (way @ way)
        assert low <= moved <= high


@pytest.mark.parametrize("factor", [0.8, 1.25])
def test_edges_tell_the_scale(shapes, laid, factor):
    """Where a part lies as it should, but was taken for smaller than it is, its edges are longer by as much."""
    _, half, _ = shapes
    _, on, part, size = laid
    found = _measure_registration(half.vertices, deformable_mesh(scale_mesh(part, factor * size)), factor * size, on)
    assert found.edge_ratio == pytest.approx(1 / factor)
    assert found.gap < 1e-9
    # Of a uniform scaling each edge gains the square of what it became longer by: the same per area at any size.
    assert found.deformation_energy == pytest.approx(1.5 * (1 / factor - 1) ** 2, rel=0.6)
    shifted = _measure_registration(
        half.vertices + 0.02 * on.surface.normals[: len(half.vertices)], deformable_mesh(half), size, on
    )
    assert shifted.gap == pytest.approx(0.02, rel=0.05)


def test_a_mirror_image_is_folded(laid):
    lay, _, part, _ = laid
    assert lay(more=inside_out(part)).flipped_area > 0.5


def test_what_lies_on_more_of_the_part_is_doubled(shapes):
    """The half of a whole, and a third of the half once more on the same place, a little above."""
    whole, half, _ = shapes
    on = sampled(whole)
    everywhere = np.ones(len(half.vertices), dtype=bool)
    assert _doubled_area(half, everywhere, on) < 0.02
    third = half.faces[: len(half.faces) // 3]
    own = np.unique(third)
    more = Mesh(np.concatenate([half.vertices, half.vertices[own] + 1e-3]), half.faces)
    number = np.zeros(len(half.vertices), dtype=np.int64)
    number[own] = len(half.vertices) + np.arange(len(own))
    more = Mesh(more.vertices, np.concatenate([half.faces, number[third]]))
    inside = np.ones(len(more.vertices), dtype=bool)
    share = surface_area(Mesh(half.vertices, third)) / surface_area(half)
    assert _doubled_area(more, inside, on) == pytest.approx(share / (1 + share), abs=0.05)
    # What lies beyond a boundary of the whole does not count, and nothing at all is no failure.
    inside[len(half.vertices) :] = False
    assert _doubled_area(more, inside, on) < 0.03
    assert _doubled_area(more, np.zeros(len(inside), dtype=bool), on) == 0.0
    beside = Mesh(half.vertices + 0.03 * on.surface.normals[: len(half.vertices)], half.faces)
    assert _doubled_area(beside, everywhere, on) > 0.9  # too far away to cover anything
    measured = _measure_registration(more.vertices, deformable_mesh(more), 1.0, on)
    assert measured.doubled_area == pytest.approx(share / (1 + share), abs=0.05)


def test_points_beyond_the_whole_are_not_pulled_to_its_boundary(shapes):
    """The whole onto its half: what has nothing to lie on is not drawn to its edge, and counts as outside."""
    whole, half, own = shapes
    size = float(np.sqrt(surface_area(half)))
    on = sampled(Mesh(half.vertices / size, half.faces))
    pair = PartPair(sampled(whole, own), on)
    found = register_part(pair, 1 / size, on.mesh.vertices, on.surface.normals, np.ones(len(own)))
    assert np.linalg.norm(found.vertices - whole.vertices / size, axis=1)[own].mean() < 0.04
    beyond = np.setdiff1d(np.arange(len(whole.vertices)), own)
    assert found.inside[own].mean() > 0.9
    far = np.linalg.norm(found.vertices - found.places.points, axis=1)[beyond] > _BEYOND
    assert far.mean() > 0.9
    assert not found.inside[beyond[far]].any()
    assert found.gap < 5e-3
    common = find_overlap(found, pair.whole)
    assert (common.part[own] > 0.5).mean() > 0.9
    assert (common.part[beyond[far]] == 0).all()
    assert (common.whole > 0.5).mean() > 0.9


def test_only_the_boundary_has_something_beyond_it(shapes):
    whole, _, _ = shapes
    on = sampled(whole)
    middle = whole.vertices[len(whole.vertices) // 2] + np.array([0.0, 0.0, 0.2])
    edge = whole.vertices[whole.vertices[:, 0].argmax()]
    corner = whole.vertices[whole.faces[0]].mean(axis=0) + np.array([0.0, 0.0, 0.03])
    asked = np.array([middle, corner, edge + 5 * _BEYOND * X, edge + 0.2 * _BEYOND * X])
    assert _is_inside(closest_points(asked, whole.vertices, whole.faces), on).tolist() == [True, True, False, True]


def test_half_is_common_to_a_whole_and_its_half():
    sides = np.linspace(-0.5, 0.5, 41)
    whole = grid(sides, sides)
    own = np.arange(20 * 41)
    half = Mesh(whole.vertices[own], whole.faces[(whole.faces < len(own)).all(axis=1)])
    common, found = overlap_probability(half, boundary_vertices(half), whole)
    np.testing.assert_allclose(common[own], 1.0)
    assert 0.02 < sides[1] - sides[0] < 1.5 * _OVERLAP_WIDTH
    assert common[len(own) :].max() < 0.2
    np.testing.assert_allclose(found.points[own], whole.vertices[own], atol=1e-9)


def test_probability_falls_with_the_distance(shapes):
    """A half at _OVERLAP_WIDTH, a sixteenth at twice that; and a quarter of it on the side that looks away."""
    whole, _, _ = shapes
    flat = Mesh(whole.vertices * [1, 1, 0], whole.faces)
    inner = ~boundary_vertices(flat)
    for times, expected in ((0.0, 1.0), (1.0, 0.5), (2.0, 0.0625)):
        common = overlap_probability(
            Mesh(flat.vertices + np.array([0, 0, times * _OVERLAP_WIDTH]), flat.faces), boundary_vertices(flat), flat
        )[0]
        np.testing.assert_allclose(common[inner], expected, atol=1e-6)
    turned = overlap_probability(inside_out(flat), boundary_vertices(flat), flat)[0]
    np.testing.assert_allclose(turned, 0.25)
    assert vertex_normals(scale_mesh(flat, 2.0)).shape == flat.vertices.shape
