"""Break formulas of the core on purpose, one at a time, and see whether the tests notice.

``python benchmarks/mutants.py`` applies each mutant of ``mutants_list.py`` to a copy of the package, runs the tests
that are named for it, and lists the survivors: formulas that could go wrong unnoticed. Then it draws ``--random``
further ones from the syntax trees of the core, without regard to what tests there are, and runs the test files whose
``GUARDS`` name the module. ``--suite`` tries their survivors with all tests. A mutant costs a few seconds to minutes.
"""

from __future__ import annotations

import argparse
import ast
import importlib
import multiprocessing
import os
import pkgutil
import shutil
import sys
import tempfile
import time
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from mutants_list import MUTANTS

import kfmaps

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "kfmaps"
TIMEOUT = 3600
"""Seconds that one mutant's tests may take. A single one that does not end fails after those of pyproject.toml."""
CORE = ("kernels", "geometry", "descriptors", "fmap", "registration", "matching", "collection", "config", "shape")
"""Packages and modules that blind mutants are drawn from."""
SWAPS = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.Pow: ast.Mult,
    ast.MatMult: ast.Mult,
    ast.Lt: ast.GtE,
    ast.LtE: ast.Gt,
    ast.Gt: ast.LtE,
    ast.GtE: ast.Lt,
}


def where(line: str, file: str = "") -> Path:
    """The file of the package that has ``line``, once, among those whose path has ``file``."""
    paths = [path for path in sorted(PACKAGE.rglob("*.py")) if file in path.as_posix()]
    found = [path for path in paths for _ in range(path.read_text().count(line))]
    if len(found) != 1:
        raise SystemExit(f"{line!r} occurs {len(found)} times in {PACKAGE}, not once")
    return found[0]


@cache
def guards() -> dict[str, tuple[str, ...]]:
    """Return the ``GUARDS`` of each test file: the modules and packages whose mutants it is run for."""
    result = {}
    for path in sorted((ROOT / "tests").glob("test_*.py")):
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "GUARDS":
                result[path.stem] = ast.literal_eval(node.value)
    return result


def guarding(path: Path) -> str:
    """Return the test files that guard a module, those first that name it most closely and the fewest beside it."""
    module = ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts).removesuffix(".__init__")
    of = {
        test: (-max(map(len, found)), len(names), test)
        for test, names in guards().items()
        if (found := [name for name in names if f"{module}.".startswith(f"{name}.")])
    }
    return " ".join(sorted(of, key=lambda test: of[test]))


def survives(path: Path, text: str, tests: str) -> bool:
    """Whether ``tests`` (all if empty) pass with ``text`` in place of the file ``path`` of the package."""
    names, _, expression = tests.partition(" -k ")
    files = [f"tests/{name}.py" for name in names.split()]
    arguments = ["-x", "-q", "-n", "0" if files else "auto", "-p", "no:cacheprovider", *files]
    arguments += ["-k", expression] if expression else []
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "kfmaps"
        shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
        (copy / path.relative_to(PACKAGE)).write_text(text)
        child = multiprocessing.get_context("fork").Process(target=_tested, args=(folder, arguments))
        child.start()
        child.join(TIMEOUT)
        if child.is_alive():
            child.kill()
            child.join()
            return False
    if child.exitcode not in (0, 1, 2, 4):  # 2 and 4: it cannot even be imported
        raise SystemExit(f"pytest {' '.join(arguments)} ended with {child.exitcode}")
    return child.exitcode == 0


def _tested(source: str, arguments: list[str]) -> None:
    """In a process of its own, which has all libraries at hand already but not the package that is to be tested."""
    for name in [name for name in sys.modules if name.split(".")[0] == kfmaps.__name__]:
        del sys.modules[name]
    sys.path.insert(0, source)
    os.environ["PYTHONPATH"] = source  # for the processes that the tests start
    os.chdir(ROOT)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(nowhere, stream)
    os._exit(int(pytest.main(arguments)))


def _load_libraries() -> None:
    """Import what the package and its tests import, once for all mutants."""
    for room in CORE:
        package = importlib.import_module(f"kfmaps.{room}")
        for found in pkgutil.walk_packages(getattr(package, "__path__", []), f"{package.__name__}."):
            importlib.import_module(found.name)
    for name in ("array_api_strict", "sklearn.metrics.pairwise", "torch", "array_api_compat.torch"):
        try:
            importlib.import_module(name)
        except ImportError:
            print(f"without {name}: what only its tests would notice survives")


def listed(word: str) -> list[tuple[Path, str, str, str]]:
    """File, its text when broken, the tests, and a name, of each mutant of the list that has ``word``."""
    found = []
    for line, broken, tests, file in MUTANTS:
        path = where(line, file)
        if word in line or word in str(path):
            found.append((path, path.read_text().replace(line, broken), tests, f"{line}  →  {broken}"))
    return found


def drawn(count: int, seed: int) -> list[tuple[Path, str, str, str]]:
    """The same of ``count`` operators and numbers drawn from all of the rooms' code, each as likely as any other."""
    places = []
    for room in CORE:
        for path in sorted((PACKAGE / room).rglob("*.py")) or [PACKAGE / f"{room}.py"]:
            places += [(path, i) for i, _ in enumerate(_spots(ast.parse(path.read_text())))]
    chosen = np.random.default_rng(seed).choice(len(places), size=count, replace=False)
    result = []
    for path, i in (places[c] for c in chosen):
        tree = ast.parse(path.read_text())
        node = _spots(tree)[i]
        before = ast.unparse(node)
        lines = path.read_text().splitlines(keepends=True)
        old = ast.get_source_segment("".join(lines), node) or ""
        _flip(node)
        # Only this piece of the text changes, so that what is shown is what is run.
        start = sum(len(line.encode()) for line in lines[: node.lineno - 1]) + node.col_offset
        data = "".join(lines).encode()
        text = (data[:start] + f"({ast.unparse(node)})".encode() + data[start + len(old.encode()) :]).decode()
        result.append((path, text, guarding(path), f"{node.lineno}: {before}  →  {ast.unparse(node)}"))
    return result


def _spots(tree: ast.Module) -> list[ast.expr]:
    """Expressions that can be broken: one operator or number each, none of them in annotations or slices."""
    skipped = set()
    for node in ast.walk(tree):
        aside = [getattr(node, name, None) for name in ("annotation", "returns")]
        aside += [node.slice] if isinstance(node, ast.Subscript) else []
        aside += [node.exc] if isinstance(node, ast.Raise) else []
        skipped |= {id(part) for root in aside if root is not None for part in ast.walk(root)}
    return [node for node in ast.walk(tree) if id(node) not in skipped and _breakable(node)]  # type: ignore[misc]


def _breakable(node: ast.AST) -> bool:
    if isinstance(node, ast.BinOp):
        return type(node.op) in SWAPS
    if isinstance(node, ast.Compare):
        return type(node.ops[0]) in SWAPS
    return isinstance(node, ast.Constant) and isinstance(node.value, float)


def _flip(node: ast.expr) -> None:
    if isinstance(node, ast.BinOp):
        node.op = SWAPS[type(node.op)]()  # type: ignore[assignment]
    elif isinstance(node, ast.Compare):
        node.ops[0] = SWAPS[type(node.ops[0])]()  # type: ignore[assignment]
    elif isinstance(node, ast.Constant):
        node.value = 2.0 * float(node.value) if node.value else 1.0  # type: ignore[arg-type]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--random", type=int, default=30, metavar="N", help="how many are drawn blindly (default: 30)")
    parser.add_argument("--seed", type=int, help="of those; drawn and printed if it is not given")
    parser.add_argument("--no-list", action="store_true", help="only those that are drawn blindly")
    parser.add_argument("--only", metavar="WORD", help="only those of the list whose line or file has the word")
    parser.add_argument("--suite", action="store_true", help="try blind ones that survive with all tests")
    options = parser.parse_args()
    seed = np.random.SeedSequence().generate_state(1)[0] if options.seed is None else options.seed
    mutants = [] if options.no_list else listed(options.only or "")
    known = len(mutants)
    if options.only is None:
        print(f"seed of the blind ones: {seed}")
        mutants += drawn(options.random, seed)
    _load_libraries()
    survivors = []
    for number, (path, text, tests, name) in enumerate(mutants):
        start = time.perf_counter()
        alive = not tests or survives(path, text, tests)
        if alive and options.suite and number >= known:
            alive = survives(path, text, "")
        label = f"{path.relative_to(PACKAGE)}  {name}"
        print(f"{'SURVIVED' if alive else 'noticed':9s}{time.perf_counter() - start:6.1f} s  {label}", flush=True)
        survivors += [(label, tests)] if alive else []
    print(f"\n{len(mutants) - len(survivors)} of {len(mutants)} noticed")
    for label, tests in survivors:
        print(f"survived {tests or 'without a test that guards it'}:\n    {label}")
    sys.exit(bool(survivors))


if __name__ == "__main__":
    main()
