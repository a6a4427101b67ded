"""Matching again and again with other landmarks: what depends on one shape alone is done once."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from kfmaps.config import Config
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.provenance import with_files
from kfmaps.matching.match import default_config, match
from kfmaps.matching.result import Match
from kfmaps.shape import Shape, prepare
from kfmaps.viz.runs import Progress


class InteractiveMatcher:
    """``matcher(landmarks, progress)``: the map of the two shapes with these landmarks, ready to be saved.

    ``names``: how messages call them; ``paths``: their files, which the saved map names. ``settings``: The
    configuration for some landmarks (l, 2); by default what :func:`kfmaps.matching.match.match` takes. It may differ
    between none and some, not between some and others.
    """

    def __init__(
        self,
        source: Mesh,
        target: Mesh,
        names: tuple[str, str],
        paths: tuple[Path, Path],
        settings: Callable[[np.ndarray], Config] = lambda _: default_config(),
    ) -> None:
        self._meshes = (source, target)
        self._names = names
        self._paths = paths
        self._settings = settings
        self._shapes: dict[bool, tuple[Shape, Shape]] = {}

    def __call__(self, landmarks: np.ndarray, progress: Progress) -> Match:
        some = len(landmarks) > 0
        config = self._settings(landmarks)
        if some not in self._shapes:
            first, second = (
                prepare(mesh, config, name=name, progress=progress)
                for mesh, name in zip(self._meshes, self._names, strict=True)
            )
            self._shapes[some] = (first, second)
        pairs = landmarks if some else None
        found = match(*self._shapes[some], config, landmarks=pairs, progress=progress)
        return with_files(found, self._paths, self._meshes)
