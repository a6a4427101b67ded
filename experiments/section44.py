"""Section 4.4: rank and condition number against the number of descriptors, with and without a kernel."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

import style
from data_sets import DataSet, Pair
from experiment import Options, Result, Rows, main
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.full_kernel import kernel_descriptor_term
from kfmaps.fmap.multiplication_operators import multiplication_operators, unpack_operators
from kfmaps.fmap.solvers import dense_matrix
from kfmaps.fmap.terms import descriptor_term, laplacian_term, operator_term
from kfmaps.kernels.kernels import KernelLike, Linear
from kfmaps.matching.features import kernel_features, pair_descriptors
from methods import paper
from pair_errors import prepared

COUNTS = (1, 2, 3, 5, 10, 20, 50, 100, 200)
SIZE = 100
"""Basis functions for descriptor preservation, whose system is one k × k matrix for every row of C."""

WHOLE_SIZE = 24
"""Basis functions for the whole system, which has k² unknowns."""

KERNELS = ("linear", "Gaussian")


SYSTEMS = ("F_P", "F_P + F_D", "F_P + F_D + F_Δ")


def conditioning(matrix: np.ndarray) -> tuple[int, float]:
    """Return the numerical rank and the condition number of a positive semi-definite ``matrix (k, k)``.

    The rank counts eigenvalues above ``k · eps`` times the largest, as ``numpy.linalg.matrix_rank`` does. A matrix
    without full rank has an infinite condition number.
    """
    values = np.linalg.eigvalsh((matrix + matrix.T) / 2)
    rank = int((values > len(values) * np.finfo(float).eps * values[-1]).sum())
    return rank, float(values[-1] / values[0]) if rank == len(values) else np.inf


def section44(options: Options) -> Result:
    """Rank and condition number with the linear and the Gaussian kernel, of F_P and of the whole."""
    data_set, pair = options.specimen()
    rows = options.map(systems, {count: (data_set, pair, count) for count in COUNTS})
    table = [{"descriptors": count, **row} for count, some in rows.items() for row in some]
    return Result({"section44": table}, {"section44": draw(table)}, conclusions(table), [data_set])


def systems(data_set: DataSet, pair: Pair, count: int) -> list[dict[str, Any]]:
    """Return the rows of the table for ``count`` descriptors."""
    base = paper(count)
    # The framework's list gives exactly as many as wanted; evenly spread ones give each landmark one at least.
    base = replace(base, descriptors=replace(base.descriptors, energy_sampling="every-nth"))
    source, target = (prepared(data_set, name, base.n_eigenfunctions) for name in pair)
    bases = (source.basis, target.basis)
    used = pair_descriptors(source, target, bases, base.descriptors, data_set.landmarks(pair), None)
    large, small = ((bases[0].truncate(size), bases[1].truncate(size)) for size in (SIZE, WHOLE_SIZE))
    rows = []
    for name in KERNELS:
        kernel: KernelLike = Linear() if name == "linear" else base.kernel
        features = kernel_features(source, target, used, replace(base, kernel=kernel), np.random.default_rng(0))
        operators = [
            unpack_operators(multiplication_operators(basis, F))
            for basis, F in zip(small, (features.source, features.target), strict=True)
        ]
        terms = {
            "descriptors": descriptor_term(small[0], features.source, small[1], features.target),
            "commutativity": operator_term(*operators),
            "laplacian": laplacian_term(*small),
        }
        matrices = {"F_P": kernel_descriptor_term(kernel, large[0], used.source, large[1], used.target).gram_s}
        for system, weights in zip(SYSTEMS[1:], ((1.0, 1.0, 0.0), (1.0, 1.0, 1.0)), strict=True):
            energy = Energy(terms, dict(zip(terms, weights, strict=True)))
            matrices[system] = dense_matrix(energy.apply, (WHOLE_SIZE, WHOLE_SIZE), small[0].functions)
        for system, matrix in matrices.items():
            rank, condition = conditioning(matrix)
            row = {"kernel": name, "system": system, "rank": rank, "size": len(matrix), "condition number": condition}
            rows.append(row)
    return rows


def conclusions(table: Rows) -> list[str]:
    """Return what the table says."""

    def first_full(kernel: str, system: str) -> str:
        rows = [row for row in table if (row["kernel"], row["system"]) == (kernel, system)]
        full = [row["descriptors"] for row in rows if row["rank"] == row["size"]]
        return f"from {min(full)} descriptors on" if full else f"with none of the numbers up to {COUNTS[-1]}"

    lines = []
    for system in SYSTEMS:
        by_kernel = "; ".join(f"{kernel} kernel: {first_full(kernel, system)}" for kernel in KERNELS)
        lines.append(f"{system} has full numerical rank — {by_kernel}.")
    one = {r["kernel"]: r for r in table if r["system"] == "F_P" and r["descriptors"] == 1}
    lines.append(
        f"With a single descriptor F_P has rank {one['linear']['rank']} of {one['linear']['size']} with the linear "
        f"kernel and {one['Gaussian']['rank']} with the Gaussian: the proposition promises an invertible kernel matrix "
        "in exact arithmetic, and floating-point numbers see as much of it as the condition number lets them."
    )
    return lines


def draw(table: Rows) -> Figure:
    """Draw rank and condition number of F_P, and condition numbers of the whole, against the number of descriptors."""
    figure, axes = style.new_figure(columns=3, width=3.9)
    look = {"marker": "o", "markersize": 3}

    def line(kernel: str, system: str, column: str) -> tuple[list[int], list[float]]:
        rows = [r for r in table if (r["kernel"], r["system"]) == (kernel, system)]
        return [r["descriptors"] for r in rows], [r[column] if np.isfinite(r[column]) else np.nan for r in rows]

    for kernel, method in (("linear", "NO17"), ("Gaussian", "ours (paper)")):
        look["color"] = style.METHODS[method]
        axes[0].plot(*line(kernel, "F_P", "rank"), label=kernel, **look)
        axes[1].plot(*line(kernel, "F_P", "condition number"), label=kernel, **look)
        for system, dash in zip(SYSTEMS[1:], ("dashed", "dotted"), strict=True):
            values = line(kernel, system, "condition number")
            axes[2].plot(*values, linestyle=dash, label=f"{kernel}, ${system}$", **look)
    axes[0].axhline(SIZE, color=style.GREY, linewidth=0.8)
    titles = (f"rank of $F_P$ (of {SIZE})", "condition number of $F_P$", f"condition number, k = {WHOLE_SIZE}")
    for ax, title in zip(axes, titles, strict=True):
        ax.set_xscale("log")
        ax.set_xlim(COUNTS[0] / 1.2, COUNTS[-1] * 1.2)
        style.labels(ax, "number of descriptors", title)
    for ax in axes[1:]:
        ax.set_yscale("log")
        ax.yaxis.set_minor_formatter(NullFormatter())
    style.legend_below(figure, axes[0], columns=2)
    axes[2].legend(fontsize=7, frameon=False)
    return figure


if __name__ == "__main__":
    main(section44)
