"""What is worked out once per shape, whatever it is matched with."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Protocol

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial import KDTree

from kfmaps._arrays import Array, KfmapsWarning, refuse, take
from kfmaps._progress import Progress, StageTimer
from kfmaps._records import short_repr
from kfmaps._threads import available_cores, parallel
from kfmaps.config import Config
from kfmaps.descriptors.shot import mirror_shot, shot
from kfmaps.geometry.basis import Basis, laplace_basis
from kfmaps.geometry.clean import CleanedMesh, clean_mesh, face_outward
from kfmaps.geometry.cloud_surface import project_noise, roughness, surface_of_cloud
from kfmaps.geometry.eigen.eigensolver import EXACT, THREADED
from kfmaps.geometry.mesh import Mesh, check_mesh, surface_area, unit_area, vertex_normals
from kfmaps.geometry.mesh import mirror_mesh as mirrored_mesh
from kfmaps.geometry.sampling import stratified_samples, stratified_vertices

FEW, NEARLY = 3_000, 1e-2
"""Vertices up to which eigenfunctions are found to rounding, and the tolerance above."""
DESCRIBED = 7_000
"""Vertices for which SHOT is worked out; where there are more they are a hundredth of √area apart."""
_SUPPORT, _IN_BALL = 10_000, 550
"""Support points of SHOT, and how many lie in a ball of a large surface that then has fewer in all: of bodies 340, of
skulls with their two walls 1,000."""
_NO_SURFACE = (
    "no closed surface was found through the points, which are too noisy, open or have gaps. Left and right cannot be "
    "told: give three landmarks, or a mesh made from the points"
)
_NOISY = 0.24
"""Roughness above which a mesh is smoothed: of 5,000 vertices with noise of more than 0.006 √area."""
_NORMALS = 0.05  # distance in space, at unit area, that counts as much as normals that differ by 1


@dataclass(frozen=True, eq=False)
class Shape:
    """A surface ready to be matched; made by :func:`prepare`.

    Attributes
    ----------
    mesh : Mesh
        Scaled to unit area, vertices in the order given.
    basis : Basis
        Of as many functions as the configuration needs in all. Vertices that lie on no surface, and all but the first
        in one place, have no area and the functions of the vertex that they count as (:attr:`cleaned`).
    shot : (n, 352) float64, of a large shape float32, or None
        The SHOT descriptor when the configuration asks for it; a point cloud has none.
    name : str
    seconds : dict of str to float
        Time each stage took.
    laplacian : str
        Which one the functions are of.
    shot_radius : float or None
        Of ``shot``, in units of √area.
    extent : float or None
        √area before it was scaled; ``None`` of a point cloud.
    """

    mesh: Mesh
    basis: Basis
    shot: np.ndarray | None
    name: str
    seconds: dict[str, float]
    laplacian: str = "robust"
    shot_radius: float | None = None
    extent: float | None = None

    __repr__ = short_repr

    @cached_property
    def cleaned(self) -> tuple[Shape, CleanedMesh]:
        """The shape with each place once, faces outward, without unused vertices and specks, and how it is numbered.

        A match works on that; a shape that has nothing of the kind is returned as it is.
        """
        part = face_outward(clean_mesh(self.mesh, specks=True))
        if part.whole:
            return (self if part.mesh is self.mesh else replace(self, mesh=part.mesh)), part
        kept = part.to_original
        few = _renumbered(self.basis, kept, take(self.basis.mass, kept))
        return replace(self, mesh=part.mesh, basis=few, shot=None if self.shot is None else self.shot[kept]), part

    @property
    def given_mesh(self) -> Mesh:
        """The mesh without the faces that were found for a point cloud."""
        return Mesh(self.mesh.vertices) if self.extent is None else self.mesh


class Descriptor(Protocol):
    """A descriptor of the user's own; one of :attr:`kfmaps.DescriptorConfig.extra`."""

    def compute(self, shape: Shape) -> np.ndarray:
        """Return a row for each vertex of a prepared shape, and the same columns for every shape, (n, d).

        They must not depend on the order of vertices, on signs of eigenfunctions, or on where the shape lies.
        """
        ...


@dataclass(frozen=True, eq=False)
class SampledShape:
    """Some points of a shape that stand for all; made by :func:`sample_shape`."""

    shape: Shape  # a point cloud with the areas and functions of the surface that it was taken from
    vertices: np.ndarray  # (q,): which they are
    landmarks: np.ndarray  # (l,): where the landmarks are among them


def sample_shape(
    shape: Shape, count: int | None, landmarks: np.ndarray, rng: int | np.random.Generator = 0
) -> SampledShape:
    """Return ``shape`` on about ``count`` stratified points and the ``landmarks (l,)``; itself when it has no more.

    ``None`` takes all points.
    """
    n = len(shape.mesh.vertices)
    if count is None or n <= count:
        return SampledShape(shape, np.arange(n), landmarks)
    samples = stratified_samples(shape.basis, count, rng, landmarks)
    rows = samples.vertices
    cloud = Mesh(shape.mesh.vertices[rows], np.zeros((0, 3), dtype=np.int64))
    local = None if shape.shot is None else shape.shot[rows]
    part = replace(shape, mesh=cloud, basis=samples.basis, shot=local)
    return SampledShape(part, rows, np.searchsorted(rows, landmarks))


def prepare(
    mesh: Mesh, config: Config | None = None, *, name: str = "shape", progress: Progress | None = None
) -> Shape:
    """Do the work that depends on one shape alone, so that matching it with many others reuses it.

    ``mesh``: in any unit; a mesh without faces is a point cloud. Open edges that lie in one place are connected, faces
    that look inward are turned, second sides of faces, specks and vertices that no face uses are left out
    (:mod:`kfmaps.geometry.clean`), much noise is smoothed (:func:`kfmaps.geometry.cloud_surface.project_noise`), with a
    warning. ``config``: its basis, descriptor and refinement settings count.
    """
    config = config or Config()
    report = progress or (lambda _stage, _done: None)
    clock = StageTimer(lambda stage, done: report(f"{stage} of {name}", done))
    part = face_outward(clean_mesh(check_mesh(mesh, name, cloud=True), specks=True))
    is_cloud = len(mesh.faces) == 0
    noisy = not is_cloud and roughness(part.mesh.vertices, part.mesh.faces) > _NOISY
    if noisy:
        part = replace(part, mesh=Mesh(project_noise(part.mesh.vertices), part.mesh.faces))
    small = unit_area(part.mesh)
    _check_size(small, name, config)
    _tell(part, name, noisy)
    if is_cloud and config.descriptors.shot:
        surface = surface_of_cloud(small.vertices)
        if surface is None:
            warnings.warn(f"{name}: {_NO_SURFACE}", KfmapsWarning, stacklevel=2)
        else:
            mesh = Mesh(surface.vertices[part.to_clean], part.to_original[surface.faces])
            part = clean_mesh(mesh, specks=True)
            small = unit_area(part.mesh)
    kind, radius, threads = config.basis.laplacian, config.descriptors.shot_radius, config.threads
    tolerance, local = EXACT if len(small.vertices) <= FEW else NEARLY, None
    with clock("eigenfunctions"):
        told = partial(clock.report, "eigenfunctions")
        basis = laplace_basis(small, config.n_eigenfunctions, kind, threads=threads, progress=told, tolerance=tolerance)
    if config.descriptors.shot and len(mesh.faces):
        with clock("SHOT"):
            local = _local_descriptors(small, basis, radius, threads, lambda d: clock.report("SHOT", min(d, 0.99)))
    radius = None if local is None else radius
    size = None if is_cloud else float(np.sqrt(surface_area(part.mesh)))
    shape = Shape(Mesh(small.vertices, mesh.faces), basis, local, name, clock.seconds, kind, radius, size)
    if part.whole:
        return shape
    mass = np.zeros(len(mesh.vertices))
    mass[part.to_original] = basis.mass
    whole = _renumbered(basis, part.to_clean, mass)
    local = None if local is None else local[part.to_clean]
    placed = replace(shape, mesh=_placed(mesh, part, small), basis=whole, shot=local)
    if not is_cloud:  # what a match works on is at hand
        vars(placed)["cleaned"] = replace(shape, mesh=small), replace(part, mesh=small)
    return placed


def _local_descriptors(
    mesh: Mesh, basis: Basis, radius: float, threads: int | None = None, progress: Callable[[float], None] | None = None
) -> np.ndarray:
    """SHOT of all vertices of a mesh of unit area, (n, 352); of more than :data:`DESCRIBED` from as many.

    It changes little within a tenth of its radius: the others take the mean of the nearest three with like normals,
    each weighted by the inverse of its squared distance.
    """
    if len(mesh.vertices) <= DESCRIBED:
        return shot(mesh, radius, threads=threads, progress=progress)
    chosen = stratified_vertices(basis, DESCRIBED, 0)
    few = mesh.vertices[chosen]
    near = KDTree(few).query_ball_point(few[::8], radius, return_length=True)
    samples = min(_SUPPORT, round(_IN_BALL * len(few) / near.mean()))
    found = shot(mesh, radius, samples=samples, at=chosen, threads=threads, progress=progress)
    places = np.hstack([mesh.vertices, _NORMALS * vertex_normals(mesh)])
    away, near = KDTree(places[chosen]).query(places, k=3, workers=threads or available_cores())
    weights = 1.0 / np.maximum(np.asarray(away) ** 2, 1e-12)
    weights /= weights.sum(axis=1, keepdims=True)
    # In single precision: of large shapes no other array takes as much memory, and time to have it.
    single = weights.astype(np.float32).ravel()
    spread = csr_array((single, np.asarray(near).ravel(), 3 * np.arange(len(places) + 1)))
    result = np.asarray(spread @ found.astype(np.float32))
    length = np.sqrt(np.einsum("ij,ij->i", result, result))[:, None]
    np.divide(result, length, out=result, where=length > 0)
    return result


def mirror_image(shape: Shape) -> Shape:
    """Return the mirror image of a prepared shape, with the same vertices, functions and areas."""
    if len(shape.mesh.faces) == 0:
        raise refuse(
            shape.name, "a surface, which can be mirrored", "a point cloud", "leave orientation at 'preserving'"
        )
    return replace(shape, mesh=mirrored_mesh(shape.mesh), shot=None if shape.shot is None else mirror_shot(shape.shot))


def _renumbered(basis: Basis, rows: np.ndarray, mass: Array) -> Basis:
    """The basis with its functions' ``rows (m,)``, column by column, and another mass (m,)."""
    return Basis(basis.eigenvalues, take(basis.functions.T, rows, axis=1).T, mass)


def _placed(mesh: Mesh, part: CleanedMesh, small: Mesh) -> Mesh:
    """All of ``mesh`` moved and scaled as ``part`` of it was to become ``small``."""
    centre = part.mesh.vertices.mean(axis=0)
    before, after = part.mesh.vertices - centre, small.vertices
    far = np.unravel_index(np.abs(before).argmax(), before.shape)
    vertices = (mesh.vertices - centre) * (after[far] / before[far])
    vertices[part.to_original] = after
    joined = ~part.unreferenced
    vertices[joined] = after[part.to_clean[joined]]
    return Mesh(vertices, mesh.faces)


def _tell(part: CleanedMesh, name: str, noisy: bool) -> None:
    """One warning of what is connected, left out, turned or smoothed."""
    what = "points in one place count as one" if len(part.mesh.faces) == 0 else "vertices on seams are connected"
    told = [f"{part.n_welded} {what}"] * bool(part.n_welded)
    told += [f"{part.specks} specks are left out"] * bool(part.specks)
    told += [f"{part.doubled} second sides of faces are left out"] * bool(part.doubled)
    if part.turned is not None:
        told.append(f"{part.turned.sum()} of {len(part.turned)} faces are turned outward")
    told += ["noisy vertices are projected to a smooth surface"] * noisy
    if told:
        warnings.warn(f"{name}: for the match {', '.join(told)}; the numbering is kept", KfmapsWarning, stacklevel=3)


def _check_size(mesh: Mesh, name: str, config: Config) -> None:
    """Refuse a mesh that has too few vertices for as many eigenfunctions as ``config`` needs."""
    if len(mesh.vertices) <= config.n_eigenfunctions:
        wanted = f"more than {config.n_eigenfunctions} vertices, one for each eigenfunction"
        remedy = "lower the basis, descriptor and refinement sizes (see docs/settings.md), or refine the mesh"
        raise refuse(name, wanted, str(len(mesh.vertices)), remedy)


def check_prepared(shape: Shape, config: Config) -> None:
    """Raise :class:`InvalidInput` when ``shape`` was prepared with other settings than ``config`` needs."""
    remedy = "prepare it with the configuration that it is matched with"
    have = shape.basis.functions.shape[1]
    if have < config.n_eigenfunctions:
        raise refuse(shape.name, f"a shape with {config.n_eigenfunctions} eigenfunctions", f"one with {have}", remedy)
    if shape.laplacian != config.basis.laplacian:
        wanted = f"a shape prepared with the {config.basis.laplacian} Laplacian"
        raise refuse(shape.name, wanted, f"one with the {shape.laplacian} one", remedy)
    if config.descriptors.shot and len(shape.mesh.faces) and shape.shot_radius != config.descriptors.shot_radius:
        wanted = f"a shape prepared with SHOT of radius {config.descriptors.shot_radius:g}"
        got = "one without" if shape.shot_radius is None else f"one with radius {shape.shot_radius:g}"
        raise refuse(shape.name, wanted, got, remedy)


def prepare_both(
    source: Mesh | Shape,
    target: Mesh | Shape,
    config: Config,
    names: tuple[str, str] = ("source", "target"),
    progress: Progress | None = None,
) -> list[Shape]:
    """Prepare both shapes, side by side where they are small: one small eigenproblem has no use for several cores.

    What is a :class:`Shape` already is checked against ``config`` and handed on. Both are checked before work begins.
    """
    both = ((source, names[0]), (target, names[1]))
    for part, name in both:
        if isinstance(part, Mesh):
            _check_size(part, name, config)
        else:
            check_prepared(part, config)
    workers = config.threads or available_cores()
    meshes = [part for part in (source, target) if isinstance(part, Mesh)]
    aside = len(meshes) == 2 and max(len(mesh.vertices) for mesh in meshes) < THREADED
    share = replace(config, threads=max(1, workers // 2)) if aside else config

    def ready(part: Mesh | Shape, name: str) -> Shape:
        return prepare(part, share, name=name, progress=progress) if isinstance(part, Mesh) else part

    return parallel(lambda item: ready(*item), both, min(workers, 2) if aside else 1)
