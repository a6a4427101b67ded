"""What each piece of the search is worth: whole matches with a piece left out or replaced.

    python benchmarks/ablation.py --data DIR [--sets SMAL_r,catdog] [--half choice] [--pairs 3] [--seeds 0]
        [--pieces no kernel fits,no repairs] [--rows FILE] [--cache DIR]

Without ``--pieces`` all of :data:`PIECES` are tried. Pairs, halves and DIR are as for benchmarks/automatic.py. For each
piece stand there, over all pairs, the mean error × 100 without the change and with it, the mean change with its
interval of 95 % (by drawing pairs), the largest rise and fall of a pair, and of all maps those that are right (below
8), called "sure" and called so wrongly, and CPU seconds. ``--rows`` keeps every match in a file of JSON lines; the same
command goes on where it ended. A pair takes 4 to 20 CPU seconds a piece.
"""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from automatic import RIGHT, Job, chosen_jobs, pair_options
from kernel_pieces import Patch, energy_in_zoomout, guided, kernel_guidance, remember
from scatter import SETS, interval, judged

import kfmaps
from kfmaps.fmap import descriptor_guidance as guidance
from kfmaps.matching import (
    candidates,
    limb_exchange,
    ranking,
    registration_refine,
    search,
    search_result,
)
from kfmaps.matching import match as matching

KEY = "set", "pair", "seed"
"""What a row and the row without a change have in common."""


def _first(found: Any, *_: Any, **__: Any) -> Any:
    return found


PIECES: dict[str, list[Patch]] = {
    "no kernel fits": [(candidates, "kernel_inits", lambda *_, **__: [])],
    "no starts from extremities": [(candidates, "extremity_inits", lambda *_, **__: [])],
    "no near-symmetries": [(candidates, "symmetry_inits", lambda *_, **__: [])],
    "no fine refinement with extremities": [(candidates, "FINE_WEIGHTS", candidates.FINE_WEIGHTS[:1])],
    "no closer look at the first two": [(one, "rerank_close", _first) for one in (ranking, limb_exchange)],
    "no near duplicates": [(search, "rerank_near_duplicates", _first)],
    "no repairs of extremity matches": [(registration_refine, "N_MATCHES", 0)],
    "repairs of the best alone": [
        (registration_refine, name, n) for name, n in (("N_REPAIRED", 1), ("N_REGISTERED", 1), ("N_MATCHES", 0))
    ],
    "no repairs": [(search, "refine_by_registration", lambda ranked, *_, **__: (ranked, ()))],
    "no second finish where torn": [(matching, "_retry_torn", lambda _task, _found, best: best)],
    "no exchanged limbs": [(search, "compare_exchanged", lambda best, *_, **__: [best])],
    "no guidance by extremities": [(search_result, "extremity_vertices", lambda *_: None)],
    "guidance of 96 components": guided(lambda s, t: guidance.descriptor_guidance(s, t, 96)),
    "Gaussian guidance": guided(kernel_guidance(2.0, 96)),
    "Gaussian guidance of all descriptors": guided(kernel_guidance(1.0, 64, "product")),
    "Gaussian guidance of each set": guided(kernel_guidance(1.0, 64, "sum")),
    "energy in ZoomOut": energy_in_zoomout(3.0),
}
"""What is changed: a piece taken out, or another in its place."""


@contextmanager
def without(piece: str) -> Iterator[None]:
    """The package without a piece; ``""``: as it is."""
    with ExitStack() as stack:
        for one in PIECES[piece] if piece else []:
            stack.enter_context(patch.object(*one))
        yield


def row_of(job: Job, seed: int, piece: str, cache: Path | None) -> dict[str, Any]:
    """One match: its error, verdict and CPU seconds."""
    of, config = judged(job, cache), replace(kfmaps.Config(), threads=1)
    remember(of.source, of.target)
    with without(piece):
        start = time.process_time()
        made = kfmaps.match(of.source, of.target, config, rng=seed)
        spent = time.process_time() - start
    error = of.error(made.target_to_source[of.true_t])
    names = {"set": job.kind, "pair": f"{job.source}-{job.target}", "seed": seed, "piece": piece}
    return {**names, "error": error, "verdict": made.verdict, "confidence": made.confidence, "cpu": spent}


def told(rows: list[dict[str, Any]]) -> str:
    """How many maps are right, sure, and sure but wrong, and the mean CPU seconds."""
    right = [row["error"] < RIGHT for row in rows]
    sure = [row["verdict"] == "sure" for row in rows]
    wrong = sum(s and not r for s, r in zip(sure, right, strict=True))
    return f"{sum(right):4} {sum(sure):4} {wrong:4} {np.mean([row['cpu'] for row in rows]):6.1f}"


def _of_whole(rows: list[dict[str, Any]]) -> dict[tuple[Any, ...], dict[str, Any]]:
    return {tuple(row[k] for k in KEY): row for row in rows if row["piece"] == ""}


def changes_of(
    rows: list[dict[str, Any]], piece: str
) -> tuple[list[dict[str, Any]], np.ndarray, np.ndarray, np.ndarray]:
    """The rows of a change, and for each of their pairs (p,) its set, its error without the change and by how much the
    change alters it: means over the seeds.
    """
    whole = _of_whole(rows)
    out = [row for row in rows if row["piece"] == piece and tuple(row[k] for k in KEY) in whole]
    pairs: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for row in out:
        errors = whole[tuple(row[k] for k in KEY)]["error"], row["error"]
        pairs.setdefault((row["set"], row["pair"]), []).append(errors)
    before, after = np.array([np.mean(errors, axis=0) for errors in pairs.values()]).reshape(-1, 2).T
    return out, np.array([kind for kind, _ in pairs]), before, after - before


def report(rows: list[dict[str, Any]], pieces: list[str]) -> None:
    """Print the table of the rows, and for each piece the change of each set."""
    whole = _of_whole(rows)
    print(f"{'':36} maps  none  with    change (95 %)     fall   rise right sure wrong  CPU s")
    print(
        f"{'(nothing)':36} {len(whole):4} {np.mean([r['error'] for r in whole.values()]):5.2f}{'':44}"
        f"{told([*whole.values()])}"
    )
    for piece in pieces:
        out, kinds, before, change = changes_of(rows, piece)
        if not out:
            continue
        low, high = interval(100 * change / before.mean())
        print(
            f"{piece:36} {len(out):4} {before.mean():5.2f} {(before + change).mean():5.2f}"
            f" {100 * change.mean() / before.mean():+6.1f} % ({low:+6.1f} to {high:+6.1f})"
            f" {change.min():+6.2f} {change.max():+6.2f} {told(out)}"
        )
        for kind in dict.fromkeys(kinds):
            at = kinds == kind
            print(f"    {kind:32} {at.sum():4} {before[at].mean():5.2f} {(before + change)[at].mean():5.2f}")


def main() -> None:
    parser = pair_options(__doc__, SETS, 3)
    parser.add_argument("--seeds", default="0")
    parser.add_argument("--pieces", default=",".join(PIECES), help="names of PIECES")
    parser.add_argument("--rows", type=Path, help="JSON lines of all matches, read first and added to")
    parser.add_argument("--cache", type=Path, help="folder that keeps prepared shapes")
    args = parser.parse_args()
    pieces = args.pieces.split(",")
    rows = [json.loads(line) for line in args.rows.read_text().splitlines()] if args.rows and args.rows.exists() else []
    known = {(row["set"], row["pair"], row["seed"], row["piece"]) for row in rows}
    for seed, job in product([int(word) for word in args.seeds.split(",")], chosen_jobs(args)):
        for piece in ("", *pieces):
            if (job.kind, f"{job.source}-{job.target}", seed, piece) in known:
                continue
            rows.append(row_of(job, seed, piece, args.cache))
            print(*(f"{v:.2f}" if isinstance(v, float) else v for v in rows[-1].values()), flush=True)
            if args.rows:
                with args.rows.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(rows[-1]) + "\n")
    report(rows, pieces)


if __name__ == "__main__":
    main()
