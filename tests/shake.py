"""What another processor or linear algebra library would change, changed on purpose: ``pytest --shake SEED``.

Eigenvalues move by units in the last place, that of the constant is exactly 0 or −1e-17; eigenfunctions change sign,
those of equal eigenvalues are rotated among each other; results of products move by 1e-15. All of it comes from the
seed and the arrays alone, so that the same input still gives the same answer. What a test finds wrong under a shake
hangs on the last bits.
"""

from __future__ import annotations

import importlib
import pkgutil
import sys
import threading
from collections.abc import Callable
from dataclasses import replace
from functools import wraps
from typing import Any
from zlib import crc32

import numpy as np

import kfmaps
from kfmaps._arrays import like, to_numpy
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.eigen.eigensolver import Eigenpairs, smallest_eigenpairs

EQUAL = 1e-9
"""Relative difference, and part of the scale of the smallest, below which eigenvalues count as equal."""
ROOMS = ("kernels", "geometry", "descriptors", "fmap", "registration", "matching")
PRODUCTS = {
    "kernels.kernels": ("kernel_matrix",),
    "descriptors.spectral": ("heat_signature", "wave_signature", "heat_map", "wave_map"),
    "descriptors.shot": ("shot",),
    "fmap.multiplication_operators": ("multiplication_operators",),
}
"""Functions whose results are products, each entry of which moves."""


def shaken(pairs: Eigenpairs, mass: np.ndarray, seed: int) -> Eigenpairs:
    """The same eigenpairs, as another machine might return them."""
    values, vectors = pairs.values.copy(), pairs.vectors.copy()
    draw = _draw(seed, "eigenpairs", vectors.shape)
    unit = 4 * np.pi / mass.sum()
    edges = np.flatnonzero(np.diff(values) > EQUAL * (values[1:] + unit)) + 1
    for run in np.split(np.arange(len(values)), edges):
        vectors[:, run] = vectors[:, run] @ np.linalg.qr(draw.normal(size=(len(run), len(run))))[0]
    vectors *= draw.choice([-1.0, 1.0], len(values))
    values *= 1 + np.finfo(float).eps * draw.integers(-3, 4, len(values))
    values.sort()
    if values[0] < 1e-6 * unit:
        values[0] = (0.0, -1e-17)[seed % 2]
    return Eigenpairs(values, vectors * _near_one(draw, vectors.shape), pairs.residuals)


def install(seed: int) -> None:
    """Replace the eigensolver's and the products' results by shaken ones, in every module that has them."""
    for room in ROOMS:
        package = importlib.import_module(f"kfmaps.{room}")
        for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            importlib.import_module(found.name)

    exact = smallest_eigenpairs

    @wraps(exact)
    def solver(stiffness: Any, mass: np.ndarray, *arguments: Any, **settings: Any) -> Eigenpairs:
        return shaken(exact(stiffness, mass, *arguments, **settings), mass, seed)

    # Where it is used, not where it is defined and tested.
    vars(importlib.import_module("kfmaps.geometry.basis"))["smallest_eigenpairs"] = solver
    for module, names in PRODUCTS.items():
        for name in names:
            original = getattr(importlib.import_module(f"kfmaps.{module}"), name)
            _everywhere(original, _moved(original, seed))
    for name in ("project", "reconstruct"):
        setattr(Basis, name, _moved(getattr(Basis, name), seed))
    mesh = importlib.import_module("kfmaps.geometry.mesh")
    scaled = mesh.unit_area

    @wraps(scaled)
    def unit_area(given: Any) -> Any:
        found = scaled(given)
        return replace(found, vertices=found.vertices * _own_factor(found.vertices, seed))

    _everywhere(scaled, unit_area)


def _moved(original: Callable[..., Any], seed: int) -> Callable[..., Any]:
    running = threading.local()

    @wraps(original)
    def moved(*arguments: Any, **settings: Any) -> Any:
        if getattr(running, "inside", False):  # it calls itself
            return original(*arguments, **settings)
        running.inside = True
        try:
            result = original(*arguments, **settings)
        finally:
            running.inside = False
        return result * like(_own_factor(abs(to_numpy(result)), seed), result)

    return moved


def _own_factor(values: np.ndarray, seed: int) -> np.ndarray:
    """Numbers near one, by a hash of each value: equal numbers, such as those of a vertex given twice, stay equal.

    Whole numbers, such as a kernel's 1 between equal rows, come out the same everywhere and stay.
    """
    bits = np.ascontiguousarray(values, dtype=np.float64).view(np.uint64)
    mixed = (bits ^ np.uint64(seed)) * np.uint64(0x9E3779B97F4A7C15)
    moves = 2.0 * (mixed >> np.uint64(11)).astype(np.float64) / 2**53 - 1
    return np.where(values == np.rint(values), 1.0, 1 + 1e-15 * moves)


def _everywhere(original: Any, new: Any) -> None:
    for name, module in list(sys.modules.items()):
        if name.split(".")[0] == kfmaps.__name__:
            for attribute, value in list(vars(module).items()):
                if value is original:
                    setattr(module, attribute, new)


def _draw(seed: int, name: str, shape: tuple[int, ...]) -> np.random.Generator:
    return np.random.default_rng([seed, crc32(name.encode()), *shape])


def _near_one(draw: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    return 1 + 1e-15 * draw.uniform(-1, 1, shape)
