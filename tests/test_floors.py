"""The one-way imports of docs/architecture.md: a module imports only from floors below its own."""

import ast
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[1] / "src" / "kfmaps"

FLOORS = {
    "_arrays": 0,
    "_errors": 0,
    "_threads": 0,
    "_progress": 0,
    "_texts": 0,
    "_memory": 1,
    "_records": 1,
    "kernels": 2,
    "geometry": 3,
    "descriptors": 4,
    "fmap": 5,
    "config": 6,
    "shape": 6,
    "registration": 6,
    "matching": 9,
    "collection": 10,
    "datasets": 10,
    "settings": 11,
    "io": 11,
    "viz": 12,
    "cli": 12,
    "learn": 12,
    "batch": 12,
    "evaluation": 12,
    "collection.api": 12,
    "collection.consistency": 12,
    "api": 12,
    "__main__": 13,
}
"""Rooms, each a package or a module. Inside a floor modules import each other freely, but never in a circle."""

UPWARD = {("matching.result", "api")}
"""The one import that goes up, when it is called: ``Match.plot``, ``view``, ``save`` and ``transfer`` are short for
functions of the API, so that a map from any place can show itself."""


def unit(module: str) -> str | None:
    """The entry of ``FLOORS`` that ``module`` (a dotted name below kfmaps) belongs to."""
    names = (module.rsplit(".", drop)[0] for drop in range(module.count(".") + 1))
    return next((name for name in names if name in FLOORS), None)


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
        if parts:
            found[".".join(parts)] = path
    return found


MODULES = modules()
IMPORTS = {module: imported(path) for module, path in MODULES.items()}


def test_imports_go_down() -> None:
    wrong = []
    for module, names in IMPORTS.items():
        own = unit(module)
        assert own is not None, f"{module} has no floor: add it to FLOORS and to docs/architecture.md"
        for name in names:
            other = unit(name)
            if other not in (None, own) and (module, other) not in UPWARD and FLOORS[other] > FLOORS[own]:
                wrong.append(f"{module} imports {name}, which is not on a floor below it")
    assert not wrong, "\n".join(wrong)


def test_no_module_imports_itself_through_others() -> None:
    """Imports that are written inside functions count too."""
    graph = {}
    for module, imports in IMPORTS.items():
        names = {n if n in MODULES else n.rpartition(".")[0] for n in imports}
        graph[module] = {n for n in names if n in MODULES and n != module and (module, n) not in UPWARD}
    try:
        tuple(TopologicalSorter(graph).static_order())
    except CycleError as error:
        pytest.fail("imports go in a circle: " + " < ".join(error.args[1]))


def test_imports_from_higher_packages_stand_inside_functions() -> None:
    for module, other in UPWARD:
        body = ast.parse(MODULES[module].read_text(encoding="utf-8")).body
        top = [ast.unparse(node) for node in body if isinstance(node, ast.Import | ast.ImportFrom)]
        assert other not in " ".join(top)
        assert other in IMPORTS[module]


def test_floors_name_only_what_exists() -> None:
    assert {unit(module) for module in MODULES} == set(FLOORS), "FLOORS and the source tree differ"
