"""Objects of the user's own in a match: terms and descriptors; kernels and refinements are tested with their kind."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from conftest import blob
from kfmaps._arrays import InvalidInput
from kfmaps.config import BasisConfig, Config, DescriptorConfig, Formulation, NystromConfig, Search, as_dict, from_dict
from kfmaps.fmap.solvers import CG
from kfmaps.fmap.terms import laplacian_term
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.io import load_map
from kfmaps.matching.features import pair_descriptors
from kfmaps.matching.fit import fit
from kfmaps.matching.match import match
from kfmaps.settings import settings_text
from kfmaps.shape import Shape, prepare

GUARDS = ("kfmaps._records", "kfmaps.matching.assemble", "kfmaps.matching.features")

K = 20
ONE = replace(
    Config.single_fit(),
    basis=BasisConfig(n_eigenfunctions=K),
    descriptors=DescriptorConfig(n_spectral=12, n_eigenfunctions=40, shot=False),
    nystrom=NystromConfig(samples=60),
    operator_rtol=0.0,
    solver=CG(rtol=1e-10, max_iter=3000),
    refinement=ZoomOut(12, 40, 6),
    threads=1,
)
MARKS = np.array([[3, 3], [100, 100], [250, 250], [290, 290]])


@pytest.fixture(scope="module")
def shapes() -> tuple[Shape, Shape]:
    return prepare(blob(400), ONE, name="a"), prepare(blob(360, twist=0.4), ONE, name="b")


class Near:
    """``½‖C − D‖²`` with the four methods that a term must have, and no more."""

    def __init__(self, D: np.ndarray) -> None:
        self.D = D

    def apply(self, C: np.ndarray) -> np.ndarray:
        return C

    def rhs(self) -> np.ndarray:
        return self.D

    def diagonal(self) -> np.ndarray:
        return np.ones_like(self.D)

    def constant(self) -> float:
        return 0.5 * float((self.D**2).sum())


@dataclass(frozen=True)
class NearIdentity:
    weight: float = 3.0

    def __call__(self, source: Shape, target: Shape) -> Near:
        return Near(np.eye(target.basis.functions.shape[1], source.basis.functions.shape[1]))


class Positions:
    """Coordinates and their squares."""

    def compute(self, shape: Shape) -> np.ndarray:
        return np.hstack([shape.mesh.vertices, shape.mesh.vertices**2])


def with_extra(config: Config, *extra: Any) -> Config:
    return replace(config, descriptors=replace(config.descriptors, extra=extra))


# Terms ----------------------------------------------------------------------------------------------------


def doubled(source: Shape, target: Shape) -> Any:
    return laplacian_term(source.basis, target.basis)


@pytest.mark.parametrize("preconditioner", ["sylvester", "jacobi", "none"])
def test_a_term_of_the_package_adds_to_its_weight(shapes: tuple[Shape, Shape], preconditioner: Any) -> None:
    config = replace(ONE, preconditioner=preconditioner)
    twice = replace(config, weights=replace(config.weights, laplacian=2.0))
    passed = fit(*shapes, replace(config, terms=(doubled,)), landmarks=MARKS)
    known = fit(*shapes, twice, landmarks=MARKS)
    np.testing.assert_allclose(passed.functional_map, known.functional_map, atol=1e-6)
    assert passed.energies["doubled"] == passed.energies["laplacian"]
    assert 2 * passed.energies["doubled"] == pytest.approx(known.energies["laplacian"], rel=1e-4)


@pytest.mark.parametrize("preconditioner", ["sylvester", "jacobi", "none"])
def test_a_term_with_four_methods_is_minimised_too(shapes: tuple[Shape, Shape], preconditioner: Any) -> None:
    """The more it weighs the nearer the map is to what it asks, and its value is the weighted residual."""
    config = replace(ONE, preconditioner=preconditioner)
    away = []
    for weight in (0.0, 3.0, 1e4):
        found = fit(*shapes, replace(config, terms=(NearIdentity(weight),)), landmarks=MARKS)
        assert found.solution.status == "converged"
        away.append(((found.functional_map - np.eye(K)) ** 2).sum())
        assert found.energies["NearIdentity"] == pytest.approx(0.5 * weight * away[-1], rel=1e-4, abs=1e-9)
    assert away[0] > 1.5 * away[1] > 100 * away[2]


def test_terms_of_both_directions_get_the_shapes_in_their_order(shapes: tuple[Shape, Shape]) -> None:
    seen = []

    def term(source: Shape, target: Shape) -> Near:
        seen.append((source.name, target.name))
        assert source.basis.functions.shape == (len(source.mesh.vertices), K)
        return Near(np.eye(K))

    config = replace(ONE, terms=(term, term), formulation=Formulation(bidirectional=True))
    found = fit(*shapes, config, landmarks=MARKS)
    assert set(seen) == {("a", "b"), ("b", "a")}
    assert {"term", "term 2"} <= set(found.energies)


# Descriptors ----------------------------------------------------------------------------------------------


def test_a_descriptor_is_as_good_as_its_values(shapes: tuple[Shape, Shape]) -> None:
    values = Positions().compute(shapes[0]), Positions().compute(shapes[1])
    handed = match(*shapes, ONE, landmarks=MARKS, descriptors=values)
    passed = match(*shapes, with_extra(ONE, Positions()), landmarks=MARKS)
    np.testing.assert_array_equal(passed.fit.raw_functional_map, handed.fit.raw_functional_map)
    plain = match(*shapes, ONE, landmarks=MARKS)
    assert np.abs(passed.fit.raw_functional_map - plain.fit.raw_functional_map).max() > 1e-6
    both = match(*shapes, with_extra(ONE, Positions()), landmarks=MARKS, descriptors=values)
    assert not np.array_equal(both.fit.raw_functional_map, passed.fit.raw_functional_map)
    assert passed.energies(passed.fit.raw_functional_map) == pytest.approx(passed.fit.energies)


def test_a_search_asks_for_descriptors_and_terms(shapes: tuple[Shape, Shape], monkeypatch: pytest.MonkeyPatch) -> None:
    """Their say is in the kernel fits, so a search makes these however easy the pair is."""
    widths: list[int] = []

    def spy(*arguments: Any) -> Any:
        used = pair_descriptors(*arguments)
        widths.append(used.source.shape[1])
        return used

    monkeypatch.setattr("kfmaps.matching.initial_maps.pair_descriptors", spy)
    config = replace(ONE, search=Search(candidates=1, n_sign_functions=2), refinement=None, terms=(NearIdentity(),))
    asked: list[int] = []

    class Counted(NearIdentity):
        def __call__(self, source: Shape, target: Shape) -> Near:
            asked.append(source.basis.functions.shape[1])
            return super().__call__(source, target)

    match(*shapes, with_extra(replace(config, terms=(Counted(),)), Positions()))
    assert widths == [30 + 6]
    assert asked == [K]


# Refusals -------------------------------------------------------------------------------------------------


class Uneven:
    def compute(self, shape: Shape) -> np.ndarray:
        return np.ones((len(shape.mesh.vertices), len(shape.name) if shape.name != "b" else 2))


class Short:
    def compute(self, shape: Shape) -> np.ndarray:
        return np.ones((len(shape.name) + 2, 1))


@pytest.mark.parametrize(
    ("change", "part"),
    [
        (lambda: replace(ONE, terms=NearIdentity()), r"Config.terms: expected a tuple, got NearIdentity"),
        (lambda: replace(ONE, terms=(3,)), "Config.terms: expected callables of two shapes, got 3"),
        (lambda: replace(ONE, terms=(NearIdentity,)), "Config.terms: expected callables of two shapes"),
        (lambda: with_extra(ONE, 3), r"DescriptorConfig.extra: expected objects with compute\(shape\), got 3"),
        (lambda: replace(ONE, terms=(lambda _s, _t: 3,)), "term: expected an object with apply, rhs"),
        (lambda: replace(ONE, terms=(NearIdentity(-1.0),)), "weight of NearIdentity"),
        (lambda: with_extra(ONE, Uneven()), r"descriptors of b: expected shape \(any, 1\)"),
        (lambda: with_extra(ONE, Short()), r"descriptors of a: expected shape \(400, any\)"),
    ],
)
def test_refused(shapes: tuple[Shape, Shape], change: Callable[[], Config], part: str) -> None:
    with pytest.raises(InvalidInput, match=part):
        fit(*shapes, change(), landmarks=MARKS)


def test_settings_files_leave_the_users_objects_out(shapes: tuple[Shape, Shape], tmp_path: Path) -> None:
    """Settings without them do not mention them; with them no file can hold them, and a map's file says so."""
    assert "terms" not in settings_text(ONE)
    assert "terms" not in as_dict(ONE)
    assert from_dict(json.loads(json.dumps(as_dict(ONE)))) == ONE
    own = with_extra(replace(ONE, terms=(NearIdentity(),)), Positions())
    with pytest.raises(InvalidInput, match="a record that a settings file can name"):
        settings_text(own)
    match(*shapes, own, landmarks=MARKS).save(tmp_path / "m.npz")
    loaded = load_map(tmp_path / "m.npz")
    assert not hasattr(loaded, "config")
    assert "NearIdentity" in loaded.fit.energies
