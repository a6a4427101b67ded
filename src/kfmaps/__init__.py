"""Kernel functional maps: which point of one 3D surface corresponds to which point of another.

>>> import kfmaps
>>> result = kfmaps.match(kfmaps.read_mesh("a.off"), kfmaps.read_mesh("b.off"))  # doctest: +SKIP
>>> result.target_to_source  # a vertex of a for each vertex of b  # doctest: +SKIP
"""

from __future__ import annotations

import importlib
import re
from pathlib import Path
from typing import Any

__version__ = "0.1.0"

# The stub beside this file is the only list of public names. A name is imported when it is first used (PEP 562), since
# SciPy and the mesh readers take half a second, for which `kfmaps --help` need not wait.
_HOMES = {
    name: home
    for home, name in re.findall(
        r"^from (\S+) import (\w+) as \2$", Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8"), re.MULTILINE
    )
}

__all__ = sorted(_HOMES)  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(f"module 'kfmaps' has no attribute {name!r}")
    packages = home == __name__
    value = importlib.import_module(f"{home}.{name}") if packages else getattr(importlib.import_module(home), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
