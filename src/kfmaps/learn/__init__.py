"""Kernels, metrics and weights learned from pairs of shapes, with PyTorch (``pip install 'kfmaps[learn]'``).

>>> pairs = [kfmaps.learn.training_pair(source, target, config, truth=truth)]  # doctest: +SKIP
>>> model = kfmaps.learn.Model(config, pairs, ["gamma", "metric", "terms"])  # doctest: +SKIP
>>> kfmaps.learn.learn(model, pairs, held_out)  # doctest: +SKIP
>>> kfmaps.match(source, target, model.settings())  # doctest: +SKIP
"""

from typing import Any

from kfmaps._arrays import MissingDependency

try:
    from kfmaps.learn.energy import differentiable_minimum, nystrom_features, pair_energy
    from kfmaps.learn.model import PARTS, Model, TrainingOptions, functional_map, pair_loss, point_error
    from kfmaps.learn.pairs import TrainingPair, training_pair
    from kfmaps.learn.training import Epoch, State, learn, learning_figure, load, save
except ModuleNotFoundError as error:
    if error.name != "torch":
        raise

__all__ = [
    "PARTS",
    "Epoch",
    "Model",
    "State",
    "TrainingOptions",
    "TrainingPair",
    "differentiable_minimum",
    "functional_map",
    "learn",
    "learning_figure",
    "load",
    "nystrom_features",
    "pair_energy",
    "pair_loss",
    "point_error",
    "save",
    "training_pair",
]


def __getattr__(name: str) -> Any:
    """Raise an error that names PyTorch only when a name is used, so that the package can be imported without it."""
    if name in __all__:
        raise MissingDependency("kfmaps.learn needs PyTorch. Install it with: pip install 'kfmaps[learn]'.")
    raise AttributeError(f"module 'kfmaps.learn' has no attribute {name!r}")
