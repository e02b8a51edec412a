"""The progress of a study in a terminal: a bar, or a line from time to time."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from giveway.studies.study import StudyProgress

_REFRESH = 0.2  # Wall-clock time [s] between two redraws
_LINE = 30.0  # Time [s] between two lines without a terminal


@contextmanager
def study_progress(console: Console, name: str) -> Iterator[_Watcher]:
    """Show a bar with rate, remaining time and failures.

    Without a terminal, a line is printed from time to time.
    """
    if console.quiet:
        yield _Watcher()
    elif console.is_terminal:
        columns = (
            TextColumn("{task.description}"),
            BarColumn(bar_width=None),
            TextColumn("{task.fields[state]}"),
            TimeRemainingColumn(),
        )
        with Progress(*columns, console=console, transient=True, refresh_per_second=4) as bar:
            yield _Bar(bar, name)
    else:
        yield _Lines(console, name)


class _Watcher:
    """A watcher that counts the runs that this session makes, and shows nothing.

    Attributes:
        made: Number of runs made so far.
    """

    def __init__(self) -> None:
        self._began = time.monotonic()
        self.made = 0

    def __call__(self, state: StudyProgress) -> None:
        self.made = state.made
        self.show(state)

    def show(self, state: StudyProgress) -> None:
        """Show the progress of the study."""

    def text(self, state: StudyProgress) -> str:
        """Return the number of runs so far, runs per second of this session, and failures."""
        elapsed = time.monotonic() - self._began
        rate = state.made / elapsed if elapsed else 0.0
        failed = f"  {state.failed} failed" if state.failed else ""
        return f"{state.finished:,}/{state.total:,} runs  {rate:.1f}/s{failed}"


class _Bar(_Watcher):
    def __init__(self, bar: Progress, name: str) -> None:
        super().__init__()
        self._bar = bar
        self._task = bar.add_task(f"study {name}", total=None, state="")
        self._drawn = 0.0

    def show(self, state: StudyProgress) -> None:
        now = time.monotonic()
        if now - self._drawn < _REFRESH and state.finished < state.total:
            return
        self._drawn = now
        self._bar.update(
            self._task, total=state.total, completed=state.finished, state=self.text(state)
        )


class _Lines(_Watcher):
    def __init__(self, console: Console, name: str) -> None:
        super().__init__()
        self._console = console
        self._name = name
        self._told = time.monotonic()

    def show(self, state: StudyProgress) -> None:
        now = time.monotonic()
        if state.latest is None or now - self._told < _LINE:
            return
        self._told = now
        left = (state.total - state.finished) / state.made * (now - self._began)
        text = f"study {self._name}: {self.text(state)}, about {left / 60.0:.0f} min left"
        self._console.print(text, highlight=False)
