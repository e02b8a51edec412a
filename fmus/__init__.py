"""Vehicle FMUs, shipped and foreign, the code that runs them, and the controller as an FMU."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fmus.names import *

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


def __getattr__(name: str) -> Any:
    """Import all that has a public name at the first use of one: one module alone needs less."""
    if name not in __all__:
        raise AttributeError(f"module 'fmus' has no attribute '{name}'")
    from fmus import names

    return getattr(names, name)
