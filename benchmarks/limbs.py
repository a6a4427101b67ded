"""Limbs of generated bodies, for ``benchmarks/kinds.py``."""

from __future__ import annotations

import numpy as np

from kfmaps.datasets.skeleton import Limb

Balls = tuple[tuple[float, float, float, float], ...]


def sided(*limbs: tuple[str, str | None, Balls]) -> tuple[Limb, ...]:
    """Limbs, those named "left" with their mirror images."""
    found = []
    for name, parent, balls in limbs:
        found.append(Limb(name, parent, balls))
        if name.startswith("left"):
            image = tuple((-x, y, z, r) for x, y, z, r in balls)
            found.append(Limb(name.replace("left", "right"), parent and parent.replace("left", "right"), image))
    return tuple(found)


def around(count: int, balls: Balls) -> tuple[Limb, ...]:
    """``count`` equal arms around the y axis."""
    found = []
    for i in range(count):
        c, s = np.cos(2 * np.pi * i / count), np.sin(2 * np.pi * i / count)
        found.append(Limb(f"arm {i}", "trunk", tuple((c * x - s * z, y, s * x + c * z, r) for x, y, z, r in balls)))
    return tuple(found)
