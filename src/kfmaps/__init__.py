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
    from kfmaps.evaluate import coverage, error_curve, evaluation, geodesic_errors
    from kfmaps.geodesics import geodesic_distances
    from kfmaps.kernels import Gaussian, Laplacian, Linear, Polynomial, Product, Sum, Tanh
    from kfmaps.maps import to_functional, to_points
    from kfmaps.matching import match
    from kfmaps.mesh import Mesh
    from kfmaps.pipeline import Match
    from kfmaps.refine import ICP, ZoomOut
    from kfmaps.shape import Shape, prepare
    from kfmaps.solvers import CG, Direct
    from kfmaps.spectrum import Basis, laplace_basis

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
    "evaluate": "coverage error_curve evaluation geodesic_errors",
    "geodesics": "geodesic_distances",
    "kernels": "Gaussian Laplacian Linear Polynomial Product Sum Tanh",
    "maps": "to_functional to_points",
    "matching": "match",
    "mesh": "Mesh",
    "pipeline": "Match",
    "refine": "ICP ZoomOut",
    "shape": "Shape prepare",
    "solvers": "CG Direct",
    "spectrum": "Basis laplace_basis",
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
