"""SHOT: histograms of the normals around each vertex, in a local reference frame.

Unlike heat and wave signatures it distinguishes left from right (:func:`mirror_shot`).

Tombari, Salti and Di Stefano, "Unique signatures of histograms for local surface description", ECCV 2010.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csc_array
from scipy.spatial import KDTree

from kfmaps._arrays import check, check_count, check_positive, refuse
from kfmaps._threads import parallel
from kfmaps.geometry.clean import clean_mesh
from kfmaps.geometry.mesh import Mesh, face_areas, unit_area, unit_rows, vertex_normals

_AZIMUTHS, _ELEVATIONS, _SHELLS = 8, 2, 2
_VOLUMES = _AZIMUTHS * _ELEVATIONS * _SHELLS
_BINS = 10  # steps of the cosine from -1 to 1: each histogram has a value at each end of a step
_TIE = 1e-6  # relative difference up to which sums count as equal

_PAIRS = 60_000
"""Pairs of a vertex and a support point in one block, whose work arrays fit the cache, which is twice as fast."""


@dataclass(frozen=True, eq=False)
class _Support:
    """Support points that sample the surface."""

    points: np.ndarray  # (p, 3)
    normals: np.ndarray  # (p, 3)
    weights: np.ndarray  # (p,): areas


@dataclass(frozen=True, eq=False)
class _Pairs:
    """The support points in the balls around ``count`` vertices; lengths in units of the radius.

    Pair p is a point at ``offset[:, p]`` from vertex ``i[p]``, ``distance[p]`` away, with ``normal[:, p]``. Those of a
    vertex follow each other.
    """

    i: np.ndarray
    offset: np.ndarray
    distance: np.ndarray
    normal: np.ndarray
    weight: np.ndarray
    count: int

    def total(self, values: np.ndarray) -> np.ndarray:
        """Return sums of ``values (..., p)`` over the pairs of each vertex, (..., count)."""
        sums = np.zeros((*values.shape[:-1], self.count))
        if len(self.i):
            sums[..., self.i[self.first]] = np.add.reduceat(values, self.first, axis=-1)
        return sums

    @cached_property
    def first(self) -> np.ndarray:
        """The first pair of each vertex that has one."""
        return np.flatnonzero(np.diff(self.i, prepend=-1))

    def along(self, axis: np.ndarray, vectors: np.ndarray) -> np.ndarray:
        """Return the part of ``vectors (3, p)`` along the ``axis (count, 3)`` of each vertex."""
        x, y, z = axis.T.astype(vectors.dtype).take(self.i, axis=1) * vectors
        return x + y + z


def shot(
    mesh: Mesh,
    radius: float | None = None,
    *,
    samples: int = 10_000,
    at: np.ndarray | None = None,
    progress: Callable[[float], None] | None = None,
) -> np.ndarray:
    """Return the signature of histograms of orientations (SHOT) of every vertex, or of some.

    The ball around a vertex is cut into 32 volumes: 8 in azimuth, 2 in elevation, 2 in distance. In each a histogram
    counts the surface by the cosine between its normal and the vertical axis of the vertex's frame. Every support point
    is shared linearly between neighbouring volumes and neighbouring bins (section 3.2 of the paper), and the whole is
    scaled to unit length.

    Unlike the paper's, which counts vertices, it integrates over the surface, so that the triangulation hardly matters:
    support points inside the faces, weighted by area; the vertical axis is the mean normal, the first axis the
    principal direction across it, pointing to where the larger part of the area lies; the weight of a point fades over
    the last tenth of the radius; square roots of the histograms are taken, so that Euclidean distances between
    descriptors are Hellinger distances.

    Parameters
    ----------
    mesh : Mesh
        With faces, oriented consistently. Open edges in one place are connected
        (:func:`kfmaps.geometry.clean.clean_mesh`); a vertex that no face uses has the descriptor of the nearest one.
    radius : float, optional
        Radius of the ball as a fraction of √area, so that units do not matter; 0.09 when not given.
    samples : int
        About how many support points the whole mesh has, whatever its resolution: large faces are divided, and where
        there are more than twice as many faces, neighbouring ones are merged.
    at : (q,) int64, optional
        Vertices whose descriptors are wanted; all when not given.
    progress : callable, optional
        Called with how much is done, from 0 to 1.

    Returns
    -------
    (n, 352) float64, or (q, 352)
        Rows of unit length, without negative values. The volume varies slowest: azimuth, elevation, shell, then bin. A
        row is zero where the ball has no other support point, or no mean normal.

    Raises
    ------
    InvalidInput
        If the mesh has no faces, no area or coordinates that are not finite, or a setting is out of range.

    Notes
    -----
    Where the first axis has as much on one side as on the other, the side of the weighted mean position decides; the
    paper counts points around the median distance instead. In a neighbourhood that looks the same turned about its
    normal, as on a plane, the first axis is arbitrary.
    """
    check_count(samples, "samples")
    radius = check_positive(0.09 if radius is None else float(radius), "radius", "give a fraction of √area")
    if len(mesh.faces) == 0:
        raise refuse("mesh", "faces, which give the normals", "a point cloud", "triangulate it first")
    check(mesh.vertices, "vertices")
    cleaned = clean_mesh(mesh)
    if not cleaned.whole:
        if at is None:
            return shot(cleaned.mesh, radius, samples=samples, progress=progress)[cleaned.to_clean]
        return shot(cleaned.mesh, radius, samples=samples, at=cleaned.to_clean[at], progress=progress)
    mesh = unit_area(mesh)
    support = _surface_support(mesh, vertex_normals(mesh), samples)
    tree = KDTree(support.points)
    centres = mesh.vertices if at is None else mesh.vertices[at]
    result = np.empty((len(centres), _VOLUMES * (_BINS + 1)))
    done = 0

    def fill(block: np.ndarray) -> None:
        nonlocal done
        result[block] = _describe(centres[block], tree, support, radius)
        done += len(block)  # threads may overwrite each other's count, which is only for the progress
        if progress is not None:
            progress(done / len(result))

    parallel(fill, _blocks(centres, tree, radius))
    return result


def mirror_shot(descriptors: np.ndarray) -> np.ndarray:
    """Return what :func:`shot` would give on the mirror image of the shape: the azimuths in reverse order.

    Matching ``shot(mesh)`` with ``mirror_shot(shot(mesh))`` finds a left-right symmetry. ``descriptors (n, 352)``; as
    many come back.
    """
    n, width = descriptors.shape
    if width % _VOLUMES:
        raise refuse("descriptors", f"a multiple of {_VOLUMES} columns", str(width), "hand in those of shot")
    return descriptors.reshape(n, _AZIMUTHS, -1)[:, ::-1].reshape(n, width)


def _surface_support(mesh: Mesh, normals: np.ndarray, samples: int) -> _Support:
    """Return support points of a mesh of unit area, about ``samples`` and at most twice as many.

    Each face gives the barycentres of its m² equal parts, m chosen by its area; normals are interpolated.
    """
    areas = face_areas(mesh)
    parts = np.maximum(np.rint(np.sqrt(areas * samples)), 1).astype(np.int64)
    points, directions, weights = [], [], []
    for m in np.unique(parts):
        faces, share = mesh.faces[parts == m], areas[parts == m] / m**2
        for bary in _barycentres(int(m)):
            points.append(np.tensordot(bary, mesh.vertices[faces], axes=(0, 1)))
            directions.append(np.tensordot(bary, normals[faces], axes=(0, 1)))
            weights.append(share)
    support = _Support(np.concatenate(points), unit_rows(np.concatenate(directions)), np.concatenate(weights))
    return _merged(support, np.sqrt(1.5 / samples)) if len(support.points) > 2 * samples else support


def _barycentres(m: int) -> list[np.ndarray]:
    """Return the barycentric coordinates of the centres of the m² equal parts of a triangle."""
    upward = [(i + 1 / 3, j + 1 / 3) for i in range(m) for j in range(m - i)]
    downward = [(i + 2 / 3, j + 2 / 3) for i in range(m - 1) for j in range(m - 1 - i)]
    return [np.array([a, b, m - a - b]) / m for a, b in upward + downward]


def _merged(support: _Support, side: float) -> _Support:
    """One point for all that share a cubic cell and the side that their normals look to.

    The cells are aligned with the principal axes of the whole and centred on its centroid, so that the answer depends
    neither on the pose nor on the order of vertices nor on the signs of the axes.
    """
    w = support.weights
    centred = support.points - w @ support.points / w.sum()
    axes = np.linalg.eigh((centred * w[:, None]).T @ centred)[1]
    cell = np.rint(centred @ axes / side).astype(np.int64)
    components = support.normals @ axes
    main = np.abs(components).argmax(axis=1)
    face = 2 * main + (np.take_along_axis(components, main[:, None], axis=1)[:, 0] > 0)
    group = np.zeros(len(w), dtype=np.int64)
    for column in (*cell.T, face):  # rows are sorted ten times as slowly as numbers
        column = column - column.min()
        group = np.unique(group * (column.max() + 1) + column, return_inverse=True)[1]
    total = np.bincount(group, w)
    both = np.hstack([support.points, support.normals])
    summed = np.stack([np.bincount(group, w * column) for column in both.T], axis=1)
    points = summed[:, :3] / np.maximum(total, np.finfo(float).tiny)[:, None]
    return _Support(points, unit_rows(summed[:, 3:]), total)


def _blocks(vertices: np.ndarray, tree: KDTree, radius: float) -> list[np.ndarray]:
    """Vertex numbers in groups of neighbours with about ``_PAIRS`` support points each."""
    order = KDTree(vertices).indices
    # Neighbours have about as many: one of some says it for all.
    each = 8  # pairs are counted at one vertex of so many
    counts = tree.query_ball_point(vertices[order[::each]], radius, return_length=True).repeat(each)[: len(order)]
    block = np.cumsum(counts) // _PAIRS
    return np.split(order, np.flatnonzero(np.diff(block)) + 1)


def _describe(centres: np.ndarray, tree: KDTree, support: _Support, radius: float) -> np.ndarray:
    """Return the descriptors of a block of vertices, (b, 352)."""
    found = KDTree(centres).sparse_distance_matrix(tree, radius, output_type="ndarray")
    order = np.argsort(found["i"].astype(np.min_scalar_type(len(centres))), kind="stable")  # radix sort: small numbers
    order = order[found["v"].take(order) > 1e-9 * radius]
    i, j, distance = found["i"].take(order), found["j"].take(order), found["v"].take(order) / radius
    offset = (support.points.take(j, axis=0).T - centres.take(i, axis=0).T) / radius
    real = np.float32  # descriptors differ by 3e-6 from those in double precision
    distance, offset, weight = distance.astype(real), offset.astype(real), support.weights.astype(real).take(j)
    normal = np.ascontiguousarray(support.normals.astype(real).take(j, axis=0).T)
    pairs = _Pairs(i, offset, distance, normal, weight, len(centres))
    faded = pairs.weight * (10 * (1 - distance)).clip(-np.inf, 1)
    return unit_rows(np.sqrt(_histograms(pairs, _frames(pairs), faded)))


def _frames(pairs: _Pairs) -> np.ndarray:
    """Return the right-handed local reference frames, (count, 3, 3), one axis a row; zero where there is none."""
    offset = pairs.offset
    near = pairs.weight * (1 - pairs.distance).clip(0, np.inf)
    lever = near * offset
    covariance = np.stack([pairs.total(row * offset) for row in lever]).transpose(2, 0, 1)
    mean_normal, moment = pairs.total(near * pairs.normal).T, pairs.total(lever).T
    cancelled = np.linalg.norm(mean_normal, axis=1) <= _TIE * pairs.total(near)
    z = unit_rows(np.where(cancelled[:, None], 0, mean_normal))
    down = z[:, :, None] * z[:, None, :]
    across = np.eye(3) - down
    # Below zero z cannot be the principal direction, even where nothing lies across it.
    down *= np.trace(covariance, axis1=1, axis2=2)[:, None, None]
    x = _towards(pairs, np.linalg.eigh(across @ covariance @ across - down)[1][:, :, 2], moment)
    exists = np.abs(z).max(axis=1) > 0
    return np.stack([x, np.cross(z, x), z], axis=1) * exists[:, None, None]


def _towards(pairs: _Pairs, axis: np.ndarray, fallback: np.ndarray) -> np.ndarray:
    """Return ``axis`` (count, 3) towards the side with more area, or that of ``fallback`` where both are equal."""
    height = pairs.along(axis, pairs.offset)
    votes = pairs.total(pairs.weight * np.sign(np.where(np.abs(height) < _TIE, 0, height)))
    tie = np.abs(votes) <= _TIE * pairs.total(pairs.weight)
    side = np.where(tie, np.einsum("ij,ij->i", axis, fallback), votes)
    return np.where(side[:, None] < 0, -axis, axis)


def _histograms(pairs: _Pairs, frames: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Return histograms with quadrilinear interpolation, (count, 352).

    In azimuth and cosine a pair is shared between two of many entries, in elevation and distance there are only two: so
    this is a sparse matrix (azimuth, cosine) times a dense one (elevation, distance).
    """
    i, count = pairs.i, pairs.count
    weight = weight * (np.abs(frames).max(axis=(1, 2)) > 0)[i]
    x, y, z = (pairs.along(frames[:, axis], pairs.offset) for axis in range(3))
    cosine = np.clip(pairs.along(frames[:, 2], pairs.normal), -1, 1)
    turn = np.arctan2(y, x) * (_AZIMUTHS / (2 * np.pi)) - 0.5
    sector = np.floor(turn)
    turn -= sector
    sector = sector.astype(np.int64)
    step = (cosine + 1) * (_BINS / 2)
    first = np.minimum(step.astype(np.int64), _BINS - 1)
    step -= first
    rows = np.empty((len(i), 4), dtype=np.int32)
    parts = np.empty((len(i), 4), dtype=weight.dtype)
    ahead = turn * step
    parts[:, 0], parts[:, 1], parts[:, 2], parts[:, 3] = 1 - turn - step + ahead, step - ahead, turn - ahead, ahead
    start = i * _AZIMUTHS
    for a in (0, 1):
        # Minus one is the last of eight, and eight the first.
        row = (start + ((sector + a) & (_AZIMUTHS - 1))) * (_BINS + 1) + first
        rows[:, 2 * a], rows[:, 2 * a + 1] = row, row + 1
    height = np.arccos(np.clip(z / pairs.distance, -1, 1)) * (_ELEVATIONS / np.pi) - 0.5
    depth = pairs.distance * _SHELLS - 0.5
    nodes = np.empty((len(i), _ELEVATIONS * _SHELLS), dtype=weight.dtype)
    inward = [(1 - np.abs(depth - d)).clip(0, np.inf) for d in range(_SHELLS)]
    for e in range(_ELEVATIONS):
        across = (1 - np.abs(height - e)).clip(0, np.inf) * weight
        for d in range(_SHELLS):
            nodes[:, e * _SHELLS + d] = across * inward[d]
    starts = np.arange(0, 4 * len(i) + 1, 4, dtype=np.int32)
    spread = csc_array((parts.ravel(), rows.ravel(), starts), shape=(count * _AZIMUTHS * (_BINS + 1), len(i)))
    summed = (spread @ nodes).reshape(count, _AZIMUTHS, _BINS + 1, _ELEVATIONS * _SHELLS)
    return summed.transpose(0, 1, 3, 2).reshape(count, _VOLUMES * (_BINS + 1))
