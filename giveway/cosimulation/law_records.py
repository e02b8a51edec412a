"""The records, besides tracks, from which the law of the road is judged after a run.

They are the network's crossings, stop lines and junctions on each ego's path, the states of the
traffic lights there, and the people's destinations. They do not depend on the rules that the ego
obeys.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from giveway.crowd.roster import Roster
from giveway.ego.rules.route import Stop
from giveway.geometry.path import EgoPath
from giveway.journal.recorder import Recorder
from giveway.run_data.way import CrossingOnWay, EgoWay, Halt, JunctionOnWay, LimitOnWay, StopLine
from giveway.sumo.network.lane_path import Light, SpeedLimit
from giveway.sumo.network.pedestrian_crossings import Crossing
from giveway.sumo.session import SumoSession

_SAMPLE = 0.5  # Distance [m] between the points of the path that are examined
# Lateral reach [m] from the path to the kerb of a crossing that the ego's body may touch
_BESIDE = 4.0
_BEFORE = 1.5  # Longitudinal reach [m] from the path to a crossing's marking
_DECIMALS = 6  # Decimals of lengths [m]: micrometres, as in all tables


class LawfulPlaces(NamedTuple):
    """The places about which the law of the road may have a say."""

    crossings: Sequence[Crossing]  # crossings of the network
    lights: Sequence[Light]  # traffic lights on the path
    junctions: Sequence[JunctionOnWay] = ()  # junctions on the path
    stops: Sequence[Stop] = ()  # scheduled stops that the ego serves
    limits: Sequence[SpeedLimit] = ()  # speed limits of the lanes


def way_of(
    ego_id: str, path: EgoPath, departure: float, length: float, places: LawfulPlaces
) -> EgoWay:
    """The crossings, lights, junctions and stops on an ego's path.

    Args:
        ego_id: Id of the ego in SUMO.
        path: Path of the ego.
        departure: Station [m] of the front bumper where the ego's position is 0.
        length: Length of the ego's body [m].
        places: Crossings of the network, and lights, junctions and stops on the path.
    """
    return EgoWay(
        ego=ego_id,
        points=tuple((_rounded(x), _rounded(y)) for x, y in path.vertices.tolist()),
        departure=_rounded(departure),
        crossings=_near(path, departure - length, places.crossings),
        lines=tuple(
            StopLine(_rounded(light.station), light.system, light.link) for light in places.lights
        ),
        junctions=tuple(
            place._replace(
                entry=_rounded(place.entry),
                exit=_rounded(place.exit),
                waiting=tuple(map(_rounded, place.waiting)),
            )
            for place in places.junctions
        ),
        halts=tuple(Halt(_rounded(stop.start), _rounded(stop.end)) for stop in places.stops),
        limits=tuple(
            LimitOnWay(_rounded(limit.station), _rounded(limit.speed)) for limit in places.limits
        ),
    )


def _near(path: EgoPath, begin: float, crossings: Sequence[Crossing]) -> tuple[CrossingOnWay, ...]:
    """The crossings on the path or close to it, from station ``begin`` [m] on."""
    if not crossings:
        return ()
    begin = max(0.0, begin)
    count = 2 + round((path.length - begin) / _SAMPLE)
    stations = np.linspace(begin, path.length, count)
    x, y = path.points(stations).T
    found: list[tuple[float, CrossingOnWay]] = []
    for crossing in crossings:
        (x_0, y_0), (x_1, y_1) = crossing.ends.tolist()
        length = float(np.hypot(x_1 - x_0, y_1 - y_0))
        if length <= 0.0:
            continue
        c, s = (x_1 - x_0) / length, (y_1 - y_0) / length
        u = (x - x_0) * c + (y - y_0) * s
        w = (y - y_0) * c - (x - x_0) * s
        near = (u >= -_BESIDE) & (u <= length + _BESIDE)
        near &= np.abs(w) <= crossing.width / 2 + _BEFORE
        if near.any():
            ends = (_rounded(x_0), _rounded(y_0)), (_rounded(x_1), _rounded(y_1))
            place = CrossingOnWay(
                crossing.lane,
                ends,
                _rounded(crossing.width),
                crossing.zebra,
                crossing.system,
                crossing.link,
            )
            found.append((float(stations[np.argmax(near)]), place))
    return tuple(place for _, place in sorted(found, key=lambda item: item[0]))


def _rounded(value: float) -> float:
    return round(float(value), _DECIMALS) + 0.0


class LawRecords:
    """Records the data for the judgement, once an ego has a path on which the law applies.

    Args:
        session: The running simulation.
        recorder: Recorder that gathers the rows.

    Attributes:
        ruled: True if a rule of the law applies on any ego's path.
    """

    def __init__(self, session: SumoSession, recorder: Recorder) -> None:
        self._session = session
        self._recorder = recorder
        self.ruled = False
        self._states: dict[str, str] = {}

    def depart(self, way: EgoWay) -> None:
        """Note an ego's path and what the law rules on it, if anything."""
        self._recorder.way(way)
        if not way.is_ruled:
            return
        self.ruled = True
        self._states |= dict.fromkeys(sorted(way.systems - self._states.keys()), "")

    def signals(self, time: float) -> None:
        """Record the lights that changed in a SUMO step, at ``time`` [s]."""
        for system, before in self._states.items():
            state = self._session.light_state(system)
            if state != before:
                self._states[system] = state
                self._recorder.signal(time, system, state)

    def walks(self, roster: Roster) -> None:
        """Record the people who joined the crowd since the last call, and their goals."""
        if not self.ruled or not roster.newcomers:
            return
        crowd, recorder = roster.crowd, self._recorder
        new = set(roster.newcomers)
        roster.newcomers.clear()
        for row, pedestrian in enumerate(roster.person_ids.tolist()):
            if pedestrian in new:
                begin = crowd.waypoint_start[row] + crowd.waypoint_index[row]
                ahead = crowd.waypoints[begin : crowd.waypoint_start[row + 1]]
                places = np.concatenate([crowd.position[row : row + 1], ahead])
                recorder.walk(pedestrian, float(crowd.desired_speed[row]), places)
