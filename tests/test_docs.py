"""The documentation names everything that is public, and fetches nothing."""

from __future__ import annotations

import re
from pathlib import Path

import kfmaps
from conftest import exists

DOCS = Path(__file__).parents[1] / "docs"


def test_the_reference_has_every_public_name():
    documented = "\n".join(path.read_text(encoding="utf-8") for path in (DOCS / "api").glob("*.rst"))
    entries = set(re.findall(r"^\.\. auto\w+:: kfmaps\.(\w+)$", documented, re.MULTILINE))
    assert set(kfmaps.__all__) <= entries


def test_the_reference_names_what_exists():
    for path in (DOCS / "api").glob("*.rst"):
        for name in re.findall(r"^\.\. auto\w+:: ([\w.]+)$", path.read_text(encoding="utf-8"), re.MULTILINE):
            assert exists(name), name


def test_every_public_name_says_what_it_is():
    for name in set(kfmaps.__all__) - {"datasets"}:
        text = getattr(kfmaps, name).__doc__ or ""
        # A dataclass without a docstring is given its signature as one.
        assert len(text.strip()) > 15, name
        assert not text.startswith(f"{name}("), name


def test_math_is_a_file_of_the_site():
    settings = (DOCS / "conf.py").read_text(encoding="utf-8")
    assert "://" not in settings
    assert re.search(r'^mathjax_path = "[\w-]+\.js"$', settings, re.MULTILINE)
