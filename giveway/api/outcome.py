"""The result of a simulation: rows, counterfactual run, remarks."""

from collections.abc import Sequence
from dataclasses import replace
from time import perf_counter

from giveway.config.files.foreign_code import provenance
from giveway.cosimulation.assembly import Parts
from giveway.cosimulation.counterfactual.counterfactual import Twin
from giveway.cosimulation.counterfactual.follow_up import Followed
from giveway.cosimulation.loop import Loop
from giveway.ego.vehicle_model import model_margin
from giveway.journal.recorder import Recorder
from giveway.journal.stored_rows import LONG
from giveway.measures import unreached
from giveway.metrics import delays
from giveway.metrics.plugged_in import declared, measured
from giveway.processes.heartbeat import Heartbeat, Phase
from giveway.results import law, mismatch, vehicle_contacts
from giveway.results.effect import Effect, who_gave_way
from giveway.results.ego_result import EgoResult, results_of_egos
from giveway.results.provenance import RunFacts, manifest
from giveway.results.run_result import RunResult
from giveway.run_data.footways import NO_FOOTWAYS
from giveway.run_data.progress import Ending
from giveway.sumo.network.painted_marks import road_marks
from giveway.sumo.opaque_bodies import NOTHING_OPAQUE
from sumo_scenarios import Scenario

TRAFFIC_DIFFERS = (
    "twin: traffic lights or background vehicles did something else than in the run, so that the "
    "delays of people are not the egos' alone"
)

NO_VIEW = (
    f"more than {LONG:,} records of people: too many for a picture from above; "
    "--record-far-period keeps fewer"
)

NO_EGO = "twin: no ego was on the road, so that there is nothing to compare with"


def outcome(
    parts: Parts,
    scenario: Scenario,
    recorder: Recorder,
    loop: Loop,
    ending: Ending,
    error: Exception | None,
    elapsed: float,
) -> RunResult:
    """Return the result of a run whose loop has ended."""
    rows = recorder.rows()
    configs = {ego.id: ego.config for ego in parts.egos}
    egos = results_of_egos(configs, rows, ending, loop.endings)
    touched = [text for text in map(vehicle_contacts.remark, egos) if text]
    touched += [loop.meetings.touches.remark] if len(loop.meetings.touches) else []
    remarks = (*parts.all_remarks, *loop.remarks, *_mismatches(parts, egos), *touched)
    crowd_track, background = rows.crowd_track(), rows.background_track()
    opaque = loop.world.opaque([*background.id, *(ego.id for ego in egos)])
    if opaque is not None and opaque.hides_nobody:
        remarks = (*remarks, NOTHING_OPAQUE)
    remarks = (*remarks, *unreached(parts.config.measure, crowd_track))
    if crowd_track.is_long:
        remarks = (*remarks, NO_VIEW)
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
        background_track=background,
        signal_track=rows.signal_track(),
        sight_track=rows.sight_track(),
        people_track=rows.people_track(),
        timings=rows.timings(),
        elapsed=elapsed,
        facts=manifest(
            parts.config,
            scenario,
            RunFacts(
                pedestrians=parts.roster.ledger,
                vehicles={
                    ego.id: ego.description | _departure(parts, ego.id) for ego in parts.egos
                },
                traffic=loop.meetings.report,
                sumo={"seed": parts.sumo.start.seed, "step_length": parts.sumo.step_length},
                time_step=parts.time_step,
                code=provenance(parts.config),
            ),
            config_text=None,  # it is written later, since many runs of a study need none
            remarks=remarks,
            ending=str(ending),
            error=None if error is None else str(error),
        ),
        sumo_messages=parts.sumo.messages,
        road=parts.sumo.lanes.areas(),
        marks=road_marks(parts.sumo.lanes),
        footways=NO_FOOTWAYS if parts.exchange is None else parts.exchange.footways,
        remarks=remarks,
        opaque=opaque,
    )


def with_twin(
    result: RunResult,
    followed: Followed,
    twin: Twin | None,
    error: Exception | None,
    since: float,
) -> RunResult:
    """Add to the result the people's delay by the egos, or the reason why it is unknown."""
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


def judged(result: RunResult, heartbeat: Heartbeat) -> RunResult:
    """Add remarks on egos that broke the law, using the counterfactual run, and metrics.

    The metrics of other packages measure the drive here, when it is complete.

    Args:
        result: Result of the run.
        heartbeat: Heartbeat that shows this phase, in case a metric ends the process.
    """
    if declared(result.config):
        heartbeat.beat(Phase.MEASURING)
        egos = (replace(ego, measured=measured(ego.config, ego)) for ego in result.egos)
        result = replace(result, egos=tuple(egos))
    judged = ((ego.id, ego.ledger) for ego in result.egos if ego.ledger is not None)
    against = [
        text for text in (law.remark(name, found.violations) for name, found in judged) if text
    ]
    faults = [fault for ego in result.egos for fault in ego.measured.faults]
    remarks = (*result.remarks, *against, *faults)
    return replace(result, remarks=remarks, facts=result.facts | {"remarks": list(remarks)})


def _departure(parts: Parts, ego: str) -> dict[str, object]:
    """Return the departure time of an inserted ego, which may have been drawn, or nothing."""
    times = parts.departures.times
    return {"depart_time": times[ego]} if ego in times else {}


def _mismatches(parts: Parts, egos: Sequence[EgoResult]) -> list[str]:
    """Return remarks on foreign vehicles that the controller's model does not describe."""
    foreign = {ego.id for ego in parts.egos if not ego.description["bundled"]}
    remarks = [
        mismatch.remark(ego, parts.time_step, model_margin(ego.config, parts.time_step))
        for ego in egos
        if ego.id in foreign
    ]
    return [text for text in remarks if text]
