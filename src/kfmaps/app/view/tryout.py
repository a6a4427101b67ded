"""Matching again and again with other landmarks: what depends on one shape alone is done once."""

from __future__ import annotations

import numpy as np

from kfmaps.app.view.runs import Progress
from kfmaps.config import Config
from kfmaps.matching import default_config, match
from kfmaps.mesh import Mesh
from kfmaps.shape import Shape, prepare


class Tryout:
    """``tryout(landmarks, progress)``: the point map of the two shapes with these landmarks.

    Parameters
    ----------
    source, target : Mesh
    names : (str, str)
        How messages call them.
    config : Config, optional
        By default what :func:`kfmaps.matching.match` takes, with landmarks or without.
    """

    def __init__(self, source: Mesh, target: Mesh, names: tuple[str, str], config: Config | None = None) -> None:
        self._meshes = (source, target)
        self._names = names
        self._config = config
        self._shapes: dict[bool, tuple[Shape, Shape]] = {}

    def __call__(self, landmarks: np.ndarray, progress: Progress) -> np.ndarray:
        some = len(landmarks) > 0
        config = self._config or default_config(landmarks)
        if some not in self._shapes:
            first, second = (
                prepare(mesh, config, name=name, progress=progress)
                for mesh, name in zip(self._meshes, self._names, strict=True)
            )
            self._shapes[some] = (first, second)
        pairs = landmarks if some else None
        return match(*self._shapes[some], config, landmarks=pairs, progress=progress).target_to_source
