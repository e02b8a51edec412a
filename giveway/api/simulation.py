"""One simulation: the assembled run, and its counterfactual run without effect on people."""

import math
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import TypeVar

from fmus import processes_reused
from giveway.api.baseline import with_baseline
from giveway.api.outcome import judged, outcome, with_twin
from giveway.cosimulation.assembly import Driven, assemble
from giveway.cosimulation.counterfactual.counterfactual import twin_of
from giveway.cosimulation.loop import Loop
from giveway.cosimulation.preflight import CheckedRun
from giveway.errors import CrowdError, SumoError
from giveway.journal.journal import Journal
from giveway.journal.recorder import Recorder
from giveway.processes.interrupts import DeferredInterrupt
from giveway.results.run_result import RunResult
from giveway.run_data.progress import Ending, Progress, Watcher
from giveway.sumo.library import is_refusal
from pedestrian_model import PedestrianModelError
from sumo_scenarios import Scenario

Result = TypeVar("Result")


def simulate(
    checked: CheckedRun,
    watcher: Watcher | None = None,
    interrupt: DeferredInterrupt | None = None,
    *,
    outputs: Path | None = None,
    journal: Journal | None = None,
    native_log: Path | None = None,
    baseline: bool = False,
) -> RunResult:
    """Run one configuration. An error on the way becomes the result's ``error``.

    Args:
        checked: Run that has passed the preflight.
        watcher: Function that is called at every control step.
        interrupt: Request to end, checked between two steps.
        outputs: Folder for SUMO's own outputs, or None to drop them.
        journal: Journal that keeps the rows if the process dies.
        native_log: File for the output of SUMO, or None for a temporary one.
        baseline: True to let plain SUMO make the egos' trips as well, if the configuration leaves
            that open.

    Raises:
        GivewayError: the run could not begin.
    """
    interrupt = interrupt or DeferredInterrupt()  # one that has not been entered requests nothing

    def goes_on(clock: float) -> bool:
        if watcher is not None:
            watcher(Progress(0.0, clock, math.nan, math.nan, math.nan, "", 0))
        return not interrupt.requested

    with processes_reused(), ExitStack() as stack:
        parts = assemble(checked, stack, outputs=outputs, native_log=native_log, goes_on=goes_on)
        recorder = Recorder(journal)
        loop = Loop(parts, recorder, follow=checked.config.twin)
        began = perf_counter()
        error: Exception | None = None
        try:
            ending = loop.run(watcher, interrupt)
        except Exception as failure:  # after any failure, the user keeps the rows so far
            error, ending = _in_our_words(failure, checked.scenario), Ending.FAILED
        elapsed = perf_counter() - began
        result = outcome(parts, checked.scenario, recorder, loop, ending, error, elapsed)
        whole = error is None and ending is not Ending.INTERRUPTED
        followed = loop.followed if whole else None
        if followed is not None:
            _tell(watcher, "People go on to where they want")
            gone_on, error = _guarded(lambda: loop.follow_up(ending, interrupt), checked.scenario)
            tracks = {ego.id: ego.track for ego in result.egos}
            driven = Driven(tracks, parts.horizon, float(result.time[0]))
    heartbeat, twin = recorder.journal.heartbeat, None
    if followed is not None:
        if gone_on and error is None and result.egos:
            _tell(
                watcher,
                f"Twin: the same again, nobody feels the ego (the run took {elapsed:.0f} s)",
            )
            make = partial(twin_of, checked, followed, driven, heartbeat, interrupt, native_log)
            twin, error = _guarded(make, checked.scenario)
        result = with_twin(result, followed, twin, error, began + elapsed)
    asked = checked.config.sumo.baseline
    asked = baseline if asked is None else asked
    if whole and asked and result.egos and not parts.secluded:  # there, the road is free
        _tell(watcher, "SUMO's own driver makes the same trip")
        result = with_baseline(result, checked, parts, heartbeat, began)
    return judged(result, heartbeat)


def _tell(watcher: Watcher | None, doing: str) -> None:
    """Tell the watcher what is done after the drive."""
    if watcher is not None:
        watcher(Progress(0.0, 0.0, math.nan, math.nan, math.nan, "", 0, doing))


def _in_our_words(error: Exception, scenario: Scenario) -> Exception:
    """Return the error of a run; SUMO's own errors get the name of the scenario."""
    if not is_refusal(error):
        return error
    reason = " ".join(str(error).split())
    told = SumoError(f"{scenario.config_file}: SUMO failed: {reason}")
    told.__cause__ = error
    return told


def _guarded(
    call: Callable[[], Result], scenario: Scenario
) -> tuple[Result | None, Exception | None]:
    """Return the result of a call, or its failure; the run's rows are kept in any case."""
    try:
        return call(), None
    except PedestrianModelError as error:
        return None, CrowdError(f"crowd of the twin: {error}")
    except Exception as error:
        return None, _in_our_words(error, scenario)
