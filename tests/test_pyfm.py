"""Functional maps from pyFM and to it, as docs/python.md says; without it by objects that are like its meshes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.spatial import KDTree

import kfmaps
from collecting import CONFIG
from conftest import blob
from kfmaps.geometry.mesh import unit_area

MESH = blob(300)
ORDER = np.random.default_rng(0).permutation(300)
OTHER = kfmaps.Mesh(MESH.vertices[ORDER], np.argsort(ORDER)[MESH.faces])


@dataclass
class TriMesh:
    """What kfmaps reads of a processed TriMesh."""

    vertices: np.ndarray
    faces: np.ndarray
    eigenvalues: np.ndarray
    eigenvectors: np.ndarray
    vertex_areas: np.ndarray


def tri_mesh(mesh: kfmaps.Mesh, signs: np.ndarray) -> TriMesh:
    """A TriMesh; another library's eigenfunctions may have other signs."""
    basis = kfmaps.laplace_basis(unit_area(mesh), len(signs))
    functions = basis.functions * signs
    return TriMesh(mesh.vertices, mesh.faces, np.asarray(basis.eigenvalues), functions, np.asarray(basis.mass))


def basis_of(mesh: TriMesh) -> kfmaps.Basis:
    return kfmaps.Basis(mesh.eigenvalues, mesh.eigenvectors, mesh.vertex_areas)


def their_points(FM_12: np.ndarray, mesh1: TriMesh, mesh2: TriMesh) -> np.ndarray:
    """pyFM's ``FM_to_p2p``: the vertex of mesh 1 whose functions, carried over, are nearest to those of mesh 2."""
    k2, k1 = FM_12.shape
    return np.asarray(KDTree(mesh1.eigenvectors[:, :k1] @ FM_12.T).query(mesh2.eigenvectors[:, :k2])[1])


def test_their_map_is_read_in_their_bases() -> None:
    """``FM_12`` (k2, k1) carries functions from mesh 1 to mesh 2: the map of a shape to itself with other numbers."""
    rng = np.random.default_rng(1)
    one, two = (tri_mesh(mesh, rng.choice([-1, 1], 40)) for mesh in (MESH, OTHER))
    FM_12 = two.eigenvectors.T @ (two.vertex_areas[:, None] * one.eigenvectors[ORDER])
    FM_12 = FM_12[:25, :30]
    points = kfmaps.to_points(FM_12, basis_of(one), basis_of(two))
    np.testing.assert_array_equal(points, their_points(FM_12, one, two))
    np.testing.assert_array_equal(points, ORDER)
    refined = kfmaps.zoomout(FM_12, basis_of(one), basis_of(two))
    assert refined.functional_map.shape == (40, 40)
    np.testing.assert_array_equal(refined.target_to_source, ORDER)


def test_our_map_is_theirs_with_our_bases() -> None:
    one, two = (tri_mesh(mesh, np.ones(40)) for mesh in (MESH, OTHER))
    landmark_vertices = np.stack([ORDER[:5], np.arange(5)], axis=1)
    found = kfmaps.match(one, two, CONFIG, landmarks=landmark_vertices)
    np.testing.assert_array_equal(found.target_to_source, ORDER)
    for mesh, basis in ((one, found.basis_source), (two, found.basis_target)):
        mesh.eigenvalues, mesh.eigenvectors = basis.eigenvalues, basis.functions
    k_t, k_s = found.functional_map.shape
    assert (k_s, k_t) == (one.eigenvectors.shape[1], two.eigenvectors.shape[1])
    np.testing.assert_array_equal(their_points(found.functional_map, one, two), ORDER)


def test_with_pyfm_itself() -> None:
    functional = pytest.importorskip("pyFM.functional", reason="pyFM is not installed")
    made = pytest.importorskip("pyFM.mesh").TriMesh
    mesh1, mesh2 = (made(mesh.vertices, mesh.faces, area_normalize=True).process(60) for mesh in (MESH, OTHER))
    landmark_vertices = np.stack([ORDER[:6], np.arange(6)], axis=1)
    model = functional.FunctionalMapping(mesh1, mesh2)
    model.compute_spectral_descriptors(60, "WKS", 60, landmark_vertices, subsample_step=5)
    model.fit(K=(20, 20))
    points = kfmaps.to_points(model.FM_12, basis_of(model.mesh1), basis_of(model.mesh2))
    np.testing.assert_array_equal(points, model.get_p2p(model.FM_12))
    assert (points == ORDER).mean() > 0.5
    found = kfmaps.match(mesh1, mesh2, CONFIG, landmarks=landmark_vertices)
    for mesh, basis in ((mesh1, found.basis_source), (mesh2, found.basis_target)):
        mesh.eigenvalues, mesh.eigenvectors = basis.eigenvalues, basis.functions
    theirs = functional.FunctionalMapping(mesh1, mesh2).get_p2p(found.functional_map)
    np.testing.assert_array_equal(theirs, ORDER)
