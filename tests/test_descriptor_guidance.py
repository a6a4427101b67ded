"""ZoomOut that looks at descriptors: it is plain ZoomOut without them, and settles symmetries with them."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from conftest import blob
from kfmaps._arrays import InvalidInput
from kfmaps.fmap.convert import nearest
from kfmaps.fmap.descriptor_guidance import descriptor_guidance
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.basis import laplace_basis
from kfmaps.geometry.mesh import unit_area
from kfmaps.geometry.sampling import spectral_samples

GUARDS = ("kfmaps.fmap.descriptor_guidance", "kfmaps.fmap.zoomout")


@pytest.fixture(scope="module")
def symmetric():
    """A body that its mirror image in x equals, sampled; its places tell left from right."""
    mesh = unit_area(blob(700))
    both = np.abs(mesh.vertices[:, 0])[:, None]
    stretched = mesh.vertices * [2.0, 1.0, 0.6] + 0.3 * both * [0.0, 1.0, 0.0]
    mesh = unit_area(replace(mesh, vertices=stretched))
    basis = laplace_basis(mesh, 60)
    samples = spectral_samples(basis, 250, 0)
    return samples.basis, mesh.vertices[samples.vertices]


def run(C, basis, weight, guided):
    return ZoomOut(6, 40, 4, descriptor_weight=weight)(C, basis, basis, guidance=guided).functional_map


def test_without_weight_or_guidance_it_is_plain_zoomout(symmetric):
    basis, places = symmetric
    start = np.diag([1.0, 1, -1, 1, 1, -1])
    plain = ZoomOut(6, 40, 4)(start, basis, basis).functional_map
    np.testing.assert_array_equal(run(start, basis, 0.0, descriptor_guidance(places, places)), plain)
    np.testing.assert_array_equal(run(start, basis, 12.0, None), plain)
    assert np.abs(run(start, basis, 12.0, descriptor_guidance(places, places)) - plain).max() > 0.1


def test_descriptors_lead_from_the_wrong_signs_to_the_right_map(symmetric):
    basis, places = symmetric
    wrong = np.diag([1.0, -1, 1, 1, 1, 1])

    def error(C):
        phi = basis.functions[:, :40]
        return np.linalg.norm(places[nearest(phi, phi @ C.T)] - places, axis=1).mean()

    assert error(run(wrong, basis, 0.0, None)) > 0.2
    assert error(run(wrong, basis, 12.0, descriptor_guidance(places, places))) < 0.02


def test_on_samples_of_large_shapes_the_guidance_is_sampled_too():
    mesh = unit_area(blob(900))
    basis = laplace_basis(mesh, 50)
    zoom = ZoomOut(6, 40, 8, samples=200, descriptor_weight=12.0)
    wrong = np.diag([1.0, -1, 1, 1, 1, 1])
    found = zoom(wrong, basis, basis, guidance=descriptor_guidance(mesh.vertices, mesh.vertices))
    assert np.linalg.norm(mesh.vertices[found.target_to_source] - mesh.vertices, axis=1).mean() < 0.02


def test_guidance_is_scaled_shared_and_truncated():
    rng = np.random.default_rng(0)
    a, b = rng.normal(size=(200, 50)) * 7, rng.normal(size=(150, 50)) * 7
    guidances: Any = descriptor_guidance(a, b, dimensions=50), descriptor_guidance(a, b)
    found, short = guidances
    before, after = np.vstack([a, b]), np.vstack([found.source, found.target])
    i, j = rng.permutation(350)[:340].reshape(2, 170)
    ratio = ((before[i] - before[j]) ** 2).sum(axis=1) / ((after[i] - after[j]) ** 2).sum(axis=1)
    np.testing.assert_allclose(ratio, 2 * before.var(axis=0).sum(), rtol=1e-9)
    assert short.source.shape == (200, 32)
    some = found.at(np.array([3, 5]), None)
    np.testing.assert_array_equal(some.source, found.source[[3, 5]])
    assert some.target is found.target


def test_some_rows_tell_the_directions_of_all(monkeypatch):
    rng = np.random.default_rng(5)
    source, target = (rng.normal(size=(n, 6)) * [3.0, 2.0, 1.5, 0.1, 0.1, 0.1] + 1.0 for n in (900, 700))
    every: Any = descriptor_guidance(source, target, 3)
    monkeypatch.setattr("kfmaps.fmap.descriptor_guidance._DIRECTION_ROWS", 400)
    some: Any = descriptor_guidance(source, target, 3)

    def distances(found):
        return ((found.target[:, None] - found.source[None]) ** 2).sum(axis=2)

    assert 0 < np.abs(distances(some) - distances(every)).max() < 0.02 * distances(every).max()
    assert (some.source**2).sum() + (some.target**2).sum() == pytest.approx(800)


def test_descriptors_in_single_precision_guide_as_well():
    """Sums over many rows of numbers far from their mean lose it in single precision: they are in double."""
    rng = np.random.default_rng(0)
    source, target = (4 + rng.normal(size=(n, 3)) * [1.0, 0.6, 0.3] for n in (300_000, 200_000))
    exact: Any = descriptor_guidance(source, target)
    single: Any = descriptor_guidance(source.astype(np.float32), target.astype(np.float32))
    for a, b in ((exact.source, single.source), (exact.target, single.target)):
        turned = np.sign((a * b).sum(axis=0))
        np.testing.assert_allclose(b * turned, a, atol=3e-6)


def test_noise_does_not_guide():
    rng = np.random.default_rng(0)
    assert descriptor_guidance(1 + 0.01 * rng.normal(size=(50, 3)), 1 + 0.01 * rng.normal(size=(40, 3))) is None
    assert descriptor_guidance(None, rng.normal(size=(40, 3))) is None


def test_bad_settings_are_refused():
    with pytest.raises(InvalidInput, match="equally many on both"):
        descriptor_guidance(np.eye(4, 3), np.eye(4, 2))
    with pytest.raises(InvalidInput, match="descriptor_weight"):
        ZoomOut(descriptor_weight=-1.0)
