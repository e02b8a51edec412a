"""The telling numbers of a run: at most fourteen, in four groups."""

import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from giveway.metrics.contacts import FRONTAL
from giveway.results.ego_result import EgoResult
from giveway.results.run_tables import RunTables

MOST = 14
"""Largest number of lines; metrics of other packages come on top."""
_ALWAYS = 0  # Rank of a number that is also shown as 0 or as a dash
_KM_H = 3.6

Value = float | str | bool | None


class Line(NamedTuple):
    """A number of each ego.

    Attributes:
        group: Group that it belongs to: drive, people, rules, computing, own metrics.
        label: Meaning in words.
        values: Texts, one for each ego; empty if there is none.
        unit: Unit, or an empty text.
    """

    group: str
    label: str
    values: tuple[str, ...]
    unit: str


class _Row(NamedTuple):
    """A number that may be shown.

    Attributes:
        rank: 0 for a number that is always shown; the others are left out if they are 0 or
            unknown, or if there is no room, those of the highest rank first.
        label: Meaning in words.
        value: Column of the summary, or a function that returns the value and its unit.
        unit: Unit of the column.
    """

    rank: int
    label: str
    value: str | Callable[[EgoResult], tuple[Value, str]]
    unit: str = ""


def _mean_speed(ego: EgoResult) -> tuple[Value, str]:
    speed, on_road = ego.summary["mean_speed"], ego.ledger or ego.plain
    return (_KM_H * speed, "km/h") if on_road is not None else (speed, "m/s")


def _let_pass(ego: EgoResult) -> tuple[Value, str]:
    met = ego.summary.get("encounters", 0)
    return (f"{round(met * ego.summary['yielding_rate'])} of {met:.0f}" if met else None), ""


_DRIVE = (
    _Row(_ALWAYS, "Time to the goal", "completion_time", "s"),
    _Row(3, "SUMO's own driver, same trip", "sumo_time", "s"),
    _Row(_ALWAYS, "Mean speed", _mean_speed),
    _Row(_ALWAYS, "Stops", "stops"),
    _Row(2, "Longest wait", "longest_wait", "s"),
    _Row(8, "Hardest braking", "peak_deceleration", "m/s²"),
)
_PEOPLE = (
    _Row(_ALWAYS, "Pedestrians touched", "overlaps"),
    _Row(1, "of these, the ego moved into", "frontal_contacts"),
    _Row(_ALWAYS, "Close passes: < 0.5 m at > 2 m/s", "close_passes"),
    _Row(5, "Smallest clearance", "minimum_clearance", "m"),
    _Row(4, "Smallest time to collision", "minimum_ttc_moving", "s"),
    _Row(7, "People below 1.5 s to a collision", "people_below_ttc"),
    _Row(6, "Delay of the people, together", "people_delay", "s"),
    _Row(3, "Overlaps with people as recorded", "recorded_contacts"),
    _Row(7, "Recorded people who began to react", "handed_over"),
)
_RULES = (
    _Row(_ALWAYS, "Red lights run", "red_lights_run"),
    _Row(3, "People let pass at crossings", _let_pass),
    _Row(1, "Failures to yield", "failures_to_yield"),
    _Row(2, "Crossings blocked", "blocked_crossings"),
    _Row(2, "Junctions blocked", "blocked_junctions"),
    _Row(2, "Stops without a cause", "stops_without_cause"),
    _Row(1, "Vehicles touched", "vehicle_contacts"),
)
_COMPUTING = (_Row(9, "Steps of the safety layer", "safety_share", "%"),)
_OF_WALKS = (
    ("Mean walking speed", "mean_walking_speed", "m/s"),
    ("Time slower than 0.2 m/s, on average", "mean_slow_time", "s"),
    ("Way, on average", "mean_walk", "m"),
)
_COUNTED = (
    ("Pedestrians added", "added"),
    ("Persons taken over from SUMO", "taken_over"),
    ("handed back", "handed_back"),
    ("arrived", "arrived"),
    ("gone on by vehicle, or to a stop", "continued"),
    ("still walking", "walking"),
)


def digest(result: RunTables) -> list[Line]:
    """Return the telling numbers of a run."""
    egos = result.egos
    lines = [*_of_egos(egos)] if egos else [*_of_people(result)]
    factor = result.timing_summary["real_time_factor"]
    blanks = ("",) * max(0, len(egos) - 1)
    lines.append(Line("computing", "Real-time factor", (formatted(factor, "x"), *blanks), "x"))
    named = {row.value for row in _PEOPLE}
    for own in (column for ego in egos[:1] for column in ego.measured.columns):
        if own.name in named:
            continue
        values = tuple(formatted(ego.summary.get(own.name), own.unit or "") for ego in egos)
        lines.append(Line("own metrics", own.name, values, own.unit or ""))
    return lines


def _of_egos(egos: tuple[EgoResult, ...]) -> Iterator[Line]:
    """Yield the lines of egos, which leave one for the computing."""
    ruled = any(ego.ledger is not None for ego in egos)
    groups = {"drive": _DRIVE, "people": _PEOPLE, "rules": _RULES, "computing": _COMPUTING}
    found = [
        (group, row, [_value(row, ego) for ego in egos])
        for group, rows in groups.items()
        for row in rows
        if ruled or row.value != "red_lights_run"
    ]
    told = [
        (group, row, values)
        for group, row, values in found
        if row.rank == _ALWAYS or any(map(_is_telling, (value for value, _ in values)))
    ]
    ranks = sorted(row.rank for _, row, _ in told)
    last = ranks[MOST - 2] if len(told) >= MOST else math.inf
    room = MOST - 1 - sum(row.rank < last for _, row, _ in told)
    for group, row, values in told:
        if row.rank == last:
            room -= 1
        if row.rank < last or (row.rank == last and room >= 0):
            unit = max(unit for _, unit in values)
            yield Line(group, row.label, tuple(formatted(v, u) for v, u in values), unit)


def _of_people(result: RunTables) -> Iterator[Line]:
    """Yield the lines of a run without an ego."""
    for label, name, unit in _OF_WALKS if result.walks is not None else ():
        yield Line("people", label, (formatted(result.summary[name], unit),), unit)
    ledger: dict[str, Any] = result.manifest["pedestrians"]
    for label, name in _COUNTED:
        if ledger[name]:
            yield Line("people", label, (str(ledger[name]),), "")


def _value(row: _Row, ego: EgoResult) -> tuple[Value, str]:
    return (ego.summary.get(row.value), row.unit) if isinstance(row.value, str) else row.value(ego)


def _is_telling(value: Value) -> bool:
    if value is None or isinstance(value, str):
        return bool(value)
    return math.isfinite(value) and value > 0.0


def formatted(value: Value, unit: str) -> str:
    """Return a number as it is shown; a dash if there is none."""
    if isinstance(value, str):
        return value
    if value is None or not math.isfinite(value):
        return "-"
    if isinstance(value, int):
        return str(value)
    return f"{100 * value:.1f}" if unit == "%" else f"{value:.2f}"


def worth_watching(result: RunTables) -> str:
    """Return the moment of a run that a user should look at first, or an empty text."""
    people = [row for ego in result.egos for row in ego.pedestrians.to_dict("records")]
    hit = [row for row in people if row["contact"] == FRONTAL]
    if hit:
        first = min(hit, key=lambda row: row["time_of_minimum_clearance"])
        return f"{first['id']} is hit near {first['time_of_minimum_clearance']:.1f} s"
    near = [row for row in people if math.isfinite(row["minimum_ttc"])]
    if not near:
        return ""
    nearest = min(near, key=lambda row: row["minimum_ttc"])
    return f"{nearest['id']} is nearest to a collision at {nearest['time_of_minimum_ttc']:.1f} s"
