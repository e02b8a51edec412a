"""The Python API: one call, one run, everything it left behind."""

import math
import shlex
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Any, TypeVar

from giveway.config import RunConfig
from giveway.config.foreign_code import provenance
from giveway.config.layers import dump_toml
from giveway.config.loading import as_layer, load
from giveway.cosimulation.assembly import Driven, Parts, assemble
from giveway.cosimulation.followed import Followed
from giveway.cosimulation.loop import Loop
from giveway.cosimulation.preflight import CheckedRun, preflight
from giveway.cosimulation.twin import Twin, twin_of
from giveway.ego.vehicle import model_margin
from giveway.errors import CrowdError, GivewayError, ResultsError, SumoError
from giveway.measures import unreached
from giveway.metrics import delays
from giveway.processes.child import STDERR_FILE
from giveway.processes.heartbeat import Phase
from giveway.processes.interrupts import DeferredInterrupt
from giveway.recording.journal import Journal
from giveway.recording.recorder import Recorder
from giveway.records.progress import Ending, Progress, Watcher
from giveway.results import law, mismatch, vehicle_contacts
from giveway.results.effect import Effect, who_gave_way
from giveway.results.ego_result import EgoResult, results_of_egos
from giveway.results.folder import (
    ARGUMENTS,
    FLAGS,
    Wording,
    release_folder,
    require_parquet,
    sumo_folder,
    taken_folder,
    write_results,
)
from giveway.results.provenance import manifest
from giveway.results.run_result import RunResult
from giveway.sumo.library import is_refusal
from giveway.sumo.road_marks import road_marks
from pedestrian_model import PedestrianModelError
from sumo_scenarios import Scenario

__all__ = ["RunResult", "run", "run_checked", "simulate"]

TRAFFIC_DIFFERS = (
    "twin: traffic lights or background vehicles did something else than in the run, so that the "
    "delays of people are not the egos' alone"
)

NO_EGO = "twin: no ego was on the road, so that there is nothing to compare with"

Result = TypeVar("Result")


def run(
    config: RunConfig | dict[str, Any] | str | Path,
    *,
    results: str | Path | None = None,
    force: bool = False,
    parquet: bool = False,
    pictures: bool = True,
    watcher: Watcher | None = None,
) -> RunResult:
    """Run one configuration: drive the egos through the scenario and its crowd.

    The simulation runs in this process: native code that crashes (SUMO, an FMU) takes it along.
    The command line isolates it.

    Args:
        config: the options that differ from the scenario's settings and the defaults, as a
            ``RunConfig`` or as a dictionary with the keys of the TOML file, by tables or dotted
            (``{"crowd.pedestrians": 30}``); or the name of a scenario, or a .toml file.
        results: a folder to write tables, summary, manifest and pictures to; None writes nothing.
        force: replace the results that are there.
        parquet: also write the tables as Parquet.
        pictures: also draw the state figure and the top view.
        watcher: called with a ``Progress`` at every control step.

    Returns:
        The result. A run that was interrupted (Ctrl-C) returns too; see its ``ending``.

    Raises:
        GivewayError: one line that says what to do. If the run had begun, its rows are written
            all the same and the partial result is the error's ``result`` attribute.
    """
    return run_checked(
        preflight(*load([as_layer(config)])),
        results=results,
        wording=ARGUMENTS,
        force=force,
        parquet=parquet,
        pictures=pictures,
        watcher=watcher,
    )


def run_checked(
    checked: CheckedRun,
    *,
    results: str | Path | None,
    force: bool = False,
    parquet: bool = False,
    pictures: bool = True,
    watcher: Watcher | None = None,
    journal: Path | None = None,
    wording: Wording = FLAGS,
) -> RunResult:
    """As :func:`run`, after the preflight.

    Args:
        checked: what is to be run.
        results: as for :func:`run`.
        force: as for :func:`run`.
        parquet: as for :func:`run`.
        pictures: as for :func:`run`.
        watcher: as for :func:`run`.
        journal: an empty folder for the rows, to be read should this process die.
        wording: of the caller, for messages.
    """
    folder = None if results is None else Path(results)
    if parquet:
        require_parquet()
    with ExitStack() as stack:
        taken = folder is not None and stack.enter_context(
            taken_folder(folder, force=force, wording=wording)
        )
        rows = Journal(journal)
        where = None if folder is None else str(folder.absolute())
        wanted = {"results": where, "taken": taken, "parquet": parquet, "pictures": pictures}
        rows.write_meta({"config": dump_toml(checked.config), **wanted})
        native_log = None if journal is None or rows.failure else journal / STDERR_FILE
        interrupt = stack.enter_context(DeferredInterrupt())  # writing is not to be torn either
        try:
            result = simulate(
                checked,
                watcher,
                interrupt,
                outputs=None if folder is None else sumo_folder(folder),
                journal=rows,
                native_log=native_log,
            )
        except Exception:
            if folder is not None and taken:
                release_folder(folder)
            raise
        rows.heartbeat.beat(Phase.WRITING)
        if folder is not None:
            try:
                keep(result, folder, parquet=parquet, pictures=pictures, taken=taken)
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
    """What to tell a user whose rows could not be written, but are in a journal that is kept."""
    return f"every row is kept: 'giveway recover {shlex.quote(str(journal))} --force' writes them"


def keep(result: RunResult, folder: Path, *, parquet: bool, pictures: bool, taken: bool) -> None:
    """Write everything into ``folder``, or free it if there is nothing to write.

    Raises:
        ResultsError: it cannot be written.
    """
    if len(result.time):
        write_results(result, folder, parquet=parquet)
        if pictures:
            from giveway.results.pictures import write_pictures

            write_pictures(result, folder)
    elif taken:
        release_folder(folder)


def simulate(
    checked: CheckedRun,
    watcher: Watcher | None = None,
    interrupt: DeferredInterrupt | None = None,
    *,
    outputs: Path | None = None,
    journal: Journal | None = None,
    native_log: Path | None = None,
) -> RunResult:
    """Run one configuration; an error on the way becomes the result's ``error``.

    Args:
        checked: what is to be run.
        watcher: called at every control step.
        interrupt: looked at between two steps.
        outputs: folder for SUMO's own outputs; None drops them.
        journal: keeps the rows where a dying process cannot take them along.
        native_log: file for what SUMO prints; None: a temporary one.

    Raises:
        GivewayError: the run could not begin.
    """
    interrupt = interrupt or DeferredInterrupt()  # one that is not entered requests nothing

    def goes_on(clock: float) -> bool:
        if watcher is not None:
            watcher(Progress(0.0, clock, math.nan, math.nan, math.nan, "", 0))
        return not interrupt.requested

    with ExitStack() as stack:
        parts = assemble(checked, stack, outputs=outputs, native_log=native_log, goes_on=goes_on)
        recorder = Recorder(journal)
        loop = Loop(parts, recorder, follow=checked.config.twin)
        began = perf_counter()
        error: Exception | None = None
        try:
            ending = loop.run(watcher, interrupt)
        except Exception as failure:  # whatever it is, the rows so far are the user's
            error, ending = _in_our_words(failure, checked.scenario), Ending.FAILED
        elapsed = perf_counter() - began
        result = _result(parts, checked.scenario, recorder, loop, ending, error, elapsed)
        if loop.followed is None or error is not None or ending is Ending.INTERRUPTED:
            return _judged(result)
        _tell(watcher, "People go on to where they want")
        gone_on, error = _guarded(lambda: loop.follow_up(ending, interrupt), checked.scenario)
        tracks = {ego.id: ego.track for ego in result.egos}
        driven = Driven(tracks, parts.horizon, float(result.time[0]))
    twin = None
    if gone_on and error is None and result.egos:
        heartbeat = recorder.journal.heartbeat
        _tell(watcher, f"Twin: the same again, nobody feels the ego (the run took {elapsed:.0f} s)")
        make = partial(twin_of, checked, loop.followed, driven, heartbeat, interrupt, native_log)
        twin, error = _guarded(make, checked.scenario)
    return _judged(_with_twin(result, loop.followed, twin, error, began + elapsed))


def _tell(watcher: Watcher | None, doing: str) -> None:
    """What is done after the drive."""
    if watcher is not None:
        watcher(Progress(0.0, 0.0, math.nan, math.nan, math.nan, "", 0, doing))


def _in_our_words(error: Exception, scenario: Scenario) -> Exception:
    """What a run has failed by; SUMO's own errors with the scenario that they are about."""
    if not is_refusal(error):
        return error
    reason = " ".join(str(error).split())
    told = SumoError(f"{scenario.config_file}: SUMO failed: {reason}")
    told.__cause__ = error
    return told


def _guarded(
    call: Callable[[], Result], scenario: Scenario
) -> tuple[Result | None, Exception | None]:
    """What a call returns, or its failure: the run's rows are the user's in any case."""
    try:
        return call(), None
    except PedestrianModelError as error:
        return None, CrowdError(f"crowd of the twin: {error}")
    except Exception as error:
        return None, _in_our_words(error, scenario)


def _with_twin(
    result: RunResult,
    followed: Followed,
    twin: Twin | None,
    error: Exception | None,
    since: float,
) -> RunResult:
    """The result with what the egos cost the people, or with why that is not known."""
    if error is not None:
        error.args = (f"in the twin of the run, which is whole: {error}", *error.args[1:])
        return replace(result, error=error, facts=result.facts | {"error": str(error)})
    if twin is None:
        if result.egos:
            return replace(result, ending=Ending.INTERRUPTED)
        remarks = (*result.remarks, NO_EGO)
        return replace(result, remarks=remarks, facts=result.facts | {"remarks": list(remarks)})
    walks = followed.walks.track
    yielded = {
        ego.id: who_gave_way(walks, twin.walks, ego.track, ego.first, ego.shape, ego.body_radius)
        for ego in result.egos
    }
    found = delays(walks, twin.walks)
    effect = Effect(
        run=walks,
        twin=twin.walks,
        delays=found,
        yielded=yielded,
        traffic_differs=twin.traffic_differs,
        traffic_delay=twin.traffic_delay,
        seconds=perf_counter() - since,
    )
    remarks = result.remarks
    if twin.traffic_differs:
        remarks = (*remarks, TRAFFIC_DIFFERS)
    about = {
        "is": "the crowd alone" if twin.among_themselves else "a second run",
        "until": round(walks.time_step * walks.last, 6),
    }
    facts = result.facts | {"remarks": list(remarks), "twin": about}
    return replace(
        result,
        egos=tuple(replace(ego, effect=effect) for ego in result.egos),
        effect=effect,
        remarks=remarks,
        facts=facts,
    )


def _judged(result: RunResult) -> RunResult:
    """The result with remarks on egos that did not keep to the law, a twin's evidence heard."""
    judged = ((ego.id, ego.ledger) for ego in result.egos if ego.ledger is not None)
    against = [
        text for text in (law.remark(name, found.violations) for name, found in judged) if text
    ]
    remarks = (*result.remarks, *against)
    return replace(result, remarks=remarks, facts=result.facts | {"remarks": list(remarks)})


def _result(
    parts: Parts,
    scenario: Scenario,
    recorder: Recorder,
    loop: Loop,
    ending: Ending,
    error: Exception | None,
    elapsed: float,
) -> RunResult:
    """What the loop has left behind."""
    rows = recorder.rows()
    egos = results_of_egos(parts.config, rows, ending, loop.endings)
    touched = [text for text in map(vehicle_contacts.remark, egos) if text]
    remarks = (*parts.all_remarks, *loop.remarks, *_mismatches(parts, egos), *touched)
    crowd_track = rows.crowd_track()
    remarks = (*remarks, *unreached(parts.config.measure, crowd_track))
    if recorder.journal.failure:
        remarks = (*remarks, recorder.journal.failure)
    return RunResult(
        config=parts.config,
        scenario=scenario,
        ending=ending,
        error=error,
        time=rows.time,
        egos=egos,
        crowd_track=crowd_track,
        background_track=rows.background_track(),
        signal_track=rows.signal_track(),
        people_track=rows.people_track(),
        timings=rows.timings(),
        elapsed=elapsed,
        facts=manifest(
            parts.config,
            scenario,
            config_text=None,  # writing it takes longer than many a run of a study
            vehicles={ego.id: ego.description | _departure(parts, ego.id) for ego in parts.egos},
            pedestrians=parts.roster.ledger,
            traffic={} if parts.yielding is None else parts.yielding.report,
            sumo={"seed": parts.sumo.start.seed, "step_length": parts.sumo.step_length},
            time_step=parts.time_step,
            remarks=remarks,
            ending=str(ending),
            error=None if error is None else str(error),
            code=provenance(parts.config),
        ),
        sumo_messages=parts.sumo.messages,
        road=parts.sumo.lanes.areas(),
        marks=road_marks(parts.sumo.lanes),
        remarks=remarks,
    )


def _departure(parts: Parts, ego: str) -> dict[str, object]:
    """When an inserted ego was due, which may have been drawn; of one taken over, nothing."""
    times = parts.departures.times
    return {"depart_time": times[ego]} if ego in times else {}


def _mismatches(parts: Parts, egos: Sequence[EgoResult]) -> list[str]:
    """Of vehicles that are not ours and that the controller's model does not describe."""
    foreign = {ego.id for ego in parts.egos if not ego.description["bundled"]}
    remarks = [
        mismatch.remark(ego, parts.time_step, model_margin(ego.config, parts.time_step))
        for ego in egos
        if ego.id in foreign
    ]
    return [text for text in remarks if text]
