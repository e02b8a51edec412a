"""The functions of FMI 2.0."""

import ctypes
from collections.abc import Mapping, Sequence
from ctypes import Structure, byref, c_char_p, c_double, c_int, c_void_p
from typing import ClassVar

from fmus.fmi.calls import (
    Calls,
    CType,
    EventInfo,
    Progress,
    Setting,
    Stepper,
    allocators,
)
from fmus.fmi.messages import formatted_receiver
from fmus.fmi.status import DISCARD, WARNING

_LAST_SUCCESSFUL_TIME = c_int(2)  # fmi2StatusKind
_TERMINATED = c_int(3)


class _Callbacks(Structure):
    _fields_: ClassVar = [
        ("logger", c_void_p),
        ("allocateMemory", c_void_p),
        ("freeMemory", c_void_p),
        ("stepFinished", c_void_p),
        ("componentEnvironment", c_void_p),
    ]


class _EventInfo(Structure):
    _fields_: ClassVar = [
        ("newDiscreteStatesNeeded", c_int),
        ("terminateSimulation", c_int),
        ("nominalsOfContinuousStatesChanged", c_int),
        ("valuesOfContinuousStatesChanged", c_int),
        ("nextEventTimeDefined", c_int),
        ("nextEventTime", c_double),
    ]


class Fmi2Calls(Calls):
    """The functions of FMI 2.0."""

    types: ClassVar[Mapping[str, CType]] = {
        "Real": CType(c_double, "Real"),
        "Integer": CType(c_int, "Integer"),
        "Enumeration": CType(c_int, "Integer"),
        "Boolean": CType(c_int, "Boolean"),
        "String": CType(c_char_p, "String"),
    }

    def find_functions(self) -> None:  # noqa: D102 - as in Calls
        self._receiver = formatted_receiver(self.messages)
        logger = ctypes.cast(self._receiver, c_void_p)
        self._callbacks = _Callbacks(logger, *allocators(), None, None)
        self._instantiate = self.library.instantiator("fmi2Instantiate")
        for name in ("SetupExperiment", "EnterInitializationMode", "ExitInitializationMode"):
            self.function(f"fmi2{name}")
        self._free = self.library.function("fmi2FreeInstance")
        self.function("fmi2Terminate")

    def instantiate(self) -> None:  # noqa: D102
        resources = (self.folder / "resources").resolve()
        component = self._instantiate(
            c_char_p(self.interface.identifier.encode()),
            c_int(0 if self.exchanges else 1),
            c_char_p(self.model.guid.encode()),
            c_char_p(resources.as_uri().encode()),
            byref(self._callbacks),
            c_int(0),  # not visible
            c_int(1),  # some FMUs give the reason of a failure only with logging
        )
        self.keep_instance(component, "fmi2Instantiate")

    def initialise(self, inputs: Sequence[Setting], tolerance: float | None) -> None:  # noqa: D102
        self.call(
            "fmi2SetupExperiment",
            c_int(tolerance is not None),
            c_double(tolerance or 0.0),
            c_double(self.start_time),
            c_int(self.stop_time is not None),
            c_double(self.stop_time or 0.0),
        )
        self.call("fmi2EnterInitializationMode")
        self.configure(inputs)
        self.call("fmi2ExitInitializationMode")

    # ---- Co-Simulation ----

    def stepper(self, start: c_double, step: c_double) -> Stepper:  # noqa: D102
        reached, ended = c_double(), c_int()
        real_status = self.library.optional("fmi2GetRealStatus")
        boolean_status = self.library.optional("fmi2GetBooleanStatus")

        def progress() -> Progress:
            ended.value = 0
            if boolean_status is None or boolean_status(
                self.component, _TERMINATED, byref(ended)
            ) not in (0, WARNING):
                ended.value = 0
            if real_status is None or real_status(
                self.component, _LAST_SUCCESSFUL_TIME, byref(reached)
            ) not in (0, WARNING, DISCARD):
                return Progress(None, bool(ended.value))
            return Progress(reached.value, bool(ended.value))

        final = c_int(1)
        arguments = (self.component, start, step, final)
        return Stepper(self.function("fmi2DoStep"), arguments, final, (0,), c_int(0), progress)

    # ---- Model Exchange ----

    def update_discrete_states(self) -> EventInfo:  # noqa: D102
        info = _EventInfo()
        self.call("fmi2NewDiscreteStates", byref(info))
        return EventInfo(
            again=bool(info.newDiscreteStatesNeeded),
            ended=bool(info.terminateSimulation),
            nominals_changed=bool(info.nominalsOfContinuousStatesChanged),
            next_time=info.nextEventTime if info.nextEventTimeDefined else None,
        )

    def completed_step(self) -> tuple[bool, bool]:  # noqa: D102
        event, end = c_int(), c_int()
        final = c_int(1)  # the state is never set back
        self.call("fmi2CompletedIntegratorStep", final, byref(event), byref(end))
        return bool(event.value), bool(end.value)
