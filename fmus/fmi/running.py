"""The states of an instance from start to end, the same for every FMI version and kind."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress

from fmus.description.model import Channel, Value
from fmus.errors import FmuStartError
from fmus.fmi.calls import CallFailedError, Calls, Setting
from fmus.fmi.clocks import Clocks
from fmus.fmi.status import ERROR, FATAL, PENDING, WARNING, named
from fmus.fmi.values import Transfer, settings
from fmus.profile.clocks import Ticking
from fmus.text import printable

Tick = Callable[[float, float], int]
"""One step: (start of the step [s], step [s]) -> status."""


class _ClocksRefusedError(Exception):
    """The FMU refuses the ticks of clocks to which nothing belongs."""


class Instance(ABC):
    """One instance of an FMU's model, which is started, stepped and stopped.

    Integers, booleans and elements of arrays are stored as doubles in the buffers, too.

    Args:
        calls: The FMU's functions.
        tolerance: Relative tolerance that the FMU is given, or None for its own.

    Attributes:
        inputs: One double per input channel; the next :attr:`tick` hands them to the FMU.
        outputs: One double per output channel, with the values of the last tick.
        remarks: Remarks for the user on the last start.
        tick: Function that does one step and fills :attr:`outputs`.
        messages: Last messages of the FMU, and the faults found in it.
    """

    tickings: tuple[Ticking, ...] = ()  # input clocks that tick

    def __init__(self, calls: Calls, tolerance: float | None) -> None:
        self.model = calls.model
        self.interface = calls.interface
        self.path = calls.model.path
        self.calls = calls
        self.tolerance = tolerance
        self.messages = calls.messages
        self.inputs = self.outputs = memoryview(bytearray()).cast("d")
        self.tick: Tick = _not_started
        self._before_start: list[Setting] = []
        self._at_start: list[Setting] = []  # start values of the inputs
        self._initialised = False
        self.clocks: Clocks | None = None
        self.remarks: list[str] = []  # remarks on the last start
        self._worst = 0  # highest status since the instance was made
        self._untouchable = False  # True after a fatal error

    def start(
        self,
        values: Mapping[Channel, Value],
        inputs: Sequence[Channel],
        outputs: Sequence[Channel],
    ) -> None:
        """Make a new instance with these start values, initialise it, read its outputs.

        Time 0 of the steps is the FMU's ``start_time``.

        Raises:
            FmuStartError: the FMU refuses, or a value does not fit its variable.
        """
        self.stop()
        self.messages.take()
        ready = settings(self.calls, values)
        single = (part.variable for channel in values for part, _factor in channel.parts)
        of_inputs = {variable.name for variable in single if variable.causality == "input"}
        self._before_start = [one for one in ready if one.name not in of_inputs]
        self._at_start = [one for one in ready if one.name in of_inputs]
        try:
            self._initialise()
            self._link(inputs, outputs, values)
        except CallFailedError as error:
            self._worst = max(self._worst, error.status)
            reason = f"{error}: {self.messages.take() or 'without a message'}"
            self.stop()
            raise FmuStartError(
                f"{self.path}: the FMU does not start: {reason}; {error.remedy}"
            ) from error
        except Exception:
            self.stop()
            raise

    def _initialise(self) -> None:
        """Make an instance and bring it to its first time."""
        self._instantiate()
        self.calls.configure(self._before_start)
        try:  # an FMU may compute with its inputs as soon as it enters initialization mode
            self.calls.configure(self._at_start)
        except CallFailedError as error:
            if error.status == FATAL:
                raise
            self.messages.take()  # it takes inputs in that mode only
            self.calls.free()
            self._instantiate()
            self.calls.configure(self._before_start)
        self.calls.initialise(self._at_start, self.tolerance)
        self._initialised = True
        try:
            self._ask_clocks()
            self.prepare()
        except _ClocksRefusedError as refusal:
            names = ", ".join(printable(one.name, 60) for one in self.tickings)
            self.remarks.append(f"it refuses the ticks of its input clocks ({names}): {refusal}")
            self.messages.take()
            self.calls.free()
            self._worst, self._initialised, self.tickings = 0, False, ()
            self.calls.event_mode, self.calls.active = False, None
            self._initialise()

    def _instantiate(self) -> None:
        """Make an instance."""
        self.calls.instantiate()

    def _ask_clocks(self) -> None:
        """Try out the clocks in the event mode after the initialisation."""
        self.clocks = Clocks(self.calls, self.tickings) if self.tickings else None
        if self.clocks is None:
            return
        try:
            self.clocks.try_out()
        except CallFailedError as error:
            if self.clocks.needed or error.status == FATAL:
                raise
            raise _ClocksRefusedError(error) from None

    def _link(
        self,
        inputs: Sequence[Channel],
        outputs: Sequence[Channel],
        values: Mapping[Channel, Value],
    ) -> None:
        into, out = Transfer(self.calls, "Set", inputs), Transfer(self.calls, "Get", outputs)
        self.inputs, self.outputs = into.view, out.view
        for index, channel in enumerate(inputs):
            given = values.get(channel)
            if isinstance(given, int | float):
                self.inputs[index] = given
        status = self.note_status(out.function(*out.arguments))
        if status > WARNING:
            raise CallFailedError("the reading of its outputs", status)
        tick = self.tick = self.make_tick(into, out)
        if first := self.calls.start_time:
            self.tick = lambda time, size: tick(first + time, size)

    def prepare(self) -> None:  # noqa: B027
        """Prepare the instance between its initialisation and the first step."""

    @abstractmethod
    def make_tick(self, into: Transfer, out: Transfer) -> Tick:
        """Return the function that does a step."""

    def note_status(self, status: int) -> int:
        """Remember the worst status; return the status (ERROR if FMI does not know it)."""
        if not 0 <= status <= PENDING:
            self.messages.add(ERROR, f"it returned {named(status)}, which FMI does not know")
            status = ERROR
        self._worst = max(self._worst, status)
        return status

    # ---- end ----

    def stop(self) -> None:
        """End and free the instance, if there is one; the library stays loaded."""
        self.tick = _not_started
        self._untouchable |= self._worst == FATAL  # no function may be called after a fatal error
        if self.calls.component and self._worst != FATAL:
            with suppress(Exception):  # an FMU that cannot be ended properly does no harm
                if self._initialised and self._worst < ERROR:
                    self.calls.terminate()
            with suppress(Exception):
                self.calls.free()
        self.calls.component = None
        self._initialised = False
        self._worst = 0

    def close(self) -> None:
        """Free the instance and the library."""
        self.stop()
        if not self._untouchable:
            self.calls.library.close()


def _not_started(_start: float, _step: float) -> int:
    return ERROR
