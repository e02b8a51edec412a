"""A drive judged by the law of the road: the numbers, and each event as a row of a table."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from giveway.metrics.law.areas import areas_of
from giveway.metrics.law.causes import owed_to, stops_without_cause
from giveway.metrics.law.drive import Drive
from giveway.metrics.law.encounters import (
    Encounter,
    PushedBack,
    encounters,
    pushed_back,
    waiting_time,
)
from giveway.metrics.law.lights import YELLOW, RedLight, red_lights
from giveway.metrics.law.standing import Blocked, blocked_crossings, blocked_junctions
from giveway.metrics.law.walks import walks_over
from giveway.metrics.vehicles import VehicleContact
from giveway.run_data.columns import Quantity, columns_of

BACK = 0.3
"""Largest distance [m] by which a person with priority may be pushed back."""

ENCOUNTER = "encounter"


@dataclass(frozen=True, slots=True)
class Event:
    """One row of ``ledger.csv``, without the ego's id."""

    time: float  # [s] time
    kind: str
    violation: bool
    other: str
    place: str
    x: float  # [m] place
    y: float  # [m] place
    value: float
    unit: str
    words: str


@dataclass(frozen=True)
class LawSummary:
    """The summary's columns in a run in which the law of the road applies on the ego's path."""

    encounters: Annotated[
        int, Quantity(None, "people with priority whom the ego met at a crossing")
    ]
    yielding_rate: Annotated[
        float, Quantity(None, "share of the encounters in which it let them pass; empty: none")
    ]
    failures_to_yield: Annotated[
        int,
        Quantity(None, "encounters in which it entered a crossing before they had left its way"),
    ]
    red_lights_run: Annotated[int, Quantity(None, "stop lines passed against the light")]
    blocked_crossings: Annotated[int, Quantity(None, "stands of 2 s or more on a crossing")]
    blocked_junctions: Annotated[int, Quantity(None, "stands of 2 s or more in a junction")]
    pushed_back: Annotated[
        float, Quantity("m", "farthest that somebody with priority went back on a crossing")
    ]
    stops_without_cause: Annotated[int, Quantity(None, "stops for which the road shows no cause")]
    mean_zebra_wait: Annotated[
        float, Quantity("s", "that people stood whom it met at zebras; empty: it met nobody there")
    ]
    longest_zebra_wait: Annotated[float, Quantity("s", "the longest of these waits; empty: none")]


LAW_FIELDS = columns_of(LawSummary)


@dataclass(frozen=True)
class Ledger:
    """The judgement on an ego by the law of the road.

    Attributes:
        summary: Summary in numbers.
        events: All encounters and violations, in order of time.
    """

    summary: LawSummary
    events: tuple[Event, ...]

    @property
    def violations(self) -> tuple[Event, ...]:
        """Events for which the ego is responsible."""
        return tuple(event for event in self.events if event.violation)


def ledger(drive: Drive, vehicles: Sequence[VehicleContact] = ()) -> Ledger:
    """Judge a drive by the law of the road; definitions are in docs/law.md.

    Args:
        drive: Drive of the ego.
        vehicles: Vehicles that it came into contact with.
    """
    areas = areas_of(drive)
    walks = [(area, walk) for area in areas for walk in walks_over(drive, area)]
    met = [found for pair in walks for found in encounters(drive, *pair)]
    back = [found for pair in walks for found in pushed_back(drive, *pair)]
    reds = red_lights(drive)
    owed = owed_to(drive, met)
    crossings = blocked_crossings(drive, areas, owed)
    junctions = blocked_junctions(drive, areas, owed)
    uncaused = stops_without_cause(drive, areas, owed)
    failures = [found for found in met if found.failed]
    waits = [waiting_time(drive, found) for found in met if not found.area.crossing.system]
    events = [
        *(_of_encounter(drive, found) for found in met),
        *(_of_failure(drive, found) for found in failures),
        *(_of_push(drive, found) for found in back if found.distance > BACK),
        *(_of_red_light(drive, found) for found in reds),
        *(_of_blocked(drive, found, "crossing") for found in crossings),
        *(_of_blocked(drive, found, "junction") for found in junctions),
        *(
            _at(drive, found.first, "stop without cause", found.duration, "s",
                f"stood for {found.duration:.2f} s with no cause in sight")
            for found in uncaused
        ),
        *(_of_contact(drive, contact) for contact in vehicles),
    ]  # fmt: skip
    return Ledger(
        LawSummary(
            encounters=len(met),
            yielding_rate=1.0 - len(failures) / len(met) if met else np.nan,
            failures_to_yield=len(failures),
            red_lights_run=len(reds),
            blocked_crossings=len(crossings),
            blocked_junctions=len(junctions),
            pushed_back=max((found.distance for found in back), default=0.0),
            stops_without_cause=len(uncaused),
            mean_zebra_wait=float(np.mean(waits)) if waits else np.nan,
            longest_zebra_wait=max(waits, default=np.nan),
        ),
        tuple(sorted(events, key=lambda event: event.time)),
    )


def count(events: Iterable[Event]) -> dict[str, int]:
    """Count the events of each kind; the kinds are in the order of their first events."""
    return Counter(event.kind for event in events)


def _of_encounter(drive: Drive, found: Encounter) -> Event:
    walk, k = found.walk, found.first
    row = int(np.argmax(walk.steps == k))
    person = _person(drive, found, row)
    away = max(0.0, float(walk.reach - walk.progress[row]) / walk.desired_speed)
    room = found.area.entry - float(drive.front[k])
    waited = waiting_time(drive, found)
    words = (
        f"{person[0]} {away:.2f} s from the ego's way, the ego {room:.2f} m before the crossing at "
        f"{drive.ego.speed[k]:.2f} m/s; stood for {waited:.2f} s"
    )
    time = float(drive.ego.time[k])
    return Event(time, ENCOUNTER, False, *person, waited, "s", words)


def _of_failure(drive: Drive, found: Encounter) -> Event:
    walk, enters = found.walk, drive.time_at(found.area.entry)
    k = int(drive.instants(np.array([enters]))[0])
    row = max(0, int(np.searchsorted(walk.steps, k, side="right")) - 1)
    person = _person(drive, found, row)
    words = (
        f"entered {found.too_early:.2f} s before {person[0]} had left its way, at "
        f"{drive.ego.speed[k]:.2f} m/s, {walk.clear - walk.progress[row]:.2f} m to go"
    )
    return Event(enters, "failure to yield", True, *person, found.too_early, "s", words)


def _of_push(drive: Drive, found: PushedBack) -> Event:
    person, k = _person(drive, found, found.farthest), int(found.walk.steps[found.farthest])
    room = found.area.entry - float(drive.front[k])
    words = (
        f"{person[0]} went back by {found.distance:.2f} m, the ego {room:.2f} m before the crossing"
    )
    time = float(drive.ego.time[k])
    return Event(time, "pushed back", True, *person, found.distance, "m", words)


def _person(drive: Drive, found: Encounter | PushedBack, row: int) -> tuple[str, str, float, float]:
    """Return who was met, at which crossing, and where [m] in a record of the walk."""
    walk = found.walk
    who = drive.crowd.ids[walk.pedestrian]
    return who, found.area.crossing.lane, float(walk.x[row]), float(walk.y[row])


def _of_red_light(drive: Drive, found: RedLight) -> Event:
    x, y, _ = drive.path.pose(found.line.station)
    if found.letter in YELLOW:
        unit, how = "m/s^2", f"yellow; {found.value:.2f} m/s^2 would have stopped it"
    else:
        unit, how = "s", f"red for {found.value:.2f} s"
    words = f"passed the stop line at '{found.letter}': {how}"
    system, link = found.line.system, str(found.line.link)
    return Event(found.time, "red light", True, system, link, x, y, found.value, unit, words)


def _of_blocked(drive: Drive, found: Blocked, what: str) -> Event:
    words = f"stood on it for {found.duration:.2f} s with nobody in front"
    event = _at(drive, found.first, f"blocked {what}", found.duration, "s", words)
    return replace(event, place=found.place)


def _of_contact(drive: Drive, contact: VehicleContact) -> Event:
    k = int(drive.instants(np.array([contact.first]))[0])
    words = f"in contact for {contact.duration:.2f} s"
    event = _at(drive, k, "vehicle contact", contact.duration, "s", words)
    return replace(event, other=contact.id)


def _at(drive: Drive, k: int, kind: str, value: float, unit: str, words: str) -> Event:
    """Return a violation at the place of the ego's front bumper at control instant ``k``."""
    ego = drive.ego
    place = float(ego.front_x[k]), float(ego.front_y[k])
    return Event(float(ego.time[k]), kind, True, "", "", *place, value, unit, words)
