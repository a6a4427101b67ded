"""What a run over a collection will need: told before it begins."""

from __future__ import annotations

from dataclasses import dataclass

from kfmaps.cli.words import in_words
from kfmaps.config import Config

SHOT = 352
"""Numbers of SHOT at each vertex."""
PROBE = 6e6
"""Bytes of what a search needs to know of one shape, whatever its size."""
MAP = 230.0
"""Bytes of a map's file a target vertex, with three runners-up."""
WORKER, VERTEX = 0.22e9, 42e3
"""Bytes that a worker takes, and how many more for each vertex of a shape: 0.43 GB was measured with 5,000."""
SEARCH, FIT = 1.8e-3, 0.5e-3
"""CPU seconds of a pair a vertex, by a search or by one fit. Measured on pairs of 5,000 vertices; machines differ."""
AGREE = 0.18e-3
"""CPU seconds of a pair a vertex to make the maps agree: 180 were measured for 206 pairs of 5,000."""
LEAST = 2.0
"""CPU seconds that a search takes of shapes however small."""


@dataclass(frozen=True)
class Need:
    """What a run needs.

    Attributes
    ----------
    shapes, pairs, vertices, workers : int
    disk, memory : float
        Bytes: in the output folder, and of all workers together.
    seconds : float
        Of the whole run.
    """

    shapes: int
    pairs: int
    vertices: int
    workers: int
    disk: float
    memory: float
    seconds: float

    def told(self) -> str:
        """In one line."""
        what = f"{self.pairs} pairs of {self.shapes} shapes of about {self.vertices:,} vertices"
        needs = f"{_size(self.disk)} on disk, {_size(self.memory)} of memory and {in_words(self.seconds)}"
        return f"{what} need about {needs} with {self.workers} workers; machines differ"


def needed(shapes: int, pairs: int, vertices: int, config: Config, workers: int, *, consistent: bool = False) -> Need:
    """An estimate for ``pairs`` of ``shapes`` of about ``vertices`` vertices each; linear in all of them.

    Maps that are made to agree in the end (``consistent``) are judged by what a search would know of the shapes.
    """
    shape = 8.0 * vertices * (config.eigenfunctions + SHOT * config.descriptors.shot)
    searched = config.search is not None
    disk = shapes * (shape + PROBE * (searched or consistent)) + pairs * MAP * vertices
    each = max(SEARCH * vertices, LEAST) if searched else FIT * vertices
    each += AGREE * vertices if consistent else 0.0
    total = pairs * each + shapes * 0.6e-3 * vertices
    return Need(
        shapes,
        pairs,
        vertices,
        workers,
        disk,
        workers * (WORKER + VERTEX * vertices),
        total / max(min(workers, pairs), 1),
    )


def _size(count: float) -> str:
    return f"{count / 1e9:.1f} GB" if count >= 1e8 else f"{count / 1e6:.0f} MB"
