"""The perception of one ego: its sensor, and the chain of refinements behind it.

Prediction, rules, controllers and the safety layer use the percept that leaves the chain. Tables
and metrics use the truth.
"""

from giveway.config import EgoRunConfig
from giveway.crowd.motion.noise import BOUND
from giveway.ego.perception.desired_speeds import Pace
from giveway.ego.perception.false_detections import ids_of, tracks_of
from giveway.ego.perception.plugged_in_sensor import sensor_of, telling
from giveway.ego.perception.protocol import Ids, OwnState, Percept, Refinement, Sensor
from giveway.ego.perception.refinements import DesiredSpeeds, HeadingGoals, PositionNoise
from giveway.ego.perception.tracking import Tracker
from giveway.ego.perception.truth import Truth
from giveway.ego.perception.walked_away import WalkedAway

_STREAM = 0x5EE  # key of the random stream of position noise, which differs from all others


class AllPeople:
    """The sensor that perceives all people exactly."""

    def observe(self, truth: Truth, person_ids: Ids, ego: OwnState) -> Percept:  # noqa: ARG002
        """Return all people, in the arrays of the truth itself."""
        return Percept(truth.people, person_ids)


class Perception:
    """One ego's sensor with the chain behind it, used as one sensor.

    Each observation draws new noise from a generator of this ego. Equal runs therefore perceive the
    same, with any other egos. If the tracker is on, positions are filtered and desired speeds are
    estimated. It is off by default for the paper's controllers.

    Args:
        config: Configuration of the ego.
        acceleration: Largest acceleration [m/s^2] of a person that the tracker assumes.
        time_step: Time between two observations [s].

    Attributes:
        exact: Whether everything is perceived as it is.
        tells_unseen: The sensor, if it tells where people would not be in sight, or None.
    """

    def __init__(self, config: EgoRunConfig, acceleration: float, time_step: float) -> None:
        seen, tracks = config.perception, config.tracks_people
        own = sensor_of(config, time_step)
        self._sensor: Sensor = AllPeople() if own is None else own
        self._chain: list[Refinement] = []
        if seen.desired_speeds != "known":
            typical = config.crowd.desired_speed_mean
            pace = Pace(typical, time_step) if tracks else None
            self._chain.append(DesiredSpeeds(typical, pace))
        if seen.position_noise:
            seed = (config.seed, _STREAM, *config.ego_id.encode())
            self._chain.append(PositionNoise(seen.position_noise, seed))
        if tracks and (seen.position_noise or own is not None):
            self._chain.append(Tracker(BOUND * seen.position_noise, acceleration, time_step))
        if seen.goals != "known":
            self._chain.append(HeadingGoals())
        self.exact = own is None and not self._chain
        self._made_up = getattr(own, "false_detections", False)
        self.tells_unseen = telling(own)
        sensor = self.tells_unseen if config.safety.hidden_speed else None
        self._walked_away = None if sensor is None else WalkedAway(sensor)

    def observe(self, truth: Truth, person_ids: Ids, ego: OwnState) -> Percept:
        """Return what the ego perceives; the next call overwrites it.

        Args:
            truth: World as it is; not changed. Its arrays are shared if they are perceived exactly.
            person_ids: Id of each pedestrian in ``truth.people``, (n,).
            ego: State of the ego.
        """
        percept = self._sensor.observe(truth, person_ids, ego)
        if self._walked_away is not None:
            percept = self._walked_away.left_out(percept, ego)
        if self._made_up:
            percept = percept._replace(person_ids=tracks_of(percept.person_ids))
        for member in self._chain:
            percept = member.refine(percept)
        return percept

    def ids(self, percept: Percept) -> Ids:
        """Return the id of each perceived person (n,), negative for false detections."""
        return ids_of(percept.person_ids) if self._made_up else percept.person_ids
