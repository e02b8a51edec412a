"""The functions of FMI 1.0; names begin with the model's identifier, booleans are characters."""

import ctypes
from collections.abc import Mapping, Sequence
from ctypes import Structure, byref, c_byte, c_char_p, c_double, c_int, c_void_p
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
from fmus.fmi.status import ERROR, WARNING

_LAST_SUCCESSFUL_TIME = c_int(2)  # fmiStatusKind
_LONGEST_WAIT = c_double(0.0)  # [ms] time for a tool to start; 0: without limit


class _Callbacks(Structure):  # passed by value
    _fields_: ClassVar = [
        ("logger", c_void_p),
        ("allocateMemory", c_void_p),
        ("freeMemory", c_void_p),
        ("stepFinished", c_void_p),
    ]


class _ModelCallbacks(Structure):  # Model Exchange has no stepFinished
    _fields_: ClassVar = _Callbacks._fields_[:3]


class _EventInfo(Structure):
    _fields_: ClassVar = [
        ("iterationConverged", c_byte),
        ("stateValueReferencesChanged", c_byte),
        ("stateValuesChanged", c_byte),
        ("terminateSimulation", c_byte),
        ("upcomingTimeEvent", c_byte),
        ("nextEventTime", c_double),
    ]

    def read(self) -> EventInfo:
        return EventInfo(
            again=not self.iterationConverged,
            ended=bool(self.terminateSimulation),
            nominals_changed=bool(self.stateValueReferencesChanged),
            next_time=self.nextEventTime if self.upcomingTimeEvent else None,
        )


class Fmi1Calls(Calls):
    """The functions of FMI 1.0."""

    types: ClassVar[Mapping[str, CType]] = {
        "Real": CType(c_double, "Real"),
        "Integer": CType(c_int, "Integer"),
        "Enumeration": CType(c_int, "Integer"),
        "Boolean": CType(c_byte, "Boolean"),
        "String": CType(c_char_p, "String"),
    }
    exchange: ClassVar[dict[str, str]] = Calls.exchange | {
        "get_nominals": "GetNominalContinuousStates"
    }

    def find_functions(self) -> None:  # noqa: D102 - as in Calls
        self.prefix = f"{self.interface.identifier}_fmi"
        self._receiver = formatted_receiver(self.messages)
        logger = ctypes.cast(self._receiver, c_void_p)
        self._callbacks: Structure = (
            _ModelCallbacks(logger, *allocators())
            if self.exchanges
            else _Callbacks(logger, *allocators(), None)
        )
        self._first: EventInfo | None = None  # result of the initialisation
        if self.exchanges:
            names = ("InstantiateModel", "Initialize", "Terminate", "FreeModelInstance")
        else:
            names = ("InstantiateSlave", "InitializeSlave", "TerminateSlave", "FreeSlaveInstance")
        make, self._initialise, self._terminate, free = map(self.name, names)
        self._make = make
        self._instantiate = self.library.instantiator(make)
        self._free = self.library.function(free)
        for name in (self._initialise, self._terminate):
            self.function(name)

    def instantiate(self) -> None:  # noqa: D102
        name, guid = (c_char_p(t.encode()) for t in (self.interface.identifier, self.model.guid))
        logging = c_byte(1)  # some FMUs give the reason of a failure only with logging
        if self.exchanges:
            component = self._instantiate(name, guid, self._callbacks, logging)
        else:
            component = self._instantiate(
                name,
                guid,
                c_char_p(self.folder.resolve().as_uri().encode()),
                c_char_p(b"application/x-fmu-sharedlibrary"),
                _LONGEST_WAIT,
                c_byte(0),  # not visible
                c_byte(0),  # not interactive
                self._callbacks,
                logging,
            )
        self.keep_instance(component, self._make)

    def initialise(self, inputs: Sequence[Setting], tolerance: float | None) -> None:  # noqa: D102
        self.configure(inputs)
        if not self.exchanges:
            stops = c_byte(self.stop_time is not None)
            stop = c_double(self.stop_time or 0.0)
            self.call(self._initialise, c_double(self.start_time), stops, stop)
            return
        self.call(self.name("SetTime"), c_double(self.start_time))
        info = _EventInfo()
        controlled = c_byte(tolerance is not None)
        self.call(self._initialise, controlled, c_double(tolerance or 0.0), byref(info))
        self._first = info.read()

    def terminate(self) -> None:  # noqa: D102
        self.call(self._terminate)

    # ---- Co-Simulation ----

    def stepper(self, start: c_double, step: c_double) -> Stepper:  # noqa: D102
        reached = c_double()
        real_status = self.library.optional(self.name("GetRealStatus"))

        def progress() -> Progress:
            status = (
                ERROR
                if real_status is None
                else real_status(self.component, _LAST_SUCCESSFUL_TIME, byref(reached))
            )
            return Progress(reached.value if status in (0, WARNING) else None, False)

        new_step = c_byte(1)
        arguments = (self.component, start, step, new_step)
        final = c_byte(1)  # FMI 1 saves no state, and does not ask
        return Stepper(
            self.function(self.name("DoStep")), arguments, final, (0,), c_byte(0), progress
        )

    # ---- Model Exchange ----

    def enter_event_mode(self) -> None:
        """Do nothing, since FMI 1 has no modes."""

    def update_discrete_states(self) -> EventInfo:  # noqa: D102
        if self._first is not None:  # FMI 1's initialisation is the first update
            first, self._first = self._first, None
            return first
        info = _EventInfo()
        self.call(self.name("EventUpdate"), c_byte(0), byref(info))
        return info.read()

    def enter_continuous_time_mode(self) -> None:
        """Do nothing, since FMI 1 has no modes."""

    def completed_step(self) -> tuple[bool, bool]:  # noqa: D102
        event = c_byte()
        self.call(self.name("CompletedIntegratorStep"), byref(event))
        return bool(event.value), False
