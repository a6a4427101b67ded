"""Every number of a match: one tree of frozen records, whose fields carry their help, bounds and options."""

from __future__ import annotations

from kfmaps.config.config import KINDS, RECORDS, Config, as_dict, from_dict
from kfmaps.config.sections import (
    BasisConfig,
    DescriptorConfig,
    Formulation,
    NystromConfig,
    Partial,
    Sampling,
    Search,
    Weights,
)

__all__ = [
    "KINDS",
    "RECORDS",
    "BasisConfig",
    "Config",
    "DescriptorConfig",
    "Formulation",
    "NystromConfig",
    "Partial",
    "Sampling",
    "Search",
    "Weights",
    "as_dict",
    "from_dict",
]
