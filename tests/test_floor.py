"""The floor of a scan is left out."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from conftest import blob, joined, sheet, shifted, small_fit
from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps.fmap.evaluate import geodesic_errors
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.clean import clean_mesh, face_outward
from kfmaps.geometry.floor import without_floor
from kfmaps.geometry.mesh import Mesh, face_areas, surface_area, unit_area
from kfmaps.geometry.topology import topology
from kfmaps.matching.match import match
from kfmaps.shape import Shape, prepare

GUARDS = ("kfmaps.geometry.floor", "kfmaps.shape", "kfmaps.matching.reindexing")

SMALL = small_fit(20, 40, 40, 60, refinement=ZoomOut(start=10, stop=40, step=10))
MARKS = np.array([[5, 5], [100, 110], [200, 190], [300, 290]])


def ground(side: float, steps: int = 30) -> Mesh:
    """A square in the plane z = 0."""
    along = np.linspace(-side / 2, side / 2, steps)
    return sheet(along, along)


def standing(side: float = 4.0, depth: float = 0.0) -> Mesh:
    """A blob whose lowest vertex is ``depth`` below the ground, which comes after it."""
    body = blob(900)
    return joined(shifted(body, 0, 0, -body.vertices[:, 2].min() - depth), ground(side))


def tower(noise: float = 0.0) -> Mesh:
    """A steep hill on a square, in one surface."""
    square = ground(2.0, 41)
    vertices = square.vertices.copy()
    away = np.linalg.norm(vertices[:, :2], axis=1)
    vertices[:, 2] = 1.5 * np.clip((0.5 - away) / 0.2, 0, 1) + noise * np.random.default_rng(0).normal(size=len(away))
    return unit_area(Mesh(vertices, square.faces))


def test_a_floor_under_a_body_is_left_out() -> None:
    mesh = unit_area(standing())
    rest = without_floor(mesh)
    assert rest is not None
    np.testing.assert_array_equal(rest.faces, blob(900).faces)
    np.testing.assert_array_equal(rest.vertices, mesh.vertices)
    upside_down = without_floor(Mesh(mesh.vertices * [1, -1, -1], mesh.faces))
    assert upside_down is not None
    np.testing.assert_array_equal(upside_down.faces, rest.faces)


@pytest.mark.parametrize("noise", [0.0, 0.005])
def test_a_floor_that_is_joined_to_what_stands_on_it_is_left_out(noise) -> None:
    mesh = tower(noise)
    rest = without_floor(mesh)
    assert rest is not None
    heights = mesh.vertices[:, 2] - np.median(mesh.vertices[:, 2])
    is_flat = (np.abs(heights[mesh.faces]) < 0.008).all(axis=1)
    left = {tuple(face) for face in rest.faces.tolist()}
    still_there = np.array([tuple(face) in left for face in mesh.faces.tolist()])
    areas = face_areas(mesh)
    assert areas[is_flat & still_there].sum() < 0.01
    assert areas[~is_flat & ~still_there].sum() < 0.05


def test_what_is_no_floor_stays() -> None:
    assert without_floor(unit_area(blob(900))) is None  # closed
    assert without_floor(unit_area(ground(2.0))) is None  # all of it is flat
    assert without_floor(unit_area(standing(depth=1.0))) is None  # a sheet through the body
    assert without_floor(unit_area(standing(side=0.9))) is None  # too small
    tube = sheet(np.linspace(0, 2 * np.pi, 41), np.linspace(0, 3, 30))
    angle, height, _ = tube.vertices.T
    bent = np.column_stack([np.cos(angle), np.sin(angle), height])
    assert without_floor(unit_area(Mesh(bent, tube.faces))) is None  # its ends are cut, not flat
    curved = ground(2.0)
    bowl = curved.vertices + np.array([0, 0, 0.3]) * (curved.vertices[:, :1] ** 2)
    assert without_floor(unit_area(joined(Mesh(bowl, curved.faces), shifted(blob(900), 0, 0, 2)))) is None


@pytest.mark.parametrize("is_source", [True, False])
def test_a_body_on_a_floor_is_matched_as_the_body(is_source) -> None:
    scan, other = standing(), blob(900, twist=0.4)
    pairs = MARKS if is_source else MARKS[:, ::-1]
    body = Mesh(scan.vertices[:900], blob(900).faces)
    clean = match(*((body, other) if is_source else (other, body)), SMALL, landmarks=pairs)
    with pytest.warns(KfmapsWarning, match="the floor is left out"):
        found = match(*((scan, other) if is_source else (other, scan)), SMALL, landmarks=pairs)
    target = other if is_source else body
    n = len(target.vertices)
    source = body if is_source else other
    assert geodesic_errors(source, found.target_to_source[:n], clean.target_to_source).mean() < 1e-3
    if not is_source:
        away = np.linalg.norm(scan.vertices[900:, None] - body.vertices, axis=2).min(axis=1)
        away /= np.sqrt(surface_area(body))
        assert (found.local_confidence[900:][away > 0.06] == 0).all()
        assert (found.local_confidence[900:][away < 0.04] > 0).any()
    shape = prepare_quietly(scan)
    assert shape.extent == pytest.approx(np.sqrt(surface_area(body)))
    assert len(shape.given_mesh.faces) == len(scan.faces)


def test_pieces_that_overlap_are_joined_above_a_floor() -> None:
    ball = blob(900)
    low = -ball.vertices[:, 2].min()
    pieces = joined(shifted(ball, -0.6, 0, low), shifted(ball, 0.6, 0, low))
    plain, scan = prepare_quietly(pieces), prepare_quietly(joined(pieces, ground(5.0)))
    assert plain.is_outer_surface
    assert plain.extent is not None
    assert scan.extent == pytest.approx(plain.extent, rel=1e-6)
    assert len(np.unique(scan.mesh.faces)) == len(np.unique(plain.mesh.faces))


def prepare_quietly(mesh: Mesh) -> Shape:
    with warnings.catch_warnings(action="ignore", category=KfmapsWarning):
        return prepare(mesh, SMALL)


def test_what_stands_on_a_floor_may_be_too_small() -> None:
    small = blob(35)
    scan = joined(shifted(small, 0, 0, -small.vertices[:, 2].min()), ground(4.0))
    with pytest.raises(InvalidInput, match="one for each eigenfunction"):
        prepare_quietly(scan)


def test_a_hole_in_a_flat_side_is_no_edge_of_a_floor() -> None:
    """Of a box, whose other sides are all on one side of the plane."""
    along = np.linspace(-1, 1, 15)
    top, side = sheet(along, along), np.diag([1.0, 1.0, 1.0])
    turns = [side, side[[0, 2, 1]], side[[2, 1, 0]]]
    box = joined(*(Mesh((top.vertices + np.array([0, 0, up])) @ turn, top.faces) for turn in turns for up in (-1, 1)))
    assert without_floor(unit_area(face_outward(clean_mesh(box)).mesh)) is None
    middle = np.linalg.norm(box.vertices[box.faces].mean(axis=1) - [0, 0, -1], axis=1)
    holed = unit_area(face_outward(clean_mesh(Mesh(box.vertices, box.faces[middle > 0.4]))).mesh)
    assert topology(holed).boundary_loops == 1
    assert without_floor(holed) is None


@pytest.mark.parametrize("seed", range(12))
def test_random_faces_are_no_floor(seed) -> None:
    """The longest of their boundaries may be a single edge."""
    rng = np.random.default_rng(seed)
    faces = np.array([rng.choice(8, 3, replace=False) for _ in range(40)])
    assert without_floor(unit_area(Mesh(rng.normal(size=(8, 3)), faces))) is None
