"""Settings inside a file of ``kfmaps learn``."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

from kfmaps._arrays import MissingDependency, refuse

SUFFIX = ".pt"
FORMAT = 1
_WANTED, _REMEDY = "a file that kfmaps learn wrote", "check the path, or learn anew"


def read_learned(path: str | Path) -> dict[str, Any]:
    """What the file holds: tensors and plain values. Nothing in it is ever executed.

    Raises
    ------
    InvalidInput
        When the file is missing, damaged, or something else.
    MissingDependency
        Without PyTorch.
    """
    try:
        import torch
    except ImportError as error:
        remedy = "Install it with: pip install 'kfmaps[learn]', or learn to a .toml file"
        raise MissingDependency(f"{path} needs PyTorch. {remedy}.") from error
    try:
        # A file that asks for more than tensors and plain values is refused before anything of it runs.
        content = torch.load(Path(path), map_location="cpu", weights_only=True)
    except OSError as error:
        raise refuse(f"{path}", _WANTED, error.strerror or str(error), _REMEDY) from error
    except (pickle.UnpicklingError, RuntimeError, EOFError, ValueError, KeyError) as error:
        got = (str(error) or type(error).__name__).splitlines()[0][:120]
        raise refuse(f"{path}", _WANTED, got, _REMEDY) from error
    if not isinstance(content, dict) or content.get("format") != FORMAT or not isinstance(content.get("settings"), str):
        raise refuse(f"{path}", _WANTED, "another content or version", _REMEDY)
    return content
