"""Figure 7: residuals of conjugate gradients, and the time of one application of the operator in each form.

On a generated pair whatever data is given, of a size at which the product of its numbers of vertices is that of two
meshes with the paper's 2,529.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np
from matplotlib.figure import Figure

import style
from data_sets import DataSet
from experiment import Options, Result, main
from kfmaps._threads import one_blas_thread
from kfmaps.config import Config
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.full_kernel import hadamard_term
from kfmaps.fmap.preconditioners import jacobi, sylvester
from kfmaps.fmap.solvers import CG, solve
from kfmaps.fmap.terms import OperatorCommutativity
from kfmaps.geometry.basis import Basis
from kfmaps.matching.assemble import assemble
from kfmaps.matching.features import Descriptors, Features, kernel_features, pair_descriptors
from methods import paper, recommended
from pair_errors import prepared

PAPER_SECONDS = 1.47
STEPS = 600
TOLERANCE = 1e-8
BLOCK = 512


def hadamard(bases: tuple[Basis, Basis], features: tuple[np.ndarray, np.ndarray], C: np.ndarray) -> np.ndarray:
    """Return ``Φ_tᵀ A_t [(Φ_t C Φ_sᵀ) ∘ (W_t W_sᵀ)] A_s Φ_s`` as in figure 1, the kernel factored, in row blocks.

    ``bases`` and ``features (n, r)`` are of source and target; ``C`` has shape (k_t, k_s).
    """
    source, target = bases
    W_s, W_t = features
    weighted = source.functions * source.mass[:, None]
    image = C @ source.functions.T
    mixed = np.zeros_like(C)
    for a in range(0, len(W_t), BLOCK):
        rows = slice(a, a + BLOCK)
        product = (target.functions[rows] @ image) * (W_t[rows] @ W_s.T)
        mixed += (target.functions[rows] * target.mass[rows, None]).T @ (product @ weighted)
    return mixed


def figure7(options: Options) -> Result:
    """Residuals for the paper's and our settings, plain and preconditioned; times of five forms of the operator."""
    residuals: dict[str, np.ndarray] = {}
    with one_blas_thread():
        for name, config in (("paper's settings", paper(100)), ("recommended", recommended(100))):
            energy = timed_assembly(options, config).energy
            operators = (("plain", None), ("Jacobi", jacobi(energy.diagonal())), ("Sylvester", sylvester(energy)))
            for preconditioner, apply in operators:
                solution = solve(energy.apply, energy.rhs(), CG(TOLERANCE, STEPS), preconditioner=apply)
                residuals[f"{name}, {preconditioner}"] = solution.residuals / solution.residuals[0]
        times = timings(options, paper(100))
    table = [
        {"settings": name, "step": step, "relative residual": float(value)}
        for name, values in residuals.items()
        for step, value in enumerate(values)
    ]
    tables = {"figure7": table, "figure7-times": times}
    lines = conclusions(residuals, times)
    return Result(tables, {"figure7": draw(residuals, times)}, lines, [DataSet("generated")])


@dataclass(frozen=True, eq=False)
class Assembled:
    """An energy, and the bases, descriptors and features that its forms are made of."""

    energy: Energy
    bases: tuple[Basis, Basis]
    descriptors: Descriptors
    features: Features


def timed_assembly(options: Options, config: Config) -> Assembled:
    """Return the energy of the generated pair."""
    data_set = DataSet("generated", vertices=options.timing_vertices)
    pair = ("poses-2-source", "poses-2-target")
    source, target = (prepared(data_set, name, config.n_eigenfunctions) for name in pair)
    bases = (source.basis, target.basis)
    descriptors = pair_descriptors(source, target, bases, config.descriptors, data_set.landmarks(pair), None)
    # The same generator twice: both see the same samples.
    features = kernel_features(source, target, descriptors, config, np.random.default_rng(0))
    task = assemble(source, target, bases, descriptors, config, np.random.default_rng(0))
    source_basis, target_basis = (basis.truncate(config.basis.n_eigenfunctions) for basis in bases)
    return Assembled(task.energy, (source_basis, target_basis), descriptors, features)


def timings(options: Options, config: Config) -> list[dict[str, Any]]:
    """Return seconds of one application of the Hessian in each form, and how far its result is from the operators'."""
    exact = timed_assembly(options, config)
    compressed = timed_assembly(options, replace(config, operator_rtol=recommended(100).operator_rtol))
    rest = {n: w for n, w in exact.energy.weights.items() if n != "commutativity"}
    others = Energy({n: exact.energy.terms[n] for n in rest}, rest)
    operators, fewer = (cast(OperatorCommutativity, each.energy.terms["commutativity"]) for each in (exact, compressed))
    W_s, W_t = exact.features.source, exact.features.target
    source, target = exact.bases
    size = config.basis.n_eigenfunctions
    one, C = np.eye(size), np.random.default_rng(0).standard_normal((size, size))

    def literal(C: np.ndarray) -> np.ndarray:
        S_s = hadamard((source, source), (W_s, W_s), one)
        S_t = hadamard((target, target), (W_t, W_t), one)
        return C @ S_s + S_t @ C - 2 * hadamard((source, target), (W_s, W_t), C)

    def reused(C: np.ndarray) -> np.ndarray:
        mixed = hadamard((source, target), (W_s, W_t), C)
        return C @ operators.gram_s + operators.gram_t @ C - 2 * mixed

    whole = hadamard_term(exact.features.kernel, source, exact.descriptors.source, target, exact.descriptors.target)
    rank = W_s.shape[1]
    forms = {
        f"figure 1 as written, rank {rank}": literal,
        f"figure 1, repeated matrices precomputed, rank {rank}": reused,
        "the same with the whole kernel": whole.apply,
        f"operators, all {operators.count}": operators.apply,
        f"operators, compressed to {fewer.count}": fewer.apply,
    }
    reference = others.apply(C) + operators.apply(C)
    rows = []
    for name, apply in forms.items():
        gap = others.apply(C) + apply(C) - reference
        row = {"form": name, "seconds": seconds(lambda apply=apply: others.apply(C) + apply(C))}
        row["relative difference"] = float(np.linalg.norm(gap) / np.linalg.norm(reference))
        rows.append(row | {"source vertices": len(W_s), "target vertices": len(W_t)})
    return rows


def seconds(work: Callable[[], object], repeats: int = 9) -> float:
    """Return the time of the shortest of ``repeats`` runs, the one least disturbed by other work of the machine."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def conclusions(residuals: dict[str, np.ndarray], times: list[dict[str, Any]]) -> list[str]:
    """Return what the residuals and times say."""
    lines = []
    for name, values in residuals.items():
        rises = int((np.diff(values) > 0).sum())
        reached = np.flatnonzero(values <= TOLERANCE)
        end = f"reach {TOLERANCE:g} in {reached[0]} steps" if len(reached) else f"end at {values[-1]:.1e}"
        lines.append(f"{name}: residuals {end} and rise {rises} times on the way.")
    risen = any((np.diff(values) > 0).any() for values in residuals.values())
    lines.append(f"Residuals of conjugate gradients are {'not ' if risen else ''}monotone here; the paper's are not.")
    written, reused, whole, ours, fewer = (float(row["seconds"]) for row in times)
    gaps = [float(row["relative difference"]) for row in times]
    lines.append(
        f"One application of the operator takes {written:.3f} s as figure 1 writes it, {reused:.3f} s when what does "
        f"not change is precomputed, and {ours:.3f} s as matrices: {written / ours:.1f} and {reused / ours:.1f} times "
        f"faster, in the same run on one thread. Compressed: {fewer:.3f} s; the whole kernel: {whole:.3f} s. "
        f"The paper's took {PAPER_SECONDS} s on a machine of 2018."
    )
    lines.append(
        f"The first two and the operators agree to {max(gaps[:2]):.0e}. The whole kernel differs from them by "
        f"{gaps[2]:.1e}, which is what the Nyström approximation leaves out."
    )
    return lines


def draw(residuals: dict[str, np.ndarray], times: list[dict[str, Any]]) -> Figure:
    """Draw residuals against steps, and times as bars."""
    figure, (left, right) = style.new_figure(columns=2, width=4.8)
    colors = (style.METHODS["ours (paper)"], style.METHODS["ours (recommended)"])
    for i, (name, values) in enumerate(residuals.items()):
        left.semilogy(values, color=colors[i // 3], linestyle=style.DASHES[i % 3], label=name, linewidth=1.4)
    style.labels(left, "step of conjugate gradients", "‖b − A(C)‖ / ‖b‖", "residuals")
    left.legend(fontsize=7, frameon=False, loc="upper right")
    names = [str(row["form"]).replace(", ", ",\n") for row in times]
    values = [float(row["seconds"]) for row in times]
    right.barh(names, values, color=[style.ORANGE, style.YELLOW, style.GREY, style.BLUE, style.GREEN])
    right.set_xlim(0, max(values) * 1.25)
    for i, value in enumerate(values):
        right.annotate(f" {value:.3g} s", (value, i), va="center", fontsize=8)
    right.invert_yaxis()
    right.tick_params(axis="y", labelsize=7)
    style.labels(right, "one application of the operator (s)", "")
    return figure


if __name__ == "__main__":
    main(figure7)
