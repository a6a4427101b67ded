"""The package's public names, imported when they are asked for."""

from __future__ import annotations

import ast
import dataclasses
import importlib
import inspect
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

import kfmaps
from conftest import blob
from kfmaps.datasets import ExamplePair

STUB = Path(str(kfmaps.__file__)).with_suffix(".pyi")
API = Path(__file__).parent.parent / "docs" / "api"
DIRECTIVE = re.compile(r"^\.\. auto(\w+):: (\S+)((?:\n   :.*)*)", re.MULTILINE)
RECORDS = {"Basis", "Config", "Energy", "Kernel", "KernelLike", "Mesh", "MeshFile", "Model", "PointMap", "Shape"}
RECORDS |= {"Term", "View"}


def test_the_stub_names_what_is_imported() -> None:
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


def test_no_other_name() -> None:
    assert dir(kfmaps) == sorted([*kfmaps.__all__, "__version__"])
    with pytest.raises(AttributeError, match="no attribute 'mach'"):
        kfmaps.mach  # noqa: B018  # pyright: ignore[reportAttributeAccessIssue]


def test_import_is_light() -> None:
    code = "import sys, kfmaps; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"numpy", "scipy", "matplotlib", "torch", "trimesh"} & set(done.stdout.split())


SAME = {"app", "geodesic_errors", "learn", "main", "match", "prepare", "transfer", "view"}
"""Names that several modules define for one thing: the function of the API, what it calls, and the command."""


def defined(path: Path) -> Iterator[str]:
    """Yield the public functions, classes and constants that a module defines."""
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node.name
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            yield from (name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name))


def test_a_public_name_has_one_meaning() -> None:
    homes = defaultdict(list)
    for path in STUB.parent.rglob("*.py"):
        for name in set(defined(path)):
            if not name.startswith("_"):
                homes[name].append(str(path.relative_to(STUB.parent)))
    assert {name: paths for name, paths in homes.items() if len(paths) > 1 and name not in SAME} == {}
    assert len(SAME) <= 10


@pytest.mark.parametrize("module", ["kfmaps", "kfmaps.io", "kfmaps.viz", "kfmaps.learn", "kfmaps.datasets"])
def test_public_records_with_arrays_have_a_short_repr(module: str) -> None:
    """The one that dataclasses make, which is wrapped against recursion, prints arrays in many lines."""
    if module == "kfmaps.learn":
        pytest.importorskip("torch")
    home = importlib.import_module(module)
    for record in (getattr(home, name) for name in getattr(home, "__all__", vars(home))):
        if isinstance(record, type) and dataclasses.is_dataclass(record):
            types = " ".join(str(f.type) for f in dataclasses.fields(record))
            if any(kind in types for kind in ("rray", "Tensor", "Mesh", "Basis", "Shape", "Config")):
                assert not hasattr(record.__repr__, "__wrapped__"), record


def test_repr_is_one_line() -> None:
    mesh = blob(300)
    pair = ExamplePair("blobs", mesh, mesh, np.arange(300), np.zeros(300, dtype=np.int64), np.eye(300, 3))
    found = kfmaps.match(mesh, mesh, kfmaps.Config.single_fit(), landmarks=np.arange(4)[:, None].repeat(2, axis=1))
    assert repr(mesh) == f"Mesh(300 vertices, {len(mesh.faces)} faces)"
    assert repr(kfmaps.Config()) == "Config()"
    assert repr(kfmaps.Config(kernel=kfmaps.Laplacian(2.0))) == "Config(kernel=Laplacian(gamma=2.0))"
    assert repr(found.basis_source).startswith("Basis(eigenvalues=<")
    records = [pair, found, found.score, found.registration, found.partial, found.fit, kfmaps.prepare(mesh)]
    for record in [*records, found.basis_target, kfmaps.Config.paper(), kfmaps.Config.single_fit()]:
        assert "\n" not in repr(record)
        assert len(repr(record)) < 400


def reference() -> Iterator[tuple[str, Callable]]:
    """Yield the functions and methods that the pages of docs/api show, with their names."""
    for page in sorted(API.glob("*.rst")):
        for kind, name, options in DIRECTIVE.findall(page.read_text(encoding="utf-8")):
            output = dict(re.findall(r":([\w-]+):(.*)", options))
            home = importlib.import_module(name if kind == "module" else name.rpartition(".")[0])
            own = [one for one, value in vars(home).items() if getattr(value, "__module__", "") == name]
            named = output.get("members", "").replace(",", " ").split()
            members = (named or own if "members" in output else []) if kind == "module" else [name.rpartition(".")[2]]
            for one in members:
                value = getattr(home, one)
                if one.startswith("_") or one in output.get("exclude-members", "").replace(",", " ").split():
                    continue
                if inspect.isfunction(value):
                    yield one, value
                elif inspect.isclass(value) and "members" in output:
                    methods = [n for n in vars(value) if not n.startswith("_") and (kind == "module" or not named)]
                    yield from ((f"{one}.{n}", f) for n in methods if inspect.isfunction(f := getattr(value, n)))


def test_the_reference_explains_every_argument() -> None:
    """A parameter is named in the documentation, or is a record of the package, whose name says enough."""
    pytest.importorskip("torch")
    left, count = [], 0
    for label, function in reference():
        text = inspect.getdoc(function) or ""
        for parameter in inspect.signature(function).parameters.values():
            words = set(re.findall(r"[A-Za-z_]\w*", str(parameter.annotation))) - {"None"}
            plain = bool(words) and words <= RECORDS
            count += 1
            if text and parameter.name != "self" and not plain and not re.search(rf"\b{parameter.name}\b", text):
                left.append(f"{label}: {parameter.name}")
    assert count > 300
    assert left == []
