"""How far a point map is from the truth, by the Princeton protocol (Kim, Lipman and Funkhouser 2011)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import check, refuse
from kfmaps.fmap.convert import check_point_map
from kfmaps.fmap.precise import PointMap, check_point_map_precise, point_positions, vertex_point_map
from kfmaps.geometry.clean import clean_mesh
from kfmaps.geometry.connectivity import half_edges
from kfmaps.geometry.face_orientation import inward_faces, turn_faces
from kfmaps.geometry.geodesics import geodesic_distance_pairs
from kfmaps.geometry.mesh import Mesh, check_is_mesh, face_areas, surface_area, vertex_areas, vertex_normals
from kfmaps.geometry.surface_points import surface_point_distances


@dataclass(frozen=True, eq=False)
class Evaluation:
    """Summary of the errors of one map, all in units of √area of the source.

    Attributes
    ----------
    errors : (q,) float64
    mean, median, worst : float
    auc : float
        Area under the error curve from 0 to ``auc_limit``, divided by it: 1 is perfect.
    auc_limit : float
    exact : float
        Fraction of points with no error at all.
    """

    errors: np.ndarray
    mean: float
    median: float
    worst: float
    auc: float
    auc_limit: float
    exact: float


def geodesic_errors(source: Mesh, predicted: np.ndarray, true: np.ndarray) -> np.ndarray:
    """Return the geodesic distance from each predicted to its true vertex, (q,), divided by √area of the source.

    Distances are worked out for one block of vertices at a time: no n × n matrix is held. Points on different
    components are at infinite distance. On a point cloud distances run along its neighbours, and the area is estimated.

    Parameters
    ----------
    source : Mesh
    predicted, true : (q,) int
        Vertices of the source. The error is NaN where none is predicted (−1).

    Raises
    ------
    InvalidInput
        When the two lists differ in length or name vertices that the source does not have.
    """
    check_is_mesh(source, "source")
    predicted, true = np.asarray(predicted), np.asarray(true)
    if predicted.shape != true.shape:
        got = f"{predicted.shape} and {true.shape}"
        raise refuse("predicted and true vertices", "lists of equal length", got, "evaluate the same points")
    errors, known = np.full(len(predicted), np.nan), predicted != -1
    ends = [check_point_map(points[known], len(source.vertices), int(known.sum())) for points in (true, predicted)]
    errors[known] = geodesic_distance_pairs(source, *ends) / np.sqrt(surface_area(source))
    return errors


def precise_errors(source: Mesh, predicted: PointMap | np.ndarray, true: PointMap | np.ndarray) -> np.ndarray:
    """Return the geodesic distance from each predicted to its true point, (q,), divided by √area of the source.

    Parameters
    ----------
    source : Mesh
    predicted, true : PointMap or (q,) int
        Points inside triangles, which are not snapped, or vertices.

    Raises
    ------
    InvalidInput
        When the two differ in length or do not fit the source.
    """
    ends = []
    for name, given in (("predicted", predicted), ("true", true)):
        ends.append(_as_points(given, source))
        if len(ends[0].faces) != len(ends[-1].faces):
            got = f"{len(ends[0].faces)} and {len(ends[-1].faces)}"
            raise refuse(f"{name} points", "lists of equal length", got, "evaluate the same points")
    distances = surface_point_distances(source, ends[0].faces, ends[0].weights, ends[1].faces, ends[1].weights)
    return distances / np.sqrt(surface_area(source))


def _as_points(places: PointMap | np.ndarray, source: Mesh, n_t: int | None = None) -> PointMap:
    """The points of a point map or of vertices, checked; ``n_t``: how many there must be, where that is known."""
    if not isinstance(places, PointMap):
        vertices = np.asarray(places)
        places = vertex_point_map(check_point_map(vertices, len(source.vertices), n_t or len(vertices)), source)
    return check_point_map_precise(places, source, n_t)


@dataclass(frozen=True)
class Smoothness:
    """How smooth and how nearly one-to-one a map is."""

    coverage: float  # part of the source's area with an image nearby: that of the vertices of which a face has one
    flipped_area: float  # part of the target's area whose triangles come out turned over
    stretched_area: float  # part of the target's edges that come out more than twice as long, or less than half


def smoothness(source: Mesh, target: Mesh, places: PointMap | np.ndarray) -> Smoothness:
    """Return whether a map tears, folds or leaves parts out.

    Parameters
    ----------
    source, target : Mesh
        Lengths are compared in space, at equal areas.
    places : PointMap or (n_t,) int
        A point or a vertex of the source for each target vertex.
    """
    places = _as_points(places, source, len(target.vertices))
    # A map of a file that is inside out turns nothing over.
    outer, faces = (turn_faces(mesh.faces, inward_faces(mesh)) for mesh in (source, target))
    images = point_positions(places, source)
    hit = np.unique(source.faces[places.faces][places.weights > 0])
    areas = vertex_areas(source)
    normals = vertex_normals(Mesh(source.vertices, outer))
    there = np.einsum("ti,tij->tj", places.weights, normals[source.faces[places.faces]])
    turned = np.cross(images[faces[:, 1]] - images[faces[:, 0]], images[faces[:, 2]] - images[faces[:, 0]])
    over = np.einsum("fi,fi->f", turned, there[faces].sum(axis=1)) < 0
    sizes = face_areas(target)
    ends = np.unique(np.sort(half_edges(faces), axis=1), axis=0)
    before = np.linalg.norm(target.vertices[ends[:, 0]] - target.vertices[ends[:, 1]], axis=1)
    after = np.linalg.norm(images[ends[:, 0]] - images[ends[:, 1]], axis=1)
    scale = np.sqrt(surface_area(source) / surface_area(target))
    long = (after > 2 * scale * before) | (after < 0.5 * scale * before)
    return Smoothness(float(areas[hit].sum() / areas.sum()), float(sizes[over].sum() / sizes.sum()), float(long.mean()))


def summarize_errors(errors: np.ndarray, auc_limit: float = 0.25) -> Evaluation:
    """Return mean, median, worst, and area under the curve of errors.

    Parameters
    ----------
    errors : (q,) float
    auc_limit : float
        Where the curve ends.
    """
    errors = np.asarray(errors, dtype=float)
    check(errors, "errors", shape=(None,), finite=False)
    if errors.size == 0:
        raise refuse("errors", "at least one", "none", "give the errors of some points")
    # The exact integral of the empirical curve: each error e contributes max(0, limit - e).
    auc = float(np.clip(auc_limit - errors, 0, None).mean() / auc_limit)
    return Evaluation(
        errors,
        float(errors.mean()),
        float(np.median(errors)),
        float(errors.max()),
        auc,
        auc_limit,
        float((errors == 0).mean()),
    )


def error_curve(errors: np.ndarray, thresholds: np.ndarray) -> np.ndarray:
    """Return the fraction of ``errors (q,)`` at or below each of ``thresholds (t,)``, (t,), from 0 to 1."""
    ordered = np.sort(np.asarray(errors, dtype=float))
    return np.searchsorted(ordered, np.asarray(thresholds, dtype=float), side="right") / len(ordered)


def coverage(target_to_source: np.ndarray, source: Mesh) -> float:
    """Return the fraction of the source's area whose vertices are the image of some target vertex.

    Connected vertices in one place count as one; those that belong to no face count for nothing.

    Parameters
    ----------
    target_to_source : (n_t,) int
        −1, no counterpart, reaches none.
    source : Mesh
    """
    check_is_mesh(source, "source")
    part = clean_mesh(source)
    areas = vertex_areas(part.mesh)
    points = np.asarray(target_to_source)
    points = points[points != -1]
    points = check_point_map(points, len(source.vertices), len(points))
    hit = np.unique(part.to_clean[points[~part.unreferenced[points]]])
    return float(areas[hit].sum() / areas.sum())


def truth_from_pairs(truth_s: np.ndarray, truth_t: np.ndarray, target_to_source: np.ndarray) -> np.ndarray:
    """Return where a map sends the target's end of each true pair: ``target_to_source[truth_t]``, checked.

    ``truth_s (q,)`` and ``truth_t (q,)`` are corresponding vertices, line k of one file to line k of the other.
    """
    if len(truth_s) != len(truth_t):
        got = f"{len(truth_s)} and {len(truth_t)}"
        raise refuse("truth of source and target", "files of equal length", got, "take both from one data set")
    points = np.asarray(target_to_source)
    check_point_map(np.asarray(truth_t), len(points), len(truth_t))
    return points[truth_t]


def area_distortion(source: Mesh, target: Mesh, target_to_source: np.ndarray) -> np.ndarray:
    """Return the base-2 logarithm of how the map ``target_to_source (n_t,)`` changes area around each target vertex.

    The area on the source of the images of the faces around a vertex over the area of those faces on the target, both
    shapes scaled to unit area. 0 keeps area, 1 doubles it, -1 halves it; faces collapsed to nothing are held at -4,
    and nothing exceeds 4. NaN where no face with area meets the vertex, around vertices without a counterpart (−1),
    and everywhere on point clouds.
    """
    n = len(target.vertices)
    if len(target.faces) == 0 or len(source.faces) == 0:
        return np.full(n, np.nan)
    lost = np.asarray(target_to_source) < 0
    image = face_areas(Mesh(source.vertices[target_to_source], target.faces)) / face_areas(source).sum()
    own = face_areas(target) / face_areas(target).sum()
    corners = target.faces.ravel()
    here = np.bincount(corners, np.repeat(own, 3), minlength=n)
    there = np.bincount(corners, np.repeat(image, 3), minlength=n)
    ratio = np.divide(there, here, out=np.full(n, np.nan), where=here > 0)
    ratio[np.unique(target.faces[lost[target.faces].any(axis=1)])] = np.nan
    return np.log2(np.clip(ratio, 2.0**-4, 2.0**4))
