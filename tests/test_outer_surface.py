"""Pieces that overlap are matched as the closed surface around them, and shapes without their inner walls."""

from __future__ import annotations

import warnings
from dataclasses import replace
from itertools import product

import igl
import numpy as np
import pytest
from scipy.spatial import ConvexHull, KDTree

from conftest import blob, joined, shifted, small_fit
from kfmaps._arrays import KfmapsWarning
from kfmaps.datasets import sphere
from kfmaps.fmap.evaluate import geodesic_errors
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.connectivity import boundary_edges
from kfmaps.geometry.face_orientation import inward_faces, turn_faces
from kfmaps.geometry.mesh import Mesh, component_areas, surface_area, unit_area
from kfmaps.geometry.outer_surface import (
    _is_in_touching_pieces,
    outer_surface,
    without_inner_walls,
    without_partitions,
)
from kfmaps.geometry.topology import topology
from kfmaps.matching.match import match
from kfmaps.shape import _are_in_the_same_pieces, _repaired, prepare, prepare_both

GUARDS = ("kfmaps.geometry.outer_surface", "kfmaps.shape", "kfmaps.matching.reindexing")

SMALL = small_fit(20, 40, 40, 60, refinement=ZoomOut(start=10, stop=40, step=10))
MARKS = np.array([[5, 5], [100, 110], [200, 190], [300, 290]])


def overlapping(mesh: Mesh, width: float = 0.35) -> tuple[Mesh, np.ndarray]:
    """Two pieces, each closed by a cone that ends inside the other; and the vertex that each was, −1 for tips."""
    height = mesh.vertices[mesh.faces].mean(axis=1)[:, 0]
    pieces, was = [], []
    for side in (1, -1):
        faces = mesh.faces[side * height > -width / 2]
        used, numbers = np.unique(faces, return_inverse=True)
        numbers = numbers.reshape(-1, 3)
        edges = np.concatenate([numbers[:, [0, 1]], numbers[:, [1, 2]], numbers[:, [2, 0]]])
        edges = edges[~(edges[:, None] == edges[None, :, ::-1]).all(axis=2).any(axis=1)]  # of the border
        tip = [-side * (width + 0.1), 0, 0]
        cone = np.column_stack([edges[:, ::-1], np.full(len(edges), len(used))])
        pieces.append(Mesh(np.vstack([mesh.vertices[used], tip]), np.vstack([numbers, cone])))
        was.append(np.append(used, -1))
    return joined(*pieces), np.concatenate(was)


@pytest.fixture(scope="module")
def pieces() -> tuple[Mesh, np.ndarray]:
    return overlapping(blob(900))


def test_the_surface_around_pieces_is_closed_and_has_their_vertices(pieces) -> None:
    mesh, was = pieces
    assert topology(mesh).components == 2
    scale = np.sqrt(surface_area(mesh))
    surface = outer_surface(unit_area(mesh))
    assert surface is not None
    counts = topology(surface)
    assert (counts.components, counts.is_closed, counts.genus) == (1, True, 0)
    np.testing.assert_allclose(scale * np.sqrt(surface_area(surface)), np.sqrt(surface_area(blob(900))), rtol=0.02)
    assert not np.isin(np.flatnonzero(was < 0), surface.faces).any()  # the tips are inside
    assert len(np.unique(was[np.unique(surface.faces)])) > 0.95 * 900


def test_one_piece_and_pieces_that_lie_apart_stay_as_they_are(pieces) -> None:
    mesh, _ = pieces
    assert outer_surface(unit_area(blob(900))) is None
    halves = np.arange(len(mesh.vertices)) > mesh.faces[: len(mesh.faces) // 2].max()
    apart = mesh.vertices + 1.5 * (halves[:, None] - 0.5) * [[-1.0, 0, 0]]
    assert outer_surface(unit_area(Mesh(apart, mesh.faces))) is None
    ball = sphere(900)
    length = np.linalg.norm(ball.vertices[ball.faces] - ball.vertices[np.roll(ball.faces, 1, axis=1)], axis=2).mean()
    for gap, is_touching in ((0.5, True), (0.9, True), (1.2, False)):
        balls = unit_area(joined(ball, Mesh(ball.vertices + np.array([2 + gap * length, 0, 0]), ball.faces)))
        assert _is_in_touching_pieces(balls) == is_touching
        assert outer_surface(balls) is None  # which is two spheres
    eyes = joined(blob(900), *(Mesh(0.1 * blob(100).vertices + x, blob(100).faces) for x in ([0.9, 0, 0], [0, 0.9, 0])))
    assert outer_surface(unit_area(eyes)) is None  # nearly all is in one piece


def test_a_shape_in_pieces_keeps_its_vertices_faces_and_extent(pieces) -> None:
    mesh, _ = pieces
    with pytest.warns(KfmapsWarning, match="pieces that overlap count as the surface around them"):
        shape = prepare(Mesh(7 * mesh.vertices, mesh.faces), SMALL)
    np.testing.assert_array_equal(shape.given_faces, mesh.faces)
    np.testing.assert_array_equal(shape.given_mesh.faces, mesh.faces)
    assert len(shape.mesh.vertices) == len(shape.basis.functions) == len(mesh.vertices)
    assert shape.extent is not None
    np.testing.assert_allclose(shape.extent, 7 * np.sqrt(surface_area(blob(900))), rtol=0.02)
    np.testing.assert_allclose(surface_area(shape.cleaned[0].mesh), 1, rtol=1e-9)


def moved_apart(mesh: Mesh) -> Mesh:
    """The piece of the last vertex is moved to the left."""
    label, _ = component_areas(mesh)
    return Mesh(mesh.vertices - 1.5 * (label == label[-1])[:, None] * [[1.0, 0, 0]], mesh.faces)


@pytest.mark.parametrize("is_prepared", [True, False])
@pytest.mark.parametrize("is_first", [True, False])
def test_of_two_shapes_in_the_same_pieces_both_are_repaired_or_none(pieces, is_first, is_prepared) -> None:
    """A pose in which no closed surface is found is not compared with one of another topology."""
    pair = [pieces[0], moved_apart(pieces[0])][:: 1 if is_first else -1]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KfmapsWarning)
        alone = [prepare(mesh, SMALL, name=name) for mesh, name in zip(pair, "ab", strict=True)]
    assert [shape.is_outer_surface for shape in alone] == [is_first, not is_first]
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", KfmapsWarning)
        both = prepare_both(*(alone if is_prepared else pair), config=SMALL)
    assert str(told[-1].message).split(", so ")[0].endswith("are in the same pieces")
    for shape, mesh in zip(both, pair, strict=True):
        assert shape.repairs == ()
        np.testing.assert_array_equal(shape.mesh.faces, mesh.faces)
    untouched = both[is_first], alone[is_first]
    if is_prepared:
        assert untouched[0] is untouched[1]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        again = prepare_both(*both, config=SMALL)
    assert [again[0] is both[0], again[1] is both[1]] == [True, True]


def test_shapes_in_other_pieces_are_repaired_each_for_itself(pieces) -> None:
    """The other one is in one piece, or its pieces are of other sizes; or both can be repaired alike."""
    body = blob(900)
    uneven = moved_apart(overlapping(Mesh(body.vertices - [1.0, 0, 0], body.faces))[0])
    for other in (body, uneven):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", KfmapsWarning)
            first, second = prepare_both(pieces[0], other, SMALL)
        assert [first.is_outer_surface, second.is_repaired] == [True, False]
        assert not _are_in_the_same_pieces([first, second])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KfmapsWarning)
        assert all(shape.is_outer_surface for shape in prepare_both(pieces[0], pieces[0], SMALL))


@pytest.mark.parametrize("is_source", [True, False])
def test_a_body_in_pieces_is_matched_as_the_body(pieces, is_source) -> None:
    mesh, was = pieces
    whole, real = blob(900, twist=0.4), was >= 0
    marks = MARKS.copy()
    column = 0 if is_source else 1
    marks[:, column] = [np.flatnonzero(was == vertex)[0] for vertex in MARKS[:, column]]
    pair = (mesh, whole) if is_source else (whole, mesh)
    with warnings.catch_warnings(action="ignore", category=KfmapsWarning):
        found = match(*pair, SMALL, landmarks=marks)
    clean = match(*((blob(900), whole) if is_source else (whole, blob(900))), SMALL, landmarks=MARKS)
    truth = clean.target_to_source
    if is_source:
        images = was[found.target_to_source]
        assert (images >= 0).mean() > 0.95
        errors = geodesic_errors(blob(900), np.maximum(images, 0), truth)[images >= 0]
    else:
        errors = geodesic_errors(whole, found.target_to_source[real], truth[was[real]])
    assert errors.mean() < 0.03
    if not is_source:
        assert found._reindexing is not None
        inside = found._reindexing.clean_t.unreferenced
        assert inside.sum() > 20
        assert np.median(found.local_confidence[inside]) > 0.2
    places = found.precise()
    assert places.faces.max() < len(pair[0].faces)
    positions = np.einsum("ni,nij->nj", places.weights, pair[0].vertices[pair[0].faces[places.faces]])
    nearest = np.linalg.norm(positions - pair[0].vertices[found.target_to_source], axis=1)
    rows = real if not is_source else slice(None)
    assert np.median(nearest[rows]) < 0.1


def test_registered_parts_know_their_size(pieces) -> None:
    mesh, _ = pieces
    with warnings.catch_warnings(action="ignore", category=KfmapsWarning):
        one, other = prepare(mesh, SMALL), prepare(replace(mesh, vertices=3 * mesh.vertices), SMALL)
    assert one.extent is not None
    assert other.extent is not None
    np.testing.assert_allclose(other.extent, 3 * one.extent, rtol=1e-6)


def scaled(mesh: Mesh, factor: float, inward: bool = False) -> Mesh:
    return Mesh(factor * mesh.vertices, mesh.faces[:, ::-1] if inward else mesh.faces)


@pytest.mark.parametrize("inward", [True, False])
@pytest.mark.parametrize("is_first", [True, False])
def test_walls_and_balls_inside_are_left_out(inward, is_first) -> None:
    body, wall = blob(900), scaled(blob(900), 0.9, inward)
    mesh = unit_area(joined(wall, body) if is_first else joined(body, wall))
    outer = without_inner_walls(mesh)
    assert outer is not None
    assert len(outer.vertices) == 1800
    first = 900 if is_first else 0
    np.testing.assert_array_equal(outer.faces, blob(900).faces + first)
    turned = without_inner_walls(unit_area(joined(wall, Mesh(body.vertices, body.faces[:, ::-1]))))
    assert turned is not None
    np.testing.assert_array_equal(turned.faces, blob(900).faces[:, ::-1] + 900)
    assert without_inner_walls(unit_area(joined(body, shifted(wall, 2, 0, 0)))) is None
    assert without_inner_walls(unit_area(body)) is None


def test_of_a_box_around_a_shape_the_shape_is_left() -> None:
    corners = np.array(list(product((-3.0, 3.0), repeat=3)))
    faces = ConvexHull(corners).simplices.astype(np.int64)
    box, body = Mesh(corners, turn_faces(faces, inward_faces(Mesh(corners, faces)))), blob(900)
    rest = without_inner_walls(unit_area(joined(box, body)))
    assert rest is not None
    np.testing.assert_array_equal(rest.faces, body.faces + 8)
    eye = without_inner_walls(unit_area(joined(box, Mesh(0.1 * corners, box.faces))))
    assert eye is not None
    np.testing.assert_array_equal(eye.faces, box.faces)


def test_a_piece_is_inside_where_four_fifths_of_its_vertices_are() -> None:
    body, ball = blob(900), scaled(blob(400), 0.3)
    for place in np.linspace(0.4, 1.2, 9):
        moved = shifted(ball, place, 0, 0)
        share = (np.asarray(igl.fast_winding_number(body.vertices, body.faces, moved.vertices)) > 0.5).mean()
        outer = without_inner_walls(unit_area(joined(body, moved)))
        assert (outer is not None) == (share >= 0.8)


def test_a_hollow_body_is_matched_as_the_body() -> None:
    body, other = blob(900), blob(900, twist=0.4)
    clean = match(body, other, SMALL, landmarks=MARKS)
    hollow = joined(body, scaled(body, 0.85, inward=True))
    with pytest.warns(KfmapsWarning, match="surfaces inside or around it are left out"):
        found = match(hollow, other, SMALL, landmarks=MARKS)
    assert geodesic_errors(body, found.target_to_source, clean.target_to_source).mean() < 1e-3
    assert found.precise().faces.max() < len(body.faces)
    with warnings.catch_warnings(action="ignore", category=KfmapsWarning):
        found = match(other, hollow, SMALL, landmarks=MARKS[:, ::-1])
        shape = prepare(Mesh(3 * hollow.vertices, hollow.faces), SMALL)
    assert len(found.target_to_source) == 1800
    nearest = KDTree(body.vertices).query(hollow.vertices[900:])[1]
    np.testing.assert_array_equal(found.target_to_source[900:], found.target_to_source[nearest])
    assert shape.extent == pytest.approx(3 * np.sqrt(surface_area(body)))
    np.testing.assert_array_equal(shape.given_mesh.faces, hollow.faces)


def test_holes_beside_inner_walls_are_filled() -> None:
    body = blob(900)
    rows = np.random.default_rng(0).random(len(body.faces)) > 0.1
    mesh = joined(Mesh(body.vertices, body.faces[rows]), scaled(body, 0.85, inward=True))
    with pytest.warns(KfmapsWarning, match="surfaces inside or around it are left out, small holes are filled"):
        shape = prepare(mesh, SMALL)
    assert shape.extent == pytest.approx(np.sqrt(surface_area(body)), rel=0.01)
    assert topology(shape.cleaned[0].mesh).is_closed


def partitioned(mesh: Mesh) -> Mesh:
    """With a cone across it, between its faces on both sides of a plane."""
    is_left = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] < 0
    border = boundary_edges(mesh.faces[is_left], len(mesh.vertices))
    cone = np.column_stack([border, np.full(len(border), len(mesh.vertices))])
    tip = mesh.vertices[np.unique(border)].mean(axis=0, keepdims=True)
    return Mesh(np.concatenate([mesh.vertices, tip]), np.concatenate([mesh.faces, cone]))


def test_partitions_are_left_out() -> None:
    body = unit_area(blob(900))
    mesh = unit_area(partitioned(body))
    rest = without_partitions(mesh)
    assert rest is not None
    np.testing.assert_array_equal(rest.faces, body.faces)
    np.testing.assert_array_equal(rest.vertices, mesh.vertices)
    turned = np.random.default_rng(0).random(len(mesh.faces)) < 0.5
    mixed = without_partitions(Mesh(mesh.vertices, np.where(turned[:, None], mesh.faces[:, ::-1], mesh.faces)))
    assert mixed is not None
    assert len(mixed.faces) == len(body.faces)


def test_what_can_be_seen_from_outside_is_no_partition() -> None:
    body = unit_area(blob(900))
    mesh = unit_area(partitioned(body))
    assert without_partitions(body) is None
    is_far = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > 0.05
    assert without_partitions(Mesh(mesh.vertices, mesh.faces[~is_far])) is None  # one side of the wall is open


def test_a_body_with_a_partition_is_matched_as_the_body() -> None:
    body, other = blob(900), blob(900, twist=0.4)
    clean = match(body, other, SMALL, landmarks=MARKS)
    with pytest.warns(KfmapsWarning, match="partitions of its inside are left out"):
        found = match(partitioned(body), other, SMALL, landmarks=MARKS)
    np.testing.assert_allclose(found.functional_map, clean.functional_map, atol=1e-6)
    assert geodesic_errors(body, found.target_to_source, clean.target_to_source).mean() < 1e-3


def test_a_repair_may_make_an_earlier_one_possible() -> None:
    """As filled holes let a floor be found; each is made once."""
    body, made = unit_area(blob(300)), []

    def repair(name: str, after: str | None = None):
        def apply(mesh: Mesh) -> Mesh | None:
            assert surface_area(mesh) == pytest.approx(1)
            if after not in (None, *made):
                return None
            made.append(name)
            return Mesh(mesh.vertices * 2, mesh.faces[1:])

        return apply, name

    surface, changes = _repaired(body, (repair("floor", after="holes"), repair("walls"), repair("holes")))
    assert changes == ["walls", "holes", "floor"] == made
    np.testing.assert_allclose(surface.vertices, 8 * body.vertices)
    np.testing.assert_array_equal(surface.faces, body.faces[3:])
    assert _repaired(body, (repair("floor", after="never"),)) == (body, [])
