"""When each ego enters the road, and how: inserted by us, or taken over as it departs."""

from __future__ import annotations

import difflib
import math
from typing import TYPE_CHECKING

from giveway.config.sections import DEFAULT_SPEED
from giveway.ego.ego import Ego
from giveway.ego.lights import Lights
from giveway.errors import ConfigError, ScenarioError
from giveway.geometry.bodies import BODY, VehicleShape
from giveway.geometry.path import EgoPath
from giveway.scenario_files import declares, undeclared

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from giveway.ego.waiting import WaitingEgo
    from giveway.sumo.lanes import LanePath
    from giveway.sumo.session import SumoSession
    from giveway.sumo.vehicles import VehicleState

LONGEST_WAIT = 86_400.0  # [s] for a departure in a scenario that never ends
_ON_THE_LINE = 0.01  # [m]
_MERGE = 20.0  # [m] along which a vehicle beside its lane's centre line joins it
_NAMES_KEPT = 100_000  # of vehicles that departed, to guess what was meant


class Departures:
    """Watches SUMO for the departure of each waiting ego.

    Args:
        egos: with their FMUs loaded.
        session: the running simulation.
        config_file: the scenario, for messages.
        time_step: [s] of the co-simulation.

    Raises:
        ScenarioError, ConfigError: an ego to be inserted has no route, or no file declares one that
            is to be taken over.
    """

    def __init__(
        self, egos: Sequence[WaitingEgo], session: SumoSession, config_file: Path, time_step: float
    ) -> None:
        self.waiting = list(egos)
        self._session = session
        self._config_file = config_file
        self._time_step = time_step
        for ego in egos:
            if ego.taken_over:
                self._require_declared(ego.id)
            else:
                self._require_undeclared(ego.id)
        self._departed: dict[str, None] = dict.fromkeys(session.vehicles.present())
        self._paths = {ego.id: self._path_of_inserted(ego) for ego in egos if not ego.taken_over}

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
            goes_on: asked at each SUMO step, with SUMO's clock [s].

        Raises:
            ScenarioError: none ever is.
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

    @property
    def _all_taken(self) -> bool:
        return all(ego.taken_over for ego in self.waiting)

    def note(self) -> None:
        """Once after each SUMO step, while anybody waits: who departed in it."""
        departed = self._session.vehicles.departed()
        if departed and len(self._departed) < _NAMES_KEPT:
            self._departed.update(dict.fromkeys(departed))
        elif departed:
            self._departed.update((d.id, None) for d in self.waiting if d.id in departed)

    def due(self) -> list[Ego]:
        """The egos that enter the road now."""
        if not self.waiting:
            return []
        ready = [ego for ego in self.waiting if self._is_due(ego)]
        self.waiting = [ego for ego in self.waiting if ego not in ready]
        return [self._enter(ego) for ego in ready]

    def require_all(self) -> None:
        """Make sure that every ego has departed.

        Raises:
            ScenarioError: one has not.
        """
        if self.waiting:
            raise ScenarioError(self._never(self.waiting[0]))

    def _is_due(self, ego: WaitingEgo) -> bool:
        if not ego.taken_over:
            return self._session.time >= ego.config.ego.depart_time - 1e-9
        return (
            ego.id in self._departed
            and ego.id in self._session.vehicles.present()
            and self._session.vehicles.on_a_road(ego.id)
        )

    def _never(self, ego: WaitingEgo) -> str:
        if not ego.taken_over:
            departure = ego.config.ego.depart_time
            return (
                f"ego '{ego.id}': {self._config_file} ends at {self._session.time:.12g} s, "
                f"before its departure at {departure:.12g} s; let it depart earlier"
            )
        names = list(self._departed)
        close = difflib.get_close_matches(ego.id, names, n=1)
        hint = "nobody did; look at its begin and end"
        if names:
            shown = ", ".join(names[:3])
            hint = f"did you mean '{close[0]}'?" if close else f"name one that does, like {shown}"
        return (
            f"--ego {ego.id}: no such vehicle departed in {self._config_file} until "
            f"{self._session.time:.12g} s ({len(names)} others did); {hint}"
        )

    # --- inserted -----------------------------------------------------------------------------

    def _path_of_inserted(self, ego: WaitingEgo) -> tuple[EgoPath, LanePath]:
        settings = ego.config.ego
        if settings.depart_time >= self._session.end:
            raise ConfigError(
                f"--ego-depart-time {settings.depart_time:.12g}: {self._config_file} ends at "
                f"{self._session.end:.12g} s; let the ego depart before [s]"
            )
        if not settings.route:
            name = self._config_file.stem
            raise ConfigError(
                f"{self._config_file}: no ego; take a vehicle of the scenario with --ego ID, "
                f"insert one with --ego-route EDGE,EDGE or in {name}.giveway.toml, [ego] route, "
                "or drive none with --no-ego"
            )
        lane_path = self._session.lanes.along(
            settings.route, settings.lane, start=settings.depart_position
        )
        path = EgoPath.through(lane_path.points)
        self._require_room(ego, path, settings.depart_position)
        return path, lane_path

    def _require_room(self, ego: WaitingEgo, path: EgoPath, departure: float) -> None:
        distance = ego.config.ego.travel_distance
        if departure >= path.length - 1e-3:
            raise ScenarioError(
                f"ego '{ego.id}': its way is {path.length:.1f} m long and it departs at "
                f"{departure:.1f} m; let it depart earlier or lengthen its route"
            )
        if distance is not None and departure + distance > path.length:
            raise ScenarioError(
                f"--ego-travel-distance {distance:g}: the way of ego '{ego.id}' is "
                f"{path.length:.1f} m long and it departs at {departure:.1f} m; "
                "shorten the distance or lengthen --ego-route"
            )

    # --- entering -----------------------------------------------------------------------------

    def _enter(self, ego: WaitingEgo) -> Ego:
        if ego.taken_over:
            return self._take_over(ego)
        settings, vehicle = ego.config.ego, ego.config.vehicle
        path, lane_path = self._paths[ego.id]
        speed = DEFAULT_SPEED if settings.initial_speed is None else settings.initial_speed
        self._session.vehicles.insert(
            ego.id,
            settings.route,
            lane=settings.lane or 0,
            position=settings.depart_position,
            speed=speed,
        )
        shape = VehicleShape(vehicle.length or BODY.length, vehicle.width or BODY.width)
        return self._on_the_road(ego, path, lane_path, settings.depart_position, shape, speed)

    def _take_over(self, ego: WaitingEgo) -> Ego:
        state = self._session.vehicles.state(ego.id)
        vehicle = ego.config.vehicle
        shape = VehicleShape(vehicle.length or state.length, vehicle.width or state.width)
        lane_path = self._session.lanes.along(
            state.edges, state.lane, kind=state.kind, start=state.lane_position
        )
        path, departure, lights = _joined(lane_path, state)
        self._require_room(ego, path, departure)
        self._session.vehicles.adopt(state, shape)
        speed = ego.config.ego.initial_speed
        speed = state.speed if speed is None else speed
        return self._on_the_road(ego, path, lights, departure, shape, speed)

    def _on_the_road(
        self,
        ego: WaitingEgo,
        path: EgoPath,
        lane_path: LanePath,
        departure: float,
        shape: VehicleShape,
        speed: float,
    ) -> Ego:
        config = ego.config
        ego.start(speed)
        goal = config.ego.travel_distance
        lights = Lights(
            lane_path.lights if config.regulation.traffic_lights else (),
            comfortable=config.regulation.comfortable_deceleration,
            hardest=config.mpc.force_limit / config.vehicle.mass,
        )
        return Ego(
            ego,
            path,
            departure,
            shape,
            lights,
            path.length - departure if goal is None else goal,
            self._time_step,
        )


def _joined(lane_path: LanePath, state: VehicleState) -> tuple[EgoPath, float, LanePath]:
    """The path of a vehicle that is taken over, its front bumper's station, and its lights.

    As a rule the front bumper is on the lane's centre line. A vehicle beside it (one that changes
    lanes, or is moved by SUMO's sublane model) joins the line within ``_MERGE``.
    """
    path = EgoPath.through(lane_path.points)
    station, lateral = path.locate(state.x, state.y, near=state.lane_position)
    if abs(lateral) <= _ON_THE_LINE:
        return path, station, lane_path
    share = (path.stations - station) / _MERGE
    beside = path.vertices[share > 1.0]
    joined = EgoPath.through([(state.x, state.y), *beside])
    shift = joined.length - (path.length - station)
    lights = [light._replace(station=light.station - station + shift) for light in lane_path.lights]
    return joined, 0.0, type(lane_path)(joined.vertices, tuple(lights))
