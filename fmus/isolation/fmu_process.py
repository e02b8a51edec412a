"""The process of an FMU as its client sees it: started anew for every episode, called, ended."""

from __future__ import annotations

import os
import weakref
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from fmus import errors
from fmus.archive.own_folder import fresh_name
from fmus.archive.place import unpacking_place
from fmus.errors import FmuCrashError, FmuError, FmuStartCrashError, FmuStepError
from fmus.isolation.cleanup import remove
from fmus.isolation.hosted import Hosted
from fmus.isolation.process_host import ProcessHost, make_process_host
from fmus.isolation.wire import LOAD, QUIT, STEP, Client, GarbledError, Text
from fmus.isolation.worker import Order
from fmus.profile.preparation import unpack
from fmus.text import printable

_END_TIMEOUT = 5.0  # [s] time for an FMU to end by itself
_END_PATIENCE = 1.0  # [s] between the end of the connection and that of the process


class FmuProcess:
    """The process of an FMU; whatever the FMU does there, this process goes on.

    Args:
        hosted: Adapter that runs the FMU in that process.
        prepared: Prepared vehicle or controller, as the adapter takes it.

    Attributes:
        warnings: Warnings of the FMU, since its last start.
        failed: True after a failed episode: the FMU is then not asked to end.
        last: Numbers of the reply that reported an error; empty without one.
        last_time: Time [s] of its last step.

    Raises:
        FmuError: the FMU cannot be unpacked, or no process can be started.
    """

    def __init__(self, hosted: type[Hosted], prepared: Any) -> None:
        self.path = prepared.path
        self.warnings: list[str] = []
        self.failed = False
        self.last: Sequence[float] = ()
        self.last_time = 0.0
        self._numbers = hosted.numbers(prepared)
        self._client: Client | None = None
        folder = fresh_name("vehicle-fmu-", unpacking_place())
        try:
            folder.mkdir(mode=0o700)
            self._host = make_process_host(Order(hosted, prepared, folder / "fmu"), folder)
        except BaseException:
            remove(folder)
            raise
        self._owner = os.getpid()
        self._closing = weakref.finalize(self, _close, self._owner, self._host, folder)
        try:
            unpack(prepared, folder / "fmu")
        except BaseException:
            self._closing()
            raise

    @property
    def closed(self) -> bool:
        """Return whether it has been closed for good."""
        return not self._closing.alive

    def begin(self) -> None:
        """End the last episode, and start a new process for the next one."""
        self.warnings = []
        self.end()
        self.failed, self.last = False, ()
        self._client = Client(self._host.start_process(), *self._numbers)

    def ask(
        self, what: bytes, numbers: Sequence[float], timeout: float, when: Callable[[], str]
    ) -> Sequence[float]:
        """Let the FMU's process carry out a request.

        Args:
            what: Kind of the request.
            numbers: Numbers of the request.
            timeout: Time [s] within which it must be done.
            when: Function that returns the time of the request in words, for messages.

        Returns:
            The numbers of the reply.

        Raises:
            FmuError: the error that the FMU's process reports.
            FmuCrashError: the process died, or did not answer in time.
        """
        assert self._client is not None  # it exists while no call is refused
        try:
            done, state, text = self._client.ask(what, numbers, timeout)
            if isinstance(warnings := text.get("warnings"), list):
                self.warnings += [printable(warning, 1000) for warning in warnings]
            if not done:
                raise self._reported_error(text, state)
        except (TimeoutError, EOFError, GarbledError) as problem:
            self.failed, self._host.sound = True, False
            raise self._crash(what, when(), problem, timeout) from None
        except BaseException:  # after Ctrl-C, the reply would be taken for that of the next step
            self.failed, self._host.sound = True, False
            raise
        return state

    def _reported_error(self, text: Text, state: Sequence[float]) -> FmuError:
        """Return the reported error; only this package's error classes are accepted."""
        kind = getattr(errors, str(text.get("error")), None)
        message = printable(text.get("message"), 2000)
        if not (isinstance(kind, type) and issubclass(kind, FmuError)):
            return FmuStepError(f"{self.path}: {message}")
        time = text.get("time")
        if isinstance(time, float):
            self.last, self.last_time = state, time
        return kind(message)

    def _crash(self, what: bytes, when: str, problem: Exception, timeout: float) -> FmuCrashError:
        """End the process; the error says when it ended, why, and its last output."""
        lost = isinstance(problem, EOFError)
        report = self._host.end_process(_END_PATIENCE if lost else 0.0)
        if lost:
            reason = f"the FMU's process {report.cause} {when}{report.after_printing}"
            advice = "report it to the FMU's maker"
        elif isinstance(problem, TimeoutError):
            reason = f"no answer within {timeout:g} s {when}{report.after_printing}; killed"
            key = "step_timeout" if what == STEP else "start_timeout"
            line = f"{key} = {min(10.0 * timeout, 3600.0):g}"
            advice = f"if it is only slow, add `{line}` to [fmu] of the profile"
        else:
            reason = (
                f"the FMU's process wrote into giveway's connection {when}{report.after_printing}"
            )
            advice = "killed; report it to the FMU's maker"
        kind = FmuCrashError if what == STEP else FmuStartCrashError
        return kind(f"{self.path}: {reason}; {advice}")

    def end(self) -> None:
        """Ask the process to end, and kill it if it does not; without a process do nothing."""
        client, self._client = self._client, None
        if client is None:
            return
        try:
            if not self.failed:
                client.ask(QUIT, (), _END_TIMEOUT)
        except TimeoutError:
            self._host.sound = False
            self.warnings.append(
                f"{self.path.name}: the FMU did not end within {_END_TIMEOUT:g} s; killed"
            )
        except (EOFError, GarbledError):
            self._host.sound = False
            cause = self._host.end_process(_END_PATIENCE).cause
            self.warnings.append(f"{self.path.name}: the FMU's process {cause} when it was ended")
        finally:
            client.close()
            self._host.end_process()

    def close(self) -> None:
        """End the FMU and its process; a second call does nothing."""
        if self.closed:
            return
        try:
            if os.getpid() == self._owner:  # a fork of this process must not end the FMU
                self.end()
        finally:
            self._closing()


def while_starting(what: bytes) -> str:
    """Return when a request other than a step was made, in words for error messages."""
    return "while it was loaded" if what == LOAD else "while it was started"


def _close(owner: int, host: ProcessHost, folder: Path) -> None:
    if os.getpid() == owner:
        try:
            host.close()
        finally:  # also after a Ctrl-C during the wait
            remove(folder)
