"""The life of an instance, which is the same for every FMI version and kind."""

from __future__ import annotations

from abc import abstractmethod
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from fmus.errors import FmuPlatformError, FmuStartError, FmuStateError
from fmus.fmi.calls import CallFailedError, named
from fmus.fmi.values import Transfer, settings
from fmus.interfaces.instance import ERROR, FATAL, PENDING, WARNING, Instance

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fmus.description.model import Channel, Value
    from fmus.fmi.calls import Calls
    from fmus.interfaces.instance import Tick


class RunningInstance(Instance):
    """An instance that is started, stepped, stopped.

    Args:
        calls: the FMU's functions.
        tolerance: relative, told to the FMU; None: its own.
    """

    def __init__(self, calls: Calls, tolerance: float | None) -> None:
        super().__init__(calls.model, calls.interface)
        self.calls = calls
        self.tolerance = tolerance
        self.journal = calls.journal
        self._initialised = False
        self._get_outputs: Transfer
        self._worst = 0  # status since the instance was made
        self._untouchable = False  # after a fatal error
        self._idle = self.tick

    @property
    def path(self) -> Any:
        """The FMU's file, for messages."""
        return self.model.path

    def start(  # noqa: D102 - as in Instance
        self,
        values: Mapping[Channel, Value],
        inputs: Sequence[Channel],
        outputs: Sequence[Channel],
    ) -> None:
        self.stop()
        self.journal.take()
        ready = settings(self.calls, values)
        of_inputs = {c.variable.name for c in values if c.variable.causality == "input"}
        try:
            self.calls.instantiate()
            self.calls.configure([one for one in ready if one.name not in of_inputs])
            self.calls.initialise([one for one in ready if one.name in of_inputs], self.tolerance)
            self._initialised = True
            self.prepare()
            self._link(inputs, outputs, values)
        except CallFailedError as error:
            self._worst = max(self._worst, error.status)
            reason = f"{error}: {self.journal.take() or 'without a message'}"
            self.stop()
            msg = f"{self.path}: the FMU does not start: {reason}; {error.remedy}"
            raise FmuStartError(msg) from error
        except Exception:
            self.stop()
            raise

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
        self._get_outputs = out
        status = self.look(out.function(*out.arguments))
        if status > WARNING:
            msg = "the reading of its outputs"
            raise CallFailedError(msg, status)
        self.tick = self.make_tick(into, out)

    def prepare(self) -> None:
        """What is left to do between the initialisation and the first step."""

    @abstractmethod
    def make_tick(self, into: Transfer, out: Transfer) -> Tick:
        """What does a step."""

    def look(self, status: int) -> int:
        """A status as FMI knows them, noted for how the instance may be ended."""
        if not 0 <= status <= PENDING:
            self.journal.add(ERROR, f"it returned {named(status)}, which FMI does not know")
            status = ERROR
        self._worst = max(self._worst, status)
        return status

    # ---- states ----

    def save(self) -> Any:  # noqa: D102 - as in Instance
        try:
            return self.calls.save()
        except (CallFailedError, FmuPlatformError) as error:
            raise self._refusal("does not save its state", error) from error

    def restore(self, state: Any) -> None:  # noqa: D102
        if self._worst == FATAL:
            msg = f"{self.path}: the FMU failed fatally; start the vehicle again"
            raise FmuStateError(msg)
        try:
            self.calls.restore(state)
        except (CallFailedError, FmuPlatformError) as error:
            raise self._refusal("does not return to the saved state", error) from error
        self._worst = 0
        status = self.look(self._get_outputs.function(*self._get_outputs.arguments))
        if status > WARNING:
            unread = CallFailedError("the reading of its outputs", status)
            raise self._refusal("does not return to the saved state", unread)

    def free_state(self, state: Any) -> None:  # noqa: D102
        if self.calls.component and self._worst != FATAL:
            with suppress(
                CallFailedError, FmuPlatformError
            ):  # nothing is left to do for a state that stays
                self.calls.free_state(state)

    def _refusal(self, what: str, error: Exception) -> FmuStateError:
        said = self.journal.take() or str(error)
        reason = "its binary lacks the function" if isinstance(error, FmuPlatformError) else said
        return FmuStateError(f"{self.path}: the FMU {what}: {reason}; start the vehicle again")

    # ---- end ----

    def stop(self) -> None:  # noqa: D102
        self.tick = self._idle
        self._untouchable |= self._worst == FATAL  # then nothing may be called any more
        if self.calls.component and self._worst != FATAL:
            with suppress(Exception):  # nothing is lost if an FMU cannot end in peace
                if self._initialised and self._worst < ERROR:
                    self.calls.terminate()
            with suppress(Exception):
                self.calls.free()
        self.calls.component = None
        self._initialised = False
        self._worst = 0

    def close(self) -> None:  # noqa: D102
        self.stop()
        if not self._untouchable:
            self.calls.library.close()
