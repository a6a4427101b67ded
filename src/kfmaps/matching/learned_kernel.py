"""What a learned kernel adds to a search: candidates beside all others, of which one must be clearly better to count.

A search goes as it would without: its fits, its judgement and its refinement know nothing of what was learned. Where
the kernel was learned without landmarks, maps are made with it as well: small fits, and refinements in which points are
compared in its metric instead of by principal components of SHOT. The best of these takes the place of what the search
has found only where it is another map and clearly better (:func:`kfmaps.matching.ranking.merge_alternatives`); so what
was learned on other bodies than those at hand changes no digit of a map that is right.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from kfmaps._arrays import refuse, to_numpy
from kfmaps.config import Config
from kfmaps.fmap.descriptor_guidance import descriptor_guidance
from kfmaps.kernels.kernels import KernelLike
from kfmaps.kernels.transformed import Metric, Network, descriptor_width, n_kernel_landmarks
from kfmaps.matching.candidates import by_score, distinct_maps, drawn_seed, refine_coarse, refine_finely, score_maps
from kfmaps.matching.features import pair_descriptors, sample_pair_for_fit
from kfmaps.matching.initial_maps import (
    FIT_POINTS,
    LEARNED,
    MUCH,
    STARTS,
    FitSpec,
    Start,
    fit_descriptor_set,
    sign_inits,
)
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.sample_pair import SamplePair, TwoLevelSamples, descriptor_cost
from kfmaps.matching.score import SCORE, Candidate
from kfmaps.shape import Shape


def drop_learned(config: Config) -> Config:
    """Return ``config`` without what :mod:`kfmaps.learn` learns: the search's own fits are those without it."""
    if descriptor_width(config.kernel) is None:
        return config
    usual = Config()
    asked = replace(config.formulation, mask=usual.formulation.mask, mask_power=usual.formulation.mask_power)
    return replace(
        config, kernel=usual.kernel, bandwidth_scale=usual.bandwidth_scale, weights=usual.weights, formulation=asked
    )


def learned_kernel_applies(config: Config, source: Shape, target: Shape) -> bool:
    """Return whether the kernel of ``config`` was learned from descriptors that these shapes have without landmarks."""
    if descriptor_width(config.kernel) is None:
        return False
    if n_kernel_landmarks(config.kernel):
        wanted = "a kernel learned without landmarks, or none"
        got = f"one learned with {n_kernel_landmarks(config.kernel)}"
        raise refuse("kernel of a search", wanted, got, "learn without --truth-landmarks, or set search to none")
    return not config.descriptors.shot or (source.shot is not None and target.shot is not None)


def learned_candidates(
    source: Shape, target: Shape, config: Config, samples: TwoLevelSamples, rng: int
) -> list[Candidate]:
    """Return candidates made with the kernel of ``config``, refined and judged as all others are.

    ``rng`` as in :func:`kfmaps.matching.candidates.candidates`. Where the kernel was learned for other descriptors
    there are none.
    """
    assert config.search is not None
    rows = _transformed_descriptors(source, target, config, samples.whole.source, samples.whole.target)
    if rows is None:
        return []
    few, whole = (_in_metric(pair, *rows) for pair in (samples.few, samples.whole))
    functions = min(len(source.basis.eigenvalues), len(target.basis.eigenvalues))
    starts = [s for s in sign_inits(min(config.search.n_sign_functions, functions - 1), few) if s.weights[0] == MUCH[0]]
    none = np.zeros((0, 2), dtype=np.int64)
    points = sample_pair_for_fit(source, target, FIT_POINTS, none, None, rng)
    operators = samples.whole.source.orientation, samples.whole.target.orientation
    fits = [FitSpec(LEARNED, min(k, config.basis.n_eigenfunctions), 0.1) for k in (20, 50)]
    made = fit_descriptor_set(fits, points, config, operators, drawn_seed(rng))
    starts += [
        Start(f"{spec.name}, from {start}", fit.functional_map, start, MUCH, True, fit=fit)
        for spec, fit in zip(fits, made, strict=True)
        for start in STARTS
    ]
    found = by_score(refine_coarse(starts, few, functions, config.threads))
    chosen = distinct_maps(found, few.source, SCORE.rough_distance, 4)
    refined = refine_finely(chosen, whole, functions, MUCH, (), config.threads)
    names = [(c.name if c.name.startswith(LEARNED) else f"{LEARNED}, {c.name}", True) for c in chosen]
    return score_maps(names, *refined, samples.whole, config.threads, [c.fit for c in chosen])


def _transformed_descriptors(
    source: Shape, target: Shape, config: Config, probe_s: ShapeSamples, probe_t: ShapeSamples
) -> tuple[np.ndarray, np.ndarray] | None:
    """Transformed descriptors ``(q_s, r)``, ``(q_t, r)`` at the samples; ``None`` where the kernel is for others."""
    bases = probe_s.samples.basis, probe_t.samples.basis
    at = [
        replace(shape, basis=basis, shot=sampled.descriptors)
        for shape, basis, sampled in zip((source, target), bases, (probe_s, probe_t), strict=True)
    ]
    used = pair_descriptors(at[0], at[1], bases, config.descriptors, np.zeros((0, 2), dtype=np.int64), None)
    if descriptor_width(config.kernel) != used.source.shape[1]:
        return None
    return _transform_rows(config.kernel, to_numpy(used.source)), _transform_rows(config.kernel, to_numpy(used.target))


def _transform_rows(kernel: KernelLike, rows: np.ndarray) -> np.ndarray:
    """``rows (n, d)`` as the innermost kernel sees them."""
    if isinstance(kernel, Metric | Network):
        return _transform_rows(kernel.kernel, np.asarray(kernel.transform(rows)))
    return rows


def _in_metric(samples: SamplePair, source: np.ndarray, target: np.ndarray) -> SamplePair:
    """The pair with points compared in the learned metric; rows of more samples than it has are left out."""
    rows = source[: len(samples.source.positions)], target[: len(samples.target.positions)]
    return replace(
        samples, descriptor_cost=None if (found := descriptor_guidance(*rows)) is None else descriptor_cost(found)
    )
