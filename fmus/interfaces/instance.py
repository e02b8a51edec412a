"""One running FMU, whatever its FMI version and kind: its life, its messages, its channels."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from fmus.text import printable

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fmus.description.model import Channel, Interface, Model, Value

WARNING: Final = 1  # the last FMI status with which a call has done what it should
DISCARD: Final = 2
ERROR: Final = 3
FATAL: Final = 4
PENDING: Final = 5
ENDED: Final = 6  # not FMI's: the FMU asked to end the simulation
STATUS_NAMES: Final = (
    "OK", "warning", "discard", "error", "fatal", "pending", "end of the simulation",
)  # fmt: skip

Tick = Callable[[float, float], int]
"""One step: (start of the step [s], step [s]) -> status."""


class Journal:
    """The last messages of an FMU that tell of anything but success."""

    def __init__(self) -> None:
        self._messages: deque[str] = deque(maxlen=3)

    def add(self, status: int, message: bytes | str | None) -> None:
        """Keep a message, on one line; one that was the last already is not repeated."""
        if not status or not message:
            return
        text = printable(_decoded(message) if isinstance(message, bytes) else message)
        if text and text not in self._messages:
            self._messages.append(text)

    def take(self) -> str:
        """Everything since the last time."""
        text = "; ".join(self._messages)
        self._messages.clear()
        return text


class Instance(ABC):
    """An FMU's library, loaded, and one instance of its model.

    Whole numbers, booleans and elements of arrays are doubles in the buffers, too.

    Attributes:
        inputs: one double per input channel; the next :attr:`tick` hands them to the FMU.
        outputs: one double per output channel, as of the last tick.
        tick: does one step and fills :attr:`outputs`.
        journal: the FMU's last messages, and what was found wrong with it.
    """

    def __init__(self, model: Model, interface: Interface) -> None:
        self.model = model
        self.interface = interface
        self.journal = Journal()
        self.inputs = self.outputs = memoryview(bytearray()).cast("d")
        self.tick: Tick = _not_started

    @abstractmethod
    def start(
        self,
        values: Mapping[Channel, Value],
        inputs: Sequence[Channel],
        outputs: Sequence[Channel],
    ) -> None:
        """Make a new instance with these start values, initialise it at time 0, read its outputs.

        Raises:
            FmuStartError: the FMU refuses, or a value does not fit its variable.
        """

    @abstractmethod
    def save(self) -> Any:
        """The FMU's state: an opaque handle, to be freed.

        Raises:
            FmuStateError: the FMU refuses.
        """

    @abstractmethod
    def restore(self, state: Any) -> None:
        """Go back to a saved state and read the outputs; also after a step that failed.

        Raises:
            FmuStateError: the FMU refuses.
        """

    @abstractmethod
    def free_state(self, state: Any) -> None:
        """Free a saved state."""

    @abstractmethod
    def stop(self) -> None:
        """End and free the instance, if there is one; the library stays loaded."""

    @abstractmethod
    def close(self) -> None:
        """Free the instance and the library."""


def _not_started(_start: float, _step: float) -> int:
    return ERROR


def _decoded(message: bytes) -> str:
    """Old tools write Latin-1 where the standard says UTF-8."""
    try:
        return message.decode("utf-8")
    except UnicodeDecodeError:
        return message.decode("latin-1")
