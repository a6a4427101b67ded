# The public names, said once: type checkers read them here, and __init__.py imports each from where this says it is.

from kfmaps._arrays import InvalidInput as InvalidInput
from kfmaps._arrays import KfmapsWarning as KfmapsWarning
from kfmaps._arrays import MissingDependency as MissingDependency
from kfmaps._arrays import NotConverged as NotConverged
from kfmaps.app import datasets as datasets
from kfmaps.app import learn as learn
from kfmaps.app.api import Match as Match
from kfmaps.app.api import match as match
from kfmaps.app.api import prepare as prepare
from kfmaps.app.api import render as render
from kfmaps.app.api import transfer as transfer
from kfmaps.app.api import view as view
from kfmaps.app.collected import Collection as Collection
from kfmaps.app.collected import collection as collection
from kfmaps.app.files import load_map as load_map
from kfmaps.app.files import read_landmarks as read_landmarks
from kfmaps.app.files import read_mesh as read_mesh
from kfmaps.app.files import save_map as save_map
from kfmaps.app.files import write_mesh as write_mesh
from kfmaps.config import BasisConfig as BasisConfig
from kfmaps.config import Config as Config
from kfmaps.config import DescriptorConfig as DescriptorConfig
from kfmaps.config import Formulation as Formulation
from kfmaps.config import NystromConfig as NystromConfig
from kfmaps.config import Search as Search
from kfmaps.config import Weights as Weights
from kfmaps.fit.shape import Shape as Shape
from kfmaps.functional.evaluate import coverage as coverage
from kfmaps.functional.evaluate import error_curve as error_curve
from kfmaps.functional.evaluate import evaluation as evaluation
from kfmaps.functional.evaluate import geodesic_errors as geodesic_errors
from kfmaps.functional.nonrigid import NonRigid as NonRigid
from kfmaps.functional.points import to_functional as to_functional
from kfmaps.functional.points import to_points as to_points
from kfmaps.functional.precise import PointMap as PointMap
from kfmaps.functional.refine import ICP as ICP
from kfmaps.functional.refine import ZoomOut as ZoomOut
from kfmaps.functional.solvers import CG as CG
from kfmaps.functional.solvers import Direct as Direct
from kfmaps.kernel.kernels import Gaussian as Gaussian
from kfmaps.kernel.kernels import Laplacian as Laplacian
from kfmaps.kernel.kernels import Linear as Linear
from kfmaps.kernel.kernels import Polynomial as Polynomial
from kfmaps.kernel.kernels import Product as Product
from kfmaps.kernel.kernels import Sum as Sum
from kfmaps.kernel.kernels import Tanh as Tanh
from kfmaps.kernel.lifted import Metric as Metric
from kfmaps.kernel.lifted import Network as Network
from kfmaps.kernel.lifted import Scaled as Scaled
from kfmaps.surface.basis import Basis as Basis
from kfmaps.surface.basis import laplace_basis as laplace_basis
from kfmaps.surface.geodesics import geodesic_distances as geodesic_distances
from kfmaps.surface.mesh import Mesh as Mesh

__version__: str
__all__: list[str]
