"""Candidate maps for matching without landmarks, before anything is chosen.

Many rough maps are refined on a few hundred points: diagonal functional maps with every choice of signs of the low
functions (all symmetries of near-isometric bodies are among them, as in MapTree, Ren et al. 2020), small fits, and
random symmetries of the best of these. The best that differ are refined further and judged again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np
from scipy.linalg import expm

from kfmaps._threads import parallel
from kfmaps.config import Config
from kfmaps.fit.fit import Fit, fit
from kfmaps.fit.shape import Shape
from kfmaps.functional.guide import guide
from kfmaps.functional.points import nearest
from kfmaps.functional.refine import ZoomOut
from kfmaps.functional.solvers import CG
from kfmaps.search.quality import Probe, Quality, map_quality, thinned

WEIGHTS = (0.0, 4.0, 12.0)
"""Of the descriptors in the rough refinement: none, so that symmetric maps are found too, some, and much."""
POINTS = 400
"""Points of the rough refinement; the first of the probe."""
ROUGH = ZoomOut(start=6, stop=40, step=4)
FINE = ZoomOut(start=20, stop=80, step=5, guidance=12.0)
"""The refinement of the best, on all points of the probe; from fewer functions it loses right maps."""
STARTS = (6, 10, 20)
"""Where the rough refinement of a fit starts. From few functions it repairs maps that are wrong in part, also of
shapes that are far from isometric; from many it keeps what is right."""
KICKS = 6
"""Maps that start from a random symmetry of the low functions."""
FINALISTS = 10
"""Distinct rough maps that are refined further."""
ZERO = 0.03
"""Frequency, the root of an eigenvalue at unit area, below which there is no wave: a sphere's first is 5."""
APART = 0.04
"""Mean distance, in units of √area, from which rough maps count as different: nearer than in the end."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """One refined map on the samples.

    Attributes
    ----------
    name : str
        Where it came from.
    functional_map : (k, k) float64
    points : (q_t,) int64
        A source sample for each target sample.
    quality : Quality
    fitted : Fit or None
        The fit that it was refined from, if any.
    guided : bool
        Whether descriptors had a say; a map that none speak for is only a rival.
    """

    name: str
    functional_map: np.ndarray
    points: np.ndarray
    quality: Quality
    fitted: Fit | None
    guided: bool = True

    @property
    def score(self) -> float:
        """Of the quality, in steps so small that only what is equal but for rounding becomes equal."""
        return round(self.quality.score, 9)


Report = Callable[[float], None]


def candidates(
    source: Shape,
    target: Shape,
    config: Config,
    probes: tuple[Probe, Probe],
    seed: int,
    *,
    descriptors: tuple[Any, Any] | None = None,
    report: Report | None = None,
) -> list[Candidate]:
    """Refined candidates, in no order."""
    assert config.search is not None
    small = thinned(probes[0], POINTS), thinned(probes[1], POINTS)
    surfaces = bool(len(source.mesh.faces) and len(target.mesh.faces))
    guides = tuple(guide(a.descriptors, b.descriptors) for a, b in (probes, small))
    rough_weights = WEIGHTS if guides[1] is not None else WEIGHTS[:1]
    functions = min(len(source.basis.eigenvalues), len(target.basis.eigenvalues))
    done: list[int] = []
    settings = variants(config, surfaces)

    def rough(name: str, C: np.ndarray, start: int, weight: float, fitted: Fit | None = None) -> Candidate:
        zoom = replace(ROUGH, start=min(start, functions), stop=min(ROUGH.stop, functions), guidance=weight)
        refined = zoom(C, small[0].samples.basis, small[1].samples.basis, threads=1, guide=guides[1])
        return judged(name, refined.functional_map, small, fitted, weight)

    def signed(weight: float, signs: tuple[int, ...]) -> list[Candidate]:
        mark = "".join("+" if sign > 0 else "-" for sign in signs)
        return tell([rough(f"signs {mark}, weight {weight:g}", np.diag([1.0, *signs]), len(signs) + 1, weight)])

    def fitting(name: str, chosen: Config) -> list[Candidate]:
        found = fit(source, target, chosen, descriptors=descriptors, rng=seed)
        C = found.functional_map
        starts = [(start, weight) for start in STARTS for weight in rough_weights[1:] or rough_weights]
        return tell([rough(f"{name}, from {start}, weight {w:g}", C, start, w, found) for start, w in starts], 8)

    def kick(best: Candidate, i: int) -> list[Candidate]:
        C = kicked(best.functional_map, source.basis.eigenvalues, np.random.default_rng(seed + i))
        return tell([rough(f"kicked {i}", C, ROUGH.start, 0.0)])

    def finish(candidate: Candidate) -> list[Candidate]:
        """A rival is refined both with the descriptors and without."""
        found = []
        weights = {FINE.guidance if guides[0] else 0.0, FINE.guidance if candidate.guided else 0.0}
        for guidance in sorted(weights):
            zoom = replace(FINE, start=min(FINE.start, functions), stop=min(FINE.stop, functions), guidance=guidance)
            bases = probes[0].samples.basis, probes[1].samples.basis
            refined = zoom(candidate.functional_map, *bases, threads=1, guide=guides[0])
            found.append(judged(candidate.name, refined.functional_map, probes, candidate.fitted, guidance))
        return tell(found, 5)

    low = min(config.search.signs, functions - 1)
    tries = () if low == 0 else tuple(product((1, -1), repeat=low))
    expected = 8 * len(settings) + len(rough_weights) * len(tries) + KICKS + 5 * FINALISTS

    def tell(found: list[Candidate], cost: int = 1) -> list[Candidate]:
        done.append(cost)
        if report is not None:
            report(min(sum(done) / expected, 1.0))
        return found

    jobs = [partial(fitting, *chosen) for chosen in settings]
    jobs += [partial(signed, weight, signs) for weight in rough_weights for signs in tries]
    found = _run(jobs, config.threads)
    best = max(found, key=lambda c: c.score)
    found += _run([partial(kick, best, i) for i in range(KICKS)], config.threads)
    chosen = apart(sorted(found, key=lambda c: c.score, reverse=True), small[0], APART)[:FINALISTS]
    return _run([partial(finish, c) for c in chosen], config.threads)


def judged(
    name: str, C: np.ndarray, probes: tuple[Probe, Probe], fitted: Fit | None = None, weight: float = 1.0
) -> Candidate:
    """A candidate with its point map on the samples and its quality."""
    k_t, k_s = C.shape
    images = probes[0].samples.basis.functions[:, :k_s] @ C.T
    points = nearest(probes[1].samples.basis.functions[:, :k_t], images, threads=1)
    return Candidate(name, C, points, map_quality(C, *probes, points), fitted, bool(weight) or fitted is not None)


def apart(order: list[Candidate], source: Probe, distance: float) -> list[Candidate]:
    """The first of ``order``, then the first of those that are ``distance`` from it on average, and so on."""
    kept: list[Candidate] = []
    for candidate in order:
        if all(differs(candidate, other, source) > distance for other in kept):
            kept.append(candidate)
    return kept


def differs(a: Candidate, b: Candidate, source: Probe) -> float:
    """Mean distance between the images of the target's samples, in units of √area."""
    return float(np.linalg.norm(source.positions[a.points] - source.positions[b.points], axis=1).mean())


def variants(config: Config, surfaces: bool = True) -> list[tuple[str, Config]]:
    """Names and configurations of the candidate fits: small, quick, and different from each other.

    Descriptors (SHOT alone or with the wave kernel signature), basis size, and weight of orientation; in the order
    of how often each was right on the shapes that they were chosen on. Point clouds (not ``surfaces``) have neither
    SHOT nor orientation.
    """
    assert config.search is not None
    base = replace(
        config,
        search=None,
        refinement=None,
        nystrom=replace(config.nystrom, samples=min(200, config.nystrom.samples)),
        compression=max(config.compression, 1e-3),
        solver=CG(rtol=1e-5, max_steps=300),
        device="cpu",
        threads=1,
    )
    both = replace(config.descriptors, count=30)
    alone = replace(both, signature="none", landmark_map="none")
    families = {"SHOT": alone, "SHOT and waves": both}
    if not (both.shot and surfaces):
        families = {"waves": replace(both, shot=False)}
    sizes = [min(k, config.basis.functions) for k in (20, 35, 50)]
    found = [
        (
            f"{name}, {k} functions, orientation {weight:g}",
            replace(
                base,
                basis=replace(config.basis, functions=k),
                descriptors=chosen,
                weights=replace(config.weights, orientation=weight),
            ),
        )
        for k, weight in zip(
            (sizes[0], sizes[2], sizes[0], sizes[1], sizes[2], sizes[1]),
            (0.1, 0.1, 1.0, 0.1, 1.0, 1.0) if surfaces else (0.0,) * 3,
            strict=False,
        )
        for name, chosen in families.items()
    ]
    return found[: config.search.candidates]


def kicked(C: np.ndarray, eigenvalues: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """``C`` after a random rotation of the source's low functions that mixes mostly those of like frequency.

    Of a shape with a continuous symmetry, whose eigenvalues come in pairs, that is about a random symmetry; of any
    other it is a bad start, from which the refinement returns to the same map or strays to a worse one.
    """
    k = min(20, *C.shape)
    values = np.sqrt(np.maximum(eigenvalues[:k], 0.0))
    # Constants of many components have eigenvalues of rounding size: all are alike.
    width = 0.02 * max(float(values[-1]), ZERO)
    alike = np.exp(-(((values[:, None] - values[None, :]) / width) ** 2))
    generator = rng.normal(size=(k, k)) * alike * np.pi
    rotation = expm((generator - generator.T) / 2)
    # A simple eigenvalue leaves no rotation, only the choice of sign, which a kick may flip too.
    signs = np.where(rng.random(k) < 0.25, -1.0, 1.0)
    signs[0] = 1.0
    return C[:k, :k] @ (rotation * signs[None, :])


def _run(jobs: list[Callable[[], list[Candidate]]], threads: int | None) -> list[Candidate]:
    return [c for several in parallel(lambda run: run(), jobs, threads) for c in several]
