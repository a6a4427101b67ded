"""The list of formulas that ``benchmarks/mutants.py`` breaks does not rot."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

import kfmaps

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"
TEXTS = {path.as_posix(): path.read_text() for path in Path(kfmaps.__file__).parent.rglob("*.py")}
sys.path.insert(0, str(BENCHMARKS))
from mutants import CORE, PACKAGE, guarding, guards  # noqa: E402
from mutants_list import MUTANTS  # noqa: E402

sys.path.remove(str(BENCHMARKS))


def test_there_are_many_and_none_twice() -> None:
    assert len({m.line + m.broken for m in MUTANTS}) == len(MUTANTS) >= 60


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda m: m.line)
def test_its_line_is_there_once_and_its_tests_too(mutant) -> None:
    found = sum(text.count(mutant.line) for path, text in TEXTS.items() if mutant.file in path)
    assert found == 1, "name the line that has taken its place, or its file where there are several"
    assert mutant.broken != mutant.line
    files, _, keywords = mutant.tests.partition(" -k ")
    texts = [(Path(__file__).parent / f"{name}.py").read_text(encoding="utf-8") for name in files.split()]
    names = [name for text in texts for name in re.findall(r"^def (test_\w+)", text, re.MULTILINE)]
    for keyword in set(re.findall(r"\w+", keywords)) - {"and", "or", "not"}:
        assert any(keyword in name for name in names), f"no test of {files} has {keyword} in its name"


def test_guards_name_modules_that_are_there() -> None:
    for test, names in guards().items():
        for name in names:
            path = PACKAGE.parent.joinpath(*name.split("."))
            assert path.is_dir() or path.with_suffix(".py").is_file(), f"tests/{test}.py: GUARDS names {name}"


@pytest.mark.parametrize("room", CORE)
def test_every_module_of_the_core_is_guarded(room: str) -> None:
    for path in sorted((PACKAGE / room).rglob("*.py")) or [PACKAGE / f"{room}.py"]:
        if path.name != "__init__.py":
            assert guarding(path), f"name {path} in the GUARDS of the test files that should notice what breaks in it"


def test_the_guards_that_name_a_module_most_closely_are_run_first() -> None:
    order = guarding(PACKAGE / "matching" / "partial" / "beam_search.py").split()
    assert order[0] == "test_parts_other_placements"
    assert order.index("test_parts_alternatives") < order.index("test_symmetries")


def test_the_core_of_the_makefile_are_test_files() -> None:
    """A file that was renamed would be missing only after the suite, in ``make shake``."""
    tests = Path(__file__).parent
    makefile = (tests.parent / "Makefile").read_text(encoding="utf-8")
    names = makefile.split("CORE := ")[1].split("\n\n")[0].replace("\\\n", " ").split()
    assert len(names) > 20
    assert [name for name in names if not (tests / f"test_{name}.py").exists()] == []
