"""The input clocks of an FMI 3 FMU: at which times they tick, or why the FMU is refused."""

from dataclasses import dataclass, replace

from fmus.description.channels import known_names
from fmus.description.model import Clock, Interface, Kind, Model
from fmus.errors import FmuInterfaceError, FmuProfileError
from fmus.profile.step_plan import divides
from fmus.profile.tables import Stepping
from fmus.text import printable

PERIODIC = frozenset({"constant", "fixed", "tunable", "calculated"})


@dataclass(frozen=True)
class Ticking:
    """An input clock that is ticked.

    Attributes:
        needed: True if variables belong to the clock, so that it has to tick.
        period: Time between two ticks [s], or None if the FMU is asked.
        shift: Time of the first tick after the start [s], or None: after its first interval.
        repeats: True if it ticks again after the same time unless the FMU names another one.
    """

    name: str
    reference: int
    needed: bool
    period: float | None
    shift: float | None = 0.0
    repeats: bool = True


def tickings_of(
    model: Model, interface: Interface, stepping: Stepping, step: float
) -> tuple[tuple[Ticking, ...], list[str]]:
    """Return the clocks that are ticked, and remarks on the others.

    Args:
        model: Model of the FMU.
        interface: Interface that is to run.
        stepping: Settings of the profile.
        step: Step of the FMU [s].

    Raises:
        FmuInterfaceError: a clock has to tick, and cannot.
        FmuProfileError: the profile names a clock that the FMU does not have.
    """
    clocks = {clock.name: clock for clock in model.clocks if clock.causality == "input"}
    for name in stepping.clocks:
        if name not in clocks:
            has = known_names(clocks)
            raise FmuProfileError(
                f"{model.path}: [fmu.clocks] no input clock '{printable(name, 60)}'; it has {has}"
            )
    found, remarks = [], []
    for name, clock in clocks.items():
        told = stepping.clocks.get(name)
        if told == 0.0:
            continue
        problem = _problem(clock, interface, told)
        period = told or clock.interval
        whole = interface.kind is Kind.MODEL_EXCHANGE or interface.variable_step
        if not problem and not whole and not (period is not None and divides(step, period)):
            problem = f"ticks between the FMU's steps of {step:g} s, which all have one length"
        if not problem:
            own = Ticking(name, clock.reference, clock.needed, told)
            if told is None:
                regular, once = clock.variability in PERIODIC, clock.variability == "countdown"
                interval, shift = (period, clock.shift) if regular else (None, None)
                own = replace(own, period=interval, shift=shift, repeats=not once)
            found.append(own)
        elif clock.needed or told is not None:
            raise FmuInterfaceError(
                f"{model.path}: its input clock '{printable(name, 60)}' {problem}; export it "
                f"without the clock, or let it stand: {printable(name, 60)} = 0 under [fmu.clocks]"
            )
        else:
            remarks.append(f"its input clock '{printable(name, 60)}' {problem}: it never ticks")
    return tuple(found), remarks


def _problem(clock: Clock, interface: Interface, told: float | None) -> str:
    """Return why a clock cannot tick, or an empty text."""
    if clock.variability == "triggered" and told is None:
        return "is triggered by other models, and there are none"
    events = interface.kind is Kind.MODEL_EXCHANGE or "hasEventMode" in interface.flags
    return "" if events else "needs event mode, which the FMU does not have"
