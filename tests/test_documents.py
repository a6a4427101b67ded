"""README and its neighbours speak of what exists."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import kfmaps
from kfmaps.cli.main import COMMANDS
from kfmaps.settings.catalogue import FLAGS

ROOT = Path(__file__).parents[1]
DOCUMENTS = [
    ROOT / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", *("docs/files.md", "docs/settings.md"))
]


def text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


@pytest.mark.parametrize("path", DOCUMENTS, ids=[path.name for path in DOCUMENTS])
def test_links_and_paths_lead_somewhere(path: Path) -> None:
    content = path.read_text(encoding="utf-8")
    links = re.findall(r"\]\(([^)#]+)", content)
    named = re.findall(r"`((?:src|tests|docs)/[\w./]+)`", content)
    for link in [link for link in links if not link.startswith("https://")]:
        assert (path.parent / link).exists(), link
    for name in named:
        assert (ROOT / name).exists(), name


@pytest.mark.parametrize("path", DOCUMENTS, ids=[path.name for path in DOCUMENTS])
def test_commands_exist(path: Path) -> None:
    for name in re.findall(r"`?kfmaps ([a-z]+)\b(?= |`)", path.read_text(encoding="utf-8")):
        if name in ("is", "functional", "proposes", "that", "wrote", "developers"):
            continue
        assert name in COMMANDS, name


def test_readme_names_every_command() -> None:
    readme = text("README.md")
    for name in COMMANDS:
        assert re.search(rf"\b{name}\b", readme), name


def test_options_in_the_documents_exist() -> None:
    known = set(FLAGS) | {"--preset", "--paper", "--config", "--set", "--seed"}
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
