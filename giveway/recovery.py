"""After a crash of native code: the rows that the run had recorded, as a result like any other."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from giveway.api import keep
from giveway.config.layers import read_toml_text
from giveway.config.loading import load
from giveway.errors import CrashError
from giveway.recording.journal_reader import read_journal
from giveway.recording.recorded import RecordedRows
from giveway.records.progress import Ending
from giveway.results.folder import release_folder
from giveway.results.provenance import manifest
from giveway.results.run_result import RunResult, results_of_egos

if TYPE_CHECKING:
    from giveway.config import RunConfig
    from giveway.processes.supervisor import Verdict
    from giveway.recording.journal_reader import JournalContents
    from sumo_scenarios import Scenario


def recover(journal: Path, verdict: Verdict) -> CrashError:
    """Write the rows of a run whose process died, and say how it died.

    Args:
        journal: the folder that the dead process wrote to.
        verdict: on its end.

    Returns:
        The error to report; its ``result`` holds the rows, if there are any.

    Raises:
        GivewayError: the rows cannot be read or written.
    """
    contents = read_journal(journal)
    if not contents.meta:
        return CrashError(f"the run's process died: {verdict.message}; run 'giveway doctor'")
    config, scenario = load([read_toml_text(contents.meta["config"], "the run's configuration")])
    folder = contents.meta["results"]
    report = (
        f"{scenario.config_file}: the run's process died: {verdict.message}; 'giveway doctor "
        f"{config.scenario}' looks for the cause"
    )
    error = CrashError(report)
    if not contents.commits:
        if contents.meta["taken"]:
            release_folder(Path(folder))
        return error
    error.result = result = _result_of(config, scenario, contents, error, verdict)
    if folder is not None:
        wanted = {name: contents.meta[name] for name in ("parquet", "pictures", "taken")}
        keep(result, Path(folder), **wanted)
        error.args = (f"{report}; rows up to then are in {folder}",)
    return error


def _result_of(
    config: RunConfig,
    scenario: Scenario,
    contents: JournalContents,
    error: CrashError,
    verdict: Verdict,
) -> RunResult:
    rows = RecordedRows(contents.tables, contents.names)
    endings = {
        ego.id: Ending.COMPLETED
        for ego in rows.egos()
        if ego.track.position[-1] >= ego.goal  # it had reached its goal before the crash
    }
    return RunResult(
        config=config,
        scenario=scenario,
        ending=Ending.CRASHED,
        error=error,
        time=rows.time,
        egos=results_of_egos(config, rows, Ending.CRASHED, endings),
        crowd_track=rows.crowd_track(),
        background_track=rows.background_track(),
        timings=rows.timings(),
        elapsed=float(np.nansum(rows.timings().seconds[:, -1])),
        manifest=manifest(
            config,
            scenario,
            config_text=contents.meta["config"],
            vehicles={},
            pedestrians=rows.ledger,
            traffic={},
            sumo={},
            time_step=None,
            remarks=(),
            ending=str(Ending.CRASHED),
            error=str(error),
        ),
        sumo_messages="\n".join(part for part in (verdict.last_words, verdict.traceback) if part),
        road=(),
        remarks=(),
    )
