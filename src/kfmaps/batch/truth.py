"""True correspondences and landmarks of one pair, from the files that its task names."""

from __future__ import annotations

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.batch.tasks import PairTask
from kfmaps.cli.evaluation import Truth
from kfmaps.io import read_vertex_numbers


def true_vertices(task: PairTask, n_s: int, n_t: int) -> Truth | None:
    """What is known of the pair's true correspondence; ``n_s`` and ``n_t`` are the numbers of vertices.

    Raises
    ------
    InvalidInput
        When its files cannot be used or do not fit the shapes.
    """
    if task.identity:
        if n_s != n_t:
            raise refuse("--identity", "equally many vertices", f"{n_s} and {n_t}", "leave it out")
        return Truth(np.arange(n_s), np.arange(n_t))
    if task.truth_map is not None:
        numbers = _within(read_vertex_numbers(task.truth_map, one_based=True), n_t, task.truth_map)
        if len(numbers) != n_s:
            raise refuse(task.truth_map, f"{n_s} lines, one per source vertex", f"{len(numbers)}", "check the file")
        return Truth(np.arange(n_s), numbers)
    if task.truth is None:
        return None
    source, target = _two_lists(task.truth, n_s, n_t)
    if task.mirrored is None:
        return Truth(source, target)
    mirrored = _within(read_vertex_numbers(task.mirrored), n_t, task.mirrored)
    _same_length(task.truth[0], source, task.mirrored, mirrored)
    return Truth(source, target, mirrored)


def landmark_pairs(task: PairTask, truth: Truth | None, n_s: int, n_t: int) -> np.ndarray | None:
    """The pair's landmarks (l, 2), 0-based, or ``None``.

    Raises
    ------
    InvalidInput
        When lines of a truth are asked for that it does not have, or the landmarks' files cannot be used.
    """
    if task.landmark_lines:
        if truth is None:
            raise refuse("--truth-landmarks", "true correspondences", "none for this pair", "leave it out")
        highest = max(task.landmark_lines)
        if highest > len(truth.source):
            got = f"line {highest} of {len(truth.source)}"
            raise refuse("--truth-landmarks", "lines of the truth", got, "choose others")
        rows = np.array(task.landmark_lines) - 1
        return np.stack([truth.source[rows], truth.target[rows]], axis=1)
    if task.landmarks is not None:
        return np.stack(_two_lists(task.landmarks, n_s, n_t), axis=1)
    return None


def _two_lists(paths: tuple[str, str], n_s: int, n_t: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertex lists of source and target, of equal length."""
    a, b = (_within(read_vertex_numbers(path), n, path) for path, n in zip(paths, (n_s, n_t), strict=True))
    _same_length(paths[0], a, paths[1], b)
    return a, b


def _same_length(path_a: str, a: np.ndarray, path_b: str, b: np.ndarray) -> None:
    if len(a) != len(b):
        got = f"{len(a)} in {path_a} and {len(b)} in {path_b}"
        raise refuse("vertex lists", "equally many lines", got, "take both from one data set")


def _within(numbers: np.ndarray, n: int, path: str) -> np.ndarray:
    if numbers.max() >= n:
        remedy = "check that the file belongs to the mesh"
        raise refuse(path, f"vertices of a mesh of {n}", f"number {numbers.max()}, counted from 0", remedy)
    return numbers
