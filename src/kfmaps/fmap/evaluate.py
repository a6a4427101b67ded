"""Errors of a point map against the truth, by the Princeton protocol (Kim, Lipman and Funkhouser 2011)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import check, refuse
from kfmaps.fmap.convert import check_point_map
from kfmaps.fmap.precise import PointMap, check_point_map_precise, point_positions, vertex_point_map
from kfmaps.geometry.clean import clean_mesh
from kfmaps.geometry.connectivity import mesh_edges
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

    No n × n matrix is held. Points on different components are at infinite distance. On a point cloud paths run along
    nearest neighbours, and the area is estimated.

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
    errors, matched = np.full(len(predicted), np.nan), predicted != -1
    n, count = len(source.vertices), int(matched.sum())
    a, b = check_point_map(true[matched], n, count), check_point_map(predicted[matched], n, count)
    errors[matched] = geodesic_distance_pairs(source, a, b) / np.sqrt(surface_area(source))
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
    a, b = _as_point_map(predicted, source), _as_point_map(true, source)
    if len(a.faces) != len(b.faces):
        got = f"{len(a.faces)} and {len(b.faces)}"
        raise refuse("true points", "lists of equal length", got, "evaluate the same points")
    distances = surface_point_distances(source, a.faces, a.weights, b.faces, b.weights)
    return distances / np.sqrt(surface_area(source))


def _as_point_map(points: PointMap | np.ndarray, source: Mesh, n_t: int | None = None) -> PointMap:
    """Return a point map or a map to vertices as a checked point map; ``n_t``: number of points, if it is known."""
    if not isinstance(points, PointMap):
        vertices = np.asarray(points)
        points = vertex_point_map(check_point_map(vertices, len(source.vertices), n_t or len(vertices)), source)
    return check_point_map_precise(points, source, n_t)


@dataclass(frozen=True)
class Smoothness:
    """Measures of how smooth and one-to-one a map is."""

    coverage: float  # share of the source's area around corners of faces that an image lies in
    flipped_area: float  # share of the target's area in triangles whose images are turned over
    stretched_area: float  # share of the target's edges whose images are more than twice or less than half as long


def smoothness(source: Mesh, target: Mesh, places: PointMap | np.ndarray) -> Smoothness:
    """Return how far a map tears, folds or leaves parts out.

    Parameters
    ----------
    source, target : Mesh
        Lengths are compared in space, at equal areas.
    places : PointMap or (n_t,) int
        A point or a vertex of the source for each target vertex.
    """
    places = _as_point_map(places, source, len(target.vertices))
    images = point_positions(places, source)
    covered = np.unique(source.faces[places.faces][places.weights > 0])
    areas_s, areas_t = vertex_areas(source), face_areas(target)
    flipped = _kept_orientation(source, target, places, images) < 0
    i, j = mesh_edges(target.faces, len(target.vertices))[0].T
    before = np.linalg.norm(target.vertices[i] - target.vertices[j], axis=1)
    after = np.linalg.norm(images[i] - images[j], axis=1)
    scale = np.sqrt(surface_area(source) / surface_area(target))
    stretched = (after > 2 * scale * before) | (after < 0.5 * scale * before)
    return Smoothness(
        float(areas_s[covered].sum() / areas_s.sum()),
        float(areas_t[flipped].sum() / areas_t.sum()),
        float(stretched.mean()),
    )


def reverses_orientation(source: Mesh, target: Mesh, places: PointMap | np.ndarray) -> bool:
    """Return whether a map turns over more of the target's area than it keeps, as one to the mirror image does.

    Triangles whose corners have one image, as most have on a much coarser source, count for neither.

    Parameters
    ----------
    source, target : Mesh
    places : PointMap or (n_t,) int
        A point or a vertex of the source for each target vertex.
    """
    places = _as_point_map(places, source, len(target.vertices))
    kept = _kept_orientation(source, target, places, point_positions(places, source))
    return float(face_areas(target) @ np.sign(kept)) < 0.0


def _kept_orientation(source: Mesh, target: Mesh, places: PointMap, images: np.ndarray) -> np.ndarray:
    """Return a number (f_t,) for each target triangle: negative if its image is turned over, 0 if it has no area.

    ``images (n_t, 3)``: the positions of ``places``.
    """
    # Files that are inside out are turned first, so that their maps flip nothing.
    faces_s, faces_t = (turn_faces(mesh.faces, inward_faces(mesh)) for mesh in (source, target))
    normals_s = vertex_normals(Mesh(source.vertices, faces_s))
    normals = np.einsum("ti,tij->tj", places.weights, normals_s[source.faces[places.faces]])
    a, b, c = (images[faces_t[:, i]] for i in range(3))
    return np.einsum("fi,fi->f", np.cross(b - a, c - a), normals[faces_t].sum(axis=1))


def summarize_errors(errors: np.ndarray, auc_limit: float = 0.25) -> Evaluation:
    """Return mean, median, worst, and area under the curve of errors.

    Parameters
    ----------
    errors : (q,) float
    auc_limit : float
        Where the curve ends.

    Returns
    -------
    Evaluation
        In the unit of the errors.

    Examples
    --------
    >>> kfmaps.summarize_errors(np.array([0.0, 0.01, 0.02])).mean
    0.01
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
    """Return the fraction of errors that are at most as large as each threshold.

    Parameters
    ----------
    errors : (q,) float
    thresholds : (t,) float
        In the unit of the errors.

    Returns
    -------
    (t,) float64
        From 0 to 1.

    Examples
    --------
    >>> kfmaps.error_curve(np.array([0.0, 0.01, 0.2]), np.array([0.0, 0.1])).round(2)
    array([0.33, 0.67])
    """
    ordered = np.sort(np.asarray(errors, dtype=float))
    return np.searchsorted(ordered, np.asarray(thresholds, dtype=float), side="right") / len(ordered)


def coverage(target_to_source: np.ndarray, source: Mesh) -> float:
    """Return the fraction of the source's area whose vertices are the image of some target vertex.

    Welded vertices count as one, and those that no face uses do not count.

    Parameters
    ----------
    target_to_source : (n_t,) int
        −1, no counterpart, reaches none.
    source : Mesh

    Returns
    -------
    float
        From 0 to 1.

    Examples
    --------
    >>> mesh = kfmaps.datasets.sphere(500)
    >>> kfmaps.coverage(np.arange(500), mesh)
    1.0
    """
    check_is_mesh(source, "source")
    cleaned = clean_mesh(source)
    areas = vertex_areas(cleaned.mesh)
    points = np.asarray(target_to_source)
    points = points[points != -1]
    points = check_point_map(points, len(source.vertices), len(points))
    covered = np.unique(cleaned.to_clean[points[~cleaned.unreferenced[points]]])
    return float(areas[covered].sum() / areas.sum())


def truth_from_pairs(truth_s: np.ndarray, truth_t: np.ndarray, target_to_source: np.ndarray) -> np.ndarray:
    """Return the predicted source vertex of each true pair, ``target_to_source[truth_t]``, checked.

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

    It compares the area of the images of the faces around a vertex with that of the faces, both shapes at unit area. 0
    keeps area, 1 doubles it, −1 halves it; values are clipped to [−4, 4]. NaN where no face with area meets the vertex,
    around vertices without a counterpart (−1), and everywhere on point clouds.
    """
    n = len(target.vertices)
    if len(target.faces) == 0 or len(source.faces) == 0:
        return np.full(n, np.nan)
    unmatched = np.asarray(target_to_source) < 0
    image_areas = face_areas(Mesh(source.vertices[target_to_source], target.faces)) / face_areas(source).sum()
    areas = face_areas(target) / face_areas(target).sum()
    corners = target.faces.ravel()
    before = np.bincount(corners, np.repeat(areas, 3), minlength=n)
    after = np.bincount(corners, np.repeat(image_areas, 3), minlength=n)
    ratio = np.divide(after, before, out=np.full(n, np.nan), where=before > 0)
    ratio[np.unique(target.faces[unmatched[target.faces].any(axis=1)])] = np.nan
    return np.log2(np.clip(ratio, 2.0**-4, 2.0**4))
