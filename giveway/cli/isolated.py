"""``giveway run`` as a supervisor: the run is a child, whose crash costs no row."""

from __future__ import annotations

from giveway.cli import INTERRUPTED, fail
from giveway.supervisor import journal_folder, own_command, supervise


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
