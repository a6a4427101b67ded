"""Small shapes and array libraries that many tests share."""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import os
import pkgutil
import signal
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pytest
from scipy.spatial import ConvexHull

import kfmaps
from kfmaps import InvalidInput, MissingDependency
from kfmaps.fmap.convert import nearest
from kfmaps.geometry.basis import Basis, laplace_basis
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.io.record import MeshFile

pytest.register_assert_rewrite("chromium", "reviewing")  # they have fixtures: test modules name them as plugins


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--shake", type=int, help="change what another processor would: see tests/shake.py")


def pytest_configure(config: pytest.Config) -> None:
    if (seed := config.getoption("--shake")) is not None:
        importlib.import_module("shake").install(seed)


def fibonacci_sphere(n: int, twist: float = 0.0) -> Mesh:
    """A unit sphere of ``n`` nearly evenly spread vertices, faces outward."""
    i = np.arange(n)
    z = 1 - (2 * i + 1) / n
    angle = np.pi * (1 + 5**0.5) * i + twist
    radius = np.sqrt(1 - z * z)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=1)
    faces = ConvexHull(points).simplices.astype(np.int64)
    a, b, c = (points[faces[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0
    faces[inward] = faces[inward][:, ::-1]
    return Mesh(points, faces)


def blob(n: int = 400, twist: float = 0.0) -> Mesh:
    """A smooth shape without any symmetry, so that its eigenvalues are simple and its map to itself unique."""
    sphere = fibonacci_sphere(n, twist)
    x, y, z = sphere.vertices.T
    stretch = 1 + 0.35 * np.sin(2 * x + 0.5) + 0.25 * np.cos(3 * y - 1) * z + 0.2 * x * y
    return Mesh(sphere.vertices * stretch[:, None] * np.array([1.0, 1.3, 0.8]), sphere.faces)


def random_basis(n: int, k: int, rng: np.random.Generator) -> Basis:
    """Functions orthonormal in a random mass, with increasing eigenvalues; no surface behind it."""
    mass = rng.uniform(0.5, 1.5, n) / n
    q = np.linalg.qr(rng.normal(size=(n, k)))[0]
    return Basis(np.cumsum(rng.uniform(0.1, 1.0, k)) - 0.1, q / np.sqrt(mass)[:, None], mass)


@pytest.fixture(scope="session")
def small_mesh() -> Mesh:
    return unit_area(blob())


@pytest.fixture(scope="session")
def small_basis(small_mesh: Mesh) -> Basis:
    return laplace_basis(small_mesh, 40)


@pytest.fixture(scope="session")
def poses() -> kfmaps.datasets.ExamplePair:
    """Two poses of one creature of 1,500 vertices."""
    return kfmaps.datasets.two_poses(1500, rng=2)


@pytest.fixture(scope="session", autouse=True)
def _coarse_pictures() -> Iterator[None]:
    """Divide fewer triangles for pictures, whose drawing takes most of the time of what draws one."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("kfmaps.viz.surfaces._MIN_TRIANGLES", 1000)
        yield


@pytest.fixture(scope="session")
def creatures() -> tuple[Any, Any, np.ndarray]:
    """Two that differ much, prepared for an automatic match, and the source vertex of each target vertex."""
    made = kfmaps.datasets.non_isometric(1500, rng=3)
    config = kfmaps.Config()
    shapes = [kfmaps.prepare(mesh, config, name=name) for mesh, name in ((made.source, "a"), (made.target, "b"))]
    return shapes[0], shapes[1], made.truth


@pytest.fixture(scope="module")
def shape(request: pytest.FixtureRequest) -> Any:
    """A blob, prepared as ``BLOBS`` of the test's module says: the settings, its vertices and those of ``other``."""
    config, n, _ = request.module.BLOBS
    return kfmaps.prepare(blob(n), config, name="blob")


@pytest.fixture(scope="module")
def other(request: pytest.FixtureRequest) -> Any:
    """The blob of :func:`shape`, meshed anew."""
    config, _, n = request.module.BLOBS
    return kfmaps.prepare(blob(n, twist=0.4), config, name="other")


@pytest.fixture(scope="module")
def truth(shape: Any, other: Any) -> np.ndarray:
    """The vertex of ``shape`` nearest to each of ``other``."""
    return nearest(other.mesh.vertices, shape.mesh.vertices)


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(7)


@pytest.fixture(params=["numpy", "array_api_strict", "torch"])
def asarray(request: pytest.FixtureRequest) -> Callable[[Any], Any]:
    """The ``asarray`` of one array library after another; the laws hold in each."""
    library = request.param
    if importlib.util.find_spec(library) is None:
        pytest.skip(f"{library} is not installed")
    return importlib.import_module(library).asarray


@pytest.fixture
def convert(asarray: Callable[[Any], Any]) -> Callable[[Basis], Basis]:
    """Moves a basis to that library."""
    return lambda basis: Basis(*(asarray(a) for a in (basis.eigenvalues, basis.functions, basis.mass)))


@pytest.fixture(scope="session")
def data() -> Path:
    """The folder of research shapes; tests that need it are skipped without."""
    folder = Path(os.environ.get("KFMAPS_DATA", Path(__file__).parents[2] / "shared" / "data"))
    if not (folder / "FAUST_r").is_dir():
        pytest.skip(f"no research shapes at {folder}; set KFMAPS_DATA")
    return folder


@pytest.fixture
def interruptible() -> Iterator[None]:
    """Ctrl-C works in this process, whatever it was started by: what is ignored is inherited."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def workers_here(monkeypatch: pytest.MonkeyPatch) -> None:
    """The work of a collection is done in this process, one item after another, without workers."""

    def imap(_pool: Any, function: Callable, items: Sequence[Any], **_: object) -> Iterator[tuple[int, Any]]:
        for number, item in enumerate(items):
            try:
                yield number, function(item)
            except Exception as error:
                yield number, error

    monkeypatch.setattr("kfmaps.batch.jobs.WorkerPool.imap", imap)
    monkeypatch.setattr("kfmaps.batch.jobs.WorkerPool.n_threads", 1, raising=False)
    monkeypatch.setattr("kfmaps.batch.run._check_workers", lambda *_: None)


def refusal(read: Callable[[Path], object], path: Path, content: bytes | None = None) -> str:
    """Return the one line in which a reader refuses a file, or one beside it, with what was expected."""
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InvalidInput) as caught:
        read(path)
    told = str(caught.value)
    assert "\n" not in told
    assert f"{path.parent}{os.sep}" in told
    assert "expected" in told
    return told


Value = TypeVar("Value")


def known(value: Value | None) -> Value:
    """Return what is not None."""
    assert value is not None
    return value


def corner_uv(shape: MeshFile) -> np.ndarray:
    """Return the texture coordinates (f, 3, 2) of all corners of faces."""
    return known(shape.uv)[known(shape.uv_faces)]


def exists(name: str) -> bool:
    """Whether a dotted name of the package is there; one that asks for a package that is not installed is."""
    try:
        return pkgutil.resolve_name(name) is not None
    except MissingDependency:
        return True
    except (AttributeError, ModuleNotFoundError):
        # A module whose own imports are missing looks as if it were not there.
        with contextlib.suppress(ModuleNotFoundError):
            return importlib.util.find_spec(name) is not None
        return False
