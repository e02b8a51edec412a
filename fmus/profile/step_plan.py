"""The communication step plan: the relation of the controller's steps to an FMU's own steps."""

from dataclasses import dataclass
from pathlib import Path

from fmus.description.model import Interface, Kind
from fmus.errors import FmuProfileError

_FIT = 1e-9  # Relative tolerance of a whole number of steps
_MOST = 1_000_000  # Largest number of substeps; more would take minutes


@dataclass(frozen=True)
class StepPlan:
    """The plan: ``substeps`` FMU steps per control step, or ``stretch`` control steps per FMU step.

    Attributes:
        step: Step of the FMU [s].
        substeps: Number of FMU steps per control step; 1 unless the FMU's step is shorter.
        stretch: Number of control steps per FMU step, over which the force is held; 1 unless the
            FMU's step is longer.
    """

    step: float
    substeps: int = 1
    stretch: int = 1


def make_step_plan(control_step: float, fmu_step: float | None) -> StepPlan:
    """Return the plan for a control step [s] and the FMU's own step [s], by default the same.

    Raises:
        FmuProfileError: neither is a whole multiple of the other, or there are too many substeps.
    """
    if fmu_step is None:
        return StepPlan(control_step)
    if fmu_step * _MOST < control_step:
        raise FmuProfileError(
            f"an FMU step of {fmu_step:g} s is more than {_MOST} times smaller than the control "
            f"step of {control_step:g} s; change step in [fmu]"
        )
    substeps = max(1, round(control_step / fmu_step))
    if abs(substeps * fmu_step - control_step) <= _FIT * control_step:
        return StepPlan(control_step / substeps, substeps=substeps)
    stretch = max(1, round(fmu_step / control_step))
    if abs(stretch * control_step - fmu_step) <= _FIT * fmu_step:
        return StepPlan(stretch * control_step, stretch=stretch)
    near = control_step / max(1, round(control_step / fmu_step))
    raise FmuProfileError(
        f"an FMU step of {fmu_step:g} s does not fit the control step of {control_step:g} s; "
        f"expected a whole part or multiple of it: add step = {near:.6g} to [fmu], or change "
        "--time-step"
    )


def step_plan_of(
    path: Path,
    wanted: float | None,
    interface: Interface,
    default: float | None,
    step_size: float,
) -> StepPlan:
    """Return the plan for the profile's step, or for a step that the FMU can do.

    Args:
        path: Path of the FMU, for messages.
        wanted: Step that the profile names [s], or None.
        interface: Interface of the FMU.
        default: Step of the FMU's default experiment [s].
        step_size: Step size of the controller [s].

    Raises:
        FmuProfileError: the steps do not fit each other.
    """
    fixed = interface.fixed_internal_step
    if wanted is None and fixed is not None and not divides(fixed, step_size):
        wanted = fixed
        if not divides(step_size, fixed):
            raise FmuProfileError(
                f"{path}: the FMU has a fixed step of {fixed:g} s, which does not fit the control "
                f"step of {step_size:g} s; expected a whole part or multiple of it: change "
                "--time-step, or export the model with another step"
            )
    one_length = interface.kind is Kind.CO_SIMULATION and not interface.variable_step
    if wanted is None and fixed is None and one_length and default is not None:
        wanted = default
        if not (divides(default, step_size) or divides(step_size, default)):
            raise FmuProfileError(
                f"{path}: the FMU does steps of one length only, and that of its default "
                f"experiment, {default:g} s, does not fit the control step of {step_size:g} s; "
                f"expected a whole part or multiple of it: run with --time-step {default:g}, or "
                "write the length that it does as step in [fmu] of the profile"
            )
    try:
        return make_step_plan(step_size, wanted)
    except FmuProfileError as error:
        raise FmuProfileError(f"{path}: {error}") from None


def divides(part: float, whole: float) -> bool:
    """Return whether ``whole`` is a multiple of ``part``, up to rounding."""
    if part < 1e-9 * whole:
        return True  # the part is finer than the resolution of floating-point numbers
    return part <= whole * (1 + 1e-9) and abs(round(whole / part) * part - whole) <= 1e-9 * whole


def step_to_run_with(fmu_step: float, usual: float = 0.05) -> str:
    """Return the flag that a run needs for an FMU's step [s], or "" if the usual one fits."""
    try:
        make_step_plan(usual, fmu_step)
    except FmuProfileError:
        return f" and run with --time-step {fmu_step:g}"
    return ""


def between(
    start: tuple[float, float], end: tuple[float, float], duration: float, share: float
) -> tuple[float, float]:
    """Return position [m] and speed [m/s] within a step, from its ends (cubic Hermite).

    Args:
        start: Position and speed at the beginning.
        end: Position and speed at the end.
        duration: Duration of the step [s].
        share: Share of the step that has passed, from 0 to 1.
    """
    (s_0, v_0), (s_1, v_1) = start, end
    r, h = share, duration
    position = (
        s_0 * (1 + 2 * r) * (1 - r) ** 2
        + s_1 * r * r * (3 - 2 * r)
        + h * r * (1 - r) * (v_0 * (1 - r) - v_1 * r)
    )
    return position, v_0 + r * (v_1 - v_0)
