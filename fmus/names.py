"""The public names of the package, which :mod:`fmus` hands out at their first use."""

from fmus.description.model import FmuDescription
from fmus.description.reading import describe
from fmus.driving.kept_folder import keep_unpacked
from fmus.driving.vehicle import VehicleFmu
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
    FmuUnsuitableError,
    FmuVariableError,
)
from fmus.interfaces.vehicle import Vehicle
from fmus.isolation import (
    IsolatedController,
    IsolatedVehicle,
    open_vehicle,
    processes_reused,
)
from fmus.profile.bundled import bundled_fmu, is_bundled
from fmus.profile.controllers.controller_preparation import (
    PreparedController,
    choose_controller_profile,
    prepare_controller,
)
from fmus.profile.controllers.controller_profile import (
    ControllerProfile,
    make_controller_profile,
    read_controller_profile,
)
from fmus.profile.preparation import choose_profile, prepare
from fmus.profile.vehicle_profile import VehicleProfile, make_profile, read_profile
from fmus.sources.export import bundled_controller, export_controller
from fmus.sources.parameters import ControllerParameters

__all__ = [
    "ControllerParameters",
    "ControllerProfile",
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
    "FmuUnsuitableError",
    "FmuVariableError",
    "IsolatedController",
    "IsolatedVehicle",
    "PreparedController",
    "Vehicle",
    "VehicleFmu",
    "VehicleProfile",
    "bundled_controller",
    "bundled_fmu",
    "choose_controller_profile",
    "choose_profile",
    "describe",
    "export_controller",
    "is_bundled",
    "keep_unpacked",
    "make_controller_profile",
    "make_profile",
    "open_vehicle",
    "prepare",
    "prepare_controller",
    "processes_reused",
    "read_controller_profile",
    "read_profile",
]
