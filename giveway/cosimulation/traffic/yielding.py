"""Background vehicles brake for the pedestrians and egos that giveway moves.

SUMO's vehicles look for persons on lanes and crossings. A person that is moved from outside is on
none of them, so SUMO's vehicles would drive through that person. Therefore each vehicle's speed is
limited to one from which it stops before the next pedestrian in its corridor, with the deceleration
of its own type: Krauss's safe speed (Krauss 1998, eq. 2.24, with a standing leader). A pedestrian
with priority on a crossing is expected to walk on over it.

An ego is on the lane that SUMO finds at the middle of its front. Where it changes lanes or cuts a
corner, part of its body is on another lane, whose vehicles do not see it. They are kept behind it
in the same way. A vehicle that follows the ego by SUMO's own model is not limited. Neither is one
that stands beside a standing ego or touches one, because the two would wait for each other for
ever.
"""

import math
from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType

import numpy as np

from controller.driving_constants import CREEPING, STANDING
from giveway.config.tables.regulation import CORRIDOR_MARGIN
from giveway.cosimulation.traffic.lane_paths import (
    Indices,
    LanePaths,
    gaps_ahead,
    sort_pedestrians,
)
from giveway.cosimulation.traffic.people_ahead import BESIDE, expected, still, touched_in_front
from giveway.cosimulation.traffic.waits import Waits
from giveway.crowd.gap_acceptance import Waiting
from giveway.ego.ego import Ego
from giveway.ego.rules.merge_points import FollowingConstraint
from giveway.geometry.kernel import Array
from giveway.geometry.overlap import rectangles_overlap
from giveway.sumo.background import BackgroundVehicles
from giveway.sumo.vehicles import SumoVehicles
from pedestrian_model import Crowd

_DISTANCE = 2.0  # Distance [m] before a pedestrian at which vehicles want to stop
_CREEPS_TO = 0.8  # Distance [m] before a person who stands, to which a stuck vehicle creeps
_REACTION = 1.0  # [s] reaction time of SUMO's default car-following model
_BESIDE_EGO = 0.1  # Smallest lateral distance [m] that vehicles keep from an ego
_BEHIND_EGO = 0.5  # Distance [m] behind an ego at which vehicles stand
_BEFORE_LINE = 1.0  # Distance [m] before their line at which vehicles wait
_PULLING_AWAY = 2.0  # Speed [m/s] at which a stuck vehicle pulls away
_APART = 0.5  # Largest distance [m] between the points that stand for an ego's outline
NOBODY: Mapping[str, float] = MappingProxyType({})


class Yielding:
    """Slows background vehicles down for pedestrians and egos.

    Args:
        vehicles: Vehicles of the running simulation.
        step_length: SUMO's step [s], for which a limit holds.

    Attributes:
        limited: Speed limit [m/s] of each vehicle that yields now, by its id.
    """

    limited: dict[str, float]

    def __init__(self, vehicles: SumoVehicles, step_length: float) -> None:
        self._vehicles = vehicles
        self._reaction = max(step_length, _REACTION)
        self._distance = _DISTANCE
        self._waits = Waits(step_length)
        self.limited = {}
        self._lane_paths = LanePaths(vehicles)
        self._ever: set[str] = set()
        self._step_length = step_length
        self._time = 0.0
        self._pulling: set[str] = set()

    @property
    def report(self) -> dict[str, float]:
        """The number of vehicles that ever yielded, and their total time [s] of yielding."""
        return {"vehicles_that_yielded": len(self._ever), "time_yielding": round(self._time, 6)}

    def update(
        self,
        background: BackgroundVehicles,
        crowd: Crowd,
        egos: Sequence[Ego] = (),
        rooms: Mapping[str, float] = NOBODY,
        merging: Sequence[Mapping[str, FollowingConstraint]] = (),
        waiting: Waiting | None = None,
    ) -> None:
        """Limit the vehicles that have to yield, and release the others, after each SUMO step.

        Args:
            background: The background vehicles now.
            crowd: The pedestrians now.
            egos: Egos on the road now.
            rooms: Distance [m] to the line of each vehicle that waits there for an ego, by its id.
            merging: Following constraints of the vehicles that let each ego merge before them, by
                their ids.
            waiting: People who wait for a gap, or None if nobody does in this network.
        """
        limits = self._limits(background, crowd, waiting) if background.ids and len(crowd) else {}
        if background.ids and egos:
            for name, limit in self._behind_egos(background, egos).items():
                limits[name] = min(limit, limits.get(name, math.inf))
            for name, limit in self._merging(background, merging).items():
                limits[name] = min(limit, limits.get(name, math.inf))
        for name, room in rooms.items():
            b = self._vehicles.deceleration(name)
            limit = _safe_speed(room - _BEFORE_LINE, 0.0, b, self._reaction)
            limits[name] = min(limit, limits.get(name, math.inf))
        before = self.limited
        if before and before.keys() - limits.keys():
            gone = before.keys() - set(background.ids)
            for name in sorted(before.keys() - limits.keys() - gone):
                self._vehicles.release(name)
        for name, limit in limits.items():
            if before.get(name) != limit:
                self._vehicles.limit(name, limit)
        self._separate(background, egos, limits.keys())
        self.limited = limits
        self._ever.update(limits)
        self._time += self._step_length * len(limits)

    def _limits(
        self,
        background: BackgroundVehicles,
        crowd: Crowd,
        waiting: Waiting | None,
    ) -> dict[str, float]:
        """The speed limit [m/s] of each vehicle with a pedestrian ahead."""
        # a vehicle decelerates with at least 2 m/s^2, from which this sight follows
        sight = (
            background.speed * self._reaction + background.speed**2 / 4.0 + self._distance + 10.0
        )
        numbers, positions = self._lane_paths.of(background.ids, sight.tolist())
        self._lane_paths.forget(background.ids)
        found = (np.column_stack([background.x, background.y]), positions, numbers)
        half_width = background.width / 2 + CORRIDOR_MARGIN
        gaps = self._gaps(found, sight, half_width, expected(crowd, waiting), waiting)
        if waiting is not None:
            room, there = background.width / 2 + BESIDE, still(crowd, waiting)
            gaps = np.minimum(gaps, self._gaps(found, sight, room, there, waiting))
            gaps[touched_in_front(background, crowd.position)] = 0.0
        near = np.flatnonzero(gaps <= sight)
        stuck = self._waits.stuck(background, near, crowd, self._vehicles)
        here = gaps if not stuck else self._gaps(found, sight, half_width, crowd.position)
        limits = {}
        for i in near:
            name = background.ids[i]
            b = self._vehicles.deceleration(name)
            safe = _safe_speed(float(gaps[i]) - self._distance, 0.0, b, self._reaction)
            if name in stuck:
                nearer = _safe_speed(float(here[i]) - _CREEPS_TO, 0.0, b, self._reaction)
                safe = max(safe, min(CREEPING, nearer))
            if safe < background.speed[i] + b * self._step_length:
                limits[name] = safe
        return limits

    def _gaps(
        self,
        found: tuple[Array, Array, Indices],
        sight: Array,
        half_width: Array,
        people: Array,
        waiting: Waiting | None = None,
    ) -> Array:
        """The distance (m,) [m] of each vehicle to the first person on its way; inf without one.

        Where people wait for gaps, the inner side of bends counts, which vehicles' middles cut.
        """
        gaps, (fronts, positions, numbers) = np.full(len(sight), np.inf), found
        if not (numbers >= 0).any() or not len(people):
            return gaps
        pool, order = self._lane_paths.pool, sort_pedestrians(people)
        gaps_ahead(found, pool, sight, half_width, people, order, gaps)
        numbers = np.where((numbers >= 0) & self._lane_paths.bent[numbers], numbers, -1)
        if waiting is not None and (numbers >= 0).any():
            inner, more = pool._replace(points=self._lane_paths.middles), np.full_like(gaps, np.inf)
            turning = fronts, positions, numbers
            gaps_ahead(turning, inner, sight, half_width, people, order, more)
            gaps = np.minimum(gaps, more)
        return gaps

    def _separate(
        self, background: BackgroundVehicles, egos: Sequence[Ego], held: Collection[str]
    ) -> None:
        """Let the vehicles that touch an ego, ahead of its front, pull away from it.

        SUMO takes the ego for their leader, and they would stand there for ever. Vehicles that are
        ``held`` have a person in front of them and stay.
        """
        stuck = set()
        slow = np.flatnonzero(background.speed <= 1.1 * _PULLING_AWAY)
        for ego in egos if len(slow) else ():
            x, y, heading = ego.pose
            own = np.array([x, y, heading, ego.shape.length, ego.shape.width])
            near = slow[
                np.hypot(background.x[slow] - x, background.y[slow] - y)
                <= ego.shape.length + background.length[slow]
            ]
            touching = near[rectangles_overlap(own, background.bodies[near])]
            ahead = (background.x[touching] - x) * math.cos(heading)
            ahead += (background.y[touching] - y) * math.sin(heading)
            stuck |= {background.ids[i] for i in touching[ahead > 0.0]}
        stuck -= set(held)
        for name in sorted(stuck - self._pulling):
            self._vehicles.pull_away(name, _PULLING_AWAY)
        for name in sorted((self._pulling - stuck) & set(background.ids)):
            self._vehicles.heed_leaders(name)
        self._pulling = stuck

    def _behind_egos(self, background: BackgroundVehicles, egos: Sequence[Ego]) -> dict[str, float]:
        """The speed limit [m/s] of each vehicle behind an ego that it does not see in SUMO."""
        fronts = np.column_stack([background.x, background.y])
        sight = background.speed * self._reaction + background.speed**2 / 4.0 + 10.0
        limits: dict[str, float] = {}
        for ego in egos:
            x, y, heading = ego.pose
            apart = np.hypot(fronts[:, 0] - x, fronts[:, 1] - y)
            near = np.flatnonzero(apart <= sight + ego.shape.length)
            if not len(near):
                continue
            points = _outline(ego)
            names = [background.ids[i] for i in near]
            numbers, positions = self._lane_paths.of(names, sight[near].tolist())
            gaps = np.full(len(near), np.inf)
            if not (numbers >= 0).any():
                continue
            gaps_ahead(
                (fronts[near], positions, numbers),
                self._lane_paths.pool,
                sight[near],
                background.width[near] / 2 + _BESIDE_EGO,
                points,
                sort_pedestrians(points),
                gaps,
            )
            for k in np.flatnonzero(gaps <= sight[near]):
                i, name = near[k], names[k]
                along = ego.vehicle.speed * math.cos(background.heading[i] - heading)
                b = self._vehicles.deceleration(name)
                safe = _safe_speed(float(gaps[k]) - _BEHIND_EGO, max(0.0, along), b, self._reaction)
                if safe >= background.speed[i] + b * self._step_length:
                    continue
                if self._vehicles.leader(name, float(sight[i])) == ego.id:
                    continue
                if _are_stuck(ego, background, int(i)):
                    continue
                limits[name] = min(safe, limits.get(name, math.inf))
        return limits

    def _merging(
        self,
        background: BackgroundVehicles,
        merging: Sequence[Mapping[str, FollowingConstraint]],
    ) -> dict[str, float]:
        """The speed limit [m/s] of each vehicle that lets an ego merge before it."""
        limits: dict[str, float] = {}
        rows = {name: i for i, name in enumerate(background.ids)}
        for others in merging:
            for name, behind in others.items():
                if name not in rows:
                    continue  # the vehicle is another ego
                speed = float(background.speed[rows[name]])
                b = self._vehicles.deceleration(name)
                firm = min(b, behind.braking)
                safe = max(
                    _safe_speed(behind.room, behind.speed, firm, self._reaction),
                    _safe_speed(behind.to_wait, 0.0, firm, self._reaction),
                    speed - firm * self._step_length,
                )
                if safe < speed + b * self._step_length:
                    limits[name] = min(safe, limits.get(name, math.inf))
        return limits


def _safe_speed(room: float, leader: float, deceleration: float, reaction: float) -> float:
    """Krauss's safe speed [m/s] at ``room`` [m] behind a leader [m/s] that brakes as hard."""
    b = deceleration * reaction
    return -b + math.sqrt(b * b + leader * leader + 2.0 * deceleration * max(0.0, room))


def _are_stuck(ego: Ego, background: BackgroundVehicles, i: int) -> bool:
    """Return whether the ego can only get away if the vehicle ``i`` goes on."""
    x, y, heading = ego.pose
    own = np.array([x, y, heading, ego.shape.length, ego.shape.width])
    if rectangles_overlap(own, background.bodies[i]):
        return True
    ahead = (background.x[i] - x) * math.cos(heading) + (background.y[i] - y) * math.sin(heading)
    return ego.vehicle.speed < STANDING and ahead > -ego.shape.length


def _outline(ego: Ego) -> Array:
    """Points (n, 2) [m] on the outline of an ego."""
    x, y, heading = ego.pose
    length, width = ego.shape.length, ego.shape.width
    along = np.linspace(0.0, -length, max(2, math.ceil(length / _APART) + 1))
    across = np.linspace(-width / 2, width / 2, max(2, math.ceil(width / _APART) + 1))
    sides = [np.column_stack([along, np.full(len(along), side)]) for side in across[[0, -1]]]
    ends = [np.column_stack([np.full(len(across), end), across]) for end in along[[0, -1]]]
    points = np.concatenate([*sides, *ends])
    cos, sin = math.cos(heading), math.sin(heading)
    turned = np.einsum("ij,jk", points, np.array([[cos, sin], [-sin, cos]]))
    return np.ascontiguousarray(turned + (x, y))
