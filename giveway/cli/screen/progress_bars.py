"""The progress bars: of a run, and of things that are counted."""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import perf_counter

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from giveway.config import RunConfig
from giveway.run_data.progress import Progress as State
from giveway.run_data.progress import Watcher

_REFRESH = 0.1  # Wall-clock time [s] between two redraws


@contextmanager
def run_progress(console: Console, config: RunConfig) -> Iterator[Watcher | None]:
    """Show a bar of the distance driven, which vanishes when the run has ended.

    The loop itself draws it: a refreshing thread would write while file descriptor 2 belongs to
    SUMO.
    """
    if console.quiet:
        yield None
        return
    columns = (
        TextColumn("{task.description}"),
        BarColumn(bar_width=None),
        TextColumn("{task.fields[state]}"),
    )
    with Progress(*columns, console=console, auto_refresh=False, transient=True) as bar:
        task = bar.add_task("SUMO runs up to the departure", total=None, state="")
        drawn = -_REFRESH

        def watch(state: State) -> None:
            nonlocal drawn
            now = perf_counter()
            if state.doing:
                bar.update(task, description=state.doing, total=None, state="", refresh=True)
                return
            if now - drawn < _REFRESH:
                return
            drawn = now
            if not math.isfinite(state.goal):  # no ego on the road
                what = f"{state.pedestrians} pedestrians" if state.pedestrians else ""
                bar.update(task, state=f"t = {state.clock:.1f} s  {what}", refresh=True)
                return
            text = (
                f"{state.position:.1f}/{state.goal:.4g} m  t = {state.time:.1f} s  "
                f"v = {state.speed:.1f} m/s  {state.acting}  {state.pedestrians} pedestrians"
            )
            bar.update(
                task,
                description=f"{config.driver} drives",
                total=state.goal,
                completed=min(state.position, state.goal),
                state=text,
                refresh=True,
            )

        yield watch


@contextmanager
def counting(console: Console, what: str) -> Iterator[Callable[[int, int, str], None]]:
    """Show a bar of how much is done, with a remark.

    The bar vanishes at the end.
    """
    columns = (
        TextColumn("{task.description}"),
        BarColumn(bar_width=None),
        TextColumn("{task.completed}/{task.total} {task.fields[state]}"),
        TimeRemainingColumn(),
    )
    shown = console.is_terminal and not console.quiet
    with Progress(*columns, console=console, transient=True, disable=not shown) as bar:
        task = bar.add_task(what, total=None, state="")

        def count(done: int, of: int, state: str) -> None:
            bar.update(task, completed=done, total=of, state=state)

        yield count
