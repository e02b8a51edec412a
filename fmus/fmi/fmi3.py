"""The functions of FMI 3.0."""

import ctypes
import os
from collections.abc import Mapping, Sequence
from ctypes import (
    byref,
    c_bool,
    c_char_p,
    c_double,
    c_float,
    c_size_t,
    c_void_p,
)
from typing import Any, ClassVar

from fmus.fmi.calls import Calls, CType, EventInfo, Progress, Setting, Stepper
from fmus.fmi.messages import plain_receiver


def _types() -> dict[str, CType]:
    types = {
        "Float64": CType(c_double, "Float64"),
        "Float32": CType(c_float, "Float32"),
        "Boolean": CType(c_bool, "Boolean"),
        "String": CType(c_char_p, "String"),
        "Enumeration": CType(ctypes.c_int64, "Int64"),
    }
    for bits in (8, 16, 32, 64):
        types[f"Int{bits}"] = CType(getattr(ctypes, f"c_int{bits}"), f"Int{bits}")
        types[f"UInt{bits}"] = CType(getattr(ctypes, f"c_uint{bits}"), f"UInt{bits}")
    return types


class Fmi3Calls(Calls):
    """The functions of FMI 3.0."""

    types: ClassVar[Mapping[str, CType]] = _types()
    state_word: ClassVar = "FMUState"
    exchange: ClassVar[dict[str, str]] = Calls.exchange | {
        "get_derivatives": "GetContinuousStateDerivatives"
    }

    def find_functions(self) -> None:  # noqa: D102 - as in Calls
        self._receiver = plain_receiver(self.messages)
        self._make = f"fmi3Instantiate{'ModelExchange' if self.exchanges else 'CoSimulation'}"
        self._instantiate = self.library.instantiator(self._make)
        for name in ("EnterInitializationMode", "ExitInitializationMode", "Terminate"):
            self.function(f"fmi3{name}")
        self._free = self.library.function("fmi3FreeInstance")

    def instantiate(self) -> None:  # noqa: D102
        resources = str((self.folder / "resources").resolve()) + os.sep
        start = (
            c_char_p(self.interface.identifier.encode()),
            c_char_p(self.model.guid.encode()),
            c_char_p(os.fsencode(resources)),
            c_bool(False),  # not visible
            c_bool(True),  # logging gives the reason of a failure
        )
        environment = (None, ctypes.cast(self._receiver, c_void_p))
        if self.exchanges:
            component = self._instantiate(*start, *environment)
        else:
            event_mode_used, early_return_allowed = c_bool(self.event_mode), c_bool(False)
            needed = (None, c_size_t(0))  # no variables between the steps
            component = self._instantiate(
                *start, event_mode_used, early_return_allowed, *needed, *environment, None
            )
        self.keep_instance(component, self._make)

    def configure(self, setting: Sequence[Setting]) -> None:  # noqa: D102
        structural: list[Setting] = []
        others: list[Setting] = []
        for one in setting:
            causality = self.model.variables[one.name].causality
            (structural if causality == "structuralParameter" else others).append(one)
        if structural:
            self.call("fmi3EnterConfigurationMode")
            super().configure(structural)
            self.call("fmi3ExitConfigurationMode")
        super().configure(others)

    def initialise(self, inputs: Sequence[Setting], tolerance: float | None) -> None:  # noqa: D102
        self.call(
            "fmi3EnterInitializationMode",
            c_bool(tolerance is not None),
            c_double(tolerance or 0.0),
            c_double(self.start_time),
            c_bool(self.stop_time is not None),
            c_double(self.stop_time or 0.0),
        )
        self.configure(inputs)
        self.call("fmi3ExitInitializationMode")

    def arguments(self, references: Sequence[int], values: Any) -> tuple[Any, ...]:  # noqa: D102
        return *super().arguments(references, values), c_size_t(len(values))

    # ---- Co-Simulation ----

    def stepper(self, start: c_double, step: c_double) -> Stepper:  # noqa: D102
        event, reached = c_bool(), c_double()
        flags = (c_bool * 2)()  # terminateSimulation, earlyReturn
        size = ctypes.sizeof(c_bool)
        report = (byref(event), byref(flags), byref(flags, size), byref(reached))

        def progress() -> Progress:
            return Progress(reached.value, flags[0])

        final = c_bool(True)
        arguments = (self.component, start, step, final, *report)
        seen = memoryview(flags).cast("B").cast("H")  # both flags in one read
        return Stepper(self.function("fmi3DoStep"), arguments, final, seen, event, progress)

    # ---- Model Exchange ----

    def update_discrete_states(self) -> EventInfo:  # noqa: D102
        again, end, nominals, values, defined = (c_bool() for _ in range(5))
        time = c_double()
        flags = (again, end, nominals, values, defined)
        self.call("fmi3UpdateDiscreteStates", *map(byref, flags), byref(time))
        return EventInfo(
            again=again.value,
            ended=end.value,
            nominals_changed=nominals.value,
            next_time=time.value if defined.value else None,
        )

    def completed_step(self) -> tuple[bool, bool]:  # noqa: D102
        event, end = c_bool(), c_bool()
        final = c_bool(True)  # the state is never set back
        self.call("fmi3CompletedIntegratorStep", final, byref(event), byref(end))
        return event.value, end.value
