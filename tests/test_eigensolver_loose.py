"""Laws of the eigensolver at a loose tolerance: in single precision, and nearly as exact."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csr_array

from conftest import blob
from kfmaps import shape as shape_module
from kfmaps.geometry.basis import laplace_basis
from kfmaps.geometry.eigen import eigensolver as eigensolver_module
from kfmaps.geometry.eigen.eigensolver import smallest_eigenpairs
from kfmaps.geometry.mesh import unit_area
from test_eigensolver import operators

GUARDS = ("kfmaps.geometry.eigen",)


def test_loose_pairs_are_nearly_the_exact_ones() -> None:
    stiffness, mass = operators(unit_area(blob(1500)))
    exact, loose = (smallest_eigenpairs(stiffness, mass, 60, tolerance=t) for t in (1e-10, 1e-2))
    assert not np.array_equal(loose.values, exact.values)
    np.testing.assert_allclose(loose.values, exact.values, rtol=1e-4, atol=1e-4)
    np.testing.assert_allclose(loose.vectors.T @ (mass[:, None] * loose.vectors), np.eye(60), atol=1e-4)
    cosines = np.linalg.svd(exact.vectors.T @ (mass[:, None] * loose.vectors), compute_uv=False)
    assert cosines.min() > 0.999
    assert np.all(np.diff(loose.values) >= 0)
    assert loose.residuals.max() < 0.05


@pytest.mark.parametrize("tolerance", [1e-10, 1e-2])
@pytest.mark.parametrize("k", [100, 200])
def test_reported_progress_ends_near_one(k: int, tolerance: float) -> None:
    """The solves that are counted are about as many as were expected, and no fewer are expected than there are."""
    calls: list[float] = []
    operator = operators(unit_area(blob(1500)))
    smallest_eigenpairs(*operator, k, tolerance=tolerance, progress=calls.append)
    assert 0.7 < calls[-1] < 0.99
    assert len(set(calls)) == len(calls)


def test_eigenpairs_that_need_double_precision_are_found_in_it(monkeypatch: pytest.MonkeyPatch) -> None:
    # Some edges very stiff, as those of needle triangles: what else their ends hang on drowns in rounding.
    stiffness, mass = operators(unit_area(blob(1500)))
    ends = np.random.default_rng(0).permutation(1500).reshape(-1, 2)
    edges = csr_array((np.tile([1.0, -1.0], 750), ends.ravel(), 2 * np.arange(751)), shape=(750, 1500))
    coarse = stiffness + 1e6 * edges.T @ edges
    loose = smallest_eigenpairs(csr_array(coarse), mass, 40, tolerance=1e-2)
    exact = smallest_eigenpairs(csr_array(coarse), mass, 40)
    assert np.array_equal(loose.values, exact.values)
    monkeypatch.setattr(eigensolver_module, "_MAX_LOOSE_RESIDUAL", np.inf)
    again = smallest_eigenpairs(csr_array(coarse), mass, 40, tolerance=1e-2)
    assert np.array_equal(again.values, exact.values)


def test_only_large_shapes_are_prepared_loosely(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[float] = []

    def spy(*args: object, **more: object) -> object:
        asked.append(float(more.get("tolerance", 1e-10)))  # pyright: ignore[reportArgumentType]
        return laplace_basis(*args, **more)  # pyright: ignore[reportArgumentType]

    monkeypatch.setattr(shape_module, "laplace_basis", spy)
    for limit in (1000, 999):
        monkeypatch.setattr(shape_module, "EXACT_EIGENPAIRS", limit)
        shape_module.prepare(blob(1000))
    assert asked == [1e-10, 1e-2]
