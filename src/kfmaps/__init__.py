"""Kernel functional maps: which point of one 3D surface corresponds to which point of another.

>>> import kfmaps
>>> result = kfmaps.match(kfmaps.read_mesh("a.off"), kfmaps.read_mesh("b.off"))  # doctest: +SKIP
>>> result.target_to_source  # a vertex of a for each vertex of b  # doctest: +SKIP
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from kfmaps._arrays import InvalidInput, KfmapsWarning, MissingDependency, NotConverged
    from kfmaps.app import datasets
    from kfmaps.app.files import load_map, read_landmarks, read_mesh, save_map, write_mesh
    from kfmaps.config import BasisConfig, Config, DescriptorConfig, NystromConfig, Search, Weights
    from kfmaps.fit.fit import Match
    from kfmaps.fit.shape import Shape, prepare
    from kfmaps.functional.evaluate import coverage, error_curve, evaluation, geodesic_errors
    from kfmaps.functional.points import to_functional, to_points
    from kfmaps.functional.refine import ICP, ZoomOut
    from kfmaps.functional.solvers import CG, Direct
    from kfmaps.kernel.kernels import Gaussian, Laplacian, Linear, Polynomial, Product, Sum, Tanh
    from kfmaps.matching import match
    from kfmaps.surface.basis import Basis, laplace_basis
    from kfmaps.surface.geodesics import geodesic_distances
    from kfmaps.surface.mesh import Mesh

__version__ = "0.1.0"

__all__ = [
    "CG",
    "ICP",
    "Basis",
    "BasisConfig",
    "Config",
    "DescriptorConfig",
    "Direct",
    "Gaussian",
    "InvalidInput",
    "KfmapsWarning",
    "Laplacian",
    "Linear",
    "Match",
    "Mesh",
    "MissingDependency",
    "NotConverged",
    "NystromConfig",
    "Polynomial",
    "Product",
    "Search",
    "Shape",
    "Sum",
    "Tanh",
    "Weights",
    "ZoomOut",
    "coverage",
    "datasets",
    "error_curve",
    "evaluation",
    "geodesic_distances",
    "geodesic_errors",
    "laplace_basis",
    "load_map",
    "match",
    "prepare",
    "read_landmarks",
    "read_mesh",
    "save_map",
    "to_functional",
    "to_points",
    "write_mesh",
]

# Where each name lives; it is imported when it is first asked for (PEP 562), because SciPy and the mesh readers take
# half a second that `kfmaps --help` need not wait for.
_HOMES = {
    "_arrays": "InvalidInput KfmapsWarning MissingDependency NotConverged",
    "app.files": "load_map read_landmarks read_mesh save_map write_mesh",
    "config": "BasisConfig Config DescriptorConfig NystromConfig Search Weights",
    "fit.fit": "Match",
    "fit.shape": "Shape prepare",
    "functional.evaluate": "coverage error_curve evaluation geodesic_errors",
    "functional.points": "to_functional to_points",
    "functional.refine": "ICP ZoomOut",
    "functional.solvers": "CG Direct",
    "kernel.kernels": "Gaussian Laplacian Linear Polynomial Product Sum Tanh",
    "matching": "match",
    "surface.basis": "Basis laplace_basis",
    "surface.geodesics": "geodesic_distances",
    "surface.mesh": "Mesh",
}


def __getattr__(name: str) -> Any:
    if name == "datasets":
        return importlib.import_module("kfmaps.app.datasets")
    for home, names in _HOMES.items():
        if name in names.split():
            value = globals()[name] = getattr(importlib.import_module(f"kfmaps.{home}"), name)
            return value
    raise AttributeError(f"module 'kfmaps' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
