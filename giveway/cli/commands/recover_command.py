"""The command ``giveway recover``: the rows of runs that were killed, written as results."""

from pathlib import Path

from rich.console import Console

from giveway.cli.commands.run_command import show
from giveway.cli.screen.printing import escape
from giveway.recovery import left_journals, recover_left


def recover_command(journal: Path | None, out: Path | None, *, force: bool) -> None:
    """Write the rows of a journal, or list the journals.

    Args:
        journal: Folder of a journal, or None to list the journals.
        out: Folder for the rows, or None for the folder of the run.
        force: True to replace existing results.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console()
    if journal is None:
        _list(console)
        return
    result, folder = recover_left(journal, out, force=force)
    show(console, result, folder)


def _list(console: Console) -> None:
    left = left_journals()
    if not left:
        console.print("No run that was killed has left a journal with rows")
    for found in left:
        text = (
            f"{found.path}  {found.scenario}: {found.steps:,} steps, up to {found.clock:.2f} s; "
            f"results were to go to {found.results}"
        )
        console.print(escape(text), highlight=False, soft_wrap=True)
