"""README and its neighbours speak of what exists."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import kfmaps
from conftest import exists
from kfmaps.cli.main import COMMANDS
from kfmaps.settings import OPTIONS

ROOT = Path(__file__).parents[1]
PAGES = sorted((ROOT / "docs").glob("*.md"))
RESEARCH = sorted((ROOT / "research").glob("*.md"))
DOCUMENTS = [*(ROOT / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md")), *PAGES, *RESEARCH]
MOST_WORDS, MOST_IN_ALL = 1_200, 15_000
LONGER = "mathematics"
"""The one page that may be longer."""


def text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_links_and_paths_lead_somewhere(path: Path) -> None:
    content = path.read_text(encoding="utf-8")
    links = re.findall(r"\]\(([^)#]+)", content)
    named = re.findall(r"`((?:src|tests|docs|research)/[\w./-]+)`", content)
    named += re.findall(r"\b((?:src|tests|benchmarks|experiments)/[\w/]+\.py)\b", content)
    for link in [link for link in links if not link.startswith("https://")]:
        made = link.removeprefix("docs/").startswith(("gallery/", "api/"))  # by Sphinx, from examples and docstrings
        assert made or (path.parent / link).exists(), link
    for name in named:
        assert (ROOT / name).exists(), name


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_names_of_the_package_exist(path: Path) -> None:
    for name in re.findall(r"`(kfmaps(?:\.\w+)+)", path.read_text(encoding="utf-8")):
        assert exists(name), name


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_commands_exist(path: Path) -> None:
    for name in re.findall(r"`?kfmaps ([a-z]+)\b(?= |`)", path.read_text(encoding="utf-8")):
        if name in ("is", "functional", "proposes", "that", "wrote", "developers"):
            continue
        assert name in COMMANDS, name


def words(path: Path) -> int:
    """How many words a page has, without displayed formulas, code and generated tables."""
    content = re.sub(
        r"^```.*?^```$|^\$\$.*?^\$\$$", "", path.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL
    )
    content = re.sub(r"<!-- begin.*<!-- end -->", "", content, flags=re.DOTALL)
    return sum(bool(re.search(r"\w", word)) for word in content.split())


def test_manual_is_short() -> None:
    lengths = {page.stem: words(page) for page in PAGES}
    assert {name: n for name, n in lengths.items() if n > MOST_WORDS and name != LONGER} == {}
    assert sum(lengths.values()) <= MOST_IN_ALL


def test_every_research_page_begins_with_its_answer() -> None:
    contents = text("research/README.md")
    for page in RESEARCH:
        if page.stem != "README":
            lines = page.read_text(encoding="utf-8").splitlines()
            assert re.fullmatch(r"# .*\?", lines[0]), page.name
            assert lines[2].startswith("**Answer: "), page.name
            assert f"({page.name})" in contents


def test_readme_names_every_command() -> None:
    readme = text("README.md")
    for name in COMMANDS:
        assert re.search(rf"\b{name}\b", readme), name


def test_options_in_the_documents_exist() -> None:
    known = set(OPTIONS) | {"--preset", "--config", "--set", "--seed"}
    for flag in re.findall(r"(?<![\w-])--[a-z][a-z-]*", text("docs/settings.md")):
        assert flag in known, flag


def test_picture_is_small() -> None:
    assert (ROOT / "docs" / "images" / "demo.png").stat().st_size <= 300_000


def test_citation() -> None:
    citation = text("CITATION.cff")
    assert f"version: {kfmaps.__version__}" in citation
    for work in (
        "Kernel functional maps",
        "ZoomOut",
        "Unique signatures",
        "wave kernel",
        "nonmanifold",
        "commutativity",
    ):
        assert work in citation
    assert citation.count("  - type: ") == citation.count("    title: ") == citation.count("    authors:")


def test_readme_call_is_public() -> None:
    for name in re.findall(r"kfmaps\.(\w+)\(", text("README.md")):
        assert name in kfmaps.__all__
