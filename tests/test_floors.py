"""The one-way imports of docs/architecture.md: a module imports only from floors below its own."""

import ast
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[1] / "src" / "kfmaps"

FLOORS = {
    "_arrays": 0,
    "_threads": 0,
    "_factor": 0.25,
    "_lanczos": 0.25,
    "mesh": 0.5,
    "eigensolver": 0.5,
    "unfolding": 0.75,
    "spectrum": 1,
    "geodesics": 1,
    "kernels": 1,
    "cells": 1,
    "topology": 1,
    "descriptors": 2,
    "shot": 2,
    "sampling": 2,
    "slices": 2,
    "neighbours": 2,
    "nystrom": 2,
    "orientation": 2,
    "terms": 2.5,
    "exact": 2.7,
    "energy": 3,
    "solvers": 3,
    "maps": 3,
    "guided": 3,
    "samples": 3,
    "preconditioners": 4,
    "refine": 4,
    "evaluate": 4,
    "confidence": 4,
    "config": 4.5,
    "shape": 4.7,
    "features": 4.8,
    "quality": 4.9,
    "problem": 4.9,
    "pipeline": 5,
    "candidates": 5.5,
    "automatic": 6,
    "matching": 7,
    "app.files": 8,
    "app.datasets": 8,
    "app.pictures": 8,
    "app.progress": 8,
    "app.settings": 8,
    "app.evaluation": 8.5,
    "app.summary": 8.7,
    "app.batch": 9,
    "app.experiments": 9,
    "app.view": 9,
    "app.commands": 10,
    "app.cli": 11,
    "__main__": 12,
}
"""A package (``app.files``) stands for all modules in it, which may import each other."""


def unit(module: str) -> str | None:
    """The entry of FLOORS that ``module`` (a dotted name below kfmaps) belongs to."""
    names = module.split(".")
    return next((n for i in range(len(names), 0, -1) if (n := ".".join(names[:i])) in FLOORS), None)


def imported(path: Path) -> set[str]:
    """Dotted names below kfmaps that the file imports."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {a.name for a in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import; write it out"
            names |= {f"{node.module}.{a.name}" for a in node.names}
    return {n.removeprefix("kfmaps.") for n in names if n.startswith("kfmaps")}


def modules() -> list[tuple[str, Path]]:
    found = []
    for path in sorted(SOURCE.rglob("*.py")):
        parts = path.relative_to(SOURCE).with_suffix("").parts
        if parts[-1] == "__init__":
            parts = parts[:-1]
        if parts and parts != ("app",):
            found.append((".".join(parts), path))
    return found


@pytest.mark.parametrize(("module", "path"), modules(), ids=[m for m, _ in modules()])
def test_imports_go_down(module: str, path: Path) -> None:
    own = unit(module)
    assert own is not None, f"{module} has no floor: add it to FLOORS and to docs/architecture.md"
    for name in imported(path):
        other = unit(name)
        if other is None or other == own:
            continue
        assert FLOORS[other] < FLOORS[own], f"{module} imports {name}, which is not on a floor below it"


def test_floors_name_only_what_exists() -> None:
    units = {unit(module) for module, _ in modules()}
    assert units == set(FLOORS), "FLOORS and the source tree differ"
