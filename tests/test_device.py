"""Everything from the basis on through PyTorch, on the CPU and on a GPU where there is one: NumPy's answers."""

from dataclasses import replace

import numpy as np
import pytest

from conftest import blob, small_fit
from kfmaps.config import NystromConfig, Weights
from kfmaps.fmap.refine import ICP
from kfmaps.fmap.solvers import CG
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.mesh import unit_area
from kfmaps.kernels.kernels import Laplacian, Linear
from kfmaps.matching.match import match
from kfmaps.shape import prepare

torch = pytest.importorskip("torch")

DEVICES = ["torch", *(["cuda"] if torch.cuda.is_available() else [])]

CONFIG = replace(
    small_fit(30, 40, 60, 80, solver=CG(1e-10, 2000), refinement=ZoomOut(20, 60, 10, samples=200), registration=None),
    nystrom=NystromConfig(samples=80, rtol=1e-8),
)

VARIANTS = {
    "default": CONFIG,
    "all points": replace(CONFIG, refinement=ZoomOut(20, 60, 10)),
    "on samples": replace(CONFIG, fit_samples=500),
    "jacobi, orthogonal": replace(CONFIG, preconditioner="jacobi", refinement=ICP(3)),
    "no17": replace(CONFIG, kernel=Linear()),
    "orientation": replace(CONFIG, weights=Weights(orientation=0.3)),
    "orientation on samples": replace(CONFIG, weights=Weights(orientation=0.3), fit_samples=500),
    "exact kernel": replace(CONFIG, full_kernel=True, kernel=Laplacian(), preconditioner="sylvester"),
    "shot, every-nth": replace(CONFIG, descriptors=replace(CONFIG.descriptors, shot=True, energy_sampling="every-nth")),
}


@pytest.fixture(scope="module")
def pair():
    config = VARIANTS["shot, every-nth"]
    source, target = (prepare(unit_area(mesh), config) for mesh in (blob(900), blob(800, twist=0.4)))
    return source, target


@pytest.mark.parametrize("where", DEVICES)
@pytest.mark.parametrize("name", VARIANTS)
def test_pytorch_agrees_with_numpy(name, where, pair):
    config = VARIANTS[name]
    landmarks = [[0, 0], [300, 270], [700, 620]]
    ours, theirs = (
        match(pair[0], pair[1], replace(config, device=device), landmarks=landmarks, rng=0) for device in ("cpu", where)
    )
    scale = np.abs(ours.fit.raw_functional_map).max()
    # On NumPy operators are multiplied in single precision.
    np.testing.assert_allclose(theirs.fit.raw_functional_map, ours.fit.raw_functional_map, atol=1e-5 * scale, rtol=0)
    np.testing.assert_allclose(theirs.functional_map, ours.functional_map, atol=1e-6, rtol=0)
    np.testing.assert_array_equal(theirs.target_to_source, ours.target_to_source)
    for term, energy in ours.fit.energies.items():
        assert theirs.fit.energies[term] == pytest.approx(energy, rel=1e-5), term
    assert isinstance(theirs.functional_map, np.ndarray)


def test_the_work_is_done_on_the_device(pair, monkeypatch):
    seen = []
    from kfmaps.fmap import minimize

    original = minimize.solve

    def spy(apply, b, *args, **kwargs):
        seen.append(type(b))
        return original(apply, b, *args, **kwargs)

    monkeypatch.setattr(minimize, "solve", spy)
    match(pair[0], pair[1], replace(CONFIG, device="torch", refinement=None), landmarks=[[0, 0]])
    assert seen == [torch.Tensor]
