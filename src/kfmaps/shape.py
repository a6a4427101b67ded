"""Prepared shapes: what is computed once per shape, whatever it is matched with."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, Protocol

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial import KDTree

from kfmaps._arrays import Array, KfmapsWarning, refuse, take
from kfmaps._progress import Progress, StageTimer
from kfmaps._records import short_repr
from kfmaps._texts import plural
from kfmaps._threads import limit_threads, n_threads, one_blas_thread, parallel
from kfmaps.config import Config
from kfmaps.descriptors.shot import mirror_shot, shot
from kfmaps.geometry.basis import Basis, laplace_basis
from kfmaps.geometry.clean import CleanedMesh, clean_mesh, divide_mesh, face_outward, flatten_spikes, smooth_noise
from kfmaps.geometry.cloud_surface import surface_of_cloud
from kfmaps.geometry.coarse_basis import coarse_basis, n_proxy_vertices
from kfmaps.geometry.eigen.eigensolver import EXACT
from kfmaps.geometry.floor import without_floor
from kfmaps.geometry.holes import fill_holes
from kfmaps.geometry.mesh import (
    Mesh,
    check_mesh,
    component_areas,
    mirror_mesh,
    surface_area,
    unit_area,
    vertex_normals,
)
from kfmaps.geometry.outer_surface import outer_surface, without_inner_walls, without_partitions
from kfmaps.geometry.sampling import stratified_samples, stratified_vertices
from kfmaps.geometry.subdivision import is_polyhedral

EXACT_EIGENPAIRS, LOOSE_TOLERANCE = 3_000, 1e-2
"""Number of vertices up to which eigenfunctions are exact to rounding, and the eigensolver's tolerance above it."""
MAX_SHOT_VERTICES = 7_000
"""Number of vertices at which SHOT is computed; on larger meshes these are a hundredth of √area apart."""
MIN_SEARCH_VERTICES = 1_000
"""Number of vertices below which the faces of a surface are divided for a search."""
_MIN_DIVIDED_VERTICES, _MIN_SOLID_VERTICES = 60, 12
"""Least number of vertices of a surface that is divided, with fewer eigenfunctions if it must be; and of a solid."""
_Repairs = tuple[tuple[Callable[[Mesh], Mesh | None], str], ...]
_REPAIRS: _Repairs = (
    (without_floor, "the floor is left out"),
    (without_inner_walls, "surfaces inside or around it are left out"),
    (without_partitions, "partitions of its inside are left out"),
    (outer_surface, "pieces that overlap count as the surface around them"),
    (fill_holes, "small holes are filled"),
)
"""What is done to a cleaned mesh where it is possible, and what is told of it."""
_OF_PIECES = {change for repair, change in _REPAIRS if repair not in (without_floor, fill_holes)}
"""What is done to both of two shapes in the same pieces, or to none."""
_WHOLE_AREA, _MAX_MOVED = 0.95, 0.1
"""Share of the area above which one piece is the whole shape, and the greatest share that may be in other pieces, from
the widest to the narrowest, than of the other shape."""
_BALL_SUPPORT = 550  # most support points of SHOT in one ball on average
_NORMAL_WEIGHT = 0.05  # distance in space, at unit area, that counts as much as normals that differ by 1


@dataclass(frozen=True, eq=False)
class Shape:
    """A surface ready to be matched; made by :func:`prepare`.

    Attributes
    ----------
    mesh : Mesh
        Scaled to unit area, vertices in the order given.
    basis : Basis
        With as many functions as the configuration needs; of a mesh of more than 60,000 vertices they are linear on a
        coarse proxy (:mod:`kfmaps.geometry.coarse_basis`). Vertices on no surface, and all but the first of several in
        one place, have no area and the functions of the vertex that replaces them (:attr:`cleaned`).
    shot : (n, 352) float64, of a large shape float32, or None
        The SHOT descriptor, where the configuration has it; a point cloud has none.
    name : str
    seconds : dict of str to float
        Time of each stage.
    laplacian : str
        Kind of the Laplacian whose eigenfunctions the basis has.
    shot_radius : float or None
        Radius of ``shot``, in units of √area.
    extent : float or None
        √area before scaling; ``None`` for a point cloud.
    given_faces : (f, 3) int64, or None
        The faces as given, where ``mesh`` has others: through a point cloud, on the outer surface of pieces, or, after
        the given ones, in small holes.
    repairs : tuple of str
        What was done to the given surface, as the warning says it.

    Examples
    --------
    >>> shape = kfmaps.prepare(kfmaps.datasets.torus(1000))
    >>> shape.mesh, shape.shot.shape
    (Mesh(1,000 vertices, 2,000 faces), (1000, 352))
    """

    mesh: Mesh
    basis: Basis
    shot: np.ndarray | None
    name: str
    seconds: dict[str, float]
    laplacian: str = "robust"
    shot_radius: float | None = None
    extent: float | None = None
    given_faces: np.ndarray | None = None
    repairs: tuple[str, ...] = ()

    __repr__ = short_repr

    @cached_property
    def cleaned(self) -> tuple[Shape, CleanedMesh]:
        """The shape on which a match works, and the record of its cleaning.

        It has welded vertices, outward faces, and neither unused vertices nor specks. A shape without any of these
        defects is returned as it is.
        """
        cleaned = face_outward(clean_mesh(self.mesh, specks=True))
        if cleaned.whole:
            return (self if cleaned.mesh is self.mesh else replace(self, mesh=cleaned.mesh)), cleaned
        rows = cleaned.to_original
        basis = _renumber(self.basis, rows, take(self.basis.mass, rows))
        return replace(
            self, mesh=cleaned.mesh, basis=basis, shot=None if self.shot is None else self.shot[rows]
        ), cleaned

    @cached_property
    def divided(self) -> tuple[Shape, CleanedMesh]:
        """:attr:`cleaned`; a surface of fewer than 1,000 vertices, or a solid with long faces, is divided.

        A search compares 1,000 samples. See :func:`kfmaps.geometry.clean.divide_mesh`.
        """
        shape, cleaned = self.cleaned
        if len(shape.mesh.faces) == 0:
            return self.cleaned
        cleaned = divide_mesh(replace(cleaned, mesh=shape.mesh), MIN_SEARCH_VERTICES)
        if cleaned.corners is None:
            return self.cleaned
        cleaned = replace(cleaned, mesh=unit_area(cleaned.mesh))
        basis = laplace_basis(cleaned.mesh, len(self.basis.eigenvalues), self.laplacian)
        local = None if self.shot_radius is None else _local_descriptors(cleaned.mesh, basis, self.shot_radius)
        return replace(shape, mesh=cleaned.mesh, basis=basis, shot=local), cleaned

    @property
    def is_repaired(self) -> bool:
        """Whether the faces are others than those given: on the outer surface of pieces, or also in small holes."""
        return self.given_faces is not None and len(self.given_faces) > 0

    @property
    def is_outer_surface(self) -> bool:
        """Whether the faces are those of the outer surface of given pieces, some of whose vertices are inside."""
        given = self.given_faces
        return given is not None and self.is_repaired and not np.array_equal(self.mesh.faces[: len(given)], given)

    @property
    def given_mesh(self) -> Mesh:
        """The mesh with the faces that were given."""
        return self.mesh if self.given_faces is None else Mesh(self.mesh.vertices, self.given_faces)


class Descriptor(Protocol):
    """A descriptor of the user's own; one of :attr:`kfmaps.DescriptorConfig.extra`."""

    def compute(self, shape: Shape) -> np.ndarray:
        """Return a row for each vertex of a prepared shape, and the same columns for every shape, (n, d).

        They must not depend on the order of vertices, on signs of eigenfunctions, or on where the shape lies.
        """
        ...


@dataclass(frozen=True, eq=False)
class SampledShape:
    """Samples of a shape that stand for all its vertices; made by :func:`sample_shape`."""

    shape: Shape  # a point cloud with areas and functions of the sampled surface
    vertices: np.ndarray  # (q,): the samples
    landmarks: np.ndarray  # (l,): positions of the landmarks among the samples


def sample_shape(
    shape: Shape, count: int | None, landmarks: np.ndarray, rng: int | np.random.Generator = 0
) -> SampledShape:
    """Return about ``count`` stratified samples of ``shape`` and the ``landmarks (l,)``; ``None`` takes all."""
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
    """Compute what depends on one shape alone, so that matches with many others share it.

    Seams are connected and inward faces turned. Second sides of faces, specks and unused vertices are left out, spikes
    flattened, and noise is smoothed (:mod:`kfmaps.geometry.clean`). A floor (:mod:`kfmaps.geometry.floor`), surfaces
    inside another and partitions are left out, too. Pieces that overlap become one
    (:mod:`kfmaps.geometry.outer_surface`), and small holes are filled (:mod:`kfmaps.geometry.holes`). A warning says
    so. ``mesh``: in any unit; without faces it is a point cloud. ``config``: its basis, descriptor and refinement
    settings count.
    """
    return _prepare(mesh, config or Config(), name, progress, _REPAIRS)


def _prepare(mesh: Mesh, config: Config, name: str, progress: Progress | None, possible: _Repairs) -> Shape:
    """Return :func:`prepare`'s shape, with those of the ``possible`` repairs that can be made."""
    report = progress or (lambda _stage, _done: None)
    timer = StageTimer(lambda stage, done: report(f"{stage} of {name}", done))
    cleaned = face_outward(clean_mesh(check_mesh(mesh, name, cloud=True), specks=True))
    is_cloud, given_faces = len(mesh.faces) == 0, None
    is_solid = is_polyhedral(cleaned.mesh)  # its corners are as sharp as spikes
    flat, n_spikes = (cleaned.mesh, 0) if is_solid else flatten_spikes(cleaned.mesh)
    cleaned = replace(cleaned, mesh=flat)
    # Edges of coarse meshes, and of solids, are as sharp as noise.
    may_be_noisy = len(cleaned.mesh.vertices) >= MIN_SEARCH_VERTICES and not is_solid
    smooth = smooth_noise(cleaned.mesh) if may_be_noisy else None
    cleaned = replace(cleaned, mesh=smooth or cleaned.mesh)
    unit = unit_area(cleaned.mesh)
    _check_size(unit, name, config)
    extent = None if is_cloud else float(np.sqrt(surface_area(cleaned.mesh)))
    if is_cloud:
        surface, repairs = (surface_of_cloud(unit.vertices) if config.descriptors.shot else None), []
    else:
        surface, repairs = _repaired(unit, possible)
    _warn_of_cleaning(cleaned, name, n_spikes, smooth is not None, repairs)
    if is_cloud and config.descriptors.shot and surface is None:
        text = (
            "no closed surface was found through the points, which are too noisy, open or have gaps. Left and "
            "right cannot be told apart: give three landmarks, or a mesh made from the points"
        )
        warnings.warn(f"{name}: {text}", KfmapsWarning, stacklevel=3)
    if surface is not None and surface is not unit:
        given_faces, extent = mesh.faces, extent and extent * float(np.sqrt(surface_area(surface)))
        mesh = _with_faces_of(surface, mesh, cleaned)
        cleaned = face_outward(clean_mesh(mesh, specks=True))
        unit = unit_area(cleaned.mesh)
        _check_size(unit, name, config)
    laplacian, radius = config.basis.laplacian, config.descriptors.shot_radius
    size, local = config.n_eigenfunctions, None
    with limit_threads(config.threads), timer("eigenfunctions"):
        basis = _basis(unit, size, laplacian, partial(timer.report, "eigenfunctions"))
    if config.descriptors.shot and len(mesh.faces):
        with limit_threads(config.threads), timer("SHOT"):
            local = _local_descriptors(unit, basis, radius, lambda d: timer.report("SHOT", min(d, 0.99)))
    radius = None if local is None else radius
    made = Mesh(unit.vertices, mesh.faces)
    shape = Shape(made, basis, local, name, timer.seconds, laplacian, radius, extent, given_faces, tuple(repairs))
    if cleaned.whole:
        return shape
    mass = np.zeros(len(mesh.vertices))
    mass[cleaned.to_original] = basis.mass
    whole_basis = _renumber(basis, cleaned.to_clean, mass)
    local = None if local is None else local[cleaned.to_clean]
    whole_shape = replace(shape, mesh=_scale_alike(mesh, cleaned, unit), basis=whole_basis, shot=local)
    if not is_cloud:  # need not be computed again
        vars(whole_shape)["cleaned"] = replace(shape, mesh=unit), replace(cleaned, mesh=unit)
    return whole_shape


def _basis(mesh: Mesh, k: int, laplacian: str, progress: Callable[[float], None]) -> Basis:
    """Return eigenfunctions of a cleaned mesh or cloud, as exact as a match needs them."""
    n = len(mesh.vertices)
    if len(mesh.faces) and n > 2 * n_proxy_vertices(k):
        return coarse_basis(mesh, k, laplacian, LOOSE_TOLERANCE, progress)
    tolerance = EXACT if n <= EXACT_EIGENPAIRS else LOOSE_TOLERANCE
    return laplace_basis(mesh, k, laplacian, progress=progress, tolerance=tolerance)


def _local_descriptors(
    mesh: Mesh, basis: Basis, radius: float, progress: Callable[[float], None] | None = None
) -> np.ndarray:
    """Return SHOT at all vertices of a mesh of unit area, (n, 352), computed at :data:`MAX_SHOT_VERTICES` at most.

    SHOT changes little within a tenth of its radius. The other vertices take the mean of the nearest three with similar
    normals, weighted by inverse squared distances.
    """
    if len(mesh.vertices) <= MAX_SHOT_VERTICES:
        return shot(mesh, radius, progress=progress)
    vertices = stratified_vertices(basis, MAX_SHOT_VERTICES, 0)
    positions = mesh.vertices[vertices]
    neighbours = KDTree(positions).query_ball_point(positions[::8], radius, return_length=True)
    # With 10,000 support points in all a ball has 340 on bodies, and 1,000 on skulls, whose walls are double.
    samples = min(10_000, round(_BALL_SUPPORT * len(positions) / neighbours.mean()))
    sampled = shot(mesh, radius, samples=samples, at=vertices, progress=progress)
    points = np.hstack([mesh.vertices, _NORMAL_WEIGHT * vertex_normals(mesh)])
    distances, neighbours = KDTree(points[vertices]).query(points, k=3, workers=n_threads())
    weights = 1.0 / np.maximum(np.asarray(distances) ** 2, 1e-12)
    weights /= weights.sum(axis=1, keepdims=True)
    # In single precision, since no other array of a large shape takes as much memory.
    weights_32 = weights.astype(np.float32).ravel()
    interpolation = csr_array((weights_32, np.asarray(neighbours).ravel(), 3 * np.arange(len(points) + 1)))
    result = np.asarray(interpolation @ sampled.astype(np.float32))
    length = np.sqrt(np.einsum("ij,ij->i", result, result))[:, None]
    np.divide(result, length, out=result, where=length > 0)
    return result


def mirror_image(shape: Shape) -> Shape:
    """Return the mirror image of a prepared shape, with the same vertices, functions and areas."""
    if len(shape.mesh.faces) == 0:
        raise refuse(
            shape.name, "a surface, which can be mirrored", "a point cloud", "leave orientation at 'preserving'"
        )
    return replace(shape, mesh=mirror_mesh(shape.mesh), shot=None if shape.shot is None else mirror_shot(shape.shot))


def _renumber(basis: Basis, rows: np.ndarray, mass: Array) -> Basis:
    """Return the basis with ``rows (m,)`` of its functions, stored column by column, and the ``mass (m,)``."""
    return Basis(basis.eigenvalues, take(basis.functions.T, rows, axis=1).T, mass)


def _with_faces_of(surface: Mesh, mesh: Mesh, cleaned: CleanedMesh) -> Mesh:
    """Return the given ``mesh`` with the faces of the ``surface`` that is made of what is left when it is ``cleaned``.

    Where holes are filled it keeps its own faces, and with them its seams and specks.
    """
    f = len(cleaned.mesh.faces)
    if f and np.array_equal(surface.faces[:f], cleaned.mesh.faces):
        faces = np.concatenate([mesh.faces, cleaned.to_original[surface.faces[f:]]])
        return Mesh(_scale_alike(mesh, cleaned, surface).vertices, faces)
    return Mesh(surface.vertices[cleaned.to_clean], cleaned.to_original[surface.faces])


def _scale_alike(mesh: Mesh, cleaned: CleanedMesh, unit: Mesh) -> Mesh:
    """Move and scale all of ``mesh`` as its ``cleaned`` part was to become ``unit``."""
    centre = cleaned.mesh.vertices.mean(axis=0)
    centred, unit_vertices = cleaned.mesh.vertices - centre, unit.vertices
    largest = np.unravel_index(np.abs(centred).argmax(), centred.shape)
    vertices = (mesh.vertices - centre) * (unit_vertices[largest] / centred[largest])
    vertices[cleaned.to_original] = unit_vertices
    is_used = ~cleaned.unreferenced
    vertices[is_used] = unit_vertices[cleaned.to_clean[is_used]]
    return Mesh(vertices, mesh.faces)


def _repaired(mesh: Mesh, repairs: _Repairs = _REPAIRS) -> tuple[Mesh, list[str]]:
    """Return the surface that is matched instead of a cleaned ``mesh`` of unit area, and what was done to it.

    Each of ``repairs`` that is possible is made once; what it changes may make an earlier one possible.
    """
    for i, (repair, change) in enumerate(repairs):
        found = repair(mesh)
        if found is not None:
            factor = float(np.sqrt(surface_area(found)))
            rest, changes = _repaired(Mesh(found.vertices / factor, found.faces), repairs[:i] + repairs[i + 1 :])
            return Mesh(factor * rest.vertices, rest.faces), [change, *changes]
    return mesh, []


def _warn_of_cleaning(cleaned: CleanedMesh, name: str, n_spikes: int, noisy: bool, repairs: list[str]) -> None:
    """Warn once of what is connected, left out, turned, smoothed or repaired."""
    welded = ("vertex on a seam is connected", "vertices on seams are connected")
    if len(cleaned.mesh.faces) == 0:
        welded = ("point counts as one with another in its place", "points in one place count as one")
    found: tuple[tuple[int, str, str], ...] = (
        (cleaned.n_welded, welded[0], welded[1]),
        (cleaned.specks, "speck is left out", "specks are left out"),
        (n_spikes, "spike is flattened", "spikes are flattened"),
        (cleaned.doubled, "second side of a face is left out", "second sides of faces are left out"),
    )
    changes = [plural(*one) for one in found if one[0]]
    if cleaned.turned is not None:
        changes.append(f"{cleaned.turned.sum()} of {len(cleaned.turned)} faces are turned outward")
    changes += ["the noise of its vertices is smoothed"] * noisy
    changes += repairs
    if changes:
        warnings.warn(f"{name}: for the match {', '.join(changes)}; the numbering is kept", KfmapsWarning, stacklevel=4)


def _check_size(mesh: Mesh, name: str, config: Config) -> None:
    """Refuse a mesh that has too few vertices for as many eigenfunctions as ``config`` needs."""
    if len(mesh.vertices) <= config.n_eigenfunctions:
        expected = f"more than {config.n_eigenfunctions} vertices, one for each eigenfunction"
        settings = "basis.n_eigenfunctions, descriptors.n_eigenfunctions, refinement.start and refinement.stop"
        remedy = f"set {settings} below that, or refine the mesh"
        raise refuse(name, expected, str(len(mesh.vertices)), remedy)


def lower_to_size(config: Config, source: Mesh | Shape, target: Mesh | Shape) -> Config:
    """Return the configuration of a match, with fewer eigenfunctions where a small surface has too few vertices.

    A search divides such a surface and has enough vertices then, but needs as many functions of both. A warning says
    so. A refinement without ``limited`` stays as it is.
    """
    meshes = (one for one in (source, target) if isinstance(one, Mesh) and len(one.faces))
    small = [mesh for mesh in meshes if 0 < len(mesh.vertices) < MIN_SEARCH_VERTICES]
    # Vertices that no face uses, and all but one in a place, do not count. What is not valid is refused elsewhere.
    valid = (Mesh(np.nan_to_num(m.vertices), np.clip(m.faces, 0, len(m.vertices) - 1)) for m in small)
    cleaned = [clean_mesh(mesh).mesh for mesh in valid]
    least = min((len(mesh.vertices) for mesh in cleaned), default=0)
    is_few = any(len(mesh.vertices) < _min_vertices(mesh) for mesh in cleaned)
    if config.search is None or is_few or not 0 < least <= config.n_eigenfunctions:
        return config
    refinement: Any = config.refinement
    count = 2 * least // 3
    if hasattr(refinement, "limited"):
        refinement = refinement.limited(count)
    basis, descriptors = (
        replace(one, n_eigenfunctions=min(one.n_eigenfunctions, count)) for one in (config.basis, config.descriptors)
    )
    warnings.warn(f"a mesh has {least} vertices: the map has {count} eigenfunctions", KfmapsWarning, stacklevel=3)
    return replace(config, basis=basis, descriptors=descriptors, refinement=refinement)


def _min_vertices(mesh: Mesh) -> int:
    """Return the least number of vertices of a cleaned mesh that is divided."""
    return _MIN_SOLID_VERTICES if is_polyhedral(mesh) else _MIN_DIVIDED_VERTICES


def check_prepared(shape: Shape, config: Config) -> None:
    """Raise :class:`InvalidInput` when ``shape`` was prepared with other settings than ``config`` needs."""
    remedy = "prepare it with the configuration that it is matched with"
    size, least = shape.basis.functions.shape[1], config.n_eigenfunctions
    if size < least:
        raise refuse(shape.name, f"a shape with {least} eigenfunctions", f"one with {size}", remedy)
    if shape.laplacian != config.basis.laplacian:
        expected = f"a shape prepared with the {config.basis.laplacian} Laplacian"
        raise refuse(shape.name, expected, f"one with the {shape.laplacian} one", remedy)
    if config.descriptors.shot and len(shape.mesh.faces) and shape.shot_radius != config.descriptors.shot_radius:
        expected = f"a shape prepared with SHOT of radius {config.descriptors.shot_radius:g}"
        got = "one without" if shape.shot_radius is None else f"one with radius {shape.shot_radius:g}"
        raise refuse(shape.name, expected, got, remedy)


def prepare_both(
    source: Mesh | Shape,
    target: Mesh | Shape,
    config: Config,
    names: tuple[str, str] = ("source", "target"),
    progress: Progress | None = None,
) -> list[Shape]:
    """Prepare both shapes, in parallel.

    A :class:`Shape` is only checked against ``config``, unless it is in the same pieces as the other and was repaired
    in another way. Both shapes are checked before work begins.
    """
    named_shapes = ((source, names[0]), (target, names[1]))
    for shape, name in named_shapes:
        if isinstance(shape, Mesh):
            _check_size(shape, name, config)
        else:
            check_prepared(shape, config)

    def prepared(item: tuple[Mesh | Shape, str]) -> Shape:
        shape, name = item
        return prepare(shape, config, name=name, progress=progress) if isinstance(shape, Mesh) else shape

    def without_repairs(item: tuple[Mesh | Shape, Shape]) -> Shape:
        given, shape = item
        if not left_out & set(shape.repairs):
            return shape
        possible = tuple(one for one in _REPAIRS if one[1] not in left_out)
        return _prepare(given if isinstance(given, Mesh) else shape.given_mesh, config, shape.name, progress, possible)

    with limit_threads(config.threads), one_blas_thread():
        shapes = parallel(prepared, named_shapes)
        left_out = _OF_PIECES & (set(shapes[0].repairs) ^ set(shapes[1].repairs))
        if not left_out or not _are_in_the_same_pieces(shapes):
            return shapes
        text = "are in the same pieces, so both are matched without what is possible for one of them alone"
        first, second = (shape.name for shape in shapes)
        warnings.warn(f"{first} and {second} {text}: {', '.join(sorted(left_out))}", KfmapsWarning, stacklevel=2)
        return parallel(without_repairs, list(zip((source, target), shapes, strict=True)))


def _are_in_the_same_pieces(shapes: list[Shape]) -> bool:
    """Return whether two surfaces are in several pieces of about the same shares of the area."""
    areas = [np.sort(component_areas(clean_mesh(shape.given_mesh, specks=True).mesh)[1])[::-1] for shape in shapes]
    shares = np.zeros((2, max(map(len, areas))))
    for row, values in zip(shares, areas, strict=True):
        row[: len(values)] = values / values.sum()
    return bool((shares[:, 0] < _WHOLE_AREA).all() and np.abs(shares[0] - shares[1]).sum() / 2 < _MAX_MOVED)
