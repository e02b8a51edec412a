"""The tables of a road campaign: one row per drive, and the pooled numbers beside their bars."""

from __future__ import annotations

from collections import Counter
from functools import partial
from math import inf, isfinite, nan
from operator import itemgetter
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from drive_row import LOST

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

RESAMPLES = 2000  # Number of bootstrap samples of an interval
NONE_SEEN = 3.69  # Upper end of the 95 % interval of a Poisson count of 0 (Garwood 1936)

Row = dict[str, Any]


class Measure(NamedTuple):
    """A pooled number with the range that a good driver keeps."""

    name: str
    of: Callable[[Sequence[Row]], float]
    least: float = -inf
    most: float = inf
    without_people: bool = False  # True if only drives without people near count
    counts: str = ""  # "total" or "per drive" if it counts events

    @property
    def bar(self) -> str:
        """The range in words; empty without one."""
        if isfinite(self.least):
            return f"{self.least:g} to {self.most:g}"
        return f"at most {self.most:g}" if isfinite(self.most) else ""

    def verdict(self, value: float) -> str:
        """Return pass or miss, or "" without a bar or a value."""
        if not self.bar or not isfinite(value):
            return ""
        return "pass" if self.least <= value <= self.most + 1e-9 else "miss"


def quantile_of(name: str, share: float) -> Callable[[Sequence[Row]], float]:
    """Return the function for a quantile of a column over all drives that have it."""

    def of(rows: Sequence[Row]) -> float:
        values = [row[name] for row in rows if isfinite(row.get(name, nan))]
        return float(np.quantile(values, share)) if values else nan

    return of


def per_drive(count: Callable[[Row], float]) -> Callable[[Sequence[Row]], float]:
    """Return the function for the mean number per drive."""
    return lambda rows: float(np.mean([count(row) for row in rows])) if rows else nan


def count(name: str, events: Callable[[Row], float], most: float = inf) -> Measure:
    """Return the measure that counts events in all drives."""
    return Measure(name, lambda rows: float(sum(map(events, rows))), most=most, counts="total")


def _hard(row: Row, cause: str = "") -> int:
    return sum(one["cause"] == cause or not cause for one in row.get("brakings", ()))


def _gaps(rows: Sequence[Row]) -> float:
    gaps = [gap for row in rows for gap in row.get("gaps_at_rest", ())]
    return float(np.median(gaps)) if gaps else nan


def _slower(rows: Sequence[Row]) -> float:
    """Return by how many percentage points the ego drives slowly on free roads more than SUMO."""
    both = [row for row in rows if isfinite(row.get("sumo_slow_share", nan))]
    own = sum(row["slow_share"] * row["driving_time"] for row in both)
    theirs = sum(row["sumo_slow_share"] * row["sumo_time"] for row in both)
    times = sum(row["driving_time"] for row in both), sum(row["sumo_time"] for row in both)
    return 100.0 * (own / times[0] - theirs / times[1]) if both and times[1] else nan


def _lost(cause: str) -> Callable[[Sequence[Row]], float]:
    def of(rows: Sequence[Row]) -> float:
        known = [row for row in rows if "lost" in row]
        driven = sum(row["driving_time"] for row in known)
        return 100.0 * sum(row["lost"][cause] for row in known) / driven if driven else nan

    return of


def _missed(row: Row) -> bool:
    return row["sumo_arrived"] is True and not row["arrived"]


def _contacts(fault: str) -> Callable[[Row], float]:
    return lambda row: list(row.get("car_contacts", {}).values()).count(fault)


MEASURES = (
    Measure("time over SUMO's, nobody near, median", quantile_of("ratio", 0.5), -inf, 1.05, True),
    Measure("time over SUMO's, nobody near, 90 %", quantile_of("ratio", 0.9), -inf, 1.25, True),
    Measure("time over SUMO's, median", quantile_of("ratio", 0.5)),
    Measure("time over SUMO's, 90 %", quantile_of("ratio", 0.9)),
    Measure("time over SUMO's, highest", quantile_of("ratio", 1.0)),
    count("not arrived where SUMO arrives", _missed, 0.0),
    Measure("hard brakings per drive", per_drive(_hard), most=0.05, counts="per drive"),
    *(
        count(f"hard brakings: {cause}", partial(_hard, cause=cause))
        for cause in ("person", "vehicle", "light", "yielding", "bend or limit", "nothing")
    ),
    count("taking over felt (> 3 m/s^2 in 2 s)", lambda row: bool(row.get("take_over_felt")), 0.0),
    count("contacts with cars, the ego's fault", _contacts("ego"), 0.0),
    count("contacts with cars, the other's fault", _contacts("other")),
    count("frontal contacts with people", itemgetter("frontal_contacts"), 0.0),
    count("side contacts with people", itemgetter("side_contacts")),
    count("red lights run", itemgetter("red_lights_run"), 0.0),
    count("failures to yield", itemgetter("failures_to_yield"), 0.0),
    count("encounters", itemgetter("encounters")),
    count("stops without cause", itemgetter("stops_without_cause")),
    count("stands >= 4 s on crossings, in junctions", lambda row: len(row.get("stands", ())), 0.0),
    Measure("slow on free road, points over SUMO's", _slower, -inf, 3.0),
    Measure("gap at rest behind a car, median [m]", _gaps, 2.0, 3.0),
    *(Measure(f"time lost: {cause} [%]", _lost(cause)) for cause in LOST),
    Measure("acceleration, 95 % [m/s^2]", quantile_of("acceleration_95", 0.5)),
    Measure("braking, 95 % [m/s^2]", quantile_of("braking_95", 0.5)),
    Measure("lateral acceleration, 95 % [m/s^2]", quantile_of("lateral_95", 0.5)),
    Measure("RMS jerk [m/s^3]", quantile_of("rms_jerk", 0.5)),
    Measure("above the limit [s per drive]", per_drive(lambda row: row.get("over_limit", 0.0))),
)


def tables(rows: Sequence[Row], before: Sequence[Row] = (), *, brief: bool = False) -> str:
    """Return the tables: all drives, what went wrong in them, and the pooled numbers.

    Args:
        rows: Kept rows of the drives.
        before: Rows of the same drives in another state of the repository, or none.
        brief: True to return the pooled numbers only.
    """
    sound = [row for row in rows if "failed" not in row]
    died = [f"{row['drive']}: died: {row['failed']}" for row in rows if "failed" in row]
    numbers = pooled(sound, len(died), [row for row in before if "failed" not in row])
    if brief:
        return numbers
    parts = [_drives(sound), "\n".join([*died, *(line for row in sound for line in _said(row))])]
    return "\n\n".join([*parts, numbers])


def pooled(rows: Sequence[Row], died: int = 0, before: Sequence[Row] = ()) -> str:
    """Return the pooled numbers with 95 % intervals, over resampled drives, beside their bars.

    Args:
        rows: Rows of the drives that did not die.
        died: Number of the drives that died.
        before: Rows of the same drives in another state of the repository, for a column of values.
    """
    alone = [row for row in rows if not row["person_near"]]
    earlier = [row for row in before if not row["person_near"]], before
    driven = sum(row["distance"] for row in rows) / 1000.0
    lines = [
        f"{len(rows)} drives, {driven:.1f} km, {len(alone)} with nobody near; {died} died; "
        f"{sum(row['sumo_teleported'] for row in rows)} whose car SUMO teleports",
        "",
        "| | value | 95 % | bar | |" + " before |" * bool(before),
        "|---|---|---|---|---|" + "---|" * bool(before),
    ]
    for measure in MEASURES:
        chosen = alone if measure.without_people else rows
        value = measure.of(chosen)
        low, high = _interval(measure, chosen)
        words = f"{value:.2f}" if isfinite(value) else "-"
        then = measure.of(earlier[not measure.without_people])
        between = f"{low:.2f} to {high:.2f}" if isfinite(low) else "-"
        lines.append(
            f"| {measure.name} | {words} | {between} | {measure.bar} | {measure.verdict(value)} |"
            + f" {then:.2f} |" * bool(before)
        )
    return "\n".join(lines + _paired(rows, {row["drive"]: row for row in before}))


def _paired(rows: Sequence[Row], before: Mapping[str, Row]) -> list[str]:
    """Return the line on the times of the drives that arrive in both states."""
    pairs = [
        {"time": row["time"], "before": before[row["drive"]]["time"]}
        for row in rows
        if row["arrived"] and before.get(row["drive"], row)["arrived"] and row["drive"] in before
    ]
    measure = Measure(
        "", lambda some: sum(one["time"] for one in some) / sum(one["before"] for one in some)
    )
    low, high = _interval(measure, pairs)
    if not isfinite(low):
        return []
    value = measure.of(pairs)
    return ["", f"time over before, {len(pairs)} pairs: {value:.4f} ({low:.4f} to {high:.4f})"]


def _interval(measure: Measure, rows: Sequence[Row]) -> tuple[float, float]:
    """Return the 95 % interval of a number by bootstrap over the drives."""
    if len(rows) < 2:
        return nan, nan
    draws = np.random.default_rng(1)
    samples = []
    for _ in range(RESAMPLES):
        sample = measure.of([rows[i] for i in draws.integers(0, len(rows), len(rows))])
        if isfinite(sample):
            samples.append(sample)
    if not samples:
        return nan, nan
    low, high = np.quantile(samples, (0.025, 0.975))
    if measure.counts and not high:  # nothing was seen
        high = NONE_SEEN / (len(rows) if measure.counts == "per drive" else 1)
    return float(low), float(high)


def _drives(rows: Sequence[Row]) -> str:
    """Return the table with one row per drive, the slowest beside SUMO first."""
    head = "time | SUMO's | ratio | near | hard | stands | contacts | slow | lost most for"
    lines = [f"| drive | {head} |", "|---" * 10 + "|"]
    ordered = sorted(rows, key=lambda row: -row["ratio"] if isfinite(row["ratio"]) else -inf)
    for row in ordered:
        hard = Counter(one["cause"] for one in row.get("brakings", ()))
        stands = Counter(f"{one['on']} ({one['waits_for']})" for one in row.get("stands", ()))
        contacts = Counter(row.get("car_contacts", {}).values())
        time = f"{row['time']:.1f}" if row["arrived"] else row["ending"]
        slow = (100.0 * row.get(name, nan) for name in ("slow_share", "sumo_slow_share"))
        most = sorted(row.get("lost", {}).items(), key=lambda item: -item[1])[:2]
        cells = (
            row["drive"],
            time,
            f"{row['sumo_time']:.1f}",
            f"{row['ratio']:.2f}" if isfinite(row["ratio"]) else "-",
            "yes" if row["person_near"] else "",
            _counted(hard),
            _counted(stands),
            _counted(contacts),
            "/".join(f"{share:.0f}" for share in slow),
            ", ".join(f"{name} {lost:.0f} s" for name, lost in most if lost >= 1.0),
        )
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _counted(found: Counter[str]) -> str:
    return ", ".join(f"{count} {name}" for name, count in found.items())


def _said(row: Row) -> list[str]:
    """Return one line for each event of a drive that somebody should look at."""
    found = [
        f"{one['time']:.2f} s, hard braking: {one['deceleration']:.1f} m/s^2 from "
        f"{one['speed']:.1f} m/s, {one['after']:.1f} s after the departure, for: {one['cause']}"
        for one in row.get("brakings", ())
    ]
    found += [
        f"{one['time']:.2f} s, stand: {one['duration']:.1f} s on a {one['on']}, waits for: "
        f"{one['waits_for'] or 'nothing'}"
        for one in row.get("stands", ())
    ]
    found += [
        f"contact with car {name}: {fault}" for name, fault in row.get("car_contacts", {}).items()
    ]
    if _missed(row):
        found.append(f"not arrived ({row['ending']}); SUMO needs {row['sumo_time']:.1f} s")
    if row["sumo_teleported"]:
        found.append("SUMO teleports this car: it stands in no ratio")
    return [f"{row['drive']}: {line}" for line in [*found, *row["violations"]]]
