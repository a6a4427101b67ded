"""This library and pyFM on the same pairs in one run: ``python benchmarks/compare.py [--data FOLDER] [--json PATH]``.

Both start from the same meshes and landmarks and take turns, with BLAS on one thread; the shortest of ``--repeats``
counts. "fit" is given the same descriptors, functions and landmarks on both sides: here features, operators and the
solve, there ``fit()``, to where it stops by itself and to the relative residual of ours, ``‖∇E(C)‖ ≤ rtol ‖∇E(0)‖``.
"whole" is everything from the mesh to the refined map, which is registered too here, unless the method says not;
geomfum takes part in it where it is installed. CPU seconds are of all threads; errors are mean geodesic distances from
the truth in per cent of √area. Needs pyFM: ``pip install 'kfmaps[bench]'``.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from shapes import Pair, bumpy_pair, read_pairs

from kfmaps._threads import one_blas_thread
from kfmaps.config import Config, DescriptorConfig
from kfmaps.fmap.convert import to_points
from kfmaps.fmap.evaluate import geodesic_errors
from kfmaps.fmap.preconditioners import sylvester
from kfmaps.fmap.solvers import CG, solve
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.matching.assemble import assemble
from kfmaps.matching.features import pair_descriptors
from kfmaps.matching.fit import check_landmark_pairs
from kfmaps.matching.match import match
from kfmaps.shape import Shape, prepare

FunctionalMapping = import_module("pyFM.functional").FunctionalMapping
TriMesh = import_module("pyFM.mesh").TriMesh
optimisation = import_module("pyFM.functional").opt_func

K, STOP, STEP = 100, 150, 5
ZOOM = ZoomOut(start=K, stop=STOP, step=STEP)


class _ReachedError(Exception):
    """Ends pyFM's minimiser with the map that it has."""


@dataclass(frozen=True)
class Row:
    """One stage of one method on one pair."""

    pair: str
    stage: str
    method: str
    work: float
    wall: float
    error: float


def timed(call: Callable[[], Any]) -> tuple[Any, float, float]:
    """What ``call`` returns, its CPU seconds and its seconds."""
    work, wall = time.process_time(), time.perf_counter()
    with one_blas_thread():
        result = call()
    return result, time.process_time() - work, time.perf_counter() - wall


def config(threads: int, rtol: float = 1e-6, refinement: ZoomOut | None = None) -> Config:
    return replace(Config.single_fit(), threads=threads, refinement=refinement, solver=CG(rtol, 2000))


def pyfm_model(pair: Pair, spectrum: tuple[Shape, Shape] | None = None) -> Any:
    """A model of pyFM; with the eigenfunctions of ``spectrum`` where they are given."""
    meshes = [TriMesh(m.vertices, m.faces, area_normalize=True) for m in (pair.source, pair.target)]
    for i, mesh in enumerate(meshes):
        mesh.process(200 if spectrum is None else 3)
        if spectrum is not None:
            mesh.eigenvalues = spectrum[i].basis.eigenvalues
            mesh.eigenvectors = spectrum[i].basis.functions
    return FunctionalMapping(*meshes)


def descriptors(pair: Pair, maps: bool) -> DescriptorConfig:
    """100 in all, or (``maps``) 100 and 100 for each landmark, as pyFM makes them."""
    if not maps:
        return DescriptorConfig(shot=False, n_eigenfunctions=200)
    count = 100 * (1 + len(pair.landmarks))
    return replace(DescriptorConfig(shot=False, n_eigenfunctions=200), n_spectral=count, signature_share=100.5 / count)


def fits(pair: Pair, shapes: tuple[Shape, Shape], threads: int, maps: bool) -> dict[str, Callable[[], np.ndarray]]:
    """Functional maps from the same descriptors: 100 in all, or (``maps``) 100 and 100 for each landmark."""
    bases = (shapes[0].basis, shapes[1].basis)
    wanted = descriptors(pair, maps)
    given = pair_descriptors(*shapes, bases, wanted, check_landmark_pairs(pair.landmarks, *shapes), None)

    def ours(rtol: float) -> np.ndarray:
        settings = config(threads, rtol)
        energy = assemble(*shapes, bases, given, settings, np.random.default_rng(0)).energy
        return solve(energy.apply, energy.rhs(), settings.solver, preconditioner=sylvester(energy)).value

    def theirs() -> Any:
        model.fit(K=(K, K))
        return model.FM_12

    def theirs_to(rtol: float) -> np.ndarray:
        """The map at which pyFM's minimiser first has a gradient of ``rtol`` times that at zero."""
        energy, sizes = optimisation.energy_and_grad_std, []

        def until_small(C: np.ndarray, *args: Any) -> tuple[float, np.ndarray]:
            value, gradient = energy(C, *args)
            if not sizes:
                sizes.append(np.linalg.norm(energy(np.zeros_like(C), *args)[1]))
            if np.linalg.norm(gradient) <= rtol * sizes[0]:
                raise _ReachedError(C.reshape(K, K))
            return value, gradient

        with patch.object(optimisation, "energy_and_grad_std", until_small):
            try:
                model.fit(K=(K, K), factr=0.0, pgtol=0.0)
            except _ReachedError as reached:
                return reached.args[0]
        return model.FM_12

    model = pyfm_model(pair, shapes).add_descriptors(given.source, given.target)
    return {
        "pyFM": theirs,
        "pyFM, 1e-6": lambda: theirs_to(1e-6),
        "pyFM, 1e-4": lambda: theirs_to(1e-4),
        "kfmaps": lambda: ours(1e-6),
        "kfmaps, 1e-4": lambda: ours(1e-4),
    }


def wholes(pair: Pair, threads: int, maps: bool) -> dict[str, Callable[[], np.ndarray]]:
    """Maps of points from meshes and landmarks, refined to ``STOP`` functions."""

    def ours(refinement: ZoomOut, **changes: Any) -> np.ndarray:
        settings = replace(config(threads, 1e-4, refinement), descriptors=descriptors(pair, maps), **changes)
        return match(pair.source, pair.target, settings, landmarks=pair.landmarks).target_to_source

    def theirs() -> Any:
        model = pyfm_model(pair)
        # As many descriptors as ours: all of 100 and 100 for each landmark, or every seventh.
        every = 1 if maps else 1 + len(pair.landmarks)
        model.compute_spectral_descriptors(100, "WKS", 128, pair.landmarks, subsample_step=every)
        model.fit(K=(K, K))
        return model.get_p2p(model.zoomout_refine(nit=(STOP - K) // STEP, step=STEP))

    sampled = replace(ZOOM, samples=1000)
    others: dict[str, Callable[[], np.ndarray]] = {"pyFM": theirs}
    if find_spec("geomfum") and not maps:
        points = import_module("by_geomfum").points
        others["geomfum"] = lambda: points(pair.source, pair.target, pair.landmarks)
    return {
        **others,
        "kfmaps": lambda: ours(ZOOM),
        "kfmaps, 1000 samples": lambda: ours(sampled),
        "kfmaps, not registered": lambda: ours(sampled, registration=None),
    }


def contest(
    pair: Pair,
    stage: str,
    methods: dict[str, Callable[[], np.ndarray]],
    repeats: int,
    points: Callable[[np.ndarray], np.ndarray],
) -> list[Row]:
    best: dict[str, Row] = {}
    for _ in range(repeats):
        for method, call in methods.items():
            found, work, wall = timed(call)
            error = 100 * float(geodesic_errors(pair.source, points(found), pair.target_to_source).mean())
            if method not in best or work < best[method].work:
                best[method] = Row(pair.name, stage, method, work, wall, error)
    return list(best.values())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, help="a folder laid out as FAUST_r is, instead of generated shapes")
    parser.add_argument("--pairs", type=int, default=3)
    parser.add_argument("--vertices", type=int, default=5000, help="of generated shapes")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--threads", type=int, default=1, help="Python threads of this library")
    parser.add_argument("--json", type=Path, help="write the rows there too")
    options = parser.parse_args()
    if options.data:
        pairs = read_pairs(options.data, options.pairs)
    else:
        pairs = [bumpy_pair(options.vertices, seed) for seed in range(options.pairs)]
    rows: list[Row] = []
    print(f"{'pair':28} {'stage':24} {'method':22} {'work':>7} {'ratio':>6} {'wall':>7} {'ratio':>6} {'error':>6}")
    for pair in pairs:
        settings = config(options.threads)
        source, target = prepare(pair.source, settings), prepare(pair.target, settings)

        def points(C: np.ndarray, a: Shape = source, b: Shape = target) -> np.ndarray:
            return to_points(C, a.basis, b.basis)

        stages = [
            ("fit", fits(pair, (source, target), options.threads, False), points),
            ("fit, 100 per landmark", fits(pair, (source, target), options.threads, True), points),
            ("whole, ZoomOut to 150", wholes(pair, options.threads, False), np.asarray),
            ("whole, 100 per landmark", wholes(pair, options.threads, True), np.asarray),
        ]
        for stage, methods, finish in stages:
            found = contest(pair, stage, methods, options.repeats, finish)
            for row in found:
                ratios = [found[0].work / row.work, found[0].wall / row.wall]
                print(
                    f"{row.pair:28} {row.stage:24} {row.method:22} {row.work:7.2f} {ratios[0]:6.2f} {row.wall:7.2f} "
                    f"{ratios[1]:6.2f} {row.error:6.2f}",
                    flush=True,
                )
            rows += found
    print("\nmedian ratio of CPU seconds, pyFM's over ours; of fits also where both stop at the same residual")
    for stage in dict.fromkeys(row.stage for row in rows):
        named: dict[str, list[Row]] = {}
        for row in rows:
            if row.stage == stage:
                named.setdefault(row.method, []).append(row)
        for method in (name for name in named if name.startswith("kfmaps")):
            same = "pyFM, 1e-4" if method.endswith("1e-4") else "pyFM, 1e-6"
            for other in (name for name in ("pyFM", same) if name in named):
                theirs, own = named[other], named[method]
                ratio = np.median([o.work / r.work for o, r in zip(theirs, own, strict=True)])
                errors = [float(np.mean([r.error for r in group])) for group in (theirs, own)]
                print(f"{stage:24} {method:22} {other:10} {ratio:6.2f}   errors {errors[0]:.2f}, {errors[1]:.2f}")
    if options.json:
        options.json.write_text(json.dumps([asdict(row) for row in rows], indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
