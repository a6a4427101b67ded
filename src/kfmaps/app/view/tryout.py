"""Matching again and again with other landmarks: what depends on one shape alone is done once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from kfmaps.app.view.runs import Progress
from kfmaps.config import Config
from kfmaps.fit.shape import Shape, prepare
from kfmaps.matching import default_config, match
from kfmaps.surface.mesh import Mesh


class Tryout:
    """``tryout(landmarks, progress)``: the point map of the two shapes with these landmarks.

    Parameters
    ----------
    source, target : Mesh
    names : (str, str)
        How messages call them.
    settings : callable
        The configuration for some landmarks (l, 2); by default what :func:`kfmaps.matching.match` takes. It may
        differ between none and some, not between some and others.
    """

    def __init__(
        self,
        source: Mesh,
        target: Mesh,
        names: tuple[str, str],
        settings: Callable[[np.ndarray], Config] = default_config,
    ) -> None:
        self._meshes = (source, target)
        self._names = names
        self._settings = settings
        self._shapes: dict[bool, tuple[Shape, Shape]] = {}

    def __call__(self, landmarks: np.ndarray, progress: Progress) -> np.ndarray:
        some = len(landmarks) > 0
        config = self._settings(landmarks)
        if some not in self._shapes:
            first, second = (
                prepare(mesh, config, name=name, progress=progress)
                for mesh, name in zip(self._meshes, self._names, strict=True)
            )
            self._shapes[some] = (first, second)
        pairs = landmarks if some else None
        return match(*self._shapes[some], config, landmarks=pairs, progress=progress).target_to_source
