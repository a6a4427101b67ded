"""A file of what was learned, from which learning goes on; nothing in it is ever executed."""

from __future__ import annotations

from dataclasses import astuple
from pathlib import Path
from typing import Any

import torch

from kfmaps._arrays import refuse
from kfmaps.io import atomic_output
from kfmaps.learn.training import Epoch, State
from kfmaps.settings.learned import FORMAT, read_learned


def save(path: str | Path, state: State, settings: str, request: dict[str, Any]) -> None:
    """Write a state, the ``settings`` (TOML) of its best parameters, and the ``request`` that it answers.

    ``request`` is of plain values: what a later run must ask for again to go on from here.
    """
    content = {
        "format": FORMAT,
        "settings": settings,
        "request": request,
        "parameters": state.parameters,
        "best": state.best,
        "start": state.start,
        "optimiser": state.optimiser,
        "history": [list(astuple(epoch)) for epoch in state.history],
    }
    with atomic_output(Path(path), force=True) as temporary:
        torch.save(content, temporary)


def load(path: str | Path) -> tuple[State, str, dict[str, Any]]:
    """The state, settings and request of a file that :func:`save` wrote.

    Only tensors and plain values are read (``weights_only``): a file that asks for anything else is refused.

    Raises
    ------
    InvalidInput
        When the file is missing, damaged, or something else.
    """
    content = read_learned(path)
    try:
        history = tuple(Epoch(*row) for row in content["history"])
        tensors = [dict(content[name]) for name in ("parameters", "best", "start")]
        if not all(isinstance(t, torch.Tensor) for part in tensors for t in part.values()):
            raise TypeError("a parameter is no tensor")
        state = State(tensors[0], tensors[1], tensors[2], dict(content["optimiser"]), history)
        return state, str(content["settings"]), dict(content["request"])
    except (KeyError, TypeError, ValueError) as error:
        raise refuse(f"{path}", "a file of kfmaps learn", f"one without {error}", "learn anew") from error
