"""The eigenproblem in four ways: ``python benchmarks/eigenproblem.py [--large] [--json PATH]``.

For each size the first ``k`` eigenpairs of one bumpy sphere's Laplacian: by SciPy's ``eigsh`` with its default
shift-invert, by :func:`kfmaps.laplace_basis` exactly and in single precision, and on a coarse proxy
(:func:`kfmaps.geometry.coarse_basis.coarse_basis`), as shapes of more than 60,000 vertices are prepared. The Laplacian
is made anew each time. Ratios are SciPy's time over ours, measured in this run; ``work`` is CPU seconds. GB is the peak
memory of a process of its own for each row, some 0.15 of it Python and the libraries. The error is the largest of an
eigenvalue, relatively.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import resource
import time
from pathlib import Path
from typing import Any

import numpy as np
from scipy.sparse import diags_array
from scipy.sparse.linalg import eigsh
from shapes import bumpy_sphere

from kfmaps._threads import one_blas_thread
from kfmaps.geometry.basis import laplace_basis, laplace_operators
from kfmaps.geometry.coarse_basis import coarse_basis
from kfmaps.geometry.mesh import Mesh
from kfmaps.shape import LOOSE_TOLERANCE

SIZES, LARGE = (5_000, 20_000, 100_000), (300_000, 500_000)


def scipy_default(mesh: Mesh, k: int) -> np.ndarray:
    """SciPy's shift-invert as its documentation shows it, just below zero."""
    stiffness, mass = laplace_operators(mesh, "robust", k)
    with one_blas_thread():
        shift = -1e-3 / mass.sum()
        return np.sort(eigsh(stiffness, k, M=diags_array(mass), sigma=shift, return_eigenvectors=True)[0])


SOLVERS = {
    "eigsh": scipy_default,
    "exact": lambda mesh, k: laplace_basis(mesh, k).eigenvalues,
    "single precision": lambda mesh, k: laplace_basis(mesh, k, tolerance=LOOSE_TOLERANCE).eigenvalues,
    "coarse proxy": lambda mesh, k: coarse_basis(mesh, k, "robust", LOOSE_TOLERANCE).eigenvalues,
}


def measure(name: str, mesh: Mesh, k: int) -> dict[str, Any]:
    """One row: seconds, CPU seconds, peak memory and eigenvalues of one solver."""
    wall, work = time.perf_counter(), time.process_time()
    values = SOLVERS[name](mesh, k)
    wall, work = time.perf_counter() - wall, time.process_time() - work
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    n = len(mesh.vertices)
    return {"n": n, "k": k, "solver": name, "wall": wall, "work": work, "peak_gb": peak, "values": values}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--large", action="store_true", help="300,000 and 500,000 vertices too")
    parser.add_argument("--sizes", type=int, nargs="+", help="these sizes instead")
    parser.add_argument("-k", type=int, nargs="+", default=[100, 200], help="eigenpairs (default: 100 and 200)")
    parser.add_argument("--solvers", nargs="+", choices=SOLVERS, help="these only; the first is the reference")
    parser.add_argument("--json", type=Path, help="write the rows there too")
    options = parser.parse_args()
    sizes = options.sizes or (SIZES + LARGE if options.large else SIZES)
    rows = []
    header = ("vertices", "k", "solver", "seconds", "ratio", "work", "ratio", "GB", "error")
    print("{:>9} {:>4}  {:24} {:>8} {:>6} {:>8} {:>6} {:>6} {:>8}".format(*header))
    context = multiprocessing.get_context("spawn")
    for n in sizes:
        mesh = bumpy_sphere(n)
        for k in options.k:
            reference = None
            for name in options.solvers or SOLVERS:
                with context.Pool(1) as pool:  # a process of its own, for its peak memory
                    row = pool.apply(measure, (name, mesh, k))
                values = row.pop("values")
                reference = reference or {**row, "values": values}
                # Of values that are zero only the absolute error means anything.
                row["error"] = float((np.abs(values - reference["values"]) / np.maximum(values, 1)).max())
                row["ratio_wall"] = reference["wall"] / row["wall"]
                row["ratio_work"] = reference["work"] / row["work"]
                rows.append(row)
                print(
                    f"{n:9d} {k:4d}  {name:24} {row['wall']:8.2f} {row['ratio_wall']:6.2f} {row['work']:8.2f} "
                    f"{row['ratio_work']:6.2f} {row['peak_gb']:6.2f} {row['error']:8.0e}",
                    flush=True,
                )
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
