"""The ego: one vehicle that giveway drives, with its FMU, its controller and its path."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from controller import Decision, Observation
from controller.driving_constants import COMFORTABLE, STANDING
from giveway.config.tables.controllers import PaperPidOptions
from giveway.ego.people_in_front import PeopleInFront
from giveway.ego.percept import Perceived
from giveway.ego.perception.corridor import Corridor
from giveway.ego.perception.kerbs import Kerbs
from giveway.ego.perception.leader import NO_LEADER, NOBODY_BESIDE
from giveway.ego.perception.path_ahead import PathView
from giveway.ego.perception.protocol import Ids, OwnState
from giveway.ego.perception.truth import Truth
from giveway.ego.rules.following import Following
from giveway.ego.rules.protocol import Told
from giveway.ego.rules.rule_set import STOPS_EARLY, RuleSet
from giveway.ego.safeguards import Safeguards
from giveway.ego.stop_cause import waits_for
from giveway.ego.vehicle_ahead import VehicleNews
from giveway.ego.vehicle_model import late_speed_of
from giveway.ego.waiting_ego import WaitingEgo
from giveway.ego.walking_pace import WalkingPace
from giveway.errors import ControlError, VehicleError
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath, Pose
from giveway.geometry.slope import Slope
from giveway.run_data.outputs import ROAD_GRADE
from giveway.run_data.tracks import EgoRow
from pedestrian_model import Surroundings

_STRAIGHT = 1.0  # time [s] for which other vehicles are predicted to go straight on


class Course(NamedTuple):
    """The drive of an ego along its path."""

    path: EgoPath
    departure: float  # station [m] of the front bumper where the FMU's position is 0
    goal: float  # position [m] of the FMU at which the drive is over
    slope: Slope | None = None  # slope of the path; None if the path is level


class Ego:
    """A vehicle on the road.

    Args:
        waiting: Ego before its departure; its FMU has been started.
        course: Path of the ego, where it departs, and where its drive is over.
        shape: Length and width of its body [m].
        rules: Rules of the road that hold for it.
        time_step: Length of a control step [s].
        kerbs: Kerbs beside its path, or None if they are not needed.

    Attributes:
        front: Station of the front bumper [m].
        pose: Centre of the front bumper [m] and heading of the body [rad].
        speed: Speed [m/s], estimated if the FMU's speed output lags behind its motion.
        speeds: Least and largest speed [m/s] that it may have.
        systems: SUMO's ids of the signal systems whose states it needs.
        beside: Marks of the last vehicles, see
            :func:`~giveway.ego.perception.leader.vehicles_in_front`.
    """

    def __init__(
        self,
        waiting: WaitingEgo,
        course: Course,
        shape: VehicleShape,
        rules: RuleSet,
        time_step: float,
        kerbs: Kerbs | None = None,
    ) -> None:
        path, departure, goal, slope = course
        config = waiting.config
        regulation, controller = config.regulation, waiting.controller
        self.config, self.id, self.shape, self._controller = config, waiting.id, shape, controller
        self.path, self.departure, self.rules = path, departure, rules
        self._slope, self._time_step = slope, time_step
        self.has_outputs = bool(waiting.vehicle.record) or slope is not None
        self._times = time_step * np.arange(1.0, waiting.horizon + 1.0)
        self.goal, self.vehicle = goal, waiting.vehicle
        self._pace = WalkingPace(config.vehicle.mass, waiting.rests, waiting.vehicle)
        self._late = None if waiting.recorded else late_speed_of(config, time_step)
        gap = config.own(PaperPidOptions)
        self.corridor = Corridor(
            path,
            half_width=gap.corridor(shape.width),
            horizon=waiting.horizon,
            time_step=time_step,
            walking_speed_limit=waiting.walking_speed_limit,
            body_length=shape.length,
            straight=round(_STRAIGHT / time_step) if controller.foresees else None,
        )
        self._origin = -shape.length / 2 if gap.gap_from == "centre" else 0.0
        self._kept = self._origin + regulation.safe_distance  # distance [m] kept by the bumper
        self._safeguards = Safeguards(waiting, self.corridor, shape, time_step)
        self._kerbs = kerbs if self._safeguards.watch_people else None
        self._people = PeopleInFront(waiting, self.corridor, shape, self._kerbs)
        self.systems = rules.systems | (frozenset() if kerbs is None else kerbs.systems)
        self._force, self._eases_off, self.beside = 0.0, False, NOBODY_BESIDE
        self._heed_vehicles = config.heeds("following")
        self._own, self._seen = OwnState(Pose(0.0, 0.0, 0.0), 0.0, 0, shape), Perceived()
        self._view = PathView(path)
        self._observation = Observation(path=self._view, safe_distance=regulation.safe_distance)
        self._locate()
        self._following = Following(
            regulation.safe_distance,
            self._origin,
            COMFORTABLE,
            time_step,
            plans=controller.foresees,
            tuned=config.defaults.smooths,
            paper=config.defaults.buffered,
        )
        self.news = VehicleNews(time_step)

    @property
    def foresees(self) -> bool:
        """Return whether the ego predicts the crowd under each of its manoeuvres."""
        return self._people.foresight is not None

    @property
    def arrived(self) -> bool:
        """Return whether the ego has driven its distance."""
        return self.vehicle.position >= self.goal

    @property
    def watches(self) -> bool:
        """Return whether the ego has to be updated after SUMO's steps."""
        return self.rules.watches or bool(self.systems)

    def update(self, time: float, told: Told) -> None:
        """Update signals and traffic, once after each of SUMO's steps.

        Args:
            time: SUMO's clock [s].
            told: Signals and vehicles that the ego needs to know about.
        """
        if self._kerbs is not None:
            self._kerbs.update(told.signals)
        self.rules.update(time, self.front, self.speed, told)

    def check_pose(self, step: int) -> Pose:
        """Return the pose if it is finite; SUMO hangs if it is given one that is not.

        Args:
            step: Number of the step, for messages.

        Raises:
            VehicleError: the pose is not finite.
        """
        pose = self.pose
        if not all(map(math.isfinite, pose)):
            msg = f"ego '{self.id}' at step {step}: pose {tuple(pose)}; expected finite numbers"
            raise VehicleError(f"{msg} from the FMU")
        return pose

    def look(
        self,
        row: int,
        poses: Array,
        truth: Truth,
        surroundings: Surroundings,
        person_ids: Ids,
    ) -> Perceived:
        """Find what is in front, now and over the horizon; the next look overwrites it.

        Args:
            row: Row of the ego among the vehicles.
            poses: Poses (N, m, 7) of all vehicles at steps 0 ... N-1.
            truth: World as it is, for the sensor and the tables. All else uses the percept.
            surroundings: Walls and lights that pedestrians heed.
            person_ids: Id of each pedestrian of the truth, (n,).
        """
        own, seen, front = self._own, self._seen, self.front
        own.pose, own.speed, own.row = self.pose, self.speed, row
        seen.poses, seen.row, seen.to_clear = poses, row, self.rules.keep_clear_distance(front)
        self._people.look(seen, truth, person_ids, surroundings, own, front)
        self._heed(seen, front, own.speed)
        return seen

    def _heed(self, seen: Perceived, front: float, speed: float) -> None:
        """Fill in the vehicle in front and what the rules of the road demand."""
        rules, leader, vehicles, seen.followed = self.rules, NO_LEADER, None, None
        if self._heed_vehicles and seen.poses.shape[1] > 1:
            leader, vehicles = self.corridor.closest_vehicle(
                seen.poses, seen.row, front, speed, self.beside
            )
            seen.followed = self.news.look(self.corridor.followed, front, seen.poses.shape[1])
            if seen.followed is not None:
                leader = self.news.estimated(leader, seen.followed, front)
                if seen.followed.decelerates > 0.0:
                    braking = self.news.stations(leader, seen.followed, self._times)
                    vehicles = np.minimum(vehicles, braking)
        rules.look(front, speed, seen.percept.people, leader, seen.hidden)
        if rules.leader is not NO_LEADER:
            leader = min(leader, rules.leader)
            merging = rules.leader.station + rules.leader.speed * self._times
            vehicles = merging if vehicles is None else np.minimum(vehicles, merging)
        if vehicles is not None:
            relaxation = self._following.gap_relaxation(
                leader, vehicles, front, speed, seen.to_clear
            )
            seen.ahead = np.minimum(seen.ahead, vehicles + relaxation)
        if rules.latest < math.inf:  # a plan may not lead beyond this station of the front bumper
            allowed = rules.latest + self._origin
            seen.ahead = np.minimum(seen.ahead, allowed + self.config.regulation.safe_distance)
        seen.leader, seen.stop, seen.stops_for = leader, rules.stop, rules.cause

    def decide(self, step: int, time: float, seen: Perceived) -> Decision:
        """Decide on the force for the step from t_k on, and keep it for :meth:`advance`.

        Args:
            step: Number k of the step, for messages.
            time: SUMO's clock t_k [s].
            seen: Percept, rules and predictions that the ego reacts to.

        Raises:
            ControlError: the controller gave no finite force.
        """
        controller = self._controller
        decision = controller.control(self._observed(time, seen))
        if not math.isfinite(decision.force):
            raise ControlError(
                f"controller '{decision.acting}' of '{self.id}' at step {step}: force = "
                f"{decision.force}; expected a finite number [N]; please report this with the "
                "run's config.toml"
            )
        asked = decision.force
        least, most = self.speeds
        decision = self._safeguards.decide(decision, self.front, most, seen, most - least)
        if decision.force != asked:
            controller.applied(decision.force)
        self._eases_off = decision.force > self._force
        self._force = decision.force
        return decision

    def _observed(self, time: float, seen: Perceived) -> Observation:
        """Return what the controller is shown; the next call overwrites it."""
        front, vehicle, leader, rules = self.front, self.vehicle, seen.leader, self.rules
        origin, stop = front + self._origin, seen.stop + self._origin
        stop += self.config.regulation.safe_distance
        following = self._following
        limit = following.speed_limit(leader, front, seen.to_clear, self.speed, seen.followed)
        early = STOPS_EARLY if self._controller.foresees else 0.0
        limit = min(rules.speed, limit, following.stop_limit(seen.stop - early, front))
        vehicle_ahead = following.leader_station(leader, front, seen.to_clear)
        if self._controller.foresees:
            limit = min(limit, rules.advice)
        self._view.station = front
        shown, percept, numbers = self._observation, seen.percept, seen.percept.person_ids
        shown.time = time
        ego, ahead, limits, people = shown.ego, shown.ahead, shown.limits, shown.pedestrians
        ego.position, ego.speed = origin, self.speed
        ego.acceleration, ego.force = vehicle.acceleration, self._force
        ahead.gap = min(seen.pedestrian, vehicle_ahead, stop) - origin
        ahead.obstacle_positions, ahead.to_clear = seen.ahead, seen.to_clear
        ahead.person_gap, ahead.stop_gap = seen.pedestrian - origin, seen.stop - front
        ahead.leader_gap, ahead.leader_speed = leader.station - origin, leader.speed
        limits.speed_limit, limits.lane_speeds = limit, rules.lane_speeds
        people.people, people.ids, people.foresight = percept.people, numbers, seen.foresight
        shown.traffic.poses, shown.traffic.row = seen.poses, seen.row
        return shown

    def expected(self, seen: Perceived) -> Array | None:
        """The positions (N, n, 2) [m] that the decision expects at steps 1 ... N, or None.

        The array is reused later.
        """
        return seen.predicted if seen.foresight is None else seen.foresight.best

    def advance(self) -> None:
        """Step the FMU with the force decided on."""
        if self._late is not None:
            self._late.applied(self._force)
        if self._slope is None:
            self.vehicle.step(self._pace.force(self._force, self.speed))
        else:
            grade = self._slope.grade(self.front, self.shape.length)
            self.vehicle.step(self._pace.force(self._force, self.speed, grade), grade)
        self._locate()
        self.rules.advance(self.front, self.speed, self._time_step)
        self.news.advance()

    def _locate(self) -> None:
        """Update station and pose from the FMU's position, and the speed from its speed output."""
        self.speed = speed = self.vehicle.speed
        self.speeds = speed, speed
        if self._late is not None:
            self.speed = self._late.look(speed)
            self.speeds = self._late.least, self._late.most
        self.front = self.departure + self.vehicle.position
        self.pose = self.path.pose(self.front, self.shape.length)

    def outputs(self) -> tuple[Sequence[tuple[str, str, str]], Sequence[float]]:
        """Return the recorded variables of the FMU and their values; on a slope also the grade."""
        record, values = self.vehicle.record, self.vehicle.recorded
        if self._slope is None:
            return record, values
        grade = self._slope.grade(self.front, self.shape.length)
        return (*record, ROAD_GRADE), (*values, grade)

    def row(self, time: float, seen: Perceived, decision: Decision) -> EgoRow:
        """Return the row of this instant for the tables."""
        front, cause = self.front, ""
        origin = front + self._origin
        if self.speed < STANDING:
            cause = waits_for(front, self._kept, seen, decision, self._eases_off)
        return EgoRow(
            time=time,
            position=self.vehicle.position,
            front_x=self.pose.x,
            front_y=self.pose.y,
            heading=self.pose.heading,
            speed=self.vehicle.speed,
            acceleration=self.vehicle.acceleration,
            force=decision.force,
            controller=decision.acting,
            reason=decision.reason,
            solver_status=decision.status,
            solver_iterations=decision.iterations,
            gap=seen.closest - origin,
            reference_speed=decision.reference_speed,
            vehicle_gap=seen.leader.station - origin,
            stop_gap=seen.stop - front,
            waits_for=cause,
        )
