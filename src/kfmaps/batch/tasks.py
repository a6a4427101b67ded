"""What a worker is told: one shape to prepare, or one pair to match. Small, and the same on every machine."""

from __future__ import annotations

from dataclasses import dataclass

from kfmaps.batch.layout import Pair
from kfmaps.config import Config


@dataclass(frozen=True)
class ShapeTask:
    """One shape to prepare.

    Attributes
    ----------
    name : str
    path : str
        The mesh.
    content : str
        Digest of that file when the run began.
    entry : str
        Where in the cache the prepared shape lies or will lie.
    folder : str
        The output folder.
    config : Config
    """

    name: str
    path: str
    content: str
    entry: str
    folder: str
    config: Config


@dataclass(frozen=True)
class Prepared:
    """What came of a :class:`ShapeTask`.

    Attributes
    ----------
    name : str
    seconds : float
        What it took; 0 when it was in the cache.
    reason : str
        Why it failed; empty when it did not.
    notes : tuple of str
        Warnings about the mesh.
    """

    name: str
    seconds: float = 0.0
    reason: str = ""
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class PairTask:
    """One pair to match.

    Attributes
    ----------
    pair : Pair
    folder : str
        The output folder.
    source, target : ShapeTask
    settings, inputs : str
        Digests, see :class:`~kfmaps.batch.results.Result`.
    config : Config
    seed : int
    truth : pair of paths, or None
        Vertex lists of source and target.
    mirrored : path or None
        Vertex list of the target, left and right swapped.
    truth_map : path or None
        Truth of this pair alone, see :class:`~kfmaps.batch.layout.ShapeFolder`.
    identity : bool
        Whether vertex i is vertex i.
    landmarks : pair of paths, or None
        Vertex lists of source and target.
    landmark_lines : tuple of int
        Lines of the truth, counted from 1, that serve as landmarks.
    """

    pair: Pair
    folder: str
    source: ShapeTask
    target: ShapeTask
    settings: str
    inputs: str
    config: Config
    seed: int = 0
    truth: tuple[str, str] | None = None
    mirrored: str | None = None
    truth_map: str | None = None
    identity: bool = False
    landmarks: tuple[str, str] | None = None
    landmark_lines: tuple[int, ...] = ()
