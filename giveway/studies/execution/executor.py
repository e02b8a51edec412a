"""The interface of what makes the runs of a study, on this machine or on others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, Self

from giveway.errors import GivewayError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from giveway.studies.record import RunRecord, Task


class WorkerError(GivewayError):
    """No process can be started or reached that would make the runs; finished runs are kept."""


class Executor(Protocol):
    """Makes runs; a context manager, at whose end no process is left."""

    @property
    def workers(self) -> int:
        """The number of runs that are made at a time."""

    def run(self, tasks: Iterable[Task]) -> Iterator[RunRecord]:
        """Make every run once, and yield its record when it is finished.

        A run that crashes, hangs, takes too long or raises is tried once more; then its record
        says why.

        Args:
            tasks: taken one by one, a few more than are being computed.

        Raises:
            GivewayError: no run can be made at all, for a reason that a user can mend.
            KeyboardInterrupt: the user wants it to end; all processes have been ended.
        """

    def __enter__(self) -> Self:
        """Begin. Processes are started when there is something to do."""

    def __exit__(self, *_: object) -> None:
        """End every process at once."""
