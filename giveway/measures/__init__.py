"""Density, speed and flow of the people by PedPy, and the levels of service."""

from giveway.measures.columns import MEASURE_COLUMNS
from giveway.measures.density_map import DensityMap, density_map
from giveway.measures.measuring import measure_table, require_pedpy
from giveway.measures.service import FRUIN, HCM, level_of_service
from giveway.measures.unreached import unreached

__all__ = [
    "FRUIN",
    "HCM",
    "MEASURE_COLUMNS",
    "DensityMap",
    "density_map",
    "level_of_service",
    "measure_table",
    "require_pedpy",
    "unreached",
]
