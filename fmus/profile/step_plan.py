"""The communication step plan: the relation of the controller's steps to an FMU's own steps."""

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from fmus.description.model import Interface, Kind
from fmus.errors import FmuProfileError

_FIT = 1e-9  # Relative tolerance of a whole number of steps
_MOST = 1_000_000  # Largest number of substeps, and of control steps in a plan's period


@dataclass(frozen=True)
class StepPlan:
    """The plan: ``substeps`` steps of the FMU take as long as ``stretch`` control steps.

    At the first of the control instants that it reaches, an FMU step begins with the force that is
    held then. It may end after the next control instant, where the motion is interpolated.

    Attributes:
        step: Step of the FMU [s].
        substeps: Number of FMU steps; 1 if the FMU's step is a multiple of the control step.
        stretch: Number of control steps in the same time; 1 if the FMU's step is a part of one.
    """

    step: float
    substeps: int = 1
    stretch: int = 1

    @property
    def delay(self) -> float:
        """Longest time [s] from a control instant to the FMU's step that gets its force."""
        return self.step * (1.0 - 1.0 / self.stretch)

    @property
    def ahead(self) -> int:
        """Largest number of control steps that end within one FMU step."""
        return -(-self.stretch // self.substeps)

    def steps_until(self, instant: int) -> int:
        """Return the number of FMU steps that reach a control instant, counted from 0."""
        return -(-instant * self.substeps // self.stretch)

    def share(self, instant: int) -> float:
        """Return the share of the last of these steps that has passed at the instant."""
        return instant * self.substeps % self.stretch / self.stretch or 1.0

    def has_ended(self, instant: int) -> bool:
        """Return whether an FMU step has ended within the control step before the instant."""
        return instant * self.substeps % self.stretch < self.substeps


def make_step_plan(control_step: float, fmu_step: float | None) -> StepPlan:
    """Return the plan for a control step [s] and the FMU's own step [s], by default the same.

    Raises:
        FmuProfileError: there are too many substeps.
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
    if abs(stretch * control_step - fmu_step) <= _FIT * fmu_step or stretch > _MOST:
        return StepPlan(stretch * control_step, stretch=stretch)
    ratio = Fraction(control_step / fmu_step).limit_denominator(_MOST)
    return StepPlan(fmu_step, ratio.numerator, ratio.denominator)


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
        FmuProfileError: there are too many substeps.
    """
    fixed = interface.fixed_internal_step
    if wanted is None and fixed is not None and not divides(fixed, step_size):
        wanted = fixed
    one_length = interface.kind is Kind.CO_SIMULATION and not interface.variable_step
    if wanted is None and fixed is None and one_length and default is not None:
        wanted = default
    try:
        return make_step_plan(step_size, wanted)
    except FmuProfileError as error:
        raise FmuProfileError(f"{path}: {error}") from None


def divides(part: float, whole: float) -> bool:
    """Return whether ``whole`` is a multiple of ``part``, up to rounding."""
    if part < 1e-9 * whole:
        return True  # the part is finer than the resolution of floating-point numbers
    return part <= whole * (1 + 1e-9) and abs(round(whole / part) * part - whole) <= 1e-9 * whole


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
