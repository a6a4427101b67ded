"""What is worked out once per shape, whatever it is matched with."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np

from kfmaps._arrays import refuse
from kfmaps._progress import Progress
from kfmaps.config import Config
from kfmaps.descriptors.shot import shot
from kfmaps.surface.basis import Basis, laplace_basis
from kfmaps.surface.mesh import Mesh, check_mesh, unit_area
from kfmaps.surface.samples import stratified_samples


@dataclass(frozen=True, eq=False)
class Shape:
    """A surface ready to be matched; made by :func:`prepare`.

    Attributes
    ----------
    mesh : Mesh
        Scaled to unit area, vertices in the order given.
    basis : Basis
        Of as many functions as the configuration needs in all.
    shot : (n, 352) float64 or None
        The SHOT descriptor when the configuration asks for it; a point cloud has none.
    name : str
    seconds : dict of str to float
        Time each stage took.
    laplacian : str
        Which one the functions are of.
    shot_radius : float or None
        Of ``shot``, in units of √area.
    """

    mesh: Mesh
    basis: Basis
    shot: np.ndarray | None
    name: str
    seconds: dict[str, float]
    laplacian: str = "robust"
    shot_radius: float | None = None


@dataclass(frozen=True, eq=False)
class Reduced:
    """Some points of a shape that stand for all; made by :func:`reduced`.

    Attributes
    ----------
    shape : Shape
        A point cloud with the areas and functions of the surface that it was taken from.
    vertices : (q,) int64
        Which they are.
    landmarks : (l,) int64
        Where the landmarks are among them.
    """

    shape: Shape
    vertices: np.ndarray
    landmarks: np.ndarray


def reduced(shape: Shape, count: int | None, landmarks: np.ndarray, rng: int | np.random.Generator = 0) -> Reduced:
    """``shape`` on about ``count`` stratified points and the ``landmarks (l,)``; itself when it has no more.

    ``None`` takes all points.
    """
    n = len(shape.mesh.vertices)
    if count is None or n <= count:
        return Reduced(shape, np.arange(n), landmarks)
    samples = stratified_samples(shape.basis, count, rng, landmarks)
    rows = samples.vertices
    cloud = Mesh(shape.mesh.vertices[rows], np.zeros((0, 3), dtype=np.int64))
    local = None if shape.shot is None else shape.shot[rows]
    part = replace(shape, mesh=cloud, basis=samples.basis, shot=local)
    return Reduced(part, rows, np.searchsorted(rows, landmarks))


def prepare(
    mesh: Mesh, config: Config | None = None, *, name: str = "shape", progress: Progress | None = None
) -> Shape:
    """Do the work that depends on one shape alone, so that matching it with many others reuses it.

    Parameters
    ----------
    mesh : Mesh
        In any unit; a mesh without faces is a point cloud.
    config : Config, optional
        Its basis, descriptor and refinement settings count here.

    Raises
    ------
    InvalidInput
        When the mesh cannot be worked with, or has fewer vertices than eigenfunctions are needed.
    NotConverged
        When the eigensolver misses its tolerance.
    """
    config = config or Config()
    report = progress or (lambda _stage, _done: None)
    mesh = unit_area(check_mesh(mesh, name, cloud=True))
    wanted = config.eigenfunctions
    if len(mesh.vertices) <= wanted:
        remedy = "lower the basis, descriptor and refinement sizes, or refine the mesh"
        raise refuse(name, f"more than {wanted} vertices, one for each eigenfunction", str(len(mesh.vertices)), remedy)
    seconds = {}
    start = time.perf_counter()
    report(f"eigenfunctions of {name}", 0.0)
    basis = laplace_basis(mesh, wanted, config.basis.laplacian, threads=config.threads)
    seconds["eigenfunctions"] = time.perf_counter() - start
    report(f"eigenfunctions of {name}", 1.0)
    local = None
    if config.descriptors.shot and len(mesh.faces):
        start = time.perf_counter()
        report(f"SHOT of {name}", 0.0)
        local = shot(mesh, config.descriptors.shot_radius, threads=config.threads)
        seconds["SHOT"] = time.perf_counter() - start
        report(f"SHOT of {name}", 1.0)
    radius = None if local is None else config.descriptors.shot_radius
    return Shape(mesh, basis, local, name, seconds, config.basis.laplacian, radius)
