"""FMUs: the shipped vehicle, what runs anybody's, and the controller as one."""

from fmus.bundled import bundled_fmu, is_bundled
from fmus.controller_fmu.export import bundled_controller, export_controller
from fmus.controller_fmu.parameters import ControllerParameters
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
    "ControllerParameters",
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
    "bundled_controller",
    "bundled_fmu",
    "choose_profile",
    "describe",
    "export_controller",
    "is_bundled",
    "make_profile",
    "open_vehicle",
    "prepare",
    "read_profile",
]
