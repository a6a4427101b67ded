"""Figure 3: relative error of the Nyström approximation against its rank, for several ways to choose samples."""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import style
from figure2 import kernel_spectra
from kernel_matrix import (
    GAMMAS,
    best_errors,
    gaussian_matrix,
    nystrom_error,
    samples,
    specimen_signature,
)
from options import Setting
from outputs import Outcome, write_conclusions, write_pictures, write_table
from store import Job

RANKS = (10, 25, 50, 100, 150, 200, 300, 400)
SEEDS = (0, 1, 2)
BOUND = "spectral bound"
WAYS = tuple(way for way in style.SAMPLINGS if way != BOUND)
PAPER = {0.01: 5.8e-11, 0.1: 5.1e-8, 1.0: 6.9e-5, 10.0: 0.051}
"""Errors of descriptor farthest-point sampling at :data:`PAPER_RANK` in the paper's section 7.1, by γ."""

PAPER_RANK = 400


def figure3(setting: Setting) -> Outcome:
    """Six ways to choose samples and the best possible, for the four γ of figure 2."""
    ranks = tuple(rank for rank in RANKS if rank <= setting.vertices // 4 or setting.data is not None)
    spectra = kernel_spectra(setting)
    keys = {
        (gamma, way): f"nystrom {setting.specimen_key()} {gamma:g} {way} {ranks}" for gamma in GAMMAS for way in WAYS
    }
    jobs = [Job((key,), sampling_errors, (setting, *which, ranks)) for which, key in keys.items()]
    found = setting.run(jobs)
    errors = {which: np.asarray(found[key]) for which, key in keys.items()}  # (seeds, ranks)
    for gamma, values in spectra.items():
        errors[gamma, BOUND] = best_errors(values)[list(ranks)][None, :]
    table = [
        {
            "gamma": gamma,
            "sampling": way,
            "rank": rank,
            "relative error": float(np.exp(np.log(values[:, i]).mean())),
            "lowest": float(values[:, i].min()),
            "highest": float(values[:, i].max()),
            "seeds": len(values),
        }
        for (gamma, way), values in errors.items()
        for i, rank in enumerate(ranks)
    ]
    lines = conclusions({which: float(np.exp(np.log(v[:, -1]).mean())) for which, v in errors.items()}, ranks[-1])
    folder = setting.folder
    return Outcome(
        "figure3",
        (write_table(folder / "figure3.csv", table),),
        write_pictures(folder, "figure3", draw(errors, ranks)),
        write_conclusions(folder, "figure3", setting.collections()[:1], lines),
        tuple(lines),
    )


def sampling_errors(setting: Setting, gamma: float, way: str, ranks: Sequence[int]) -> list[list[list[float]]]:
    """Errors for each of :data:`SEEDS` and ``ranks``, as a job returns them."""
    shape, X = specimen_signature(setting)
    K = gaussian_matrix(X, gamma)
    # The greedy choice has nothing random in it.
    seeds = SEEDS[:1] if way == "pivoted Cholesky" else SEEDS
    found = []
    for seed in seeds:
        longest = samples(way, shape.mesh, X, gamma, ranks[-1], seed)
        chosen = [samples(way, shape.mesh, X, gamma, r, seed) if way == "uniform" else longest[:r] for r in ranks]
        found.append([nystrom_error(K, X, rows, gamma) for rows in chosen])
    return [found]


def conclusions(last: dict[tuple[float, str], float], rank: int) -> list[str]:
    """What the errors at the largest rank say; ``last`` by γ and way."""
    lines = []
    farthest = {gamma: last[gamma, "descriptor farthest"] for gamma in GAMMAS}
    where = "" if rank == PAPER_RANK else f" at rank {PAPER_RANK}"
    told = ", ".join(f"{farthest[g]:.2g} (paper{where} {PAPER[g]:.2g})" for g in GAMMAS)
    off = max(abs(np.log10(farthest[g] / PAPER[g])) for g in GAMMAS)
    lines.append(
        f"Descriptor farthest points at rank {rank}: {told} for γ = {', '.join(f'{g:g}' for g in GAMMAS)}; the largest "
        f"difference from the paper is a factor of {10**off:.2g}"
        + (", within one order of magnitude." if off <= 1 else ", more than one order of magnitude.")
    )
    for way in (way for way in WAYS if "Cholesky" in way):
        ratios = {g: last[g, way] / farthest[g] for g in GAMMAS}
        better = all(r <= 1 for r in ratios.values())
        lines.append(
            f"{way[0].upper()}{way[1:]} has "
            + ", ".join(f"{ratios[g]:.3g}" for g in GAMMAS)
            + " times the error of descriptor farthest points: "
            + ("at least as good for all four γ." if better else "not as good for every γ.")
        )
    worst = {g: max(WAYS, key=lambda way, g=g: last[g, way]) for g in GAMMAS}
    lines.append(
        "The worst choice is " + ", ".join(f"{worst[g]} (γ = {g:g})" for g in GAMMAS) + "; the paper's is uniform."
    )
    slight = {g: last[g, "geodesic farthest"] / farthest[g] for g in GAMMAS}
    lines.append(
        "Geodesic farthest points have "
        + ", ".join(f"{slight[g]:.2g}" for g in GAMMAS)
        + " times the error of descriptor farthest points; in the paper slightly more than 1."
    )
    return lines


def draw(errors: dict[tuple[float, str], np.ndarray], ranks: Sequence[int]) -> Figure:
    """A panel for each γ; bands span the seeds."""
    figure, axes = style.new_figure(columns=2, rows=2, height=2.9)
    for ax, gamma in zip(axes, GAMMAS, strict=True):
        for (way, color), dash in zip(style.SAMPLINGS.items(), style.DASHES, strict=True):
            values = errors[gamma, way]
            ax.fill_between(ranks, values.min(axis=0), values.max(axis=0), color=color, alpha=0.15, linewidth=0)
            middle = np.exp(np.log(values).mean(axis=0))
            ax.semilogy(ranks, middle, color=color, linestyle=dash, label=way, linewidth=1.5)
        if gamma in PAPER:
            ax.plot(
                [PAPER_RANK],
                [PAPER[gamma]],
                marker="x",
                color=style.BLUE,
                markersize=8,
                linestyle="none",
                label="paper, descriptor farthest",
            )
        style.labels(ax, "rank", "relative Frobenius error", f"γ = {gamma:g}")
    style.legend_below(figure, axes[0], columns=3)
    return figure


if __name__ == "__main__":
    from run import main

    main(["figure3", *sys.argv[1:]])
