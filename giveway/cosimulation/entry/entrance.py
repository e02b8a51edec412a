"""The entrance of a waiting ego: inserted where its route begins, or taken over where it is."""

import math
from collections.abc import Sequence

from giveway.config.option import LANE
from giveway.config.tables.basics import DEFAULT_SPEED
from giveway.cosimulation.entry.joining import join
from giveway.cosimulation.entry.other_plans import remarks_on_route, require_own_plan
from giveway.cosimulation.entry.smoothing import smoothed
from giveway.cosimulation.entry.stop_places import SERVING, lanes_of, on_path, placed
from giveway.cosimulation.law_records import LawfulPlaces, way_of
from giveway.ego.controllers import make_controller
from giveway.ego.ego import Course, Ego
from giveway.ego.perception.kerbs import Kerbs
from giveway.ego.rules.route import RouteContext
from giveway.ego.rules.rule_set import RuleSet
from giveway.ego.waiting_ego import WaitingEgo
from giveway.errors import ScenarioError
from giveway.geometry.bodies import BODY, VehicleShape
from giveway.geometry.path import EgoPath
from giveway.geometry.slope import Slope
from giveway.run_data.way import EgoWay, JunctionOnWay
from giveway.scenario_files.rerouters import rerouters
from giveway.sumo.network.lane_path import LanePath
from giveway.sumo.session import SumoSession
from giveway.sumo.vehicles import PlannedStop, VehicleState
from giveway.walkways import WalkNetwork

_STEEP = 0.01  # Slope [rad] below which no remark is made


class Entrance:
    """Brings egos onto the road.

    Args:
        session: The running simulation.
        time_step: Control step [s].
        network: Network in which people can walk, or None if no rule needs it.

    Attributes:
        remarks: Remarks for the user.
        ways: Paths of the egos that have entered, by their ids.
    """

    def __init__(
        self, session: SumoSession, time_step: float, network: WalkNetwork | None = None
    ) -> None:
        self._session, self._network = session, network
        self._time_step = time_step
        self.remarks: list[str] = []
        self.ways: dict[str, EgoWay] = {}

    def insert(self, ego: WaitingEgo, path: EgoPath, lane_path: LanePath) -> Ego:
        """Put an ego where its route begins.

        Args:
            ego: Ego before its departure.
            path: Path of the ego.
            lane_path: Lanes that the path was made of.
        """
        settings = ego.config.ego
        speed = initial_speed(ego, lane_path)
        self._session.vehicles.insert(
            ego.id,
            settings.route,
            lane=settings.lane or 0,
            position=settings.depart_position,
            speed=speed,
        )
        departure, shape = settings.depart_position, shape_of(ego, BODY)
        route = RouteContext(ego, self._session, path, lane_path, departure, shape, self._time_step)
        return self._on_the_road(route, speed)

    def take_over(self, ego: WaitingEgo) -> Ego:
        """Take over a vehicle from SUMO: one of the scenario, or an ego that SUMO inserted."""
        vehicles = self._session.vehicles
        state = vehicles.state(ego.id)
        shape = shape_of(ego, state)
        stops = vehicles.stops(ego.id)
        keep = ego.config.rules.stops
        serves = state.kind in SERVING if keep is None else keep
        if ego.taken_over:
            self._require_own_plan(ego.id, state, stops, serves)
        places = placed(stops, state) if serves else {}
        lane_path = self._session.lanes.along(
            state.edges,
            state.lane,
            kind=state.kind,
            start=state.lane_position,
            by=lanes_of(places, stops),
        )
        path, departure, joined = join(lane_path, state)
        path, joined = smoothed(ego, path, joined, departure, shape, state.fastest)
        require_way(ego, path, departure)
        if ego.taken_over:
            vehicles.adopt(state, shape)
        else:
            vehicles.claim(ego.id)
        self._remark_on_stops(ego, len(places), len(stops))
        speed = ego.config.ego.initial_speed
        speed = state.speed if speed is None else speed
        route = RouteContext(
            ego,
            self._session,
            path,
            joined,
            departure,
            shape,
            self._time_step,
            state.fastest,
            on_path(places, stops, path, joined, self._session.lanes),
        )
        return self._on_the_road(route, speed)

    def _require_own_plan(
        self, name: str, state: VehicleState, stops: Sequence[PlannedStop], serves: bool
    ) -> None:
        """Refuse a vehicle that SUMO directs, and remark on what would change its route."""
        devices = self._session.devices
        require_own_plan(name, devices, stops, serves=serves)
        found = rerouters(self._session.start.read)
        self.remarks += remarks_on_route(name, state.edges, devices, found)

    def _remark_on_stops(self, ego: WaitingEgo, served: int, stops: int) -> None:
        """Add a remark on what becomes of the stops of a vehicle that is taken over."""
        if served:
            self.remarks.append(
                f"ego '{ego.id}': it halts at {served} stop(s) for the scenario's times; nobody "
                "boards or alights"
            )
        if stops > served:
            self.remarks.append(
                f"ego '{ego.id}': its {stops - served} stop(s) are left out; the vehicle FMU "
                "drives on"
            )

    def _on_the_road(self, route: RouteContext, speed: float) -> Ego:
        """The ego that departs on its route at ``speed`` [m/s]."""
        ego, path, lane_path, departure = route.ego, route.path, route.lane_path, route.departure
        if route.profile is not None and not ego.recorded:
            ego.controller = make_controller(ego.config, self._time_step, route.fastest)
        ego.start(speed)
        goal = ego.config.ego.travel_distance
        self.ways[ego.id] = way_of(
            ego.id,
            path,
            departure,
            route.shape.length,
            LawfulPlaces(
                self._session.lanes.crossings,
                lane_path.lights,
                [
                    JunctionOnWay(
                        one.entry, one.exit, one.waiting, one.movement.has_stop_sign, one.offset
                    )
                    for one in route.junctions
                ],
                route.stops,
                lane_path.limits,
            ),
        )
        slope = Slope.through(lane_path.heights)
        if slope is not None and not ego.recorded:
            self._remark_on_slope(ego, slope)
        goal = path.length - departure if goal is None else goal
        course = Course(path, departure, goal, slope)
        rules, kerbs = RuleSet.on(route), self._kerbs(route)
        return Ego(ego, course, route.shape, rules, self._time_step, kerbs)

    def _remark_on_slope(self, ego: WaitingEgo, slope: Slope) -> None:
        """Add a remark if the road is steep and the vehicle model ignores slopes."""
        if slope.steepest >= _STEEP and not ego.vehicle.knows_grades:
            percent = 100.0 * math.tan(slope.steepest)
            self.remarks.append(
                f"ego '{ego.id}': its road is up to {percent:.1f} % steep, and its FMU drives as "
                "on the level: no profile names an input of it for the grade (docs/vehicles.md)"
            )

    def _kerbs(self, route: RouteContext) -> Kerbs | None:
        """The kerbs beside the path, or None if there are none or no rule needs them."""
        network, safety = self._network, route.ego.safety
        if network is None or safety is None or safety.setting_out == math.inf:
            return None
        crossings = self._session.lanes.crossings
        kerbs = Kerbs(route.path, route.shape.width, network.sidewalks, crossings, route.change_of)
        return kerbs if kerbs else None


def require_way(ego: WaitingEgo, path: EgoPath, departure: float) -> None:
    """Make sure that an ego's path is as long as the distance that it is to drive.

    Args:
        ego: Ego before its departure.
        path: Path of the ego.
        departure: Station [m] at which it enters.

    Raises:
        ScenarioError: the path is too short.
    """
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


def shape_of(ego: WaitingEgo, own: VehicleShape | VehicleState) -> VehicleShape:
    """The ego's body: as configured, or its ``own``."""
    vehicle = ego.config.vehicle
    return VehicleShape(vehicle.length or own.length, vehicle.width or own.width)


def initial_speed(ego: WaitingEgo, lane_path: LanePath) -> float:
    """The speed [m/s] at which an ego that is inserted departs."""
    speed = ego.config.ego.initial_speed
    if speed is not None:
        return speed
    by_lane = ego.config.reference_speed == LANE
    return min(DEFAULT_SPEED, lane_path.limits[0].speed) if by_lane else DEFAULT_SPEED
