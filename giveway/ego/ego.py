"""One vehicle that giveway drives: its FMU, its controller, its path."""

import math
from collections.abc import Sequence

import numpy as np

from controller import Decision, Observation
from giveway.config.tables.regulation import CORRIDOR_MARGIN
from giveway.ego.foresight.building import foresight_of
from giveway.ego.foresight.relevance import Nearby, Relevance
from giveway.ego.percept import NOBODY, Seen
from giveway.ego.perception.corridor import Corridor
from giveway.ego.perception.kerbs import NO_KERBS, Kerbs
from giveway.ego.perception.leader import NO_LEADER, NOBODY_BESIDE
from giveway.ego.perception.path_ahead import PathView
from giveway.ego.perception.protocol import Ids, OwnState, Percept
from giveway.ego.perception.sensing import Perception
from giveway.ego.perception.sudden_starts import SettingOut
from giveway.ego.perception.truth import Truth
from giveway.ego.rules.following import Following
from giveway.ego.rules.protocol import Told
from giveway.ego.rules.rule_set import RuleSet
from giveway.ego.safety_layer import Guard
from giveway.ego.stop_cause import waits_for
from giveway.ego.waiting_ego import WaitingEgo
from giveway.errors import ControlError, VehicleError
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath, Pose
from giveway.geometry.slope import Slope
from giveway.run_data.outputs import ROAD_GRADE
from giveway.run_data.rows import STOP_SPEED
from giveway.run_data.tracks import EgoRow
from pedestrian_model import Crowd, Surroundings

_STRAIGHT = 1.0  # [s] for which other vehicles are predicted straight on; then the road may bend
_LIKELY = 0.75  # of what positions are off at most, as plans count with it: the layer with all


class Ego:
    """A vehicle on the road.

    Args:
        waiting: the ego before its departure; its FMU has been started.
        path: of the ego.
        departure: station [m] of the front bumper where the FMU's position is 0.
        shape: of its body.
        rules: Rules of the road that hold for it.
        goal: the FMU's position [m] at which it is done.
        time_step: [s].
        kerbs: Kerbs beside its path, or None if nobody asks for them.
        slope: of the path; None: it is level.

    Attributes:
        front: station of the front bumper [m].
        pose: where the front bumper's centre is, and the direction of the body.
        systems: SUMO's ids of the signal systems whose states it is told.
        beside: of the background vehicles' rows, see
            :func:`~giveway.ego.perception.leader.vehicles_in_front`.
    """

    front: float
    pose: Pose

    def __init__(
        self,
        waiting: WaitingEgo,
        path: EgoPath,
        departure: float,
        shape: VehicleShape,
        rules: RuleSet,
        goal: float,
        time_step: float,
        kerbs: Kerbs | None = None,
        slope: Slope | None = None,
    ) -> None:
        config = waiting.config
        self._controller, self._predictor = waiting.controller, waiting.predictor
        self.config, self.id, self.shape = config, waiting.id, shape
        self.path, self.departure, self.rules = path, departure, rules
        self._slope, self._time_step = slope, time_step
        self.has_outputs = bool(waiting.vehicle.record) or slope is not None
        self._times = time_step * np.arange(1.0, waiting.horizon + 1.0)
        self.goal, self.vehicle = goal, waiting.vehicle
        half_width = config.regulation.corridor_half_width
        self.corridor = Corridor(
            path,
            half_width=shape.width / 2 + CORRIDOR_MARGIN if half_width is None else half_width,
            horizon=waiting.horizon,
            time_step=time_step,
            walking_speed_limit=waiting.walking_speed_limit,
            body_length=shape.length,
            straight=round(_STRAIGHT / time_step) if waiting.controller.foresees else None,
        )
        span = waiting.horizon * time_step
        self._relevance = Relevance(waiting, span, shape.length + self.corridor.half_width)
        self._nearby = Nearby(waiting, path, shape, span, self.corridor.half_width, time_step)
        self._view = PathView(path)
        self._chosen: Crowd | None = None  # memory for those who matter
        self._origin = -shape.length / 2 if config.regulation.gap_from == "centre" else 0.0
        safety = waiting.safety
        perception = Perception(config, waiting.worst.acceleration, time_step)
        self._perception = None if perception.exact else perception
        self._own = OwnState(Pose(0.0, 0.0, 0.0), 0.0, 0, shape)
        self._guard = None if safety is None else Guard(safety, config, path, shape, time_step)
        self._kerbs = kerbs if self._guard is not None else None
        self.systems = rules.systems | (frozenset() if kerbs is None else kerbs.systems)
        self._setting_out = SettingOut(waiting.worst.setting_out, time_step)
        self._foresight = foresight_of(waiting, path, shape, self.corridor.half_width, time_step)
        self._force, self._eases_off, self.beside = 0.0, False, NOBODY_BESIDE
        self._heed_vehicles = config.heeds("following")
        self._locate()
        self._following = Following(
            config.regulation.safe_distance,
            self._origin,
            config.regulation.comfortable_deceleration,
            plans=waiting.controller.foresees,
            tuned=config.defaults.smooths,
        )

    @property
    def foresees(self) -> bool:
        """Whether it predicts the crowd under each of its manoeuvres."""
        return self._foresight is not None

    @property
    def arrived(self) -> bool:
        """Whether it has driven its distance."""
        return self.vehicle.position >= self.goal

    @property
    def watches(self) -> bool:
        """Whether it wants to be told what happens in SUMO."""
        return self.rules.watches or bool(self.systems)

    def update(self, time: float, told: Told) -> None:
        """Take note of signals and traffic, once after each of SUMO's steps.

        Args:
            time: SUMO's clock [s].
            told: Signals and vehicles that matter to it.
        """
        if self._kerbs is not None:
            self._kerbs.update(told.signals)
        self.rules.update(time, self.front, self.vehicle.speed, told)

    def check_pose(self, step: int) -> Pose:
        """The pose, which SUMO must not be given if it is not finite (it hangs).

        Raises:
            VehicleError: it is not finite.
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
    ) -> Seen:
        """Find what is in front, now and over the horizon.

        Args:
            row: the ego's row among the vehicles.
            poses: (N, m, 7) of all vehicles at steps 0 ... N-1.
            truth: World as it is, which the sensor looks at; all else works on the percept.
            surroundings: the walls and lights that they heed.
            person_ids: Number of each pedestrian of the truth, (n,).
        """
        front, speed, corridor = self.front, self.vehicle.speed, self.corridor
        percept, perception = Percept(truth.people, person_ids), self._perception
        if perception is not None:
            own = self._own
            own.pose, own.speed, own.row = self.pose, speed, row
            percept = perception.observe(truth, person_ids, own)
        crowd, numbers, _, errors = percept
        kerbs, hasty = NO_KERBS, NOBODY
        if self._kerbs is not None:
            kerbs = self._kerbs.of(crowd.position, crowd.velocity, front)
            hasty = self._setting_out.beyond(numbers, crowd.velocity, kerbs)
        pedestrian, reachable = corridor.closest_now(crowd.position, front)
        closest = pedestrian
        if perception is not None:
            closest, _ = corridor.closest_now(truth.people.position, front)
        ahead = corridor.empty
        predictor, predicted, relevant, foresight = self._predictor, None, None, None
        if reachable and predictor is not None:
            foresight = self._foresight
            if foresight is None:
                relevant = self._relevance.of(crowd, self.pose.x, self.pose.y, speed)
            else:
                relevant = self._nearby.of(crowd, front, speed)
            pedestrians = crowd
            if relevant is not None:
                self._chosen = pedestrians = crowd.select(relevant, self._chosen)
            if foresight is not None:
                behind = self._kerbs.kept(pedestrians, kerbs, relevant) if self._kerbs else kerbs
                off = 0.0 if errors is None or not len(errors) else _LIKELY * float(errors.mean())
                who = numbers if relevant is None else numbers[relevant]
                foresight.look(pedestrians, surroundings, poses, row, front, off, behind, who)
            else:
                predicted = predictor.predict(pedestrians, poses[: predictor.horizon], surroundings)
                ahead = corridor.closest_predicted(predicted, front, speed)
        rules, leader, vehicles = self.rules, NO_LEADER, None
        to_clear = rules.keep_clear_distance(front)
        if self._heed_vehicles and poses.shape[1] > 1:
            leader, vehicles = corridor.closest_vehicle(poses, row, front, speed, self.beside)
        rules.look(front, speed, crowd, leader)
        if rules.leader is not NO_LEADER:
            leader = min(leader, rules.leader)
            merging = rules.leader.station + rules.leader.speed * self._times
            vehicles = merging if vehicles is None else np.minimum(vehicles, merging)
        if vehicles is not None:
            spared = self._following.gap_relaxation(leader, vehicles, front, speed, to_clear)
            ahead = np.minimum(ahead, vehicles + spared)
        if rules.latest < math.inf:  # a plan may lead as far as the front bumper is allowed to
            allowed = rules.latest + self._origin
            ahead = np.minimum(ahead, allowed + self.config.regulation.safe_distance)
        return Seen(
            pedestrian,
            leader,
            rules.stop,
            rules.cause,
            ahead,
            predicted,
            relevant,
            closest,
            percept,
            foresight,
            poses,
            row,
            to_clear,
            kerbs,
            hasty,
        )

    def decide(self, step: int, time: float, seen: Seen) -> Decision:
        """The force for the step from t_k on; kept for :meth:`advance`.

        Args:
            step: k, for messages.
            time: t_k on SUMO's clock [s].
            seen: what the ego reacts to.

        Raises:
            ControlError: the controller gave no finite force.
        """
        controller = self._controller
        decision = controller.control(self._observation(time, seen))
        if not math.isfinite(decision.force):
            raise ControlError(
                f"controller '{decision.acting}' of '{self.id}' at step {step}: force = "
                f"{decision.force}; expected a finite number [N]; please report this with the "
                "run's config.toml"
            )
        if self._guard is not None:
            there = self.front, self.vehicle.speed
            people, _, _, bound = seen.percept
            safe = self._guard.overrule(decision, *there, people, bound, seen.kerbs)
            if safe is not None:
                controller.applied(safe.force)
                decision = safe
        self._eases_off = decision.force > self._force
        self._force = decision.force
        return decision

    def _observation(self, time: float, seen: Seen) -> Observation:
        """What the controller is shown."""
        front, vehicle, leader = self.front, self.vehicle, seen.leader
        safe_distance = self.config.regulation.safe_distance
        origin, stop = front + self._origin, seen.stop + self._origin + safe_distance
        rules = self.rules
        vehicle_ahead, limit = math.inf, rules.speed
        if not seen.stop == math.inf == leader.station:
            vehicle_ahead = self._following.leader_station(leader, front, seen.to_clear)
            braking = self._following.speed_limit(leader, seen.stop, front, seen.to_clear)
            limit = min(limit, braking)
        if self._controller.foresees:
            limit = min(limit, rules.advice)
        self._view.station = front
        return Observation(  # by position: a third of the time that keywords take
            origin,
            vehicle.speed,
            min(seen.pedestrian, vehicle_ahead, stop) - origin,
            seen.ahead,
            limit,
            safe_distance,
            seen.foresight,
            time,
            vehicle.acceleration,
            self._force,
            seen.stop - front,
            self._view,
            seen.percept.people,
            seen.poses,
            seen.row,
            rules.lane_speeds,
            seen.pedestrian - origin,
            leader.station - origin,
            leader.speed,
            seen.percept.person_ids,
            seen.to_clear,
        )

    def expected(self, seen: Seen) -> Array | None:
        """(N, n, 2) [m] positions that the decision expects at steps 1 ... N; reused later."""
        return seen.predicted if seen.foresight is None else seen.foresight.best

    def advance(self) -> None:
        """Step the FMU with the force decided on."""
        if self._slope is None:
            self.vehicle.step(self._force)
        else:
            self.vehicle.step(self._force, self._slope.grade(self.front, self.shape.length))
        self._locate()
        self.rules.advance(self.front, self.vehicle.speed, self._time_step)

    def _locate(self) -> None:
        """Note where it is now: asked for several times at each instant."""
        self.front = self.departure + self.vehicle.position
        self.pose = self.path.pose(self.front, self.shape.length)

    def outputs(self) -> tuple[Sequence[tuple[str, str, str]], Sequence[float]]:
        """What is recorded of its FMU at this instant, and the grade of its road if it has one."""
        record, values = self.vehicle.record, self.vehicle.recorded
        if self._slope is None:
            return record, values
        grade = self._slope.grade(self.front, self.shape.length)
        return (*record, ROAD_GRADE), (*values, grade)

    def row(self, time: float, seen: Seen, decision: Decision) -> EgoRow:
        """The row of this instant for the tables."""
        front = self.front
        origin = front + self._origin
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
            waits_for=self._waits_for(seen, decision),
        )

    def _waits_for(self, seen: Seen, decision: Decision) -> str:
        if self.vehicle.speed >= STOP_SPEED:
            return ""
        kept = self._origin + self.config.regulation.safe_distance
        return waits_for(self.front, kept, seen, decision, self._eases_off)
