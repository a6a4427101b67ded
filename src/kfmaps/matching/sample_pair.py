"""Where the candidates of one pair are made and judged: samples of both shapes, and what speaks for pairs of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from kfmaps.fmap.descriptor_guidance import Guide, guide
from kfmaps.matching.batched_zoomout import projector
from kfmaps.matching.extremity_matching import Pairing, against
from kfmaps.matching.landmark_evidence import Marks, around, side_by_side
from kfmaps.matching.quality import Probe, mirrored_probe, thinned
from kfmaps.shape import Shape

POINTS = 400
"""Points of the rough refinement; the first of the probe."""


@dataclass(frozen=True, eq=False)
class Ground:
    """Samples of both shapes and what speaks against pairs of them.

    Attributes
    ----------
    source, target : Probe
    shot : (q_t, q_s) float32 or None
        See :func:`differences`; ``None`` where SHOT says nothing.
    landmarks : (q_t, q_s) float32 or None
        The same of the functions around landmarks.
    marks : Marks or None
    solvers : dict
        What :meth:`solver` has made, to be found again.
    """

    source: Probe
    target: Probe
    shot: np.ndarray | None
    landmarks: np.ndarray | None = None
    marks: Marks | None = None
    solvers: dict[int, np.ndarray] = field(default_factory=dict)

    def solver(self, k: int) -> np.ndarray:
        """:func:`kfmaps.matching.batched_zoomout.projector` of the target, made once for all refinements."""
        if k not in self.solvers:
            self.solvers[k] = projector(self.target.samples.basis, k)
        return self.solvers[k]

    def against(
        self, shot: float, landmarks: float = 0.0, tips: float = 0.0, paired: Sequence[Pairing | None] = ()
    ) -> np.ndarray | None:
        """What speaks against pairs, with weights, for :func:`kfmaps.matching.batched_zoomout.zoomed`.

        (q_t, q_s), or (m, q_t, q_s) when the tips of m maps are ``paired`` and count.
        """
        total = None
        for weight, part in ((shot, self.shot), (landmarks, self.landmarks)):
            if part is not None and weight:
                total = np.float32(weight) * part + (0 if total is None else total)
        if tips and any(pairing is not None for pairing in paired):
            each = np.zeros((len(paired), len(self.target.positions), len(self.source.positions)), dtype=np.float32)
            if total is not None:
                each[:] = total
            for i, pairing in enumerate(paired):
                if pairing is not None:
                    each[i] += tips * against(self.source.tips, self.target.tips, pairing)
            total = each
        return total


@dataclass(frozen=True, eq=False)
class Arena:
    """Few samples for many rough maps, and all of a probe for the best."""

    few: Ground
    whole: Ground


def arena(source: Shape, target: Shape, probes: tuple[Probe, Probe], landmarks: np.ndarray | None = None) -> Arena:
    """For two prepared shapes with their ``probes``, which know of the ``landmarks (l, 2)``, if any."""
    found = None
    if landmarks is not None and len(landmarks):
        sides = list(zip((source, target), probes, landmarks.T, strict=True))
        functions = [around(p.samples.basis, shape.basis, at) for shape, p, at in sides]
        found = Marks(target.basis.functions[landmarks[:, 1]], probes[0].marks, functions[0], functions[1])
    few = thinned(probes[0], POINTS), thinned(probes[1], POINTS)
    less = found and found.thinned(*(len(p.samples.vertices) for p in few))
    return Arena(ground(*few, less), ground(*probes, found))


def ground(source: Probe, target: Probe, marks: Marks | None = None) -> Ground:
    found = guide(source.descriptors, target.descriptors)
    around = None if marks is None else differences(side_by_side(marks.functions_s, marks.functions_t))
    return Ground(source, target, None if found is None else differences(found), around, marks)


def without(on: Ground, wrong: np.ndarray) -> Ground:
    """The ground without the ``wrong (l,)`` landmarks."""
    return ground(on.source, on.target, on.marks and on.marks.without(wrong))


def turned(on: Ground) -> Ground:
    """The ground with the target's mirror image."""
    return ground(on.source, mirrored_probe(on.target), on.marks)


def differences(found: Guide) -> np.ndarray:
    """Half the squared differences ``(q_t, q_s)`` float32 of a guide, up to a constant for each target point."""
    return (0.5 * (found.source**2).sum(axis=1)[None, :] - found.target @ found.source.T).astype(np.float32)
