"""All experiments by name."""

from __future__ import annotations

from collections.abc import Callable

from kfmaps._arrays import refuse
from kfmaps.experiments.figure2 import figure2
from kfmaps.experiments.figure3 import figure3
from kfmaps.experiments.figure4 import figure4
from kfmaps.experiments.figure5 import figure5
from kfmaps.experiments.figure6 import figure6
from kfmaps.experiments.figure7 import figure7
from kfmaps.experiments.formulations import formulations
from kfmaps.experiments.outputs import Outcome
from kfmaps.experiments.section44 import section44
from kfmaps.experiments.setting import Setting

FIGURES: dict[str, Callable[[Setting], Outcome]] = {
    "figure2": figure2,
    "figure3": figure3,
    "figure4": figure4,
    "figure5": figure5,
    "figure6": figure6,
    "figure7": figure7,
    "section44": section44,
    "formulations": formulations,
}


def named(name: str) -> list[str]:
    """The experiments that ``name`` stands for: one, or with "all" every one. "2" and "4.4" are understood too.

    Raises
    ------
    InvalidInput
        When there is none of that name.
    """
    if name == "all":
        return list(FIGURES)
    short = {figure.removeprefix("figure"): figure for figure in FIGURES} | {"4.4": "section44"}
    found = short.get(name, name)
    if found not in FIGURES:
        raise refuse("figure", "all or one of " + ", ".join(FIGURES), repr(name), "choose one of them")
    return [found]
