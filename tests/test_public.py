"""The package's public names, imported when they are asked for."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import kfmaps

TREE = ast.parse(Path(str(kfmaps.__file__)).read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", kfmaps.__all__)
def test_name(name: str) -> None:
    assert getattr(kfmaps, name) is not None
    assert name in dir(kfmaps)
    documented = getattr(kfmaps, name).__doc__
    assert documented


def test_type_checkers_see_the_same_names() -> None:
    """The imports that only type checkers read are those that happen at run time, from the same modules."""
    guarded = next(node for node in TREE.body if isinstance(node, ast.If))
    seen = {}
    for node in guarded.body:
        assert isinstance(node, ast.ImportFrom)
        seen |= {alias.name: node.module for alias in node.names}
    assert set(seen) == set(kfmaps.__all__)
    for name, module in seen.items():
        assert module is not None
        if name != "datasets":
            assert getattr(sys.modules[module], name) is getattr(kfmaps, name)


def test_unknown_name() -> None:
    with pytest.raises(AttributeError, match="no attribute 'mach'"):
        kfmaps.mach  # noqa: B018  # pyright: ignore[reportAttributeAccessIssue]


def test_import_is_light() -> None:
    code = "import sys, kfmaps; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"numpy", "scipy", "matplotlib", "torch", "trimesh"} & set(done.stdout.split())


def test_version_is_the_installed_one() -> None:
    text = (Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8")
    assert f'version = "{kfmaps.__version__}"' in text
