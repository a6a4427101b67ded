"""The groups of fields of a match: score, registration, part, fit and files."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from kfmaps._records import short_repr
from kfmaps.geometry.mesh import Mesh
from kfmaps.registration.accept import RegistrationReport

_UNKNOWN: Any = None
"""Value of a field that only a loaded match lacks; of open type, so that a fresh one needs no checks."""
ONE_FIT = "one fit"
"""``score.initialization`` of a map that was fitted once, without a search."""


@dataclass(frozen=True, eq=False)
class MatchScore:
    """How a search scored its map.

    Attributes
    ----------
    scores : tuple of float
        Of the map and of each alternative; higher is better. Empty without a search.
    quality : float or None
        Score of the map by itself, 0 at best (:attr:`kfmaps.matching.score.Quality.score`).
    deformation_energy : float or None
        How far the shapes must deform to follow the map; 0 for a rigid motion
        (:class:`kfmaps.registration.evidence.DeformationEnergy`).
    initialization : str
        What the map started from: "one fit", or the name of a candidate of the search.
    rejected_landmarks : (d,) int64
        Numbers, from 0, of the landmarks that the map contradicts. They were left out.
    """

    scores: tuple[float, ...] = ()
    quality: float | None = None
    deformation_energy: float | None = None
    initialization: str = ""
    rejected_landmarks: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class MatchRegistration:
    """What the non-rigid registration of the source onto the target gave.

    Attributes
    ----------
    registered_vertices : (n_s, 3) float64 or None
        The source's vertices on the target, scaled and centred as by :func:`kfmaps.geometry.mesh.unit_area`; ``None``
        where no registration was accepted.
    report : RegistrationReport or None
        Its evidence, and why it was accepted or not; ``None`` where none was made.
    """

    registered_vertices: np.ndarray | None = None
    report: RegistrationReport | None = None

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class MatchPart:
    """Which shape is a part of the other.

    Attributes
    ----------
    which : "none", "source", "target" or "both"
        The shape that was taken for a part.
    reason : str
        Why, in words; empty where nobody asked.
    scale : float or None
        √area of the part over that of the whole, as found.
    suspected : bool
        Whether a part was looked for; with ``which`` of "none" both shapes were taken for whole in the end.
    overlap_source, overlap_target : (n_s,), (n_t,) float64 or None
        Probability of each vertex to be in the part that both shapes have; ``None`` where both were taken for whole.
    """

    which: str = "none"
    reason: str = ""
    scale: float | None = None
    suspected: bool = False
    overlap_source: np.ndarray | None = None
    overlap_target: np.ndarray | None = None

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class MatchFit:
    """The map before its refinement, and the kernel fit that it came from.

    A search compares candidates of several kinds. Where its map began with the signs of eigenfunctions or with matched
    extremities, as of most near-isometric pairs, no kernel fit was made of it: the fields from ``size`` on are empty.
    :meth:`Match.energies` evaluates the energy at any map.

    Attributes
    ----------
    raw_functional_map : (k, k) float64
        What the refinement started from: the minimiser of one fit, or the best candidate of a search. ``None`` of a
        part, and where a file does not hold it. A search takes functions of the divided mesh where one has fewer than
        1,000 vertices.
    raw_target_to_source : (n_t,) int64 or None
        Its point map; a search does not compute it.
    size : int or None
        Number of eigenfunctions that the fit was made with. A search fits less than ``raw_functional_map`` has.
    status : str or None
        "converged", "step limit" or "breakdown".
    steps : int or None
        Steps of the solver.
    residuals : float64 array
        Residual before the first step and after each, divided by the first; empty where none is known.
    energies : dict of str to float
        Weighted value of each term at the minimiser.
    kernel : str
        The kernel with its widths.
    rank : int or None
        Number of kernel features.
    n_operators : int or None
        Number of multiplication operators after compression.
    weights : (g,) float64 or None
        Trust in each landmark or descriptor, 0 to 1, under a robust loss.
    """

    raw_functional_map: np.ndarray = _UNKNOWN
    raw_target_to_source: np.ndarray | None = None
    size: int | None = None
    status: str | None = None
    steps: int | None = None
    residuals: np.ndarray = field(default_factory=lambda: np.zeros(0))
    energies: dict[str, float] = field(default_factory=dict)
    kernel: str = ""
    rank: int | None = None
    n_operators: int | None = None
    weights: np.ndarray | None = None

    __repr__ = short_repr


@dataclass(frozen=True)
class ShapeFile:
    """The file of a shape, as far as it is known.

    Attributes
    ----------
    path : str
        Empty where the shape came from no file.
    sha256 : str
        Of the file, in hexadecimal digits.
    n_vertices, n_faces : int or None
    """

    path: str = ""
    sha256: str = ""
    n_vertices: int | None = None
    n_faces: int | None = None

    @classmethod
    def of(cls, mesh: Mesh, path: str = "", sha256: str = "") -> ShapeFile:
        """Return the record of a mesh that was read from ``path``, a file with this ``sha256``."""
        return cls(path, sha256, len(mesh.vertices), len(mesh.faces))
