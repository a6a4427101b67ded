"""The one-way imports of docs/architecture.md: a module imports only from floors below its own."""

import ast
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[1] / "src" / "kfmaps"

FLOORS = {
    "_arrays": 0,
    "_memory": 1,
    "_threads": 0,
    "_progress": 0,
    "_records": 1,
    "kernel": 2,
    "surface": 3,
    "descriptors": 4,
    "functional": 5,
    "config": 6,
    "fit": 7,
    "search": 8,
    "parts": 8,
    "matching": 9,
    "many": 10,
    "app": 11,
    "__main__": 12,
}
"""Rooms, each a package or a module. Inside a room modules import each other freely, but never in a circle."""

APP = {
    "words": 0,
    "terminal": 0,
    "progress": 1,
    "files": 0,
    "datasets": 0,
    "settings": 0,
    "inputs": 1,
    "pictures": 1,
    "evaluation": 2,
    "partial_truth": 3,
    "summary": 3,
    "collected": 3,
    "experiments": 4,
    "learn": 4,
    "view": 4,
    "batch": 5,
    "api": 6,
    "commands": 6,
    "cli": 7,
}
"""The same inside ``app``."""


def unit(module: str, table: dict[str, int] = FLOORS) -> str | None:
    """The entry of ``table`` that ``module`` (a dotted name below kfmaps, or below kfmaps.app) belongs to."""
    name = module.split(".")[0]
    return name if name in table else None


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


def modules() -> dict[str, Path]:
    found = {}
    for path in sorted(SOURCE.rglob("*.py")):
        parts = path.relative_to(SOURCE).with_suffix("").parts
        if parts[-1] == "__init__":
            parts = parts[:-1]
        if parts and parts != ("app",):
            found[".".join(parts)] = path
    return found


MODULES = modules()


@pytest.mark.parametrize("module", MODULES)
def test_imports_go_down(module: str) -> None:
    own = unit(module)
    assert own is not None, f"{module} has no floor: add it to FLOORS and to docs/architecture.md"
    for name in imported(MODULES[module]):
        other = unit(name)
        if other is not None and other != own:
            assert FLOORS[other] < FLOORS[own], f"{module} imports {name}, which is not on a floor below it"


@pytest.mark.parametrize("module", [m for m in MODULES if m.startswith("app.")])
def test_imports_go_down_inside_app(module: str) -> None:
    own = unit(module.removeprefix("app."), APP)
    assert own is not None, f"{module} has no floor: add it to APP and to docs/architecture.md"
    for name in imported(MODULES[module]):
        other = unit(name.removeprefix("app."), APP) if name.startswith("app.") else None
        if other is not None and other != own:
            assert APP[other] < APP[own], f"{module} imports {name}, which is not on a floor below it"


def test_no_module_imports_itself_through_others() -> None:
    """Imports that are written inside functions count too."""
    graph = {}
    for module, path in MODULES.items():
        names = {n if n in MODULES else n.rpartition(".")[0] for n in imported(path)}
        graph[module] = {n for n in names if n in MODULES and n != module}
    try:
        tuple(TopologicalSorter(graph).static_order())
    except CycleError as error:
        pytest.fail("imports go in a circle: " + " < ".join(error.args[1]))


def test_floors_name_only_what_exists() -> None:
    assert {unit(module) for module in MODULES} == set(FLOORS), "FLOORS and the source tree differ"
    inside = {unit(m.removeprefix("app."), APP) for m in MODULES if m.startswith("app.")}
    assert inside == set(APP), "APP and the source tree differ"
