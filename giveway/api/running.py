"""The run of one configuration, up to its folder; the rows are kept after every failure."""

import shlex
from contextlib import ExitStack
from pathlib import Path
from typing import Any, TypedDict

from fmus import processes_reused
from giveway.api.simulation import simulate
from giveway.config import RunConfig
from giveway.config.files.layers import dump_toml
from giveway.config.files.loading import as_layer, load
from giveway.cosimulation.preflight import CheckedRun, preflight
from giveway.errors import GivewayError, ResultsError
from giveway.journal.journal import Journal
from giveway.processes.child import STDERR_FILE
from giveway.processes.heartbeat import Phase
from giveway.processes.interrupts import DeferredInterrupt
from giveway.results.folder import (
    ARGUMENTS,
    NOWHERE,
    Destination,
    release_folder,
    sumo_folder,
    taken_folder,
    write_results,
)
from giveway.results.inputs import require_recorded
from giveway.results.run_result import RunResult
from giveway.results.table_files import require_parquet
from giveway.run_data.progress import Watcher
from giveway.run_data.seal import Form


class Outputs(TypedDict):
    """The outputs that a user wants in the results folder."""

    parquet: bool  # True to write the tables also as Parquet
    trajectories: Form  # form of the longest table
    pictures: bool  # True to draw the pictures


@processes_reused()
def run(
    config: RunConfig | dict[str, Any] | str | Path,
    *,
    out: str | Path | None = None,
    results: str | Path | None = None,
    force: bool = False,
    parquet: bool = False,
    trajectories: Form = "csv",
    pictures: bool = True,
    watcher: Watcher | None = None,
) -> RunResult:
    """Run one configuration: drive the egos through the scenario and its crowd.

    The simulation runs in this process, which ends if native code (SUMO, an FMU) crashes. The
    command line isolates it.

    Args:
        config: Options that differ from the scenario's settings and the defaults, as a
            ``RunConfig`` or as a dictionary with the keys of the TOML file, by tables or dotted
            (``{"crowd.pedestrians": 30}``); or the name of a scenario, or of a .toml file.
        out: Folder for tables, summary, manifest and pictures, or None to write nothing.
        results: Former name of ``out``.
        force: True to replace existing results.
        parquet: True to write the tables also as Parquet.
        trajectories: Form of the longest table.
        pictures: True to draw also the state figure and the top view.
        watcher: Function that is called with a ``Progress`` at every control step.

    Returns:
        The result. A run that was interrupted (Ctrl-C) also returns one; see its ``ending``.

    Raises:
        GivewayError: one line that says what to do. If the run had begun, its rows are written
            anyway, and the partial result is the error's attribute ``result``.
    """
    folder = results if out is None else out
    layer = as_layer(config)
    loaded = load([layer])
    if layer.results is not None:
        require_recorded(layer.results, *loaded)
    return run_checked(
        preflight(*loaded),
        Destination(
            None if folder is None else Path(folder),
            force,
            parquet,
            trajectories,
            pictures,
            ARGUMENTS,
        ),
        watcher=watcher,
        baseline=True,
    )


def run_checked(
    checked: CheckedRun,
    destination: Destination = NOWHERE,
    *,
    watcher: Watcher | None = None,
    journal: Path | None = None,
    baseline: bool = False,
) -> RunResult:
    """Do the same as :func:`run` for a run that has passed the preflight.

    Args:
        checked: Run that has passed the preflight.
        destination: Folder and files of the results.
        watcher: Function, see :func:`run`.
        journal: Empty folder for the rows, which can be read if this process dies.
        baseline: True to let plain SUMO make the egos' trips as well, if the configuration leaves
            that open.
    """
    folder, force, parquet, trajectories, pictures, wording = destination
    if parquet or trajectories == "parquet":
        require_parquet()
    with ExitStack() as stack:
        # neither taking the folder nor writing into it is interrupted
        interrupt = stack.enter_context(DeferredInterrupt())
        taken = folder is not None and stack.enter_context(
            taken_folder(folder, force=force, wording=wording)
        )
        rows = Journal(journal)
        where = None if folder is None else str(folder.absolute())
        outputs: Outputs = {"parquet": parquet, "trajectories": trajectories, "pictures": pictures}
        wanted = {"results": where, "taken": taken, **outputs}
        rows.write_meta({"config": dump_toml(checked.config), **wanted})
        native_log = None if journal is None or rows.failure else journal / STDERR_FILE
        try:
            result = simulate(
                checked,
                watcher,
                interrupt,
                outputs=None if folder is None else sumo_folder(folder),
                journal=rows,
                native_log=native_log,
                baseline=baseline,
            )
        except Exception:
            if folder is not None and taken:
                release_folder(folder)
            raise
        rows.heartbeat.beat(Phase.WRITING)
        if folder is not None:
            try:
                keep(result, folder, taken, outputs)
            except ResultsError as error:
                if journal is not None and not rows.failure:
                    rows.heartbeat.keep()
                    error.args = (f"{error}; {in_journal(journal)}",)
                raise
    if result.error is not None:
        if isinstance(result.error, GivewayError):
            result.error.result = result
        raise result.error
    return result


def in_journal(journal: Path) -> str:
    """Return a sentence on how to write the rows that are only in a kept journal."""
    return f"every row is kept: 'giveway recover {shlex.quote(str(journal))} --force' writes them"


def keep(result: RunResult, folder: Path, taken: bool, outputs: Outputs) -> None:
    """Write the result into ``folder``, or free the folder if there is nothing to write.

    Args:
        result: Result of the run.
        folder: Results folder.
        taken: True if the folder was empty before the run.
        outputs: Outputs that are wanted.

    Raises:
        ResultsError: the result cannot be written.
    """
    if len(result.time):
        write_results(
            result, folder, parquet=outputs["parquet"], trajectories=outputs["trajectories"]
        )
        if outputs["pictures"]:
            from giveway.results.pictures import write_pictures

            write_pictures(result, folder)
    elif taken:
        release_folder(folder)
