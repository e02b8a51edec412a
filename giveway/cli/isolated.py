"""``giveway run`` as a supervisor: the run is a child process, whose crash loses no row."""

from __future__ import annotations

from typing import TYPE_CHECKING

from giveway.cli.exit import INTERRUPTED, fail
from giveway.errors import GivewayError
from giveway.processes.child import Supervised
from giveway.processes.supervisor import journal_folder, own_command, supervise

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


def run_isolated() -> int:
    """Run this very command line in a process of its own.

    Returns:
        The exit code: the child's own, or 1 after a crash, whose report goes to stderr.

    Raises:
        GivewayError: the rows of a crashed run cannot be written.
    """
    with journal_folder() as journal:
        verdict = supervise(own_command(), journal)
        if not verdict.crashed:
            return verdict.code
        from giveway.recovery import recover

        return fail(str(recover(journal, verdict)), INTERRUPTED if verdict.interrupted else 1)


def supervised(journal: Path | None, command: Callable[[], int]) -> None:
    """In the child: make the run, and end with its exit code.

    Args:
        journal: folder named by the supervisor; None without one.
        command: makes the run and tells the exit code; may raise a ``GivewayError``.

    Raises:
        SystemExit: always.
    """
    with Supervised(journal) as child:
        try:
            child.listen()
            code = command()
        except KeyboardInterrupt:  # typer would print nothing
            code = fail("interrupted before the run began", INTERRUPTED)
        except GivewayError as error:
            code = fail(str(error), error.exit_code)
        raise SystemExit(code)  # inside: a failed run that crashes while it ends is no success
