"""The supervisor of ``giveway run``: the run is a child process, whose crash loses no row."""

import sys
from collections.abc import Callable
from pathlib import Path

from giveway.cli.exit import fail
from giveway.errors import CrashError, GivewayError
from giveway.processes.child import Supervised
from giveway.processes.interrupts import DeferredInterrupt, exit_code_of, who_ended
from giveway.processes.supervisor import journal_folder, own_command, supervise


def run_isolated() -> int:
    """Run the same command line in a process of its own.

    Returns:
        The exit code: the child's own, or 1 after a crash, whose report goes to stderr.

    Raises:
        GivewayError: the run's process cannot be started, or the rows of a crashed run cannot be
            written.
    """
    with journal_folder() as journal:
        try:
            verdict = supervise(own_command(), journal)
        except OSError as error:
            raise CrashError(
                f"{error.filename or sys.executable}: the run's process cannot be started "
                f"({error.strerror}); free memory or disk, raise the limit of processes "
                "(ulimit -u), or run with --no-isolate"
            ) from error
        if not verdict.crashed:
            return verdict.code
        from giveway.recovery import recover

        with DeferredInterrupt():  # the journal is removed after this
            report = str(recover(journal, verdict))
        return fail(report, verdict.code if verdict.interrupted else 1)


def supervised(journal: Path | None, command: Callable[[], int]) -> None:
    """Make the run in the child process, and end with its exit code.

    Args:
        journal: Folder named by the supervisor, or None without one.
        command: Function that makes the run and returns the exit code; it may raise a
            ``GivewayError``.

    Raises:
        SystemExit: always.
    """
    with Supervised(journal) as child:
        try:
            child.listen()
            code = command()
        except KeyboardInterrupt as error:
            code = fail(f"{who_ended(error)} before the run began", exit_code_of(error))
        except GivewayError as error:
            code = fail(str(error), error.exit_code)
        # raised inside: a failed run that crashes while it ends counts as failed
        raise SystemExit(code)
