"""Functions of the package that accept files, arrays and other libraries' meshes.

:mod:`kfmaps.matching.match` computes with meshes only.
"""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from kfmaps._arrays import check, refuse
from kfmaps._progress import Progress
from kfmaps.cli.progress import Stages
from kfmaps.config import Config
from kfmaps.evaluation import Truth, check_truth, read_truth
from kfmaps.fmap import evaluate
from kfmaps.fmap.precise import PointMap
from kfmaps.fmap.refine import Refined
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import MeshFile, atomic_output, check_map, load_map, read_mesh_file
from kfmaps.io import save_map as save_map
from kfmaps.io.atomic import write_text
from kfmaps.io.convert import (
    FileName,
    LandmarksLike,
    MapLike,
    ShapeLike,
    TruthLike,
    as_landmarks,
    as_map,
    as_mesh,
    is_file,
)
from kfmaps.io.mapfile import map_mesh_file
from kfmaps.io.transfer import transfer as transfer_values
from kfmaps.matching import match as matching
from kfmaps.matching.result import Match
from kfmaps.shape import Shape
from kfmaps.shape import prepare as prepare_mesh

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_Truth = TruthLike | Truth | tuple[FileName, FileName]


def match(
    source: ShapeLike,
    target: ShapeLike,
    config: Config | None = None,
    *,
    landmarks: LandmarksLike | None = None,
    descriptors: tuple[ArrayLike, ArrayLike] | None = None,
    rng: int | np.random.Generator | None = 0,
    progress: bool | Progress | None = None,
) -> Match:
    """Find for each vertex of ``target`` the corresponding vertex of ``source``.

    Many candidate maps are computed and compared (:mod:`kfmaps.matching.search`). The result comes with the probability
    that it is right. Landmarks, if any, guide the candidates and help to choose between them. A landmark is rejected,
    and reported, if a map agrees with most of the others and contradicts it. With ``config.search=None`` there is a
    single fit, which needs landmarks to resolve symmetries. If ``config.partial`` or the boundaries say that one shape
    is a part of the other, it is placed there, and vertices without a counterpart have −1
    (:mod:`kfmaps.matching.partial`).

    Parameters
    ----------
    source, target : Mesh, Shape, path, (vertices, faces), or an object
        A file, a pair of arrays (n, 3) and (f, 3), one array (n, 3) for a point cloud, or a mesh of trimesh, PyVista,
        meshio or Open3D. A :class:`Shape` from :func:`prepare` saves the work that depends on one shape alone; it must
        have the same settings of the basis, SHOT and the numbers of functions.
    config : Config, optional
        ``Config()`` when not given.
    landmarks : (l, 2) whole numbers, a path, or a pair of paths, optional
        Pairs "source vertex, target vertex", 0-based; or the landmarks of either shape, which are paired by name
        (``.mrk.json``, ``.fcsv``, ``.tps``, ``.pts``, ``.csv``, ``.particles``).
    descriptors : pair of arrays (n_s, d), (n_t, d), optional
        Descriptors of the user, in addition to those of the configuration.
    rng : seed or Generator
        The same seed gives the same result.
    progress : bool or callable, optional
        ``True`` shows bars on a terminal and in notebooks, and lines elsewhere. A callable gets ``(stage, done)`` with
        ``done`` from 0 to 1.

    Returns
    -------
    Match
        With ``target_to_source (n_t,)``, a source vertex for each target vertex, and how likely it is right.

    Raises
    ------
    InvalidInput
        When a shape, the landmarks or the descriptors cannot be used; the message says what to do.
    NotConverged
        When the eigensolver misses its tolerance.

    Examples
    --------
    >>> pair = kfmaps.datasets.two_poses(1500)
    >>> result = kfmaps.match(pair.source, pair.target)
    >>> result.verdict
    'sure'
    >>> result.target_to_source.shape == (len(pair.target.vertices),)
    True
    """
    _check_config(config)
    shapes = (source, target)
    meshes = [as_mesh(shape, name) for shape, name in zip(shapes, ("source", "target"), strict=True)]
    first, second = (one if isinstance(one, Shape) else mesh for one, mesh in zip(shapes, meshes, strict=True))
    pairs = as_landmarks(landmarks, shapes, meshes)
    with _reporting(progress) as report:
        return matching.match(first, second, config, landmarks=pairs, descriptors=descriptors, rng=rng, progress=report)


def prepare(
    shape: ShapeLike, config: Config | None = None, *, name: str | None = None, progress: bool | Progress | None = None
) -> Shape:
    """Compute what depends on one shape alone, so that matches with many others share it.

    Parameters
    ----------
    shape : Mesh, path, (vertices, faces), or an object
        As :func:`match` takes them; in any unit.
    config : Config, optional
        Its basis, descriptor and refinement settings are used.
    name : str, optional
        Name in messages; by default the file's name.
    progress : bool or callable, optional
        As in :func:`match`.

    Returns
    -------
    Shape
        The cleaned shape at unit area, with its basis and descriptors.

    Raises
    ------
    InvalidInput
        When the shape cannot be used, or has too few vertices for the eigenfunctions.
    NotConverged
        When the eigensolver misses its tolerance.

    Examples
    --------
    >>> pair = kfmaps.datasets.two_poses(1500)
    >>> kfmaps.prepare(pair.source).basis.functions.shape
    (1500, 100)
    """
    _check_config(config)
    name = name or (Path(shape).name if is_file(shape) else "shape")
    with _reporting(progress) as report:
        return prepare_mesh(as_mesh(shape, name), config, name=name, progress=report)


def transfer(
    values: ArrayLike, map: MapLike, lost: ArrayLike | None = None, *, source: ShapeLike | None = None
) -> np.ndarray:
    """Transfer values from the vertices of the source to those of the target.

    Parameters
    ----------
    values : (n_s, ...) array
        Functions, labels, colours: anything with a row per source vertex.
    map : Match, path, PointMap, or (n_t,) whole numbers
        The map.
    lost : optional
        Value of target vertices without a counterpart; by default NaN, −1 for whole numbers, and empty for texts.
    source : as :func:`match` takes it, optional
        With it floating numbers are interpolated where the map has points inside triangles. A PointMap needs it.

    Returns
    -------
    (n_t, ...) array
        With the same dtype. Row j is ``values[target_to_source[j]]``, or a weighted mean of three rows.

    Raises
    ------
    InvalidInput
        When the map names a vertex that has no value, or the source has another number of vertices.

    Examples
    --------
    >>> pair = kfmaps.datasets.two_poses(1500)
    >>> heights = pair.source.vertices[:, 1]
    >>> kfmaps.transfer(heights, pair.truth).shape
    (1200,)
    """
    mesh = None if source is None else as_mesh(source, "source")
    return transfer_values(values, as_map(map, mesh), None if mesh is None else mesh.faces, lost)


def geodesic_errors(source: ShapeLike, predicted: MapLike, true: TruthLike | PointMap) -> np.ndarray:
    """Return the geodesic distance on the source from each predicted to its true point, divided by √area.

    Parameters
    ----------
    source : as :func:`match` takes it
    predicted : Match, path, PointMap, or (q,) whole numbers
        A map, for all target vertices, or a source vertex for each evaluated point. The points of a PointMap are not
        rounded to vertices.
    true : (q,) whole numbers, PointMap, or a tuple ((q,), (q,)) of whole numbers
        The true source vertex of each target vertex; or corresponding vertices of the source and of the target.

    Returns
    -------
    (q,) float64
        In units of the square root of the source's area; infinite between components, NaN without a counterpart.

    Raises
    ------
    InvalidInput
        When the two differ in length, or have vertices that the source does not have.

    Examples
    --------
    >>> pair = kfmaps.datasets.two_poses(1500)
    >>> wrong = np.zeros(1200, dtype=int)  # every target vertex goes to the first source vertex
    >>> bool(kfmaps.geodesic_errors(pair.source, wrong, pair.truth).mean() > 0.5)
    True
    """
    mesh = as_mesh(source, "source")
    points = predicted if isinstance(predicted, PointMap) else as_map(predicted).target_to_source
    true_points = true if isinstance(true, PointMap | tuple) else np.asarray(true)
    if isinstance(true_points, tuple):
        true_points, rows = (check(np.asarray(part), "truth", shape=(None,)) for part in true_points)
        n_t = len(points.faces if isinstance(points, PointMap) else points)
        rows = check_map(rows, n_t, len(true_points), "the truth's target vertices")
        points = PointMap(points.faces[rows], points.weights[rows]) if isinstance(points, PointMap) else points[rows]
    if isinstance(points, PointMap) or isinstance(true_points, PointMap):
        return evaluate.precise_errors(mesh, points, true_points)
    return evaluate.geodesic_errors(mesh, points, true_points)


def zoomout(
    C: ArrayLike,
    source: Basis | Shape,
    target: Basis | Shape,
    *,
    start: int | None = None,
    stop: int | None = None,
    step: int = 5,
    samples: int | None = None,
) -> Refined:
    """Refine a functional map by ZoomOut: alternate point map and functional map while the basis grows.

    Parameters
    ----------
    C : (k_t, k_s) array
        Carries coefficients of functions from source to target.
    source, target : Basis or Shape
        From :func:`kfmaps.laplace_basis` or :func:`kfmaps.prepare`, with at least ``stop`` functions.
    start, stop : int, optional
        First and last size of the map; by default that of ``C`` and all functions that both bases have.
    step : int
        Growth of the size from one step to the next.
    samples : int, optional
        Points of the target that all steps but the last work on; by default all.

    Returns
    -------
    Refined
        ``functional_map (stop, stop)`` and ``target_to_source (n_t,)``.

    Raises
    ------
    InvalidInput
        When a basis has too few functions, or ``C`` is larger than a basis.

    References
    ----------
    Melzi et al., ZoomOut: Spectral upsampling for efficient shape correspondence, 2019.

    Examples
    --------
    >>> pair = kfmaps.datasets.two_poses(1500)
    >>> source, target = (kfmaps.laplace_basis(mesh, 60) for mesh in (pair.source, pair.target))
    >>> C = kfmaps.to_functional(pair.truth, source.truncate(10), target.truncate(10))
    >>> kfmaps.zoomout(C, source, target).functional_map.shape
    (60, 60)
    """
    bases = [shape.basis if isinstance(shape, Shape) else shape for shape in (source, target)]
    for basis, name in zip(bases, ("source", "target"), strict=True):
        if not isinstance(basis, Basis):
            got = f"a {type(basis).__name__}"
            raise refuse(name, "a Basis or a Shape", got, "give kfmaps.laplace_basis(mesh, k) or kfmaps.prepare(mesh)")
    k_s, k_t = (basis.functions.shape[1] for basis in bases)
    initial = check(np.asarray(C, dtype=np.float64), "C", shape=(None, None), remedy="give a functional map (k_t, k_s)")
    if initial.shape[0] > k_t or initial.shape[1] > k_s:
        got = f"{initial.shape[0]} × {initial.shape[1]}"
        raise refuse("C", f"at most {k_t} × {k_s} entries", got, "compute more functions")
    refine = ZoomOut(
        min(initial.shape) if start is None else start, min(k_s, k_t) if stop is None else stop, step, samples
    )
    return refine(initial, bases[0], bases[1])


def render(
    map: MapLike,
    source: ShapeLike | None = None,
    target: ShapeLike | None = None,
    *,
    output: str | Path | None = None,
    truth: _Truth | None = None,
    force: bool = False,
    **options: Any,
) -> Figure:
    """Return the figure of a map: the source, the target in its colours, and the error where the truth is given.

    Parameters
    ----------
    map : Match, path, PointMap, or (n_t,) whole numbers
    source, target : as :func:`match` takes them, optional
        By default those of the match, or those that the map file names.
    output : path, optional
        File to write as well: .png, .svg or .pdf.
    truth : (n_t,) whole numbers or a tuple ((q,), (q,)) of them, optional
        The true source vertex of each target vertex, −1 where there is none; or corresponding vertices of the source
        and of the target, or the two files of them.
    force : bool
        Whether an existing file is replaced.
    **options
        Of :func:`kfmaps.viz.match_figure`: ``title``, ``colors``, ``view``, ``limit``, ...

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InvalidInput
        When the shapes are not known, or the map or the truth does not fit them.

    Examples
    --------
    >>> pair = kfmaps.datasets.two_poses(1500)
    >>> figure = kfmaps.render(pair.truth, pair.source, pair.target, title="The truth")
    """
    from kfmaps.viz import match_figure, painted_errors, picture_format, save_figure, true_views

    match, files, _ = _map_and_shapes(map, source, target)
    meshes = files[0].mesh, files[1].mesh
    points = check_map(match, len(meshes[0].vertices), len(meshes[1].vertices), partial=True)
    correspondences = _truth(truth, meshes)
    if correspondences is not None:
        pairs = correspondences.source, correspondences.target
        options.setdefault("errors", painted_errors(*meshes, points, *pairs))
        views = true_views(*meshes, *pairs, options.get("view"))
        options = {"target_view": views[1], **options, "view": views[0]}
    figure = match_figure(*meshes, match, **options)
    if output is not None:
        picture_format(output)
        with atomic_output(output, force) as temporary:
            save_figure(figure, temporary)
    return figure


def view(
    map: MapLike,
    source: ShapeLike | None = None,
    target: ShapeLike | None = None,
    *,
    output: str | Path | None = None,
    truth: _Truth | None = None,
    names: tuple[str, str] | None = None,
    descriptors: bool = True,
    up: str | None = None,
    force: bool = False,
) -> Path | None:
    """Show a map in the browser, or in the cell of a notebook, or write the page.

    Parameters
    ----------
    map, source, target, truth, force
        As in :func:`render`.
    output : path, optional
        Write the page there and show nothing.
    names : (str, str), optional
        Names of the shapes on the page; by default those of their files.
    descriptors : bool
        Whether descriptors are computed and shown, which takes an eigensolve of each shape.
    up : {"x", "y", "z"}, optional
        The vertical axis; by default the page chooses a good side.

    Returns
    -------
    Path or None
        The page, one file that needs no network; ``None`` in a notebook's cell.

    Examples
    --------
    >>> pair = kfmaps.datasets.two_poses(1500)
    >>> page = kfmaps.view(pair.truth, pair.source, pair.target, output="page.html", descriptors=False)
    """
    from kfmaps.viz.result_pages import in_notebook, open_page, show_in_cell

    html, title = map_page(map, source, target, truth=truth, names=names, descriptors=descriptors, up=up)
    if output is not None:
        write_text(output, html, force)
        return Path(output)
    if in_notebook():
        return show_in_cell(html, title)
    return open_page(html)[0]


def map_page(
    map: MapLike,
    source: ShapeLike | None = None,
    target: ShapeLike | None = None,
    *,
    truth: _Truth | None = None,
    identity: bool = False,
    names: tuple[str, str] | None = None,
    descriptors: bool = True,
    up: str | None = None,
) -> tuple[str, str]:
    """Return the page of a map and its title; the arguments are those of :func:`view`.

    ``identity``: whether the truth is that vertex i corresponds to vertex i.
    """
    from kfmaps.viz.result_pages import match_page

    match, files, file_names = _map_and_shapes(map, source, target)
    drawn, path = files[0], Path(match.source_file.path)
    if source is None and hasattr(match, "source") and path.is_file():  # for the picture
        file = map_mesh_file(path, match, "source", Path())
        drawn = replace(file, mesh=drawn.mesh) if len(file.mesh.faces) == len(drawn.mesh.faces) else drawn
    correspondences = _truth(truth, (drawn.mesh, files[1].mesh), identity)
    names = names or file_names
    html = match_page(match, drawn, files[1].mesh, names, truth=correspondences, descriptors=descriptors, up=up)
    return html, f"{names[0]} → {names[1]}"


def picture_html(match: Match, description: str) -> str:
    """Return the figure of a match as an HTML image with a ``description``."""
    from kfmaps.viz.result_pages import figure_html

    return figure_html(render(match), description)


def _check_config(config: object) -> None:
    if config is not None and not isinstance(config, Config):
        raise refuse("config", "a Config", type(config).__name__, "give kfmaps.Config() or Config.paper(), say")


def _reporting(progress: bool | Progress | None) -> AbstractContextManager[Progress | None]:
    """Return a context with the progress callback: bars for ``True``, else ``progress`` itself."""
    if progress is True:
        return Stages()
    return nullcontext(progress or None)


def _truth(truth: _Truth | None, meshes: tuple[Mesh, Mesh], identity: bool = False) -> Truth | None:
    """Return corresponding vertices of both shapes, from a truth as :func:`render` takes it."""
    n_s, n_t = (len(mesh.vertices) for mesh in meshes)
    if truth is None or isinstance(truth, Truth):
        return read_truth(None, n_s, n_t, identity=True) if identity else truth
    if isinstance(truth, tuple) and is_file(truth[0]) and is_file(truth[1]):
        return read_truth((Path(truth[0]), Path(truth[1])), n_s, n_t, identity=identity)
    if not isinstance(truth, tuple):
        points = check_map(truth, n_s, n_t, "truth", partial=True)
        matched = np.flatnonzero(points >= 0)
        truth = points[matched], matched
    both = [check(np.asarray(part), "truth", shape=(None,), remedy="give vertex numbers") for part in truth]
    if len(both) != 2 or len(both[0]) != len(both[1]) or len(both[0]) == 0:
        got = " and ".join(str(len(part)) for part in both)
        raise refuse("truth", "two lists of equal length", got, "give corresponding vertices")
    return check_truth(Truth(both[0], both[1]), n_s, n_t)


def _map_and_shapes(
    map: MapLike, source: ShapeLike | None, target: ShapeLike | None
) -> tuple[Match, tuple[MeshFile, MeshFile], tuple[str, str]]:
    """Return a map, its two shapes and their names: the given shapes, else the match's own or those that it names."""
    map_path = Path(map) if is_file(map) else Path()
    match = load_map(map_path) if is_file(map) else map if isinstance(map, Match) else None
    files, names = [], []
    for shape, side in ((source, "source"), (target, "target")):
        path = Path(shape) if is_file(shape) else None
        if path is None and shape is not None:
            files.append(MeshFile(as_mesh(shape, side)))
        elif path is None and hasattr(match, side):
            files.append(MeshFile(getattr(match, side)))
        elif match is not None:
            files.append(map_mesh_file(path, match, side, map_path))
        elif path is None:
            raise refuse(side, "the shape", "a map alone", f"give {side}=")
        else:
            files.append(read_mesh_file(path))
        named = None if match is None else getattr(match, f"{side}_file").path
        names.append(Path(path or named or side).stem)
    match = match or as_map(map, files[0].mesh)
    return match, (files[0], files[1]), (names[0], names[1])
