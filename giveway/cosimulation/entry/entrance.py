"""How a waiting ego enters the road: inserted where its route says, or taken over where it is."""

import math
from collections.abc import Sequence

from giveway.config import EgoRunConfig
from giveway.config.option import LANE
from giveway.config.tables.basics import DEFAULT_SPEED
from giveway.config.tables.regulation import RegulationConfig
from giveway.cosimulation.entry.joining import join
from giveway.cosimulation.entry.stop_places import SERVING, lanes_of, on_path, placed
from giveway.cosimulation.law_records import way_of
from giveway.ego.controllers import make_controller
from giveway.ego.crossings import Crossings, crossings_on
from giveway.ego.ego import Ego
from giveway.ego.junctions import PathJunction, junctions_on
from giveway.ego.kerbs import Kerbs
from giveway.ego.lights import Lights
from giveway.ego.merges import Merges, places_of
from giveway.ego.perception.leader import CLOSEST
from giveway.ego.right_of_way import RightOfWay
from giveway.ego.speed_profile import SpeedProfile, profile_of
from giveway.ego.stops import Stop, Stops
from giveway.ego.waiting_ego import WaitingEgo
from giveway.ego.way_ahead import WayAhead
from giveway.errors import ScenarioError
from giveway.geometry.bodies import BODY, VehicleShape
from giveway.geometry.path import EgoPath
from giveway.geometry.slope import Slope
from giveway.run_data.way import EgoWay, JunctionOnWay
from giveway.sumo.lane_path import LanePath
from giveway.sumo.session import SumoSession
from giveway.sumo.signal_plans import ChangeOf, untold
from giveway.sumo.vehicles import VehicleState
from giveway.walkways import WalkNetwork

_BEHIND = 0.5  # [m] more than it keeps is left behind a vehicle that stands
_LEAST_GAP = 1.0  # [m] behind it
_STEEP = 0.01  # [rad] less is not worth a word


class Entrance:
    """Brings egos onto the road.

    Args:
        session: the running simulation.
        time_step: [s] of the co-simulation.
        network: where people can walk; None: nobody asks.

    Attributes:
        remarks: what the user should know.
        ways: of those that have entered, by their ids.
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
            ego: before its departure.
            path: of it.
            lane_path: that the path was made of.
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
        shape = shape_of(ego, BODY)
        return self._on_the_road(
            ego, path, lane_path, settings.depart_position, shape, speed, math.inf
        )

    def take_over(self, ego: WaitingEgo) -> Ego:
        """Take a vehicle that SUMO drives over as an ego: the scenario's, or one SUMO inserted."""
        vehicles = self._session.vehicles
        state = vehicles.state(ego.id)
        shape = shape_of(ego, state)
        stops = vehicles.stops(ego.id)
        keep = ego.config.ego.keep_stops
        serves = state.kind in SERVING if keep is None else keep
        places = placed(stops, state) if serves else {}
        lane_path = self._session.lanes.along(
            state.edges,
            state.lane,
            kind=state.kind,
            start=state.lane_position,
            by=lanes_of(places, stops),
        )
        path, departure, joined = join(lane_path, state)
        require_way(ego, path, departure)
        if ego.taken_over:
            vehicles.adopt(state, shape)
        else:
            vehicles.claim(ego.id)
        self._remark_on_stops(ego, len(places), len(stops))
        speed = ego.config.ego.initial_speed
        speed = state.speed if speed is None else speed
        return self._on_the_road(
            ego,
            path,
            joined,
            departure,
            shape,
            speed,
            state.fastest,
            on_path(places, stops, path, joined, self._session.lanes),
        )

    def _remark_on_stops(self, ego: WaitingEgo, served: int, stops: int) -> None:
        """Say what becomes of the stops of a vehicle that is taken over."""
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

    def _on_the_road(
        self,
        ego: WaitingEgo,
        path: EgoPath,
        lane_path: LanePath,
        departure: float,
        shape: VehicleShape,
        speed: float,
        capable: float,
        stops: Sequence[Stop] = (),
    ) -> Ego:
        config = ego.config
        profile = profile_of(
            ego, path, lane_path.limits, departure, shape.length, capable, self._time_step
        )
        if profile is not None and not ego.recorded:
            ego.controller = make_controller(config, self._time_step, profile.fastest)
        hardest = config.vehicle.acceleration_limit
        ego.start(speed)
        goal = config.ego.travel_distance
        junctions = junctions_on(
            path, lane_path.passages, shape.width, self._session.junctions, self._session.lanes
        )
        self.ways[ego.id] = way_of(
            ego.id,
            path,
            departure,
            shape.length,
            crossings=self._session.lanes.crossings,
            lights=lane_path.lights,
            junctions=[
                JunctionOnWay(one.entry, one.exit, one.waiting, one.movement.has_stop_sign)
                for one in junctions
            ],
            stops=stops,
        )
        halts = Stops(stops, clock=self._session.time, time_step=self._time_step, hardest=hardest)
        way = WayAhead(
            self._lights(config, lane_path, hardest),
            halts if stops else None,
            self._crossings(config, path, shape),
            self._right_of_way(config, junctions, shape, profile),
            self._merges(config, path, lane_path, shape, departure),
            self._kerbs(ego, path, shape),
        )
        slope = Slope.through(lane_path.heights)
        if slope is not None and not ego.recorded:
            self._remark_on_slope(ego, slope)
        return Ego(
            ego,
            path,
            departure,
            shape,
            way,
            path.length - departure if goal is None else goal,
            self._time_step,
            profile,
            slope,
        )

    def _remark_on_slope(self, ego: WaitingEgo, slope: Slope) -> None:
        """Say so where the road is steep and the vehicle does not feel it."""
        if slope.steepest >= _STEEP and not ego.vehicle.knows_grades:
            percent = 100.0 * math.tan(slope.steepest)
            self.remarks.append(
                f"ego '{ego.id}': its road is up to {percent:.1f} % steep, and its FMU drives as "
                "on the level: no profile names an input of it for the grade (docs/vehicles.md)"
            )

    def _kerbs(self, ego: WaitingEgo, path: EgoPath, shape: VehicleShape) -> Kerbs | None:
        """The kerbs beside the path; None: there are none, or they are no matter."""
        network = self._network
        if network is None or ego.safety is None or ego.safety.setting_out == math.inf:
            return None
        crossings, change_of = self._session.lanes.crossings, self._change_of(ego.config)
        kerbs = Kerbs(path, shape.width, network.sidewalks, crossings, change_of)
        return kerbs if kerbs else None

    def _change_of(self, config: EgoRunConfig) -> ChangeOf:
        """What traffic lights tell the ego of their next change."""
        return self._session.signal_plans.change if config.perception.signal_plans else untold

    def _lights(self, config: EgoRunConfig, lane_path: LanePath, hardest: float) -> Lights | None:
        """The traffic lights that the ego heeds; None: there are none."""
        if not (config.regulation.traffic_lights and lane_path.lights):
            return None
        return Lights(
            lane_path.lights,
            comfortable=config.regulation.comfortable_deceleration,
            hardest=hardest,
            arrows=config.heeds_priority,
            greens_of=self._session.signal_plans.greens if config.perception.signal_plans else None,
        )

    def _merges(
        self,
        config: EgoRunConfig,
        path: EgoPath,
        lane_path: LanePath,
        shape: VehicleShape,
        departure: float,
    ) -> Merges | None:
        """Where the ego comes onto a lane together with others; None: nowhere."""
        if not (config.heeds_priority and config.regulation.vehicles):
            return None
        found = self._session.lanes.mergings(lane_path)
        places = places_of(path, shape.width / 2, found, departure)
        return Merges(places, shape.length) if places else None

    def _crossings(
        self, config: EgoRunConfig, path: EgoPath, shape: VehicleShape
    ) -> Crossings | None:
        """The crossings at which the ego gives way; None: none."""
        if not config.heeds_priority:
            return None
        found = crossings_on(path, shape, self._session.lanes.crossings)
        if not found:
            return None
        regulation = config.regulation
        return Crossings(
            found,
            length=shape.length,
            gap=_standing_gap(regulation),
            kerb_distance=regulation.kerb_distance,
            kerb_time=regulation.kerb_time,
            change_of=self._change_of(config),
        )

    def _right_of_way(
        self,
        config: EgoRunConfig,
        junctions: Sequence[PathJunction],
        shape: VehicleShape,
        profile: SpeedProfile | None,
    ) -> RightOfWay | None:
        """Who goes first at the junctions; None: there are none, or the ego keeps to no law."""
        if not (config.heeds_priority and junctions):
            return None
        regulation = config.regulation
        return RightOfWay(
            junctions,
            name=config.ego_id,
            length=shape.length,
            gap=_standing_gap(regulation),
            fastest=float(config.reference_speed) if profile is None else profile.fastest,
            critical_gap=regulation.critical_gap,
            follow_up_gap=regulation.follow_up_gap,
        )


def require_way(ego: WaitingEgo, path: EgoPath, departure: float) -> None:
    """Make sure that an ego's way is as long as it is to drive.

    Args:
        ego: before its departure.
        path: of it.
        departure: station [m] at which it enters.

    Raises:
        ScenarioError: it is not.
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
    """The ego's body: as wanted, or its ``own``."""
    vehicle = ego.config.vehicle
    return VehicleShape(vehicle.length or own.length, vehicle.width or own.width)


def initial_speed(ego: WaitingEgo, lane_path: LanePath) -> float:
    """The speed [m/s] at which an ego that is inserted departs."""
    speed = ego.config.ego.initial_speed
    if speed is not None:
        return speed
    by_lane = ego.config.reference_speed == LANE
    return min(DEFAULT_SPEED, lane_path.limits[0].speed) if by_lane else DEFAULT_SPEED


def _standing_gap(regulation: RegulationConfig) -> float:
    """The gap [m] that it needs behind a vehicle that stands, so as not to block a place."""
    return max(_LEAST_GAP, min(regulation.safe_distance, CLOSEST) + _BEHIND)
