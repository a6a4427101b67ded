"""The groups of fields of a match: score, registration, part, fit and files."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from kfmaps.fmap.solvers import Solution
from kfmaps.registration.accept import RegistrationReport

_UNKNOWN: Any = None
"""Value of a field that a loaded map lacks."""
ONE_FIT = "one fit"
"""``score.initialization`` of a map that was fitted once, without a search."""


@dataclass(frozen=True, eq=False)
class MatchScore:
    """How a search judged its map.

    Attributes
    ----------
    scores : tuple of float
        Of the map and of each alternative; higher is better. Empty without a search.
    quality : float or None
        Score of the map by itself, 0 at best (:attr:`kfmaps.matching.score.Quality.score`).
    deformation_energy : float or None
        How far the shapes must deform to follow the map; 0 for a rigid motion
        (:func:`kfmaps.registration.deformation_energy.deformation_energy`).
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
    overlap_source, overlap_target : (n_s,), (n_t,) float64 or None
        Probability of each vertex to be in the part that both shapes have; ``None`` where both were taken for whole.
    """

    which: str = "none"
    reason: str = ""
    scale: float | None = None
    overlap_source: np.ndarray | None = None
    overlap_target: np.ndarray | None = None


@dataclass(frozen=True, eq=False)
class MatchFit:
    """The map before its refinement, and how it was fitted.

    Attributes
    ----------
    raw_functional_map : (k, k) float64
        What the refinement started from: the minimiser of one fit, or the best candidate of a search.
    raw_target_to_source : (n_t,) int64 or None
        Its point map; a search does not compute it.
    solution : Solution or None
        Status, steps and residuals of the solver. ``None``, as the rest of the record is empty, after a search.
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
    solution: Solution | None = None
    energies: dict[str, float] = field(default_factory=dict)
    kernel: str = ""
    rank: int | None = None
    n_operators: int | None = None
    weights: np.ndarray | None = None

    @property
    def relative_residuals(self) -> np.ndarray:
        """The solver's residuals divided by the first, (steps + 1,); empty without a solver."""
        residuals = np.zeros(0) if self.solution is None else np.asarray(self.solution.residuals, dtype=np.float64)
        return residuals / (residuals[0] if len(residuals) and residuals[0] > 0 else 1.0)


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
