"""Parts: what distances on a part say of the whole, and who looks like a part."""

import numpy as np
import pytest

from kfmaps.parts.decide import opening, suspicion
from kfmaps.parts.labels import consistency, gauge
from kfmaps.surface.mesh import Mesh


def ball(n: int = 24) -> Mesh:
    """A sphere of n rings of n vertices, closed."""
    up, around = np.meshgrid(np.linspace(0, np.pi, n)[1:-1], np.arange(n) * 2 * np.pi / n, indexing="ij")
    rings = np.stack([np.sin(up) * np.cos(around), np.sin(up) * np.sin(around), np.cos(up)], axis=2).reshape(-1, 3)
    v = np.concatenate([rings, [[0, 0, 1], [0, 0, -1]]])
    f = []
    for i in range(n - 2):
        for j in range(n):
            a, b = i * n + j, i * n + (j + 1) % n
            if i < n - 3:
                f += [[a, a + n, b], [b, a + n, b + n]]
            if i == 0:
                f.append([len(v) - 2, a, b])
            if i == n - 3:
                f.append([len(v) - 1, b, a])
    return Mesh(v, np.array(f))


def test_a_cut_is_an_opening_and_names_the_part():
    whole = ball()
    half = Mesh(whole.vertices, whole.faces[(whole.vertices[whole.faces, 2] > -0.2).all(axis=1)])
    assert opening(whole) == 0
    assert opening(half) > 0.1
    assert opening(Mesh(7 * half.vertices, half.faces)) == pytest.approx(opening(half))
    assert suspicion(whole, half).which == "target"
    assert suspicion(half, whole).which == "source"
    assert suspicion(half, half).which == suspicion(whole, whole).which == "none"


def test_only_what_a_detour_explains_is_forgiven():
    part = gauge(np.array([[0.0, 0.5], [0.5, 0.0]]), np.array([0.1, 0.1]), 1.0)
    far, low = part.far[0, 1], part.low[0, 1]
    assert low == pytest.approx(0.2)
    fits = [
        float(consistency(np.array([far]), np.array([low]), np.array([d]), (0.02, 0.1))[0]) for d in (0.5, 0.45, 0.55)
    ]
    assert fits[0] == 1
    assert fits[2] < fits[1] < 1
    sure = consistency(np.array([far]), np.array([far]), np.array([0.45]), (0.02, 0.1))[0]
    assert sure < fits[1]
    assert consistency(np.array([np.inf]), np.array([np.inf]), np.array([0.4]), (0.02, 0.1))[0] == 0
