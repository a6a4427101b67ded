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
def test_links_paths_names_and_commands_exist(path: Path) -> None:
    content = path.read_text(encoding="utf-8")
    links = re.findall(r"\]\(([^)#]+)", content)
    named = re.findall(r"`((?:src|tests|docs|research)/[\w./-]+)`", content)
    named += re.findall(r"\b((?:src|tests|benchmarks|experiments)/[\w/]+\.py)\b", content)
    for link in [link for link in links if not link.startswith("https://")]:
        made = link.removeprefix("docs/").startswith(("gallery/", "api/"))  # by Sphinx, from examples and docstrings
        assert made or (path.parent / link).exists(), link
    for name in named:
        assert (ROOT / name).exists(), name
    for name in re.findall(r"`(kfmaps(?:\.\w+)+)", content):
        assert exists(name), name
    others = {"is", "functional", "proposes", "that", "wrote", "developers"}
    assert set(re.findall(r"`?kfmaps ([a-z]+)\b(?= |`)", content)) - others <= set(COMMANDS)


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


def test_readme_names_every_command_and_calls_what_is_public() -> None:
    readme = text("README.md")
    for name in COMMANDS:
        assert re.search(rf"\b{name}\b", readme), name
    assert set(re.findall(r"kfmaps\.(\w+)\(", readme)) <= set(kfmaps.__all__)


def test_options_in_the_documents_exist() -> None:
    known = set(OPTIONS) | {"--preset", "--config", "--set", "--seed"}
    assert set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", text("docs/settings.md"))) <= known


def test_picture_is_small() -> None:
    assert (ROOT / "docs" / "images" / "demo.png").stat().st_size <= 300_000


def test_citation_and_version() -> None:
    citation = text("CITATION.cff")
    assert f'version = "{kfmaps.__version__}"' in text("pyproject.toml")
    assert f"version: {kfmaps.__version__}" in citation
    for work in ("Kernel functional maps", "ZoomOut", "Unique signatures", "wave kernel", "nonmanifold"):
        assert work in citation
    assert citation.count("  - type: ") == citation.count("    title: ") == citation.count("    authors:")


def test_the_reference_has_every_public_name() -> None:
    documented = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "docs" / "api").glob("*.rst"))
    entries = set(re.findall(r"^\.\. auto\w+:: kfmaps\.(\w+)$", documented, re.MULTILINE))
    assert set(kfmaps.__all__) <= entries


def test_the_reference_names_what_exists() -> None:
    for path in (ROOT / "docs" / "api").glob("*.rst"):
        for name in re.findall(r"^\.\. auto\w+:: ([\w.]+)$", path.read_text(encoding="utf-8"), re.MULTILINE):
            assert exists(name), name


def test_every_public_name_says_what_it_is() -> None:
    for name in set(kfmaps.__all__) - {"datasets"}:
        text = getattr(kfmaps, name).__doc__ or ""
        # A dataclass without a docstring is given its signature as one.
        assert len(text.strip()) > 15, name
        assert not text.startswith(f"{name}("), name


def test_math_is_a_file_of_the_site() -> None:
    settings = (ROOT / "docs" / "conf.py").read_text(encoding="utf-8")
    assert "://" not in settings
    assert re.search(r'^mathjax_path = "[\w-]+\.js"$', settings, re.MULTILINE)
