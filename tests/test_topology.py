"""Topological counts, checked on surfaces whose answers are known and by Euler's formula."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from conftest import blob, fibonacci_sphere, joined, reordered, sheet, shifted
from kfmaps.geometry.connectivity import unique_vertices
from kfmaps.geometry.mesh import Mesh
from kfmaps.geometry.topology import topology

GUARDS = ("kfmaps.geometry.mesh", "kfmaps.geometry.connectivity", "kfmaps.geometry.topology")


def strip(rows: int, columns: int, wrap: tuple[bool, bool] = (False, False), flip: bool = False) -> Mesh:
    """A grid of squares, each cut in two; wrapped it is a cylinder or torus, flipped a Möbius strip."""
    ends = [2 * np.pi if is_wrapped else 5.0 for is_wrapped in wrap]  # open sides do not lie along each other
    flat = sheet(np.linspace(0, ends[0], rows + 1), np.linspace(0, ends[1], columns + 1))
    number = np.arange((rows + 1) * (columns + 1)).reshape(rows + 1, columns + 1)
    if wrap[0]:
        number[-1] = number[0, ::-1] if flip else number[0]
    if wrap[1]:
        number[:, -1] = number[:, 0]
    used, faces = np.unique(number.ravel()[flat.faces], return_inverse=True)
    u, v, _ = flat.vertices[used].T
    places = np.stack([(3 + np.cos(v)) * np.cos(u), (3 + np.cos(v)) * np.sin(u), np.sin(v)], axis=1)
    return Mesh(places, faces.reshape(-1, 3))


TORUS = strip(6, 5, (True, True))


@pytest.mark.parametrize(
    ("mesh", "loops", "edges", "genus", "characteristic"),
    [
        (fibonacci_sphere(100), 0, 0, 0, 2),
        (strip(4, 5), 1, 18, 0, 1),
        (strip(6, 5, (True, False)), 2, 12, 0, 0),
        (TORUS, 0, 0, 1, 0),
        (
            joined(TORUS, shifted(strip(5, 4, (True, True)), 10, 0, 0), shifted(fibonacci_sphere(50), 20, 0, 0)),
            0,
            0,
            2,
            2,
        ),
        (strip(7, 4, (True, False), flip=True), 1, 14, None, 0),
    ],
    ids=["sphere", "disc", "cylinder", "torus", "two tori and a sphere", "Möbius strip"],
)
def test_known_surfaces(mesh: Mesh, loops: int, edges: int, genus: int | None, characteristic: int) -> None:
    counts = topology(mesh)
    assert (counts.boundary_loops, counts.boundary_edges) == (loops, edges)
    assert (counts.genus, counts.euler_characteristic) == (genus, characteristic)
    assert counts.is_orientable == (genus is not None) == (counts.inconsistent_edges == 0)
    assert counts.is_closed == (edges == 0)
    assert counts.is_manifold
    assert counts.duplicated_vertices == counts.unreferenced_vertices == counts.degenerate_faces == 0


def test_a_flipped_face_is_found_but_the_surface_stays_orientable() -> None:
    mesh = fibonacci_sphere(60)
    faces = mesh.faces.copy()
    faces[5] = faces[5, ::-1]
    counts = topology(Mesh(mesh.vertices, faces))
    assert counts.inconsistent_edges == 3
    assert counts.is_orientable
    assert counts.genus == 0
    assert counts.is_manifold  # fans do not depend on orientation


def test_three_faces_on_an_edge() -> None:
    counts = topology(Mesh(np.random.default_rng(0).normal(size=(5, 3)), np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]])))
    assert counts.nonmanifold_edges == 1
    assert counts.nonmanifold_vertices == 2
    assert not counts.is_manifold
    assert not counts.is_closed
    assert counts.genus is None


def test_two_spheres_that_touch_in_a_vertex() -> None:
    both = joined(fibonacci_sphere(40), shifted(fibonacci_sphere(40), 10, 0, 0))
    counts = topology(Mesh(both.vertices, np.where(both.faces == 40, 0, both.faces)))
    assert (counts.components, counts.nonmanifold_vertices, counts.unreferenced_vertices) == (1, 1, 1)
    assert counts.is_closed
    assert counts.genus is None


def test_boundary_loops_that_touch_are_told_apart() -> None:
    counts = topology(Mesh(np.eye(5, 3) + 2 * np.eye(5, 3, -3), np.array([[0, 1, 2], [2, 3, 4]])))
    assert counts.boundary_loops == 2
    assert counts.components == 1


def test_degenerate_faces_and_loose_vertices() -> None:
    mesh = fibonacci_sphere(50)
    middle = mesh.vertices[mesh.faces[0, :2]].mean(axis=0)
    places = np.vstack([mesh.vertices, mesh.vertices[3], middle])
    faces = np.vstack([mesh.faces, [[7, 7, 9], [*mesh.faces[0, :2], 51]]])
    counts = topology(Mesh(places, faces))
    assert counts.degenerate_faces == 2
    assert counts.unreferenced_vertices == 1
    assert counts.duplicated_vertices == 1
    assert counts.components == 1


def test_a_cloud_has_no_surface() -> None:
    counts = topology(Mesh(np.eye(3), np.zeros((0, 3), dtype=int)))
    assert (counts.components, counts.boundary_loops, counts.euler_characteristic) == (0, 0, 0)
    assert counts.genus is None
    assert counts.unreferenced_vertices == 3


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=30, deadline=None)
def test_permuting_everything_changes_nothing(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mesh = blob(60)
    faces = mesh.faces[rng.random(len(mesh.faces)) < 0.8]
    order = rng.permutation(len(mesh.vertices))
    turned = np.take_along_axis(faces, (np.arange(3) + rng.integers(0, 3, (len(faces), 1))) % 3, axis=1)
    moved = reordered(Mesh(mesh.vertices, turned[rng.permutation(len(faces))]), order)
    counts = topology(Mesh(mesh.vertices, faces))
    assert counts == topology(moved)
    other = trimesh.Trimesh(moved.vertices, moved.faces, process=False)
    assert counts.euler_characteristic == other.euler_number
    assert counts.boundary_edges == (np.unique(np.sort(other.edges, axis=1), axis=0, return_counts=True)[1] == 1).sum()


@given(st.integers(1, 40), st.integers(0, 2**32 - 1))
@settings(max_examples=50, deadline=None)
def test_first_occurrence_is_the_first_equal_row(n: int, seed: int) -> None:
    places = np.random.default_rng(seed).choice([-1.0, -0.0, 0.0, 1.0], size=(n, 3))
    expected = [next(j for j in range(n) if (places[j] == places[i]).all()) for i in range(n)]
    np.testing.assert_array_equal(unique_vertices(places), expected)
