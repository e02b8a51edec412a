"""The interface of an executor, which makes the runs of a study on this machine or on others."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Protocol, Self

from giveway.errors import GivewayError

if TYPE_CHECKING:
    from giveway.studies.record import RunRecord, Task


class WorkerError(GivewayError):
    """No process that makes the runs can be started or reached; finished runs are kept."""


class Executor(Protocol):
    """A maker of runs. It is a context manager, and leaves no process at its end."""

    @property
    def workers(self) -> int:
        """The number of runs that are made at the same time."""

    def run(self, tasks: Iterable[Task]) -> Iterator[RunRecord]:
        """Make every run once, and yield its record when it is finished.

        A run that crashes, hangs, takes too long or raises an error is made once more. If it fails
        again, its record has the reason.

        Args:
            tasks: Runs to be made, taken one by one and only a few in advance.

        Raises:
            GivewayError: no run can be made at all, for a reason that a user can remove.
            KeyboardInterrupt: the user ends it; all processes have been ended.
        """

    def __enter__(self) -> Self:
        """Begin; processes are started when there are runs to make."""

    def __exit__(self, *_: object) -> None:
        """End every process at once."""
