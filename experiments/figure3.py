"""Figure 3: relative error of the Nyström approximation against its rank, for several ways to choose samples."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import style
from data_sets import DataSet
from experiment import Options, Result, main
from kernel_matrix import GAMMAS, best_errors, gaussian_matrix, kernel_spectra, nystrom_error, samples, signature

RANKS = (10, 25, 50, 100, 150, 200, 300, 400)
SEEDS = (0, 1, 2)
BOUND = "spectral bound"
METHODS = tuple(method for method in style.SAMPLINGS if method != BOUND)
PAPER = {0.01: 5.8e-11, 0.1: 5.1e-8, 1.0: 6.9e-5, 10.0: 0.051}
"""Errors of descriptor farthest-point sampling at :data:`PAPER_RANK` in the paper's section 7.1, by γ."""

PAPER_RANK = 400


def figure3(options: Options) -> Result:
    """Six ways to choose samples and the best possible approximation, for the four γ of figure 2."""
    ranks = tuple(rank for rank in RANKS if rank <= options.vertices // 4 or options.data is not None)
    data_set, (name, _) = options.specimen()
    every = {(gamma, method): (data_set, name, gamma, method, ranks) for gamma in GAMMAS for method in METHODS}
    errors = {key: np.asarray(values) for key, values in options.map(sampling_errors, every).items()}  # (seeds, ranks)
    for gamma, eigenvalues in kernel_spectra(options).items():
        errors[gamma, BOUND] = best_errors(eigenvalues)[list(ranks)][None, :]
    means = {key: np.exp(np.log(values).mean(axis=0)) for key, values in errors.items()}
    table = [
        {
            "gamma": gamma,
            "sampling": method,
            "rank": rank,
            "relative error": float(means[gamma, method][i]),
            "lowest": float(values[:, i].min()),
            "highest": float(values[:, i].max()),
            "seeds": len(values),
        }
        for (gamma, method), values in errors.items()
        for i, rank in enumerate(ranks)
    ]
    lines = conclusions({key: float(mean[-1]) for key, mean in means.items()}, ranks[-1])
    return Result({"figure3": table}, {"figure3": draw(errors, ranks)}, lines, [data_set])


def sampling_errors(data_set: DataSet, name: str, gamma: float, method: str, ranks: Sequence[int]) -> list[list[float]]:
    """Return the errors for each of :data:`SEEDS` and ``ranks``."""
    shape, X = signature(data_set, name)
    K = gaussian_matrix(X, gamma)
    errors = []
    # The greedy choice does not depend on a seed.
    for seed in SEEDS[:1] if method == "pivoted Cholesky" else SEEDS:
        longest = samples(method, shape.mesh, X, gamma, ranks[-1], seed)
        chosen = [samples(method, shape.mesh, X, gamma, r, seed) if method == "uniform" else longest[:r] for r in ranks]
        errors.append([nystrom_error(K, X, rows, gamma) for rows in chosen])
    return errors


def conclusions(last: dict[tuple[float, str], float], rank: int) -> list[str]:
    """Return what the errors at the largest rank say; ``last`` by γ and method."""

    def listed(values: dict[float, float], digits: int = 2) -> str:
        return ", ".join(f"{values[gamma]:.{digits}g}" for gamma in GAMMAS)

    farthest = {gamma: last[gamma, "descriptor farthest"] for gamma in GAMMAS}
    factor = max(max(farthest[gamma] / PAPER[gamma], PAPER[gamma] / farthest[gamma]) for gamma in GAMMAS)
    lines = [
        f"Descriptor farthest points at rank {rank}: {listed(farthest)} for γ = {', '.join(f'{g:g}' for g in GAMMAS)} "
        f"(paper at rank {PAPER_RANK}: {listed(PAPER)}); the largest difference from the paper is a factor of "
        f"{factor:.2g}, {'within' if factor <= 10 else 'more than'} one order of magnitude."
    ]
    for method in (method for method in METHODS if "Cholesky" in method):
        ratios = {gamma: last[gamma, method] / farthest[gamma] for gamma in GAMMAS}
        better = all(r <= 1 for r in ratios.values())
        lines.append(
            f"{method[0].upper()}{method[1:]} has {listed(ratios, 3)} times the error of descriptor farthest points: "
            + ("at least as good for all four γ." if better else "not as good for every γ.")
        )
    worst = (f"{max(METHODS, key=lambda method, g=gamma: last[g, method])} (γ = {gamma:g})" for gamma in GAMMAS)
    lines.append(f"The worst choice is {', '.join(worst)}; the paper's is uniform.")
    ratios = {gamma: last[gamma, "geodesic farthest"] / farthest[gamma] for gamma in GAMMAS}
    text = f"Geodesic farthest points have {listed(ratios)} times the error of descriptor farthest points; "
    return [*lines, text + "in the paper slightly more than 1."]


def draw(errors: dict[tuple[float, str], np.ndarray], ranks: Sequence[int]) -> Figure:
    """Draw a panel for each γ; bands span the seeds."""
    figure, axes = style.new_figure(columns=2, rows=2, height=2.9)
    for ax, gamma in zip(axes, GAMMAS, strict=True):
        for (method, color), dash in zip(style.SAMPLINGS.items(), style.DASHES, strict=True):
            values = errors[gamma, method]
            ax.fill_between(ranks, values.min(axis=0), values.max(axis=0), color=color, alpha=0.15, linewidth=0)
            middle = np.exp(np.log(values).mean(axis=0))
            ax.semilogy(ranks, middle, color=color, linestyle=dash, label=method, linewidth=1.5)
        look = {"marker": "x", "color": style.BLUE, "markersize": 8, "linestyle": "none"}
        ax.plot([PAPER_RANK], [PAPER[gamma]], label="paper, descriptor farthest", **look)
        style.labels(ax, "rank", "relative Frobenius error", f"γ = {gamma:g}")
    style.legend_below(figure, axes[0], columns=3)
    return figure


if __name__ == "__main__":
    main(figure3)
