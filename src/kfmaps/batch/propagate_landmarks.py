"""Carry the landmarks of one specimen to all specimens of a run, along the most probable paths of its maps."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.batch.consistent import CONSISTENT, map_in_use, replacement_result
from kfmaps.batch.layout import Pair
from kfmaps.batch.results import Result, all_results, read_result, write_rows
from kfmaps.batch.run_spec import read_run_spec
from kfmaps.collection.paths import MapPath, adjacency, best_paths
from kfmaps.fmap.precise import vertex_point_map
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import check_map, check_output, load_map, read_mesh
from kfmaps.io.landmark_files import LandmarkSet, mesh_space, write_landmark_sets
from kfmaps.io.named_points import NamedPoints, read_named_points, transfer_points
from kfmaps.io.partial_map import find_counterparts, precise_points
from kfmaps.matching.result import Match

_UNKNOWN = 0.5
"""Probability of a map of which nothing is known."""
MIN_PROBABILITY = 0.5
"""Probability of the weakest map on the path below which a specimen fits none of the others."""
_PAIRS = "pairs.csv"


@dataclass(frozen=True, eq=False)
class PropagatedLandmarks:
    """The landmarks on one specimen.

    Attributes
    ----------
    specimen : str
    points : NamedPoints
    through : tuple of str
        The specimens between it and that with the landmarks.
    weakest : float
        The lowest probability of a map on the path.
    """

    specimen: str
    points: NamedPoints
    through: tuple[str, ...]
    weakest: float = 1.0


@dataclass(frozen=True)
class _Edge:
    pair: Pair
    path: Path
    chance: float


def propagate_landmarks(
    folder: Path, landmarks: Path, on: str | None = None
) -> tuple[list[PropagatedLandmarks], list[str]]:
    """The points of a file (:func:`~kfmaps.io.named_points.read_named_points`) on every specimen of a run.

    Each map on the way carries them once: from the specimen with the landmarks along the paths whose maps are most
    probably all right. The confidence of a point is that of the way times, at each step, how well distances around it
    are kept. Maps of parts are gone round, but to specimens that nothing else leads to; of the points that have no
    counterpart there vertex and face are −1, place and confidence NaN, and so they are on all that lies behind.

    Parameters
    ----------
    folder : Path
        Output of ``kfmaps batch``; replaced maps are used.
    on : str, optional
        The specimen that the landmarks are on; where all maps start from one, that.

    Returns
    -------
    list of PropagatedLandmarks
        The specimen with the landmarks first, then in the order of how sure the ways are.
    list of str
        Specimens that no map leads to.

    Raises
    ------
    InvalidInput
        When there are no maps, or they and their meshes do not fit each other any more.
    """
    edges = _edges(folder)
    names = sorted({name for e in edges for name in (e.pair.source, e.pair.target)})
    if not names:
        raise refuse(f"collection {folder}", "maps of kfmaps batch", "none", "see why its pairs failed")
    start = _start(names, edges, on)
    number = {name: i for i, name in enumerate(names)}
    ends = [(number[e.pair.source], number[e.pair.target]) for e in edges]
    meshes: dict[str, Mesh] = {}
    found: dict[int, PropagatedLandmarks] = {}
    for at, way in _ways(len(names), ends, edges, number[start]).items():
        if not way.edges:
            mesh = _mesh(start, edges, meshes)
            points = read_named_points(landmarks, mesh, specimen=start, space=mesh_space(_mesh_file(start, edges)))
            found[at] = PropagatedLandmarks(start, replace(points, confidence=np.ones(len(points.names))), ())
            continue
        edge, before = edges[way.edges[-1]], found[way.shapes[-2]]
        sides = (_mesh(name, edges, meshes) for name in (edge.pair.source, edge.pair.target))
        back = ends[way.edges[-1]][1] == way.shapes[-2]
        known = load_map(edge.path)
        points = carry_points(known, before.points, *sides, name=str(edge.path), back=back, chance=edge.chance)
        through = (*before.through, before.specimen) if before.specimen != start else ()
        found[at] = PropagatedLandmarks(names[at], points, through, min(before.weakest, edge.chance))
    return list(found.values()), [name for name in names if number[name] not in found]


def _ways(count: int, ends: Sequence[tuple[int, int]], edges: Sequence[_Edge], start: int) -> dict[int, MapPath]:
    """The best ways over whole maps, and over maps of parts to the specimens that nothing else leads to.

    A part has no counterpart for every landmark. Each way's last step begins where another way ends.
    """
    around, own = adjacency(count, ends), [e.chance for e in edges]
    chances = list(own)
    while True:
        ways = best_paths(around, chances, start)
        used = dict.fromkeys(link for way in ways.values() for link in way.edges)
        parts = [link for link in used if (load_map(edges[link].path).target_to_source < 0).any()]
        if not parts:
            break
        for link in parts:
            chances[link] = 0.0
    further = {} if len(ways) == count else best_paths(around, own, start)
    return ways | {at: way for at, way in further.items() if at not in ways}


def carry_points(
    known: Match,
    points: NamedPoints,
    source: Mesh,
    target: Mesh,
    *,
    name: str,
    back: bool = False,
    chance: float = 1.0,
) -> NamedPoints:
    """Return points carried over a map; those lost on the way stay lost.

    Parameters
    ----------
    known : Match
        The map from ``source`` to ``target``.
    points : NamedPoints
        On the source, or (``back``) on the target.
    name : str
        How messages call the map.
    chance : float
        Probability that the map is right. The confidence of a point is multiplied by it and by how well the map keeps
        distances around the point.

    Raises
    ------
    InvalidInput
        When the map does not fit the meshes.
    """
    ways = find_counterparts(known, source, target, name) if (known.target_to_source < 0).any() else None
    if ways is None:
        check_map(known, len(source.vertices), len(target.vertices), name)
        place, some = precise_points(known, source) or vertex_point_map(known.target_to_source, source), {}
    else:
        place, some = ways.place, {"known": ways.target, "common": ways.source}
    trust = getattr(known, "local_confidence", None)
    local = np.ones(len(target.vertices)) if trust is None else np.nan_to_num(np.asarray(trust))
    carried = transfer_points(points, source, target, place, local, back=back, **some)
    return replace(carried, confidence=carried.confidence * points.confidence * chance)


def _edges(folder: Path) -> list[_Edge]:
    """The maps of a run with their probabilities."""
    settings = read_run_spec(folder)
    agreed = _agreed(folder)
    edges = []
    for result in all_results(folder, str(settings["digest"])):
        pair = Pair(result.source, result.target)
        path = map_in_use(folder, pair.key)
        if result.status != "done" or not path.exists():
            continue
        other = read_result(replacement_result(folder, pair.key))
        used = other if other is not None and other.status == "done" else result
        edges.append(_Edge(pair, path, _chance(used, agreed.get((pair.source, pair.target)))))
    return edges


def _chance(result: Result, agreed: float | None) -> float:
    """What is known of a map, best first: agreement with others, the search's confidence, distances kept."""
    for value in (result.agreement, agreed, result.confidence, result.local_confidence):
        if value is not None:
            return float(np.clip(value, 1e-3, 1.0))
    return _UNKNOWN


def _agreed(folder: Path) -> dict[tuple[str, str], float]:
    try:
        with open(folder / CONSISTENT / _PAIRS, encoding="utf-8", newline="") as file:
            return {(row["source"], row["target"]): float(row["probability"]) for row in csv.DictReader(file)}
    except (OSError, ValueError, KeyError):
        return {}


def _start(names: Sequence[str], edges: Sequence[_Edge], on: str | None) -> str:
    if on is not None:
        for name in (on, Path(on).stem):
            if name in names:
                return name
        raise refuse("--on", f"a specimen ({', '.join(names[:5])}, ...)", repr(on), "check the spelling")
    sources = {e.pair.source for e in edges}
    if len(sources) == 1:
        return sources.pop()
    raise refuse("--on", "the specimen that the landmarks are on", "none", f"name one of {', '.join(names[:5])}, ...")


def _mesh(name: str, edges: Sequence[_Edge], known: dict[str, Mesh]) -> Mesh:
    """The mesh of a specimen, from where its maps say that it lies."""
    if name not in known:
        path = _mesh_file(name, edges)
        mesh = read_mesh(path)
        if len(mesh.faces) == 0:
            raise refuse(
                str(path),
                "a surface with faces",
                "a point cloud",
                "carry landmarks between surfaces",
            )
        known[name] = mesh
    return known[name]


def _mesh_file(name: str, edges: Sequence[_Edge]) -> Path:
    edge = next(e for e in edges if name in (e.pair.source, e.pair.target))
    side = "source" if edge.pair.source == name else "target"
    path = getattr(load_map(edge.path), f"{side}_file").path
    if not path or not Path(path).exists():
        expected = f"its {side} at the path that it names"
        raise refuse(str(edge.path), expected, f"no file {path}", "put the mesh back, or match again")
    return Path(path)


def write_propagated(path: Path, propagated: Sequence[PropagatedLandmarks], force: bool = False) -> None:
    """Write the landmarks of all specimens.

    As ``.csv`` a row a landmark and specimen: where it is in the specimen's own unit, on which triangle, how sure it
    is. Of one without a counterpart vertex and face are −1, and the other cells are empty. As ``.tps`` as
    :func:`~kfmaps.io.landmark_files.write_landmark_sets` does.

    Parameters
    ----------
    path : Path
    propagated : sequence of PropagatedLandmarks
    force : bool
        Whether an existing file may be replaced.
    """
    if path.suffix.lower() != ".csv":
        sets = [LandmarkSet(one.points.names, one.points.points, one.specimen) for one in propagated]
        write_landmark_sets(path, sets, force)
        return
    check_output(path, force)
    titles = ["name", "specimen", "x", "y", "z", "vertex", "face", "weight_1", "weight_2", "weight_3"]
    rows: list[list[object]] = [[*titles, "confidence", "through"]]
    for one in propagated:
        p = one.points
        for i, name in enumerate(p.names):
            place: list[str] = [repr(x) for x in p.points[i].tolist()]
            weights, confidence = [f"{w:.9g}" for w in p.place.weights[i].tolist()], f"{p.confidence[i]:.4f}"
            if p.vertices[i] < 0:
                place, weights, confidence = [""] * 3, [""] * 3, ""
            at = [int(p.vertices[i]), int(p.place.faces[i])]
            rows.append([name, one.specimen, *place, *at, *weights, confidence, " ".join(one.through)])
    write_rows(path, rows, force)
