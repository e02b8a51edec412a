"""The vehicle as an FMU: the plant's source, the shipped FMUs, and what runs any vehicle FMU."""

from fmus.bundled import bundled_fmu
from fmus.errors import (
    FmuBuildError,
    FmuError,
    FmuFileError,
    FmuInterfaceError,
    FmuOutputError,
    FmuPlatformError,
    FmuStartError,
    FmuStateError,
    FmuStepError,
    FmuVariableError,
)
from fmus.fmi import describe
from fmus.model import FmuDescription
from fmus.vehicle import SavedState, VehicleFmu, VehicleVariables

__all__ = [
    "FmuBuildError",
    "FmuDescription",
    "FmuError",
    "FmuFileError",
    "FmuInterfaceError",
    "FmuOutputError",
    "FmuPlatformError",
    "FmuStartError",
    "FmuStateError",
    "FmuStepError",
    "FmuVariableError",
    "SavedState",
    "VehicleFmu",
    "VehicleVariables",
    "bundled_fmu",
    "describe",
]
