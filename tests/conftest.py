"""Small shapes and array libraries that many tests share."""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import os
import pkgutil
import signal
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any, TypeVar

import numpy as np
import pytest
from scipy.spatial import ConvexHull

import kfmaps
from kfmaps import InvalidInput, MissingDependency
from kfmaps.config import BasisConfig, Config, DescriptorConfig, NystromConfig, Search
from kfmaps.fmap.convert import nearest, to_functional
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.basis import Basis, laplace_basis
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.io.record import MeshFile
from kfmaps.matching.candidates import score_maps
from kfmaps.matching.initial_maps import Start
from kfmaps.matching.quality import sample_for_scoring
from kfmaps.matching.ranking import ProxyCache
from kfmaps.matching.sample_pair import two_level_samples
from kfmaps.matching.search import search_map
from kfmaps.matching.search_result import SearchResult

NO_FACES = np.zeros((0, 3), dtype=np.int64)
NO_LANDMARKS = np.zeros((0, 2), dtype=np.int64)
SMALL = replace(
    Config(),
    basis=BasisConfig(n_eigenfunctions=40),
    descriptors=replace(Config().descriptors, n_eigenfunctions=90, shot_radius=0.15),
    nystrom=NystromConfig(samples=100),
    refinement=ZoomOut(50, 90, 10, descriptor_weight=36.0),
    search=Search(candidates=2, n_sign_functions=3),
    threads=2,
)
"""Settings of a search that takes a second."""


def small_fit(functions: int, spectral: int, eigenfunctions: int, samples: int, **more: Any) -> Config:
    """Settings of a single fit of so many functions, which takes a moment."""
    return replace(
        Config.single_fit(),
        basis=BasisConfig(n_eigenfunctions=functions),
        descriptors=DescriptorConfig(n_spectral=spectral, n_eigenfunctions=eigenfunctions, shot=False),
        nystrom=NystromConfig(samples=samples),
        **{"refinement": None, "threads": 1, **more},
    )


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


def cloud_of(mesh: Mesh) -> Mesh:
    """Its vertices alone."""
    return Mesh(mesh.vertices, NO_FACES)


def shifted(mesh: Mesh, *by: float) -> Mesh:
    return Mesh(mesh.vertices + np.array(by), mesh.faces)


def joined(*meshes: Mesh) -> Mesh:
    """All of them as one mesh, each where it is."""
    starts = np.cumsum([0, *(len(m.vertices) for m in meshes)])
    faces = [m.faces + start for m, start in zip(meshes, starts, strict=False)]
    return Mesh(np.concatenate([m.vertices for m in meshes]), np.concatenate(faces))


def reordered(mesh: Mesh, order: np.ndarray) -> Mesh:
    """The same surface; its vertex ``i`` was ``order[i]``."""
    return Mesh(mesh.vertices[order], np.argsort(order)[mesh.faces])


def inside_out(mesh: Mesh) -> Mesh:
    return Mesh(mesh.vertices, mesh.faces[:, ::-1])


def sheet(x: np.ndarray, y: np.ndarray) -> Mesh:
    """A flat rectangle of squares that are cut in two, seen from above; ``y`` changes fastest."""
    across, along = (part.ravel() for part in np.meshgrid(x, y, indexing="ij"))
    a = (np.arange(len(x) - 1)[:, None] * len(y) + np.arange(len(y) - 1)).ravel()
    b = a + len(y)
    faces = np.concatenate([np.stack([a, b, b + 1], axis=1), np.stack([a, b + 1, a + 1], axis=1)])
    return Mesh(np.stack([across, along, 0 * across], axis=1), faces)


def rotation(seed: int) -> np.ndarray:
    """A random rotation, (3, 3)."""
    q = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return q * np.sign(np.linalg.det(q))


@cache
def two_poses(vertices: int) -> kfmaps.datasets.ExamplePair:
    """One creature in two poses, generated once."""
    return kfmaps.datasets.two_poses(vertices, rng=3)


def functional_map(points: np.ndarray, source: Any, target: Any, k: int = 40) -> np.ndarray:
    """The functional map of ``points`` between prepared shapes, (k, k)."""
    return np.asarray(to_functional(points, source.basis.truncate(k), target.basis.truncate(k)))


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


def prepared_pair(source: Any, target: Any, truth: np.ndarray, **how: Any) -> SimpleNamespace:
    """Two prepared shapes with their samples and coarse proxies, and the true map as a candidate."""
    each = sample_for_scoring(source, **how), sample_for_scoring(target, **how)
    samples = two_level_samples(source, target, each)
    C = functional_map(truth, source, target)
    return SimpleNamespace(
        source=source,
        target=target,
        truth=truth,
        samples=samples,
        fine=samples.fine,
        C=C,
        right=score_maps([Start("truth", C)], samples.fine)[0],
        proxies=ProxyCache.of(source, target, samples.fine),
    )


@pytest.fixture(scope="session")
def creature_pair(creatures: tuple[Any, Any, np.ndarray]) -> SimpleNamespace:
    """The creatures with what a search needs."""
    return prepared_pair(*creatures, count=200)


@pytest.fixture(scope="session")
def symmetric() -> SimpleNamespace:
    """Two poses of a creature that its mirror image equals, prepared for a small search."""
    made = kfmaps.datasets.symmetric_creature(1500, rng=1)
    source, target = (kfmaps.prepare(mesh, SMALL, name=name) for mesh, name in ((made.source, "a"), (made.target, "b")))
    found = prepared_pair(source, target, made.truth)
    found.mirrored = made.mirrored
    return found


@pytest.fixture(scope="session")
def unmarked(symmetric: SimpleNamespace) -> SearchResult:
    """The search between them without landmarks."""
    return search_map(symmetric.source, symmetric.target, SMALL)


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
    output = str(caught.value)
    assert "\n" not in output
    assert f"{path.parent}{os.sep}" in output
    assert "expected" in output
    return output


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
