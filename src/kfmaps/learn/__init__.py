"""Kernels, metrics and weights learned from pairs of shapes, with PyTorch (``pip install 'kfmaps[learn]'``).

>>> lessons = [kfmaps.learn.lesson(source, target, config, truth=truth)]  # doctest: +SKIP
>>> model = kfmaps.learn.Model(config, lessons, ["gamma", "ard", "terms"])  # doctest: +SKIP
>>> kfmaps.learn.learn(model, lessons, held_out)  # doctest: +SKIP
>>> kfmaps.match(source, target, model.settings())  # doctest: +SKIP
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from kfmaps._arrays import MissingDependency

if TYPE_CHECKING:
    from kfmaps.learn.checkpoint import load, save
    from kfmaps.learn.curve import learning_figure
    from kfmaps.learn.energies import features, pair_energy
    from kfmaps.learn.fitting import functional_map, pair_loss, point_error
    from kfmaps.learn.implicit import Minimum, minimiser
    from kfmaps.learn.lessons import Known, Lesson, lesson
    from kfmaps.learn.model import Model
    from kfmaps.learn.names import LOSSES, PARTS
    from kfmaps.learn.training import Epoch, State, Training, learn

__all__ = [
    "LOSSES",
    "PARTS",
    "Epoch",
    "Known",
    "Lesson",
    "Minimum",
    "Model",
    "State",
    "Training",
    "features",
    "functional_map",
    "learn",
    "learning_figure",
    "lesson",
    "load",
    "minimiser",
    "pair_energy",
    "pair_loss",
    "point_error",
    "save",
]

_HOMES = {
    "checkpoint": "load save",
    "curve": "learning_figure",
    "energies": "features pair_energy",
    "fitting": "functional_map pair_loss point_error",
    "implicit": "Minimum minimiser",
    "lessons": "Known Lesson lesson",
    "model": "Model",
    "names": "LOSSES PARTS",
    "training": "Epoch State Training learn",
}


def __getattr__(name: str) -> Any:
    """Names are imported when they are first asked for: only then must PyTorch be there.

    Raises
    ------
    MissingDependency
        When it is not.
    """
    for home, names in _HOMES.items():
        if name in names.split():
            try:
                value = globals()[name] = getattr(importlib.import_module(f"kfmaps.learn.{home}"), name)
            except ModuleNotFoundError as error:
                if error.name != "torch":
                    raise
                text = "kfmaps.learn needs PyTorch; install it with: pip install 'kfmaps[learn]'"
                raise MissingDependency(text) from error
            return value
    raise AttributeError(f"module 'kfmaps.learn' has no attribute {name!r}")
