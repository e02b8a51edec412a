"""The delay of a drive against free flow, and the control delay at each traffic light.

Free flow is a drive at the lanes' limits, or at the ego's own highest speed where that is lower.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import nan
from typing import Annotated, Final, NamedTuple

import numpy as np

from giveway.geometry.kernel import Array
from giveway.metrics.law.drive import Drive
from giveway.metrics.standing import stops
from giveway.run_data.columns import Quantity, columns_of

Levels = tuple[tuple[float, str], ...]
"""Largest delay [s] of each level of service, and the level; F beyond."""

LEVELS: Final[Levels] = ((10.0, "A"), (20.0, "B"), (35.0, "C"), (55.0, "D"), (80.0, "E"))
"""Largest control delay [s] of each level of service at a traffic light, and the level; F beyond
(Highway Capacity Manual, 6th ed., 2016, exhibit 19-8)."""

# Distances [m] before and behind a stop line within which delay counts as the light's
_BEFORE, _BEHIND = 250.0, 100.0
_SPACING = 1.0  # Distance [m] between the stations at which times are compared


@dataclass(frozen=True)
class TravelSummary:
    """The summary's columns on delay, where the law of the road applies on the ego's path."""

    free_flow_delay: Annotated[
        float, Quantity("s", "time beyond that of a drive at the limits over the same distance")
    ]
    stops_per_km: Annotated[float, Quantity("1/km", "stops over the travelled distance")]
    signals_passed: Annotated[int, Quantity(None, "stop lines of traffic lights that it passed")]
    control_delay: Annotated[
        float, Quantity("s", "mean delay at these lights, see signal_delays.csv; empty: none")
    ]
    level_of_service: Annotated[
        str, Quantity(None, "A to F of this mean, by the Highway Capacity Manual; empty: none")
    ]


TRAVEL_FIELDS = columns_of(TravelSummary)


@dataclass(frozen=True)
class SignalDelay:
    """One row of ``signal_delays.csv``, without the ego's id."""

    time: Annotated[float, Quantity("s", "simulation time at which it passed the stop line")]
    system: Annotated[str, Quantity(None, "SUMO id of the traffic light")]
    link: Annotated[int, Quantity(None, "index of the movement in the light's state")]
    station: Annotated[float, Quantity("m", "station of the stop line along the ego's path")]
    control_delay: Annotated[
        float, Quantity("s", "time beyond that at the limits, from 250 m before to 100 m behind")
    ]
    level_of_service: Annotated[
        str, Quantity(None, "A to F of this delay, by the Highway Capacity Manual")
    ]


class _Profile(NamedTuple):
    """The times [s] at rising stations (n,) [m] of the driven path."""

    stations: Array
    real: Array  # as driven
    free: Array  # at free flow

    def delay(self, begin: float, end: float) -> float:
        """Return the delay [s] between two stations [m], at least 0."""
        ends = np.array([begin, end])
        real, free = (np.diff(np.interp(ends, self.stations, t))[0] for t in self[1:])
        return max(0.0, float(real - free))


def level_of_service(delay: float, levels: Levels = LEVELS) -> str:
    """Return the level of a mean delay [s], a control delay by default; empty if it is nan."""
    if delay != delay:
        return ""
    return next((level for most, level in levels if delay <= most), "F")


def summarise_travel(drive: Drive, delays: Sequence[SignalDelay], fastest: float) -> TravelSummary:
    """Return the delays of a drive in one row.

    Args:
        drive: Drive of the ego.
        delays: Its delays at traffic lights.
        fastest: Highest speed [m/s] that the ego would drive at.
    """
    profile = _profile(drive, fastest)
    driven = float(drive.ego.position[-1] - drive.ego.position[0])
    free = profile.free[-1] - profile.free[0] if profile else nan
    mean = float(np.mean([one.control_delay for one in delays])) if delays else nan
    return TravelSummary(
        free_flow_delay=float(drive.ego.time[-1] - drive.ego.time[0] - free),
        stops_per_km=1000.0 * len(stops(drive.ego, drive.stop_speed)) / driven if driven else nan,
        signals_passed=len(delays),
        control_delay=mean,
        level_of_service=level_of_service(mean),
    )


def signal_delays(drive: Drive, fastest: float) -> tuple[SignalDelay, ...]:
    """Return the delay at each traffic light that the ego has passed, in the path's order.

    A light's stretch begins 250 m before its line and ends 100 m behind it, but halfway to the next
    line at the latest, and where the drive begins or ends.

    Args:
        drive: Drive of the ego.
        fastest: Highest speed [m/s] that the ego would drive at.
    """
    profile = _profile(drive, fastest)
    if profile is None:
        return ()
    lines = sorted({line.station: line for line in drive.way.lines}.items())
    at = [station for station, _ in lines]
    found = []
    for i, (station, line) in enumerate(lines):
        time = drive.time_at(station)
        if not np.isfinite(time):
            continue
        before = (at[i - 1] + station) / 2.0 if i else -np.inf
        behind = (station + at[i + 1]) / 2.0 if i + 1 < len(at) else np.inf
        delay = profile.delay(max(before, station - _BEFORE), min(behind, station + _BEHIND))
        level = level_of_service(delay)
        found.append(SignalDelay(time, line.system, line.link, station, delay, level))
    return tuple(found)


SIGNAL_DELAY_FIELDS = columns_of(SignalDelay)


def _profile(drive: Drive, fastest: float) -> _Profile | None:
    """Return the times along the driven path, or None if its limits are not known."""
    first, last = float(drive.front[0]), float(drive.front[-1])
    limits = drive.way.limits
    if not limits or last <= first:
        return None
    stations = np.linspace(first, last, 2 + int((last - first) / _SPACING))
    begins = np.array([limit.station for limit in limits])
    speeds = np.minimum([limit.speed for limit in limits], fastest)
    middle = (stations[1:] + stations[:-1]) / 2.0
    holds = np.maximum(np.searchsorted(begins, middle, side="right") - 1, 0)
    free = np.concatenate([[0.0], np.cumsum(np.diff(stations) / speeds[holds])])
    # While the ego stands, its station is the same: the time at which it leaves counts.
    leaves = np.append(np.diff(drive.front) > 0.0, True)
    real = np.interp(stations, drive.front[leaves], drive.ego.time[leaves])
    return _Profile(stations, real, free)
