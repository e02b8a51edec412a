"""The drives of plain SUMO for the trips of a run's egos."""

from dataclasses import replace
from time import perf_counter

from giveway.config import EgoRunConfig
from giveway.config.tables.basics import DEFAULT_SPEED
from giveway.cosimulation.assembly import Parts, start_options, types_of
from giveway.cosimulation.entry.stop_places import SERVING
from giveway.cosimulation.preflight import CheckedRun
from giveway.errors import GivewayError
from giveway.processes.heartbeat import Heartbeat, Phase
from giveway.results.run_result import RunResult
from giveway.sumo.plain_drive import PlainDrives, Trip, plain_drives
from giveway.sumo.types import ROAD_CLASSES, inserted_type

# Wall-clock limit [s] of SUMO's drives, and its share of the time that the run took
_PATIENCE = 60.0, 4.0


def with_baseline(
    result: RunResult, checked: CheckedRun, parts: Parts, heartbeat: Heartbeat, since: float
) -> RunResult:
    """Return the result with the drives of plain SUMO.

    Args:
        result: Result of the run.
        checked: Checked configuration of the run.
        parts: Parts of the run.
        heartbeat: Heartbeat that shows this phase.
        since: Time [s] of ``perf_counter`` at which the run began.
    """
    heartbeat.beat(Phase.MEASURING)
    options, types = start_options(checked.config, False, None), types_of(checked.egos)
    least, share = _PATIENCE
    patience = least + share * (perf_counter() - since)
    egos, remarks = [], list(result.remarks)
    for ego in result.egos:
        trip = _trip(ego.config, parts.departures.times.get(ego.id, 0.0))
        try:
            found = plain_drives(checked.files, options, trip, types, patience=patience)
        except (GivewayError, OSError):  # a file has gone, or the disk is full
            found = PlainDrives(None, None)
        egos.append(replace(ego, plain=found))
        name = f"ego '{ego.id}': SUMO's own drive of this trip"
        teleported = [one.teleported for one in found if one and one.teleported > 0.0]
        if found.as_is is None:
            remarks.append(f"{name} did not come about, so that there is no time beside the ego's")
        elif teleported:
            remarks.append(
                f"{name} has no time: SUMO teleported the vehicle at {teleported[0]:.12g} s"
            )
    facts = result.facts | {"remarks": remarks}
    return replace(result, egos=tuple(egos), remarks=tuple(remarks), facts=facts)


def _trip(config: EgoRunConfig, depart: float) -> Trip:
    """Return the trip of an ego.

    Args:
        config: Configuration of the ego.
        depart: Time [s] of its departure, if it is inserted.
    """
    ego, serves = config.ego, config.rules.stops
    classes = SERVING if serves is None else ROAD_CLASSES if serves else ()
    if ego.take_over:
        return Trip(config.ego_id, tuple(classes))
    return Trip(
        config.ego_id,
        route=ego.route,
        kind=inserted_type(ego.id),
        lane="first" if ego.lane is None else str(ego.lane),
        depart=depart,
        position=ego.depart_position,
        speed=DEFAULT_SPEED if ego.initial_speed is None else ego.initial_speed,
    )
