"""The departures of egos: inserted by giveway or SUMO, or taken over as they depart.

An ego that is to be inserted enters at its time if there is room for it. Otherwise SUMO inserts it
as soon as SUMO's own check finds room, and giveway takes it over there.
"""

import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from giveway.cosimulation.entry.departure_time import departure_time
from giveway.cosimulation.entry.entrance import Entrance, initial_speed, require_way, shape_of
from giveway.cosimulation.entry.room import Entry, has_room
from giveway.cosimulation.entry.smoothing import smoothed
from giveway.ego.ego import Ego
from giveway.ego.waiting_ego import WaitingEgo
from giveway.errors import ConfigError, ScenarioError, suggestion
from giveway.geometry.bodies import BODY
from giveway.geometry.overlap import rectangles_overlap
from giveway.geometry.path import EgoPath
from giveway.scenario_files import declares, flows_due, undeclared
from giveway.sumo.network.lane_path import LanePath
from giveway.sumo.session import SumoSession
from giveway.walkways import WalkNetwork

LONGEST_WAIT = 86_400.0  # Longest wait [s] for a departure in a scenario that never ends
LONGEST_WAIT_FOR_ROOM = 300.0  # Longest wait [s] of an ego for room, after which the run ends
_NAMES_KEPT = 100_000  # Number of vehicle ids remembered for hints on misspelt ids


class Departures:
    """Watches SUMO for the departure of each waiting ego.

    Args:
        egos: Waiting egos with their FMUs loaded.
        session: The running simulation.
        config_file: The scenario, for messages.
        time_step: Control step [s].
        network: Network in which people can walk, or None if no rule needs it.

    Attributes:
        times: Departure times [s] of the egos that are to be inserted, by their ids.

    Raises:
        ScenarioError, ConfigError: an ego to be inserted has no route, or no file declares a
            vehicle that is to be taken over.
    """

    def __init__(
        self,
        egos: Sequence[WaitingEgo],
        session: SumoSession,
        config_file: Path,
        time_step: float,
        network: WalkNetwork | None = None,
    ) -> None:
        self.waiting = list(egos)
        self._session = session
        self._config_file = config_file
        for ego in egos:
            if ego.taken_over:
                self._require_declared(ego.id)
            else:
                self._require_undeclared(ego.id)
        self._departed: dict[str, None] = dict.fromkeys(session.vehicles.present())
        self.times = {ego.id: departure_time(ego.config) for ego in egos if not ego.taken_over}
        self._paths = {ego.id: self._path_of_inserted(ego) for ego in egos if not ego.taken_over}
        self._begin = session.time
        self._blocked: dict[str, float] = {}  # time [s] since which an ego lacks room
        self._queued: set[str] = set()  # egos that SUMO is to insert
        # queued egos that have room, but SUMO may insert others there
        self._cautious: set[str] = set()
        self._entrance = Entrance(session, time_step, network)
        self.remarks = self._entrance.remarks  # remarks for the user
        self.ways = self._entrance.ways  # records of the egos that have departed

    def _require_declared(self, name: str) -> None:
        """Refuse to wait for a vehicle that no file declares."""
        hint = undeclared(name, self._session.start.read)
        if hint is not None:
            raise ScenarioError(
                f"--ego {name}: no such vehicle in the routes of {self._config_file}; {hint}"
            )

    def _require_undeclared(self, name: str) -> None:
        """Refuse an id that a vehicle of the scenario has, even if that departs later."""
        if declares(name, self._session.start.read):
            raise ScenarioError(
                f"--ego-id {name}: {self._config_file} has a vehicle of this id; choose another, "
                f"or take that one over with --ego {name}"
            )

    @property
    def names(self) -> list[str]:
        """Ids of the vehicles that have not departed yet."""
        return [ego.id for ego in self.waiting]

    @property
    def first_path(self) -> EgoPath | None:
        """The path of the first ego to be inserted, if there is one."""
        return next((path for path, _ in self._paths.values()), None)

    def run_until_first(self, goes_on: Callable[[float], bool]) -> None:
        """Let the scenario run by itself until an ego is due.

        Args:
            goes_on: Function that is called with SUMO's clock [s] at each step; waiting ends when
                it returns False.

        Raises:
            ScenarioError: no ego ever is due.
        """
        session = self._session
        began = session.time
        while self.waiting and not any(map(self._is_due, self.waiting)):
            if not goes_on(session.time):
                return
            over = session.time >= min(session.end, began + LONGEST_WAIT) - 1e-9
            if over or (session.end == math.inf and not session.expects_more and self._all_taken):
                raise ScenarioError(self._never(self.waiting[0]))
            session.step()
            self.note()

    def forgo(self, time: float) -> None:
        """Let the scenario run by itself up to ``time`` [s]; no ego departs then or later."""
        self.waiting.clear()
        while self._session.time < time - 1e-9:
            self._session.step()

    @property
    def _all_taken(self) -> bool:
        return all(ego.taken_over for ego in self.waiting)

    def note(self) -> None:
        """Take note, after each SUMO step, of the vehicles that departed in it."""
        departed = self._session.vehicles.departed()
        if departed and len(self._departed) < _NAMES_KEPT:
            self._departed.update(dict.fromkeys(departed))
        elif departed:
            self._departed.update((d.id, None) for d in self.waiting if d.id in departed)

    def due(self) -> list[Ego]:
        """The egos that enter the road now."""
        if not self.waiting:
            return []
        entered: list[Ego] = []
        for waiting in self.waiting[:]:
            if self._is_due(waiting, entered):
                self.waiting.remove(waiting)
                entered.append(self._enter(waiting))
        return entered

    def require_all(self) -> None:
        """Make sure that every ego has departed.

        Raises:
            ScenarioError: an ego has not departed.
        """
        if self.waiting:
            raise ScenarioError(self._never(self.waiting[0]))

    def _is_due(self, ego: WaitingEgo, entered: Sequence[Ego] = ()) -> bool:
        """Return whether an ego enters the road now; ``entered`` are the egos that just entered."""
        if ego.taken_over or ego.id in self._queued:
            return self._is_free_to_take(ego)
        if self._session.time < self.times[ego.id] - 1e-9:
            return False
        room = has_room(self._entry(ego), self._session.vehicles, entered)
        if room and not self._may_meet(ego, entered):
            return True
        if room:
            self._cautious.add(ego.id)
        self._blocked[ego.id] = self._session.time
        self._queue(ego)
        return False

    def _is_free_to_take(self, ego: WaitingEgo) -> bool:
        """Return whether SUMO has the vehicle on a road, and no other vehicle overlaps it.

        Raises:
            ScenarioError: the vehicle has had no room for too long.
        """
        vehicles, now = self._session.vehicles, self._session.time
        there = ego.id in self._departed and ego.id in vehicles.present()
        if there and vehicles.on_a_road(ego.id) and not self._overlapped(ego):
            return True
        if there and ego.id not in self._blocked and self._overlapped(ego):
            self._blocked[ego.id] = now
        if now - self._blocked.get(ego.id, now) >= LONGEST_WAIT_FOR_ROOM:
            raise ScenarioError(self._no_room(ego))
        return False

    def _overlapped(self, ego: WaitingEgo) -> bool:
        """Return whether another vehicle on the road overlaps the one that is to be taken over."""
        vehicles = self._session.vehicles
        state, others = vehicles.state(ego.id), vehicles.everybody_but(ego.id)
        if not others.ids:
            return False
        shape = shape_of(ego, state)
        body = np.array([state.x, state.y, state.heading, shape.length, shape.width])
        touched = np.flatnonzero(rectangles_overlap(body, others.bodies))
        return any(not vehicles.parked(others.ids[i]) for i in touched)

    def _may_meet(self, ego: WaitingEgo, entered: Sequence[Ego]) -> bool:
        """Return whether SUMO may insert a vehicle now near the place of an ego to be inserted."""
        session = self._session
        edge = ego.config.ego.route[0]
        near = {edge, *ego.config.ego.route[:2], *session.lanes.edges_before(edge)}
        if near & session.vehicles.edges_of_entry({other.id for other in entered}):
            return True
        starts = flows_due(
            session.start.read, session.time - session.step_length, session.time, self._begin
        )
        edges = (start.edge or session.vehicles.first_edge(start.route) for start in starts)
        return any(not first or first in near for first in edges)

    def _entry(self, ego: WaitingEgo) -> Entry:
        path, lane_path = self._paths[ego.id]
        config = ego.config
        return Entry(
            path,
            lane_path.first,
            config.ego.depart_position,
            shape_of(ego, BODY),
            initial_speed(ego, lane_path),
            config.vehicle.acceleration_limit,
        )

    def _queue(self, ego: WaitingEgo) -> None:
        """Let SUMO insert the ego."""
        entry = self._entry(ego)
        self._session.vehicles.queue(
            ego.id,
            ego.config.ego.route,
            lane=entry.lane,
            position=entry.station,
            speed=entry.speed,
        )
        self._queued.add(ego.id)

    def _no_room(self, ego: WaitingEgo) -> str:
        since = self._blocked[ego.id]
        if ego.id not in self._queued:
            return (
                f"--ego {ego.id}: other vehicles overlap it ever since {since:.12g} s; it is not "
                f"taken over later than {LONGEST_WAIT_FOR_ROOM:g} s after; name another vehicle"
            )
        entry = self._entry(ego)
        return (
            f"ego '{ego.id}': no room on lane '{entry.lane}' at {entry.station:g} m for "
            f"{entry.speed:g} m/s within {LONGEST_WAIT_FOR_ROOM:g} s from {since:.12g} s on; "
            "let it depart elsewhere (--ego-depart-position, --ego-lane, --ego-route), at another "
            "time (--ego-depart-time) or as fast as the traffic (--ego-initial-speed)"
        )

    def _never(self, ego: WaitingEgo) -> str:
        if ego.id in self._queued:
            return (
                f"ego '{ego.id}': {self._config_file} ends at {self._session.time:.12g} s, and "
                f"from {self._blocked[ego.id]:.12g} s on there was no room for it; let it depart "
                "at another time (--ego-depart-time) or elsewhere (--ego-depart-position, "
                "--ego-route)"
            )
        if not ego.taken_over:
            departure = self.times[ego.id]
            return (
                f"ego '{ego.id}': {self._config_file} ends at {self._session.time:.12g} s, "
                f"before its departure at {departure:.12g} s; let it depart earlier"
            )
        names = list(self._departed)
        some = f"name one that does, like {', '.join(names[:3])}"
        none = "no vehicle departed; check the scenario's begin and end"
        hint = suggestion(ego.id, names, some if names else none, cutoff=0.6)
        return (
            f"--ego {ego.id}: no such vehicle departed in {self._config_file} until "
            f"{self._session.time:.12g} s ({len(names)} others did); {hint}"
        )

    # --- inserted egos ------------------------------------------------------------------------

    def _path_of_inserted(self, ego: WaitingEgo) -> tuple[EgoPath, LanePath]:
        settings = ego.config.ego
        departure = self.times[ego.id]
        if departure >= self._session.end:
            raise ConfigError(
                f"--ego-depart-time {departure:.12g}: {self._config_file} ends at "
                f"{self._session.end:.12g} s; let the ego depart before [s]"
            )
        if not settings.route:
            name = self._config_file.stem
            raise ConfigError(
                f"{self._config_file}: no ego; take a vehicle of the scenario with --ego ID, "
                f"insert one with --ego-route EDGE,EDGE or in {name}.giveway.toml, [ego] route, "
                f"or drive none with --no-ego; giveway doctor {self._config_file} proposes some"
            )
        lane_path = self._session.lanes.along(
            settings.route, settings.lane, start=settings.depart_position
        )
        path = EgoPath.through(lane_path.points)
        begin = settings.depart_position
        path, lane_path = smoothed(ego, path, lane_path, begin, shape_of(ego, BODY))
        require_way(ego, path, begin)
        return path, lane_path

    def _enter(self, ego: WaitingEgo) -> Ego:
        if not ego.taken_over and ego.id not in self._queued:
            return self._entrance.insert(ego, *self._paths[ego.id])
        self._remark_on_wait(ego)
        return self._entrance.take_over(ego)

    def _remark_on_wait(self, ego: WaitingEgo) -> None:
        """Add a remark on how long the ego has waited for room, if it has."""
        if ego.id not in self._blocked:
            return
        since, now = self._blocked[ego.id], self._session.time
        if ego.id in self._cautious and now - since < 1.5 * self._session.step_length:
            return  # there was room, and SUMO's own insertion takes a step
        waited = f"{now - since:.12g} s later, at {now:.12g} s"
        if ego.taken_over:
            text = f"overlapped another vehicle at {since:.12g} s; it was taken over {waited}"
        else:
            place = f"on lane '{self._entry(ego).lane}'"
            text = f"there was no room {place} at {since:.12g} s; SUMO inserted it {waited}"
        self.remarks.append(f"ego '{ego.id}': {text}")
