"""Everything that is known of a vehicle before its FMU is unpacked: read, chosen, checked.

Whatever is wrong with a file or a profile is said here, before native code is loaded. What is
prepared can be handed to another process.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite, isnan
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from fmus.errors import FmuProfileError, FmuVariableError
from fmus.profile.bundled import BUNDLED_PROFILE, is_bundled
from fmus.profile.commands import Command, make_command
from fmus.profile.pace import Pace, make_pace
from fmus.profile.wiring import Wiring, wire

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

    from fmus.description.model import Interface, Model, Value
    from fmus.profile.vehicle_profile import VehicleProfile


@dataclass(frozen=True)
class Bound:
    """The range that an FMU declares for an input, in the FMU's unit."""

    index: int  # of the input
    low: float
    high: float


@dataclass(frozen=True)
class Prepared:
    """A vehicle that is ready to be unpacked and loaded.

    Attributes:
        model: of the FMU.
        wiring: which variables it is driven and read by.
        command: the inverse map.
        step_size: of the controller [s].
        binary: this platform's binary in the archive.
        solver: of Model Exchange; None: the best there is.
        tolerance: of Model Exchange, relative; None: the default.
        ours: a shipped FMU: nobody watches it, and no step of it is discarded.
        speed_limit: [m/s] beyond which the FMU is at fault.
        position_jump: [m] likewise.
        frozen_time: [s] without a change that are worth a warning.
        run_up: whether it may be driven up to its initial speed.
        run_up_mass: M [kg] for that.
        run_up_friction: alpha [N.s/m] for that.
        start_timeout: [s] of wall clock.
        step_timeout: [s] of wall clock.
    """

    model: Model
    wiring: Wiring
    command: Command
    pace: Pace
    bounds: tuple[Bound, ...]
    step_size: float
    binary: str
    solver: Literal["cvode", "rk4"] | None
    tolerance: float | None
    ours: bool
    speed_limit: float
    position_jump: float
    frozen_time: float
    run_up: bool
    run_up_mass: float
    run_up_friction: float
    start_timeout: float
    step_timeout: float

    @property
    def path(self) -> Path:
        """Of the FMU."""
        return self.model.path


def prepare(
    path: str | os.PathLike[str],
    *,
    step_size: float,
    profile: VehicleProfile | None = None,
    start_values: Mapping[str, Value] | None = None,
) -> Prepared:
    """Read an FMU through the archive's gate and fit a profile to it.

    Args:
        path: the .fmu file.
        step_size: of the controller [s].
        profile: which variable plays which part; None: the shipped FMUs' own, or a draft from
            names and units if it leaves no doubt.
        start_values: further start values by variable name.

    Raises:
        FmuFileError: the file is missing, or no readable FMU.
        FmuInterfaceError: it has no interface that can be run here.
        FmuPlatformError: it has no binary for this platform.
        FmuVariableError: a variable is missing, or is not what it is used for.
        FmuProfileError: the profile does not fit, or there is none where one is needed.
    """
    from fmus.description.binaries import binary_of
    from fmus.description.reading import read_model

    path = Path(path)
    if not (isfinite(step_size) and step_size > 0.0):
        msg = f"{path}: step size {step_size:g} s; expected a number above 0"
        raise FmuVariableError(msg)
    model = read_model(path)
    profile = _chosen(model, profile)
    wiring = wire(model, profile, start_values)
    inverse, fitted = profile.inverse_map, profile.model
    return Prepared(
        model=model,
        wiring=wiring,
        command=make_command(profile, wiring.inputs, step_size),
        pace=_pace(path, profile.fmu.step, wiring.interface, step_size),
        bounds=_bounds(wiring),
        step_size=step_size,
        binary=binary_of(model, wiring.interface),
        solver=profile.fmu.solver,
        tolerance=profile.fmu.tolerance,
        ours=profile is BUNDLED_PROFILE,
        speed_limit=profile.limits.speed,
        position_jump=profile.limits.position_jump,
        frozen_time=profile.limits.frozen_time,
        run_up=profile.initial.run_up,
        run_up_mass=inverse.mass if fitted is None else fitted.mass,
        run_up_friction=inverse.friction if fitted is None else fitted.friction,
        start_timeout=profile.fmu.start_timeout,
        step_timeout=profile.fmu.step_timeout,
    )


def choose_profile(path: Path, profile: VehicleProfile | None) -> VehicleProfile:
    """The profile to drive an FMU by: the one given, ours, or a draft that leaves no doubt.

    Raises:
        FmuFileError: the file is missing, or no readable FMU.
        FmuProfileError: there is doubt; the message says which lines to add.
    """
    from fmus.description.reading import read_model

    return _chosen(read_model(path), profile)


def _chosen(model: Model, profile: VehicleProfile | None) -> VehicleProfile:
    if profile is not None:
        return profile
    if is_bundled(model.path):
        return BUNDLED_PROFILE
    from fmus.profile.draft_profile import draft_profile, require_confident

    return require_confident(draft_profile(model), model.path)


def unpack(prepared: Prepared, folder: Path) -> None:
    """Unpack what this platform needs of the FMU into ``folder``.

    Raises:
        FmuArchiveError: a member is damaged.
    """
    from fmus.archive.gate import extract, open_archive

    binaries = prepared.binary.rpartition("/")[0]
    wanted = ("modelDescription.xml", f"{binaries}/", "resources/", "extra/")
    extract(open_archive(prepared.path), folder, wanted)
    (folder / "resources").mkdir(exist_ok=True)  # named to the FMU even where it has none


def _pace(path: Path, wanted: float | None, interface: Interface, step_size: float) -> Pace:
    fixed = interface.fixed_internal_step
    if wanted is None and fixed is not None and not _divides(fixed, step_size):
        wanted = fixed
        if not _divides(step_size, fixed):
            msg = (
                f"{path}: the FMU has a fixed step of {fixed:g} s, which does not fit the control "
                f"step of {step_size:g} s; expected a whole part or multiple of it: change "
                "--time-step, or export the model with another step"
            )
            raise FmuProfileError(msg)
    try:
        return make_pace(step_size, wanted)
    except FmuProfileError as error:
        raise FmuProfileError(f"{path}: {error}") from None


def _divides(part: float, whole: float) -> bool:
    """Whether ``whole`` is a multiple of ``part``, as far as numbers of seconds tell."""
    if part < 1e-9 * whole:
        return True  # finer than anything that can be told
    return part <= whole * (1 + 1e-9) and abs(round(whole / part) * part - whole) <= 1e-9 * whole


def _bounds(wiring: Wiring) -> tuple[Bound, ...]:
    return tuple(
        Bound(
            index,
            -inf if low is None or isnan(low) else low,
            inf if high is None or isnan(high) else high,
        )
        for index, wired in enumerate(wiring.inputs)
        for variable in (wired.channel.variable,)
        for low, high in ((variable.minimum, variable.maximum),)
        if (low is not None or high is not None) and (low is None or high is None or low <= high)
    )
