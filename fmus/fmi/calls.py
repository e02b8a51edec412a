"""The C functions of one FMI version, under names that all versions share."""

from __future__ import annotations

import ctypes
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from ctypes import c_size_t, c_uint32, c_void_p
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

from fmus.description.model import Interface, Kind, Model
from fmus.fmi.library import Function, Library
from fmus.fmi.messages import MessageLog
from fmus.fmi.status import ERROR, WARNING, named


class CallFailedError(Exception):
    """A function of the FMU failed.

    Attributes:
        status: Status that the function returned.
        remedy: Advice for the user.
    """

    remedy = "check its start values"

    def __init__(self, function: str, status: int) -> None:
        super().__init__(f"{function} returned {named(status)}")
        self.status = status


class NoInstanceError(CallFailedError):
    """The FMU made no instance."""

    remedy = "its binary may be of another model than its description: export the FMU again"

    def __init__(self, function: str) -> None:
        super().__init__(function, ERROR)
        self.args = (f"{function} returned no instance",)


@dataclass(frozen=True)
class CType:
    """The C type of an FMI type, and the end of the names of its functions."""

    type: type[Any]
    suffix: str


@dataclass(frozen=True)
class Progress:
    """The answer of an FMU about a step that it did not complete."""

    reached: float | None  # [s] time that it reached, or None if the FMU does not say
    ended: bool  # the FMU wants to end the simulation


@dataclass
class EventInfo:
    """The answer of an FMU after an update of its discrete states."""

    again: bool = False
    ended: bool = False
    nominals_changed: bool = False
    next_time: float | None = None  # [s] time of its next time event


class Calls(ABC):
    """An FMU's functions.

    Args:
        library: Loaded library.
        model: Model description.
        interface: Interface that is to run.
        folder: Folder with the extracted FMU.
        messages: Log that receives the FMU's messages.

    Raises:
        FmuPlatformError: a function is missing that the FMU must have.
    """

    types: ClassVar[Mapping[str, CType]]
    state_word: ClassVar = "FMUstate"  # the standard's spelling in the names of functions
    exchange: ClassVar[dict[str, str]] = {  # functions that Model Exchange calls often, by purpose
        "set_time": "SetTime",
        "set_states": "SetContinuousStates",
        "get_states": "GetContinuousStates",
        "get_derivatives": "GetDerivatives",
        "get_indicators": "GetEventIndicators",
        "get_nominals": "GetNominalsOfContinuousStates",
    }

    def __init__(
        self,
        library: Library,
        model: Model,
        interface: Interface,
        folder: Path,
        messages: MessageLog,
    ) -> None:
        self.library = library
        self.model = model
        self.interface = interface
        self.folder = folder
        self.messages = messages
        self.component: c_void_p | None = None
        self.start_time = 0.0  # [s] first time of the FMU
        # [s] end of the simulation that the FMU is given, or None
        self.stop_time: float | None = None
        # references of the clocks that tick now, or None if none is ever ticked
        self.active: frozenset[int] | None = None
        self.event_mode = False  # FMI 3's Co-Simulation: True for instances with event mode
        self.prefix = f"fmi{model.fmi_version[0]}"  # beginning of all functions' names
        self.exchanges = interface.kind == Kind.MODEL_EXCHANGE
        self._functions: dict[str, Function] = {}
        self._free: Function
        self.find_functions()

    # ---- life ----

    @abstractmethod
    def find_functions(self) -> None:
        """Look up the functions that every FMU must have, and make the receiver of messages."""

    @abstractmethod
    def instantiate(self) -> None:
        """Make an instance of the model.

        Raises:
            CallFailedError: the FMU refuses.
        """

    def keep_instance(self, component: int | None, function: str) -> None:
        """Keep the instance that a function has made.

        Raises:
            NoInstanceError: the function has made none.
        """
        if not component:
            raise NoInstanceError(function)
        self.component = c_void_p(component)

    def configure(self, setting: Sequence[Setting]) -> None:
        """Set start values."""
        for one in setting:
            self.apply(one)

    @abstractmethod
    def initialise(self, inputs: Sequence[Setting], tolerance: float | None) -> None:
        """Bring the instance to its first time and set the inputs' start values."""

    def terminate(self) -> None:
        """End the simulation."""
        self.call(self.name("Terminate"))

    def free(self) -> None:
        """Free the instance."""
        self._free(self.component)
        self.component = None

    # ---- values ----

    def name(self, verb: str, suffix: str = "") -> str:
        """Return a function's name, e.g. of ``Set`` and ``Real``."""
        return f"{self.prefix}{verb}{suffix}"

    def arguments(self, references: Sequence[int], values: Any) -> tuple[Any, ...]:
        """Return the arguments of a set or get function, for any number of calls."""
        count = len(references)
        return self.component, (c_uint32 * count)(*references), c_size_t(count), values

    def apply(self, setting: Setting) -> None:
        """Set a value.

        Raises:
            CallFailedError: the FMU refuses.
        """
        name = self.name("Set", setting.type.suffix)
        self.call(name, *self.arguments([setting.reference], setting.values)[1:])

    # ---- Co-Simulation ----

    @abstractmethod
    def stepper(self, start: ctypes.c_double, step: ctypes.c_double) -> Stepper:
        """Return the function that does a step, with its arguments."""

    # ---- Model Exchange ----

    def enter_event_mode(self) -> None:
        """Enter event mode from continuous-time mode."""
        self.call(self.name("EnterEventMode"))

    @abstractmethod
    def update_discrete_states(self) -> EventInfo:
        """Do one round of the event iteration."""

    def enter_step_mode(self) -> None:
        """Enter step mode from event mode, in Co-Simulation (FMI 3)."""
        self.call(self.name("EnterStepMode"))

    def enter_continuous_time_mode(self) -> None:
        """Enter continuous-time mode from event mode."""
        self.call(self.name("EnterContinuousTimeMode"))

    @abstractmethod
    def completed_step(self) -> tuple[bool, bool]:
        """Tell the FMU that a step is done; return whether it wants event mode, and to end."""

    def exchange_names(self) -> Mapping[str, str]:
        """Return the names of the functions that Model Exchange calls often, by their purpose."""
        return {what: self.name(verb) for what, verb in self.exchange.items()}

    # ---- state ----

    def save(self) -> c_void_p:
        """Return the FMU's state."""
        state = c_void_p()
        self.call(self.name("Get", self.state_word), ctypes.byref(state))
        return state

    def restore(self, state: c_void_p) -> None:
        """Restore a saved state."""
        self.call(self.name("Set", self.state_word), state)

    def free_state(self, state: c_void_p) -> None:
        """Free a saved state."""
        self.call(self.name("Free", self.state_word), ctypes.byref(state))

    # ---- calling ----

    def function(self, name: str) -> Function:
        """Return a function, which is looked up once.

        Raises:
            FmuPlatformError: the FMU has no such function.
        """
        found = self._functions.get(name)
        if found is None:
            found = self._functions[name] = self.library.function(name)
        return found

    def call(self, name: str, *arguments: Any) -> None:
        """Call a function of the instance.

        Raises:
            CallFailedError: the function failed.
        """
        status = self.function(name)(self.component, *arguments)
        if status not in (0, WARNING):
            raise CallFailedError(name, status)


@dataclass(frozen=True)
class Setting:
    """A variable's start value, ready for C."""

    name: str
    reference: int
    type: CType
    values: Any  # ctypes array


@dataclass(frozen=True)
class Stepper:
    """A step of Co-Simulation.

    ``flags[0]`` is not 0 after a step that FMI 3 calls completed although it ended early.

    ``event`` is a C value that is true after a step that ended with an event (FMI 3).
    ``final`` is a C value among the arguments: the FMU's state will not be set back to a time
    before the beginning of the step (noSetFMUStatePriorToCurrentPoint). Some FMUs keep a step only
    if that is true, and return OK all the same.
    """

    do_step: Function
    arguments: tuple[Any, ...]
    final: Any  # .value may be changed between two steps
    flags: Any  # indexable
    event: Any  # .value may be read after a step
    progress: Callable[[], Progress]  # function to call after an incomplete step


_c_library = ctypes.cdll.msvcrt if sys.platform == "win32" else ctypes.CDLL(None)


def allocators() -> tuple[c_void_p, c_void_p]:
    """Return C's own calloc and free, for FMUs that use the host's functions for memory."""
    return (
        ctypes.cast(_c_library.calloc, c_void_p),
        ctypes.cast(_c_library.free, c_void_p),
    )
