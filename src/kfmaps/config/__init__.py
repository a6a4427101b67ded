"""Every number of a match: one tree of frozen records, whose fields carry their help, bounds and options."""

from kfmaps.config.config import FORMULATIONS as FORMULATIONS
from kfmaps.config.config import KINDS as KINDS
from kfmaps.config.config import RECORDS as RECORDS
from kfmaps.config.config import Config as Config
from kfmaps.config.config import as_dict as as_dict
from kfmaps.config.config import from_dict as from_dict
from kfmaps.config.sections import BasisConfig as BasisConfig
from kfmaps.config.sections import DescriptorConfig as DescriptorConfig
from kfmaps.config.sections import Formulation as Formulation
from kfmaps.config.sections import NystromConfig as NystromConfig
from kfmaps.config.sections import Partial as Partial
from kfmaps.config.sections import Sampling as Sampling
from kfmaps.config.sections import Search as Search
from kfmaps.config.sections import Weights as Weights
