"""One application of the commutativity operator: ``python benchmarks/application.py [--device cuda] [--json PATH]``.

At the paper's size, two shapes of 2,529 vertices, k = 100, rank 400 and a Gaussian kernel. Three Hadamard forms: the
literal one, all three products of equations (10) to (12) worked out at every application from the features; the
coupling alone, with what does not depend on C worked out before, in row blocks; and that with the kernel matrix kept
in memory. Then one for each feature, and operators after compression. Seconds are CPU seconds on one thread, the
median of several; GFlop/s count the multiplications and additions of the matrix products, and the peak is that of one
product of 2,000 x 2,000 matrices in the same run. The error is ``‖A(C) − A_exact(C)‖ / ‖A_exact(C)‖`` against the
literal form.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from shapes import bumpy_pair

from kfmaps._arrays import Array, is_numpy, namespace, to_numpy
from kfmaps._threads import one_blas_thread
from kfmaps.config import Config
from kfmaps.fmap.full_kernel import hadamard_term
from kfmaps.fmap.multiplication_operators import (
    multiplication_operators,
    truncate_features,
    truncate_operators,
    unpack_operators,
)
from kfmaps.fmap.terms import operator_term
from kfmaps.kernels.kernels import Linear
from kfmaps.matching.assemble import FEATURES_SHARE
from kfmaps.matching.features import kernel_features, pair_descriptors
from kfmaps.shape import prepare


def seconds(call: Callable[[], Array], device: str, repeats: int) -> float:
    """Median CPU seconds of ``call``; on another device seconds, waited for."""
    clock = time.process_time if device in ("cpu", "torch") else time.perf_counter
    found = []
    call()
    for _ in range(repeats):
        start = clock()
        result = call()
        if not is_numpy(result):
            to_numpy(result[:1, :1])  # waits for the device
        found.append(clock() - start)
    return float(np.median(found))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vertices", type=int, default=2529)
    parser.add_argument("-k", type=int, default=100)
    parser.add_argument("--rank", type=int, default=400)
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    with one_blas_thread():
        rows = measure(options)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


def measure(options: argparse.Namespace) -> list[dict[str, Any]]:
    k, device = options.k, options.device
    pair = bumpy_pair(options.vertices)
    config = replace(
        Config.single_fit(),
        refinement=None,
        nystrom=replace(Config.single_fit().nystrom, samples=options.rank),
    )
    config = replace(config, basis=replace(config.basis, n_eigenfunctions=k))
    source, target = (prepare(mesh, config) for mesh in (pair.source, pair.target))
    bases = (source.basis.to(device), target.basis.to(device))
    used = pair_descriptors(source, target, bases, config.descriptors, pair.landmarks, None)
    features = kernel_features(source, target, used, config, np.random.default_rng(0))
    small = (bases[0].truncate(k), bases[1].truncate(k))
    xp = namespace(small[0].functions)
    C = xp.asarray(np.random.default_rng(1).normal(size=(k, k)), device=small[0].functions.device)
    F_s, F_t = features.source, features.target
    n_s, n_t, r = F_s.shape[0], F_t.shape[0], F_s.shape[1]
    blocked = hadamard_term(Linear(), small[0], F_s, small[1], F_t)
    phi_s, phi_t = (basis.functions for basis in small)
    weighted_s, weighted_t = (basis.mass[:, None] * basis.functions for basis in small)
    kernel = F_t @ F_s.T

    def literal() -> Array:
        """Equations (10) to (12) as they stand, each kernel matrix from the features."""
        within_s = (phi_s @ phi_s.T) * (F_s @ F_s.T)
        within_t = (phi_t @ phi_t.T) * (F_t @ F_t.T)
        squares_s = weighted_s.T @ (within_s @ weighted_s)
        squares_t = weighted_t.T @ (within_t @ weighted_t)
        between = (phi_t @ (C @ phi_s.T)) * (F_t @ F_s.T)
        return C @ squares_s + squares_t @ C - 2 * (weighted_t.T @ (between @ weighted_s))

    def held() -> Array:
        """The coupling alone, its kernel matrix at hand."""
        product = (phi_t @ (C @ phi_s.T)) * kernel
        mixed = weighted_t.T @ (product @ weighted_s)
        return C @ blocked.gram_s + blocked.gram_t @ C - 2 * mixed

    def formed(rtol: float) -> Any:
        kept = truncate_features(small[0], F_s, small[1], F_t, FEATURES_SHARE * rtol) if rtol else (F_s, F_t)
        packed = multiplication_operators(small[0], kept[0]), multiplication_operators(small[1], kept[1])
        packed = truncate_operators(*packed, rtol) if rtol else packed
        return operator_term(*(unpack_operators(p) for p in packed))

    square = xp.asarray(np.random.default_rng(2).normal(size=(2000, 2000)), device=C.device)
    peak = 2 * 2000**3 / seconds(lambda: square @ square, device, 3) / 1e9
    forms: list[tuple[str, Callable[[], Array], float]] = [
        ("Hadamard, literal", literal, 2.0 * (n_s * n_t + n_s**2 + n_t**2) * (2 * k + r)),
        ("Hadamard, row blocks", lambda: blocked.apply(C), 2.0 * n_s * n_t * (2 * k + r)),
        ("Hadamard, kernel held", held, 2.0 * n_s * n_t * 2 * k),
    ]
    for name, rtol in (
        ("operators", 0.0),
        ("operators, 1e-5", 1e-5),
        ("operators, 1e-4", 1e-4),
        ("operators, 1e-3", 1e-3),
    ):
        term = formed(rtol)
        forms.append((f"{name} ({term.count})", lambda term=term: term.apply(C), 2.0 * (2 * term.count + 2) * k**3))
    exact = literal()
    rows, first = [], None
    print(f"{n_s} and {n_t} vertices, k = {k}, rank {r}, {device}; peak {peak:.0f} GFlop/s")
    print(f"{'form':26} {'seconds':>9} {'ratio':>7} {'GFlop/s':>8} {'of peak':>8} {'error':>8}")
    for name, call, work in forms:
        spent = seconds(call, device, options.repeats)
        first = first or spent
        error = float(np.linalg.norm(to_numpy(call() - exact)) / np.linalg.norm(to_numpy(exact)))
        speed = work / spent / 1e9
        rows.append({"form": name, "seconds": spent, "ratio": first / spent, "gflops": speed, "error": error})
        print(f"{name:26} {spent:9.5f} {first / spent:7.1f} {speed:8.1f} {speed / peak:8.2f} {error:8.1e}")
    return [{"device": device, "vertices": [n_s, n_t], "k": k, "rank": r, "peak_gflops": peak}, *rows]


if __name__ == "__main__":
    main()
