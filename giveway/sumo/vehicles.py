"""SUMO's vehicles: reading, taking over, inserting and slowing them."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from giveway.errors import ScenarioError, SumoError
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import angle_to_heading, angles_to_headings
from giveway.sumo.background import NO_VEHICLES, BackgroundVehicles
from giveway.sumo.library import direct
from giveway.sumo.network.lanes import Lanes
from giveway.sumo.types import ego_type, inserted_type

_PARKING_AREA = 64  # SUMO's flag of a stop in a parking area
_TRIGGERED = 2 | 4  # its flags of stops that wait for persons, and for containers
_ALL_CHECKS, _WITHOUT_SAFE_SPEED = 31, 30  # SUMO's speed modes


@dataclass(frozen=True)
class VehicleState:
    """The state of one of SUMO's vehicles at one instant."""

    id: str
    type: str
    kind: str  # SUMO's vehicle class
    edges: tuple[str, ...]  # edges of its route from the present one on
    lane: int  # index of its lane on the present edge
    lane_position: float  # [m] position on the lane
    x: float  # [m] front-bumper centre
    y: float  # [m] front-bumper centre
    heading: float  # [rad] counter-clockwise from +x
    speed: float  # [m/s]
    length: float  # [m]
    width: float  # [m]
    fastest: float  # [m/s] largest speed of its type


class PlannedStop(NamedTuple):
    """A planned stop of one of SUMO's vehicles."""

    lane: str
    start: float  # [m] beginning on the lane
    end: float  # [m] place of the front bumper at the stop
    duration: float  # [s] duration; not given if it is not positive
    until: float  # [s] end of the stop on SUMO's clock; not given if negative
    beside: bool  # True if it is in a parking area beside the lane
    triggered: bool = False  # True if it lasts until passengers or containers have boarded


class SumoVehicles:
    """The vehicles of a running simulation: reading them, and acting on them.

    Args:
        sumo: The libsumo module.
        call: Function that calls libsumo and explains its failures.
        lanes: Lanes of the network.
    """

    def __init__(self, sumo: Any, call: Callable[..., Any], lanes: Lanes) -> None:
        self._vehicle = sumo.vehicle
        self._sumo = sumo
        self._call = call
        self._lanes = lanes
        self._size = cache(self._type_length_width)
        self._hardest: Callable[[str], float] = cache(sumo.vehicle.getEmergencyDecel)
        self._id_list = direct(sumo, "vehicle", "getIDList")
        self._position = direct(sumo, "vehicle", "getPosition")
        self._angle = direct(sumo, "vehicle", "getAngle")
        self._speed = direct(sumo, "vehicle", "getSpeed")
        self._lane_id = direct(sumo, "vehicle", "getLaneID")
        self._lane_position = direct(sumo, "vehicle", "getLanePosition")
        self._route_id = direct(sumo, "vehicle", "getRouteID")
        self._time_loss = direct(sumo, "vehicle", "getTimeLoss")
        self.egos: set[str] = set()  # ids of the vehicles that giveway drives

    # --- reading ------------------------------------------------------------------------------

    def departed(self) -> frozenset[str]:
        """Return the ids of the vehicles that departed in SUMO's latest step."""
        return frozenset(self._sumo.simulation.getDepartedIDList())

    def present(self) -> tuple[str, ...]:
        """Return the ids of all vehicles on the road."""
        return tuple(self._vehicle.getIDList())

    def background(self) -> BackgroundVehicles:
        """Return all vehicles of the scenario except the egos, at SUMO's present instant."""
        everybody = self._id_list()
        if self.egos.issuperset(everybody):
            return NO_VEHICLES
        return self._bodies(sorted(name for name in everybody if name not in self.egos))

    def everybody_but(self, name: str) -> BackgroundVehicles:
        """Return all vehicles on the road except the one named, egos included."""
        others = sorted(set(self._id_list()) - {name})
        return self._bodies(others) if others else NO_VEHICLES

    def _bodies(self, names: Sequence[str]) -> BackgroundVehicles:
        """Return the positions and bodies of at least one vehicle."""
        ids = tuple(names)
        types, lengths, widths = zip(*map(self._size, ids), strict=True)
        places = np.array(list(map(self._position, ids)), dtype=np.float64)
        return BackgroundVehicles(
            ids=ids,
            types=types,
            x=np.ascontiguousarray(places[:, 0]),
            y=np.ascontiguousarray(places[:, 1]),
            heading=angles_to_headings(np.array(list(map(self._angle, ids)))),
            speed=np.array(list(map(self._speed, ids))),
            length=np.array(lengths),
            width=np.array(widths),
        )

    def _type_length_width(self, name: str) -> tuple[str, float, float]:
        vehicle = self._vehicle
        return vehicle.getTypeID(name), vehicle.getLength(name), vehicle.getWidth(name)

    def emergency_braking(self, names: Sequence[str]) -> Array:
        """The decelerations (n,) [m/s^2] of vehicles on the road in an emergency."""
        return np.array([self._hardest(name) for name in names], dtype=np.float64)

    def state(self, name: str) -> VehicleState:
        """Return the state of one vehicle as SUMO has it now."""
        vehicle = self._vehicle
        x, y = vehicle.getPosition(name)
        return VehicleState(
            id=name,
            type=vehicle.getTypeID(name),
            kind=vehicle.getVehicleClass(name),
            edges=tuple(vehicle.getRoute(name))[max(0, vehicle.getRouteIndex(name)) :],
            lane=int(vehicle.getLaneIndex(name)),
            lane_position=float(vehicle.getLanePosition(name)),
            x=float(x),
            y=float(y),
            heading=angle_to_heading(vehicle.getAngle(name)),
            speed=float(vehicle.getSpeed(name)),
            length=float(vehicle.getLength(name)),
            width=float(vehicle.getWidth(name)),
            fastest=float(vehicle.getMaxSpeed(name)),
        )

    def on_a_road(self, name: str) -> bool:
        """Return whether the vehicle is on a lane outside of junctions."""
        road = self._vehicle.getRoadID(name)
        return bool(road) and not road.startswith(":")

    def stops(self, name: str) -> list[PlannedStop]:
        """Return the stops that are ahead of the vehicle, in order."""
        return [
            PlannedStop(
                *(s.lane, s.startPos, s.endPos, s.duration, s.until),
                beside=bool(s.stopFlags & _PARKING_AREA),
                triggered=bool(s.stopFlags & _TRIGGERED),
            )
            for s in self._vehicle.getStops(name)
        ]

    def parked(self, name: str) -> bool:
        """Return whether the vehicle stands in a parking area beside the lane."""
        return bool(self._vehicle.isStoppedParking(name))

    def edges_of_entry(self, but: Collection[str]) -> set[str]:
        """Return the edges where SUMO's next step may insert a known vehicle, except ``but``."""
        vehicle = self._vehicle
        return {
            vehicle.getRoute(name)[0]
            for name in vehicle.getLoadedIDList()
            if name not in but and vehicle.getDeparture(name) < 0.0 <= vehicle.getDepartDelay(name)
        }

    def first_edge(self, route: str) -> str:
        """Return the first edge of a route that the scenario names, or "" if it is unknown."""
        known = route in self._sumo.route.getIDList()
        return str(self._sumo.route.getEdges(route)[0]) if known else ""

    def whereabouts(self, name: str) -> tuple[str, str, float]:
        """Return the vehicle's lane ("" if it has none), its route's id, and its position [m]."""
        return self._lane_id(name), self._route_id(name), self._lane_position(name)

    def lanes_ahead(self, name: str, lane: str, distance: float) -> tuple[str, ...]:
        """Return the vehicle's ``lane`` and the next ones within ``distance`` [m]."""
        return self._by_its_route(name, lane, distance) or self._by_its_plan(name, lane, distance)

    def _by_its_route(self, name: str, lane: str, distance: float) -> tuple[str, ...]:
        """Return the lanes ahead if the route leaves no choice of lanes, otherwise none."""
        vehicle = self._vehicle
        if vehicle.getStops(name, 1):
            return ()  # SUMO's plans end at a stop
        edges, at = vehicle.getRoute(name), vehicle.getRouteIndex(name)
        lanes, known = [lane], 0.0
        while known <= distance and at + 1 < len(edges):
            onwards = self._lanes.onwards(lanes[-1], edges[at + 1])
            if len(onwards) != 1:
                return ()
            lanes.append(onwards[0])
            known += self._lanes.length(onwards[0])
            at += not onwards[0].startswith(":")
        return tuple(lanes)

    def _by_its_plan(self, name: str, lane: str, distance: float) -> tuple[str, ...]:
        """Return the lanes ahead that SUMO's driver plans to use, with those inside junctions."""
        lanes = [lane, *self._lanes.out_of_junction(lane)]
        known = sum(map(self._lanes.length, lanes[1:]))
        for link in self._vehicle.getNextLinks(name):
            if known > distance:
                break
            first = link[4] or link[0]
            onwards = [first, *self._lanes.out_of_junction(first)]
            known += sum(map(self._lanes.length, onwards))
            lanes += onwards
        return tuple(lanes)

    def shape(self, lane: str) -> Array:
        """Return the centre line (k, 2) [m] of a lane."""
        return self._lanes.shape(lane)

    def lane_length(self, lane: str) -> float:
        """Return SUMO's nominal length [m] of a lane, which may differ from its centre line's."""
        return float(self._sumo.lane.getLength(lane))

    def leader(self, name: str, distance: float) -> str:
        """Return the id of the vehicle's leader within ``distance`` [m], or "" without one."""
        found = self._vehicle.getLeader(name, distance)
        return str(found[0]) if found else ""

    def deceleration(self, name: str) -> float:
        """Return the deceleration [m/s^2] of the vehicle's driver."""
        return float(self._vehicle.getDecel(name))

    def time_loss(self, name: str) -> float:
        """Return the time [s] that the vehicle has lost since its departure, as SUMO counts it."""
        return float(self._time_loss(name))

    # --- acting -------------------------------------------------------------------------------

    def insert(
        self, ego_id: str, edges: Sequence[str], *, lane: int, position: float, speed: float
    ) -> None:
        """Insert an ego. It appears with the next mirrored step.

        The FMU determines the ego's speed. SUMO is given at most the lane's limit.
        """
        permitted = min(speed, self._sumo.lane.getMaxSpeed(f"{edges[0]}_{lane}"))
        self._add(ego_id, edges, departPos=f"{position:.3f}", departSpeed=f"{permitted:.3f}")
        self.egos.add(ego_id)

    def queue(
        self, ego_id: str, edges: Sequence[str], *, lane: str, position: float, speed: float
    ) -> None:
        """Let SUMO insert an ego as soon as its own check finds room; then use :meth:`claim`.

        Args:
            ego_id: Id of the ego.
            edges: Edges of its route.
            lane: SUMO's id of the lane.
            position: Station [m] of the front bumper on the lane's centre line.
            speed: Speed [m/s], reduced to the lane's limit.
        """
        nominal = self.lane_length(lane)
        there = min(position * nominal / self._lanes.length(lane), nominal)
        self._add(
            ego_id,
            edges,
            departLane=lane.rpartition("_")[2],
            departPos=f"{there:.3f}",
            departSpeed=f"{min(speed, self._sumo.lane.getMaxSpeed(lane)):.3f}",
        )

    def claim(self, ego_id: str) -> None:
        """Drive an ego that SUMO has inserted from now on."""
        self.egos.add(ego_id)

    def _add(self, ego_id: str, edges: Sequence[str], **departure: str) -> None:
        """Hand an ego to SUMO, to depart with its next step."""
        route = f"giveway_route_{ego_id}"
        self._call(self._sumo.route.add, route, list(edges))
        try:
            self._call(
                self._vehicle.add,
                ego_id,
                route,
                typeID=inserted_type(ego_id),
                depart="now",
                **departure,
            )
        except SumoError as error:
            if "already exists" not in str(error):
                raise
            raise ScenarioError(
                f"ego id '{ego_id}': the scenario already has this vehicle; choose another id, or "
                f"take it over with --ego {ego_id}"
            ) from error

    def adopt(self, state: VehicleState, shape: VehicleShape) -> None:
        """Take over one of SUMO's vehicles, with the body ``shape``, and drive it from now on."""
        name = state.id
        try:
            kind = ego_type(state.kind)
        except ScenarioError as error:
            raise ScenarioError(f"--ego {name}: {error}") from error
        self._call(self._vehicle.setType, name, kind)
        self._call(self._vehicle.setLength, name, shape.length)
        self._call(self._vehicle.setWidth, name, shape.width)
        self._drop_stops(name)
        self.egos.add(name)

    def _drop_stops(self, name: str) -> None:
        """Remove a vehicle's stops.

        SUMO would park the vehicle beside the road while the FMU drives on. Where the ego drives a
        step beyond the end of its route, SUMO would look for the stops again, and fail. Therefore
        the route is extended there.
        """
        if self._vehicle.isStopped(name):
            self._call(self._vehicle.resume, name)
        if self._vehicle.getStops(name, 1):
            route = tuple(self._vehicle.getRoute(name))
            beyond = self._lanes.edges_after(route[-1], self._vehicle.getVehicleClass(name))
            if beyond:
                self._call(self._vehicle.setRoute, name, [*route, beyond[0]])
        for _ in range(len(self._vehicle.getStops(name))):
            self._call(self._vehicle.replaceStop, name, 0, "")

    def dismiss(self, name: str) -> None:
        """Remove an ego that has reached its goal from the road."""
        self._call(self._vehicle.remove, name)
        self.egos.discard(name)

    def limit(self, name: str, speed: float) -> None:
        """Let SUMO's driver go no faster than ``speed`` [m/s]."""
        self._call(self._vehicle.setSpeed, name, speed)

    def pull_away(self, name: str, speed: float) -> None:
        """Let SUMO's driver go at ``speed`` [m/s] although a leader is in front."""
        self._call(self._vehicle.setSpeedMode, name, _WITHOUT_SAFE_SPEED)
        self._call(self._vehicle.setSpeed, name, speed)

    def heed_leaders(self, name: str) -> None:
        """Let SUMO's driver heed leaders again, after :meth:`pull_away`."""
        self._call(self._vehicle.setSpeedMode, name, _ALL_CHECKS)
        self._call(self._vehicle.setSpeed, name, -1.0)

    def release(self, name: str) -> None:
        """Let SUMO's driver choose its speed again."""
        self._call(self._vehicle.setSpeed, name, -1.0)
