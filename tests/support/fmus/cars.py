"""What a car of the zoo is: its options, and from them its settings and its vehicle profile."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, Literal

if TYPE_CHECKING:
    from collections.abc import Mapping

Role = Literal["force", "drive_brake", "acceleration", "throttle_brake", "speed_setpoint"]
Kind = Literal["co-simulation", "model-exchange", "both"]
UnitSpec = tuple[str, float, float]  # name, factor, offset: SI = factor * raw + offset

# Quantity: its unit in SI; in the order of source/car.h, which is that of the value references.
QUANTITIES: Final = {
    "force": "N", "drive_force": "N", "brake_force": "N", "wanted_acceleration": "m/s2",
    "throttle": "1", "brake": "1", "speed_setpoint": "m/s", "spare_input": "",
    "grade": "rad",
    "speed": "m/s", "position": "m", "acceleration": "m/s2", "wheel_force": "N", "gear": "",
    "clock": "s", "state_position": "m", "state_speed": "m/s", "state_force": "N",
    "rate_position": "m/s", "rate_speed": "m/s2", "rate_force": "N/s", "indicator": "",
    "mass": "kg", "friction": "N.s/m", "drag": "N.s2/m2", "lag": "s", "response": "s",
    "full_drive": "N", "full_brake": "N", "holds": "", "gear_time": "s", "gear_speed": "m/s",
    "gear_ratio": "", "gears": "", "engaged": "", "initial_speed": "m/s",
    "initial_position": "m", "array_size": "", "position_step": "m",
    "creep": "N", "sensor_lag": "s",
}  # fmt: skip
REFERENCES: Final = {name: index + 1 for index, name in enumerate(QUANTITIES)}
INPUT_ARRAY: Final = 60  # value references beyond those of single quantities
OUTPUT_ARRAY: Final = 61
LOAD: Final = 62
CLOCK: Final = 59

INPUTS: Final[dict[Role, tuple[str, ...]]] = {
    "force": ("force",),
    "drive_brake": ("drive_force", "brake_force"),
    "acceleration": ("wanted_acceleration",),
    "throttle_brake": ("throttle", "brake"),
    "speed_setpoint": ("speed_setpoint",),
}
DEFAULTS: Final = {  # [SI] what the car is unless told otherwise
    "mass": 1000.0,
    "friction": 100.0,
    "drag": 0.0,
    "lag": 0.0,
    "response": 0.5,
    "full_drive": 5000.0,
    "full_brake": 10000.0,
    "gear_time": 0.0,
    "gear_speed": 0.0,
    "gear_ratio": 0.5,
    "gears": 1.0,
    "engaged": 1.0,
    "initial_speed": 0.0,
    "initial_position": 0.0,
    "array_size": 3.0,
    "position_step": 0.0,
    "creep": 0.0,
    "sensor_lag": 0.0,
}
PARAMETERS: Final = ("mass", "friction", "lag", "engaged", "gears")  # offered by every car
PHASES: Final = (
    "load", "instantiate", "initialise", "step", "event", "terminate", "free", "unload",
)  # fmt: skip


@dataclass(frozen=True)
class Fault:
    """What goes wrong, where and from when on."""

    name: str  # of FAULTS
    phase: str = "step"  # of PHASES; Model Exchange: 'step' is where it gives its derivatives
    at: float = 0.2  # [s] in steps that begin then or later


@dataclass(frozen=True)
class Car:
    """A car of the zoo.

    Attributes:
        fmi: version of the standard.
        kind: Co-Simulation, Model Exchange or both (FMI 1.0: Co-Simulation only).
        role: which inputs it is driven by.
        outputs: of speed, position, acceleration, wheel_force, gear, clock.
        initial: of speed, position: those that have a parameter for where it starts.
        names: quantity: what the FMU calls it.
        units: quantity: its unit's name, factor and offset; None: none is declared.
        spoken: quantity: factor and offset of what it really speaks, whatever it declares.
        kinds: quantity: FMI type, e.g. "Integer", "Float32", "Boolean".
        float32: FMI 3: all inputs and outputs are Float32.
        array: FMI 3: one array of inputs ``u``, one of outputs ``y``; "structural": the length of
            ``u`` is a structural parameter (3: the others are spare).
        define_units: units have a definition by base units; else a name only.
        values: quantity: its value [SI] if it is not that of DEFAULTS.
        extra: further quantities that are offered as inputs or parameters.
        faults: what it does wrong.
        flags: attributes of the interface's element, as they stand in the XML.
        step: [s] of its default experiment.
        only_step: [s] the one communication step it accepts.
        constant_step: it refuses a step that differs from its first.
        keeps_final_only: it keeps a step only if its state will not be set back before it.
        clock: FMI 3: attributes of its input clock ``tick``; the force counts as it ticks.
        clocked: the force belongs to the clock.
        interval: [s] of the clock, for who asks.
        refuses_ticks: it answers them with an error.
        only_event_mode: FMI 3: it makes no instance without event mode.
        divides: by its spare input, as soon as it enters initialization mode.
        needs_event_mode: FMI 3: it refuses steps before its events are handled.
        needs_stop_time: [s] it wants to be told a stop time as late as this.
        strict_time: it refuses a step that does not begin where the last one ended.
        euler: one explicit Euler step for each communication step.
        once_per_process: a second instance in the process is refused.
        nominal: Model Exchange: of all its states.
        without: functions that its library lacks.
        wrong_token: its library expects another GUID than the description gives.
        calls: it appends the name of every call to the file ``<name>.calls`` beside it.
    """

    fmi: str = "2.0"
    kind: Kind = "co-simulation"
    role: Role = "force"
    outputs: tuple[str, ...] = ("speed", "position", "acceleration")
    initial: tuple[str, ...] = ("speed", "position")
    names: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, UnitSpec | None] = field(default_factory=dict)
    spoken: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    kinds: Mapping[str, str] = field(default_factory=dict)
    float32: bool = False
    array: bool | Literal["structural"] = False
    define_units: bool = True
    values: Mapping[str, float] = field(default_factory=dict)
    extra: tuple[str, ...] = ()
    faults: tuple[Fault, ...] = ()
    flags: Mapping[str, str] = field(default_factory=dict)
    step: float | None = 0.05
    only_step: float | None = None
    constant_step: bool = False
    keeps_final_only: bool = False
    clock: Mapping[str, str] = field(default_factory=dict)
    clocked: bool = False
    interval: float = 0.0
    refuses_ticks: bool = False
    only_event_mode: bool = False
    divides: bool = False
    needs_event_mode: bool = False
    needs_stop_time: float | None = None
    strict_time: bool = False
    euler: bool = False
    once_per_process: bool = False
    nominal: float = 1.0
    without: tuple[str, ...] = ()
    wrong_token: bool = False
    calls: bool = False

    @property
    def inputs(self) -> tuple[str, ...]:
        """The quantities it is driven by, and the extra inputs."""
        extra = [name for name in self.extra if REFERENCES[name] < REFERENCES["speed"]]
        return (*INPUTS[self.role], *extra)

    @property
    def parameters(self) -> tuple[str, ...]:
        """The quantities that can be set before the start."""
        start = tuple(f"initial_{name}" for name in self.initial)
        named = (*self.values, *self.extra)
        more = [n for n in named if REFERENCES[n] >= REFERENCES["mass"] and n != "holds"]
        return tuple(dict.fromkeys((*PARAMETERS, *start, *more)))

    @property
    def states(self) -> tuple[str, ...]:
        """The continuous states of Model Exchange."""
        if self.role == "speed_setpoint" and self.value("response") == 0.0:
            return ()
        return ("position", "speed", "force") if self.value("lag") > 0 else ("position", "speed")

    @property
    def interfaces(self) -> tuple[str, ...]:
        """The names of its interfaces' elements."""
        return {
            "co-simulation": ("CoSimulation",),
            "model-exchange": ("ModelExchange",),
            "both": ("ModelExchange", "CoSimulation"),
        }[self.kind]

    def value(self, quantity: str) -> float:
        """The start value of a quantity [SI]."""
        if quantity == "holds":  # a brake pedal does not drive the car backwards
            return self.values.get("holds", float(self.role in ("drive_brake", "throttle_brake")))
        return self.values.get(quantity, DEFAULTS.get(quantity, 0.0))

    def name(self, quantity: str) -> str:
        """What the FMU calls a quantity."""
        return self.names.get(quantity, quantity)

    def unit(self, quantity: str) -> UnitSpec | None:
        """The unit that the FMU declares for a quantity."""
        own = QUANTITIES[quantity]
        return self.units.get(quantity, (own, 1.0, 0.0) if own else None)

    def scale(self, quantity: str) -> tuple[float, float]:
        """Factor and offset of what the FMU really speaks."""
        unit = self.unit(quantity)
        return self.spoken.get(quantity, unit[1:] if unit else (1.0, 0.0))

    def raw(self, quantity: str) -> float:
        """The start value of a quantity as the FMU counts it."""
        factor, offset = self.scale(quantity)
        return (self.value(quantity) - offset) / factor

    def kind_of(self, quantity: str) -> str:
        """The FMI type of a quantity."""
        real = "Float64" if self.fmi == "3.0" else "Real"
        if self.float32 and REFERENCES[quantity] <= REFERENCES["clock"]:
            real = "Float32"
        whole = "Int32" if self.fmi == "3.0" else "Integer"
        usual = {"engaged": "Boolean", "gears": whole, "gear": whole, "array_size": "UInt64"}
        return self.kinds.get(quantity, usual.get(quantity, real))


def settings(car: Car, token: str, calls: str) -> str:
    """The text of resources/car.txt, which the library reads about itself."""
    lines = [f"token {token}", f"role {car.role}", f"nominal {car.nominal!r}"]
    flags = ("euler", "once_per_process", "strict_time", "constant_step", "keeps_final_only",
             "needs_event_mode", "divides", "only_event_mode")  # fmt: skip
    lines += [flag for flag in flags if getattr(car, flag)]
    if car.needs_stop_time:
        lines.append(f"needs_stop_time {car.needs_stop_time!r}")
    if car.clock and not car.refuses_ticks:
        lines += ["samples", f"interval {car.interval!r}"]
    if car.only_step:
        lines.append(f"only_step {car.only_step!r}")
    if car.calls:
        lines.append(f"calls {calls}")
    lines += [f"value {name} {car.value(name)!r}" for name in (*DEFAULTS, "holds")]
    for name, reference in REFERENCES.items():
        factor, offset = car.scale(name)
        lines += [f"variable {reference} {name}", f"scale {name} {factor!r} {offset!r}"]
    lines.append(f"variable {INPUT_ARRAY} {' '.join(input_elements(car))}")
    lines.append(f"variable {OUTPUT_ARRAY} {' '.join(car.outputs)}")
    lines += [f"fault {fault.name} {fault.phase} {fault.at!r}" for fault in car.faults]
    return "\n".join(lines) + "\n"


def input_elements(car: Car) -> tuple[str, ...]:
    """What the elements of the array of inputs are."""
    spare = 3 - len(car.inputs) if car.array == "structural" else 0
    return (*car.inputs, *("spare_input" for _ in range(spare)))


def profile(car: Car) -> dict[str, Any]:
    """The car's vehicle profile; units are those that the FMU declares."""

    def axis(quantity: str, **more: Any) -> dict[str, Any]:
        if car.array and quantity in car.inputs:
            return {"variable": f"u[{car.inputs.index(quantity) + 1}]", **more}
        if car.array and quantity in car.outputs:
            return {"variable": f"y[{car.outputs.index(quantity) + 1}]", **more}
        return {"variable": car.name(quantity), **more}

    role: dict[str, dict[str, Any]] = {
        "force": {"force": axis("force")},
        "drive_brake": {n: axis(n) for n in ("drive_force", "brake_force")},
        "acceleration": {"acceleration": axis("wanted_acceleration")},
        "throttle_brake": {
            "throttle": axis("throttle", full_force=car.value("full_drive")),
            "brake": axis("brake", full_force=car.value("full_brake")),
        },
        "speed_setpoint": {"speed_setpoint": axis("speed_setpoint")},
    }
    if car.value("response"):
        role["speed_setpoint"]["speed_setpoint"]["lead"] = car.value("response")
    if "grade" in car.extra:
        role[car.role]["grade"] = axis("grade")
    fmu: dict[str, Any] = {} if car.kind == "both" else {"kind": car.kind}
    if car.only_step:
        fmu["step"] = car.only_step
    return {
        "fmu": fmu,
        "inputs": role[car.role],
        "outputs": {n: axis(n) for n in ("speed", "position", "acceleration") if n in car.outputs},
        "initial": {name: {"variable": car.name(f"initial_{name}")} for name in car.initial},
        "inverse_map": {"mass": car.value("mass"), "friction": car.value("friction")},
    }
