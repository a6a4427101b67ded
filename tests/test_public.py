"""The package's public names, imported when they are asked for."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import kfmaps

STUB = Path(str(kfmaps.__file__)).with_suffix(".pyi")


@pytest.mark.parametrize("name", kfmaps.__all__)
def test_name(name: str) -> None:
    assert getattr(kfmaps, name) is not None
    assert name in dir(kfmaps)
    documented = getattr(kfmaps, name).__doc__
    assert documented


def test_what_type_checkers_read_is_what_is_imported() -> None:
    """Every import of the stub, read by Python's own parser, is a public name, and from the module that it names."""
    seen = {}
    for node in ast.parse(STUB.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ImportFrom):
            for alias in node.names:
                assert alias.asname == alias.name, f"{alias.name}: without 'as' type checkers take it for private"
                seen[alias.name] = node.module
    assert sorted(seen) == kfmaps.__all__
    for name, module in seen.items():
        value = getattr(kfmaps, name)
        assert module is not None
        assert value is sys.modules.get(f"{module}.{name}", None) or value is getattr(sys.modules[module], name)


def test_stub_is_in_the_package() -> None:
    """It is read when the package is imported, so a wheel must carry it: everything in the package's folder goes in."""
    text = (Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8")
    assert STUB.is_file()
    assert 'packages = ["src/kfmaps"]' in text
    assert "exclude" not in text


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
