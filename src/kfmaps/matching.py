"""The one call."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Any

import numpy as np

from kfmaps._threads import available_cores, parallel
from kfmaps.config import Config
from kfmaps.fit.fit import Match, fit
from kfmaps.fit.shape import Progress, Shape, prepare
from kfmaps.functional.confidence import local_confidence
from kfmaps.search.choose import choose
from kfmaps.surface.eigen.pencil import THREADED
from kfmaps.surface.mesh import Mesh


def match(
    source: Mesh | Shape,
    target: Mesh | Shape,
    config: Config | None = None,
    *,
    landmarks: Any = None,
    descriptors: tuple[Any, Any] | None = None,
    rng: int | np.random.Generator | None = 0,
    progress: Progress | None = None,
) -> Match:
    """Find for each vertex of ``target`` the corresponding vertex of ``source``.

    With landmarks they settle which way round a symmetric shape goes, and one fit is made. Without, several
    candidate maps are fitted and compared (:mod:`kfmaps.search.choose`), and the answer says how sure it is.

    Parameters
    ----------
    source, target : Mesh or Shape
        A :class:`Shape` from :func:`prepare` saves the work that depends on one shape alone; it must come from the
        same configuration.
    config : Config, optional
        ``Config()`` with landmarks or given descriptors, ``Config.automatic()`` without.
    landmarks : (l, 2) whole numbers, optional
        Pairs "source vertex, target vertex", 0-based.
    descriptors : pair of arrays (n_s, d), (n_t, d), optional
        Of the user's own, used beside those that the configuration names.
    rng : seed or Generator
        The same seed gives the same answer.
    progress : callable, optional
        ``progress(stage, done)`` with done from 0 to 1.

    Raises
    ------
    InvalidInput
        When a mesh, the landmarks or the descriptors cannot be used; the message says what to do.
    NotConverged
        When the eigensolver misses its tolerance.
    """
    config = config or default_config(landmarks, descriptors)
    shapes = _prepared(source, target, config, progress)
    search = config.search is not None and not has_landmarks(landmarks)
    answer = choose if search else fit
    found = answer(
        shapes[0], shapes[1], config, landmarks=landmarks, descriptors=descriptors, rng=rng, progress=progress
    )
    start = time.perf_counter()
    trust = local_confidence(shapes[0].mesh, shapes[1].mesh, found.target_to_source)
    seconds = {**found.seconds, "confidence": time.perf_counter() - start}
    return replace(found, local_confidence=trust, seconds=seconds)


def _prepared(source: Mesh | Shape, target: Mesh | Shape, config: Config, progress: Progress | None) -> list[Shape]:
    """Both shapes; side by side where they are small, since one small eigenproblem has no use for several cores."""
    workers = config.threads or available_cores()
    meshes = [part for part in (source, target) if isinstance(part, Mesh)]
    aside = len(meshes) == 2 and max(len(mesh.vertices) for mesh in meshes) < THREADED
    share = replace(config, threads=max(1, workers // 2)) if aside else config

    def ready(part: Mesh | Shape, name: str) -> Shape:
        return part if isinstance(part, Shape) else prepare(part, share, name=name, progress=progress)

    both = ((source, "source"), (target, "target"))
    return parallel(lambda item: ready(*item), both, min(workers, 2) if aside else 1)


def has_landmarks(landmarks: Any) -> bool:
    """Whether there is at least one pair."""
    return landmarks is not None and np.asarray(landmarks).size > 0


def default_config(landmarks: Any = None, descriptors: Any = None) -> Config:
    """What :func:`match` uses when no configuration is given."""
    return Config() if has_landmarks(landmarks) or descriptors is not None else Config.automatic()
