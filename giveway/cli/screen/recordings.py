"""The screen of commands about recordings: progress while they are read, and their citation."""

import itertools
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console

from giveway.cli.screen.printing import escape
from giveway.cli.screen.progress_bars import counting
from giveway.recordings import Dataset, Recording, read_recordings


def read(console: Console, folder: Path, dataset: Dataset) -> tuple[Recording, ...]:
    """Read all recordings of a folder, and show a bar of how many are read.

    Raises:
        DatasetError: they cannot be read.
    """
    with counting(console, "Reading") as count:
        return read_recordings(
            folder, dataset, lambda done, of, name: count(done, of, escape(name))
        )


@contextmanager
def counted(console: Console, what: str, of: int) -> Iterator[Callable[[str], None]]:
    """Show a bar of how many recordings are done; the context takes each one's name."""
    with counting(console, what) as count:
        numbers = itertools.count(1)
        yield lambda name: count(next(numbers), of, escape(name))


def cite(console: Console, dataset: Dataset) -> None:
    """Print what the authors of a data set ask to be cited."""
    if dataset.citation:
        console.print(f"Please cite: {escape(dataset.citation)}", highlight=False)
