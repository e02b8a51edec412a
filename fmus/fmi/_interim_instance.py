"""One running FMU, whatever its FMI version: its folder, its messages, its life."""

import tempfile
import zipfile
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack, suppress
from ctypes import c_double
from pathlib import Path
from typing import Any, Final

from fmus.errors import FmuFileError, FmuStartError
from fmus.fmi._interim_model import Model, Variable

WARNING: Final = 1  # the last FMI status with which a call has done what it should
DISCARD: Final = 2
STATUS_NAMES: Final = ("OK", "warning", "discard", "error", "fatal", "pending")

Tick = Callable[[float, float], int]
"""One step: (force [N], start of the step [s]) -> FMI status."""


class Journal:
    """The last messages of an FMU that tell of anything but success."""

    def __init__(self) -> None:
        self._messages: deque[str] = deque(maxlen=3)

    def add(self, status: int, message: bytes | None) -> None:
        """Keep a message, on one line."""
        if status and message:
            self._messages.append(" ".join(message.decode("utf-8", "replace").split()))

    def take(self) -> str:
        """Everything since the last time."""
        text = "; ".join(self._messages)
        self._messages.clear()
        return text


class Instance(ABC):
    """An FMU's library, loaded from a temporary folder of its own, and one instance of its model.

    A subclass knows the calls of one FMI version.

    Raises:
        FmuFileError: the archive is damaged.
        FmuPlatformError: the binary cannot be loaded.
    """

    def __init__(self, model: Model) -> None:
        self.model = model
        self.journal = Journal()
        self.buffer = (c_double * 3)()  # filled by every tick
        self.outputs: Sequence[float] = memoryview(self.buffer).cast("B").cast("d")  # quick to read
        with ExitStack() as stack:  # what has been set up is undone if the rest fails
            folder = stack.enter_context(
                tempfile.TemporaryDirectory(prefix="vehicle-fmu-", ignore_cleanup_errors=True)
            )
            _extract(model, folder)
            stack.callback(self.load(Path(folder)))
            stack.callback(self.stop)
            self._resources = stack.pop_all()

    def start(self, values: Mapping[Variable, float | bool]) -> None:
        """Make a new instance with these start values and initialise it at time 0.

        Raises:
            FmuStartError: the FMU refuses.
        """
        self.stop()
        try:
            self.instantiate()
            for variable, value in values.items():
                if variable.is_real:
                    self.set_real(variable.reference, float(value))
                else:
                    self.set_boolean(variable.reference, bool(value))
            self.initialise()
        except Exception as error:
            reason = self.journal.take() or str(error)
            self.stop()
            msg = f"{self.model.path}: the FMU does not start: {reason}; check its start values"
            raise FmuStartError(msg) from error

    def stop(self) -> None:
        """End and free the instance, if there is one; the library stays loaded."""
        with suppress(Exception):  # nothing is lost if an FMU cannot end in peace
            self.terminate()
        self.free_instance()

    def close(self) -> None:
        """Free the instance, the library and the temporary folder."""
        self._resources.close()

    @abstractmethod
    def load(self, folder: Path) -> Callable[[], None]:
        """Load the library from the extracted FMU; returns what unloads it."""

    @abstractmethod
    def instantiate(self) -> None:
        """Make an instance; its messages go to the journal."""

    @abstractmethod
    def set_real(self, reference: int, value: float) -> None:
        """Set a start value."""

    @abstractmethod
    def set_boolean(self, reference: int, value: bool) -> None:
        """Set a start value."""

    @abstractmethod
    def initialise(self) -> None:
        """Bring the instance to time 0, ready to step."""

    @abstractmethod
    def link(self, force: int, outputs: Sequence[int], step_size: float) -> Tick:
        """Read :attr:`outputs`, and return what sets the force, does a step and reads them.

        Args:
            force: value reference of the input.
            outputs: value references, in the order of :attr:`outputs`.
            step_size: [s].

        Raises:
            FmuStartError: the outputs cannot be read.
        """

    @abstractmethod
    def terminate(self) -> None:
        """End the simulation."""

    @abstractmethod
    def free_instance(self) -> None:
        """Free the instance, if there is one."""

    @abstractmethod
    def save(self) -> Any:
        """The FMU's state: an opaque handle, to be freed."""

    @abstractmethod
    def restore(self, state: Any) -> None:
        """Go back to a saved state."""

    @abstractmethod
    def free_state(self, state: Any) -> None:
        """Free a saved state."""


def _extract(model: Model, folder: str) -> None:
    """Unpack what this platform needs."""
    try:
        with zipfile.ZipFile(model.path) as archive:
            wanted = (f"{model.folder}/", "resources/")
            archive.extractall(folder, [m for m in archive.namelist() if m.startswith(wanted)])
    except (zipfile.BadZipFile, EOFError, OSError) as error:
        msg = f"{model.path}: cannot be unpacked: {error}; copy or export the FMU again"
        raise FmuFileError(msg) from error
    Path(folder, "resources").mkdir(exist_ok=True)  # named to the FMU even where it has none
