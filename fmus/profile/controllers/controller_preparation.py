"""The preparation of a controller FMU: reading it, choosing a profile, and checking both.

As with vehicles, faults of a file or a profile are reported here, before native code is loaded.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from fmus.description.binaries import binary_of
from fmus.description.model import Value
from fmus.description.reading import read_model
from fmus.profile.clocks import tickings_of
from fmus.profile.controllers.controller_draft import draft_controller
from fmus.profile.controllers.controller_profile import ControllerProfile
from fmus.profile.controllers.controller_wiring import ControllerWiring, wire_controller
from fmus.profile.preparation import PreparedFmu, bounds_of, notes_on
from fmus.profile.step_plan import step_plan_of


@dataclass(frozen=True)
class PreparedController(PreparedFmu):
    """A controller that is ready to be unpacked and loaded.

    Attributes:
        profile: Profile by which it is called.
        wiring: Variables for its inputs and its answer.
    """

    profile: ControllerProfile
    wiring: ControllerWiring


def prepare_controller(
    path: Path,
    *,
    step_size: float,
    setup: Mapping[str, float],
    profile: ControllerProfile | None = None,
    start_values: Mapping[str, Value] | None = None,
) -> PreparedController:
    """Check and read a controller FMU, and fit a profile to it.

    Args:
        path: Path of the .fmu file.
        step_size: Time between two calls [s].
        setup: Settings of the run, by the names of the profile's table ``setup`` [SI].
        profile: Roles of the FMU's variables, or None for a draft from names if it leaves no doubt.
        start_values: Further start values by variable name.

    Raises:
        FmuFileError: the file is missing, or no readable FMU.
        FmuInterfaceError: it has no interface that can be run here.
        FmuPlatformError: it has no binary for this platform.
        FmuVariableError: a variable is missing, or is not what it is used for.
        FmuProfileError: the profile does not fit, or there is none where one is needed.
    """
    model = read_model(path)
    profile = profile or draft_controller(model).profile()
    model = read_model(path, {**profile.parameters, **(start_values or {})})
    wiring = wire_controller(model, profile, setup, start_values or {})
    interface = wiring.interface
    plan = step_plan_of(path, profile.fmu.step, interface, model.default_step, step_size)
    clocks, remarks = tickings_of(model, interface, profile.fmu, plan.step)
    return PreparedController(
        model=model,
        profile=profile,
        wiring=wiring,
        step_plan=plan,
        bounds=bounds_of(wiring.inputs),
        step_size=step_size,
        binary=(binary := binary_of(model, interface)),
        notes=(*notes_on(interface, binary), *remarks),
        clocks=clocks,
    )


def choose_controller_profile(path: Path, profile: ControllerProfile | None) -> ControllerProfile:
    """Return the profile for calling an FMU: the given one, or a draft.

    Raises:
        FmuFileError: the file is missing, or no readable FMU.
        FmuProfileError: there is doubt; the message says which lines to add.
    """
    return profile or draft_controller(read_model(path)).profile()
