"""The pedestrians in front of one ego, as it perceives and predicts them."""

from giveway.ego.foresight.building import foresight_of
from giveway.ego.foresight.relevance import Nearby, Relevance
from giveway.ego.percept import Perceived
from giveway.ego.perception.corridor import Corridor
from giveway.ego.perception.hidden_people import HidingPlaces
from giveway.ego.perception.kerbs import Kerbs
from giveway.ego.perception.protocol import Ids, OwnState, Percept
from giveway.ego.perception.sensing import Perception
from giveway.ego.perception.sights import Sights
from giveway.ego.perception.sudden_starts import SuddenStarts
from giveway.ego.perception.truth import Truth
from giveway.ego.waiting_ego import WaitingEgo
from giveway.geometry.bodies import VehicleShape
from pedestrian_model import Crowd, CrowdPredictor, Surroundings
from pedestrian_model.drift.predictor import DriftPredictor

_LIKELY = 0.75  # share of the largest position error that plans take into account


class PeopleInFront:
    """Perceives the pedestrians, and predicts those who matter to one ego.

    Args:
        waiting: Ego before its departure.
        corridor: Corridor about the ego's path.
        shape: Length and width of its body [m].
        kerbs: Kerbs beside its path, or None without a safety layer.
    """

    def __init__(
        self, waiting: WaitingEgo, corridor: Corridor, shape: VehicleShape, kerbs: Kerbs | None
    ) -> None:
        path, time_step, half_width = corridor.path, corridor.time_step, corridor.half_width
        span, worst = waiting.horizon * time_step, waiting.worst
        self._corridor, self._kerbs, self._predictor = corridor, kerbs, waiting.predictor
        predictor = waiting.predictor
        self._drift = predictor if isinstance(predictor, DriftPredictor) else None
        self._relevance = Relevance(waiting, span, shape.length + half_width)
        self._nearby = Nearby(waiting, path, shape, span, half_width, time_step)
        self._chosen: Crowd | None = None  # memory for those who matter
        perception = Perception(waiting.config, worst.acceleration, time_step)
        self._perception = None if perception.exact else perception
        self._sights = Sights() if waiting.config.perception.plugged_in_sensor else None
        self._hiding_places: HidingPlaces | None = None
        if pace := waiting.config.safety.hidden_speed:
            self._hiding_places = HidingPlaces(path, pace)
        self._sudden_starts = SuddenStarts(worst.setting_out, time_step)
        self.foresight = foresight_of(waiting, path, shape, half_width, time_step)

    def look(
        self,
        seen: Perceived,
        truth: Truth,
        person_ids: Ids,
        surroundings: Surroundings,
        own: OwnState,
        front: float,
    ) -> None:
        """Fill in the perceived pedestrians, now and over the horizon.

        Args:
            seen: Object to fill in, with the poses of the vehicles.
            truth: World as it is, for the sensor and the tables alone.
            person_ids: Id of each pedestrian of the truth, (n,).
            surroundings: Walls and lights that pedestrians heed.
            own: State of the ego.
            front: Station of the front bumper [m].
        """
        corridor, perception, kerbs = self._corridor, self._perception, self._kerbs
        if perception is None:
            percept, seen.ids = Percept(truth.people, person_ids), person_ids
        else:
            percept = perception.observe(truth, person_ids, own)
            seen.ids = perception.ids(percept)
            if self._sights is not None:
                seen.sights = self._sights.changes(seen.ids, percept.people.position, own)
            sensor = perception.tells_unseen
            if sensor is not None and self._hiding_places is not None:
                seen.hidden = self._hiding_places.ahead(sensor, truth, own.row, front, own.speed)
        people, predictor = percept.people, self._predictor
        seen.percept = percept
        if self._drift is not None:
            self._drift.remember(people, percept.person_ids)
        if kerbs is not None:
            seen.kerbs = kerbs.of(people.position, people.velocity, front)
            seen.sudden_starts = self._sudden_starts.beyond(seen.ids, people.velocity, seen.kerbs)
        seen.pedestrian, reachable = corridor.closest_now(people.position, front)
        seen.closest = seen.pedestrian
        if perception is not None:
            seen.closest, _ = corridor.closest_now(truth.people.position, front)
        seen.ahead, seen.predicted, seen.relevant, seen.foresight = corridor.empty, None, None, None
        if reachable and predictor is not None:
            self._predict(predictor, seen, surroundings, own, front)

    def _predict(
        self,
        predictor: CrowdPredictor,
        seen: Perceived,
        surroundings: Surroundings,
        own: OwnState,
        front: float,
    ) -> None:
        """Predict the people who matter, or prepare the foresight.

        Args:
            predictor: Predictor of the crowd.
            seen: Object to fill in.
            surroundings: Walls and lights that pedestrians heed.
            own: State of the ego.
            front: Station of the front bumper [m].
        """
        people, numbers, _, errors, _ = seen.percept
        foresight, speed = self.foresight, own.speed
        if foresight is None:
            relevant = self._relevance.of(people, own.pose.x, own.pose.y, speed)
        else:
            relevant = self._nearby.of(people, front, speed)
        if relevant is not None:
            self._chosen = people = people.select(relevant, self._chosen)
            numbers = numbers[relevant]
            if self._drift is not None:
                self._drift.choose(numbers)
        seen.relevant, seen.foresight = relevant, foresight
        if foresight is None:
            poses = seen.poses[: predictor.horizon]
            seen.predicted = predictor.predict(people, poses, surroundings)
            seen.ahead = self._corridor.closest_predicted(seen.predicted, front, speed)
            return
        kerbs = self._kerbs.kept(people, seen.kerbs, relevant) if self._kerbs else seen.kerbs
        off = 0.0 if errors is None or not len(errors) else _LIKELY * float(errors.mean())
        there = seen.poses, own.row, front
        foresight.look(people, surroundings, there, off, kerbs, numbers)
