"""The vehicle as an FMU: the plant's source, the shipped FMUs, and what runs any vehicle FMU."""

from fmus.bundled import bundled_fmu, is_bundled
from fmus.errors import (
    FmuArchiveError,
    FmuBuildError,
    FmuCrashError,
    FmuError,
    FmuFileError,
    FmuInterfaceError,
    FmuOutputError,
    FmuPlatformError,
    FmuProfileError,
    FmuStartCrashError,
    FmuStartError,
    FmuStateError,
    FmuStepError,
    FmuVariableError,
)
from fmus.fmi.reading import describe
from fmus.isolation import IsolatedVehicle, open_vehicle
from fmus.model import FmuDescription
from fmus.preparation import choose_profile, prepare
from fmus.profile import VehicleProfile, make_profile, read_profile
from fmus.vehicle import SavedState, VehicleFmu
from fmus.vehicle_protocol import Vehicle

__all__ = [
    "FmuArchiveError",
    "FmuBuildError",
    "FmuCrashError",
    "FmuDescription",
    "FmuError",
    "FmuFileError",
    "FmuInterfaceError",
    "FmuOutputError",
    "FmuPlatformError",
    "FmuProfileError",
    "FmuStartCrashError",
    "FmuStartError",
    "FmuStateError",
    "FmuStepError",
    "FmuVariableError",
    "IsolatedVehicle",
    "SavedState",
    "Vehicle",
    "VehicleFmu",
    "VehicleProfile",
    "bundled_fmu",
    "choose_profile",
    "describe",
    "is_bundled",
    "make_profile",
    "open_vehicle",
    "prepare",
    "read_profile",
]
