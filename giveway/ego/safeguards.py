"""The last word on an ego's force: the layers for vehicles and people, and a gentle entry.

The safety layer for people guarantees a stop from a state in which one is certain. A vehicle that
SUMO drove, or that is inserted at speed, may be in another state: people at a kerb could step in
front of it. For its first seconds an ego therefore brakes no harder than firmly for what people
could do, and harder only if a person is about to be hit, or for a vehicle or a stop.
"""

import numpy as np

from controller import Decision
from controller.driving_constants import AT_REST, FIRM
from giveway.config import EgoRunConfig
from giveway.ego.percept import Perceived
from giveway.ego.perception.corridor import Corridor
from giveway.ego.rules.yielding import needed_braking
from giveway.ego.safety_layer import EgoSafetyLayer, vehicle_layer_of
from giveway.ego.waiting_ego import WaitingEgo
from giveway.geometry.bodies import VehicleShape

ENTRY = 2.0  # time [s] after which the entry is over
_LOOK = 0.25  # spacing [s] of the instants at which a person could be hit
_SPARE = 1.05  # factor on the deceleration that just stops the ego at a demanded stop


class GentleEntry:
    """Limits the braking of an ego that has just entered, unless a person is about to be hit.

    Args:
        config: Configuration of the ego.
        corridor: Corridor about its path.
        time_step: Time step of the co-simulation [s].
    """

    def __init__(self, config: EgoRunConfig, corridor: Corridor, time_step: float) -> None:
        self._vehicle, self._corridor = config.vehicle, corridor
        self._left, self._time_step = ENTRY, time_step

    def least_force(self, front: float, speed: float, seen: Perceived) -> float | None:
        """Return the least force [N] that this step may have, or None if it has no limit.

        Args:
            front: Station of the front bumper [m].
            speed: Speed of the ego [m/s].
            seen: World as the ego perceives it, and what the rules of the road demand.
        """
        self._left -= self._time_step
        if self._left < 0.0 or self._hits(front, speed, seen):
            return None
        braking = max(FIRM, _SPARE * needed_braking(speed, seen.stop - front))
        return self._vehicle.friction * speed - self._vehicle.mass * braking

    def _hits(self, front: float, speed: float, seen: Perceived) -> bool:
        """Return whether a person who walks straight on is hit in spite of firm braking.

        Who walks on a sidewalk, rather along the kerb than towards it, stays there.
        """
        people, kerbs = seen.percept.people, seen.kerbs
        velocity = people.velocity
        if len(kerbs):
            across = (velocity * kerbs[:, :2]).sum(axis=1)
            along = velocity - across[:, None] * kerbs[:, :2]
            stays = (kerbs[:, 2] > 0.0) & (across <= np.hypot(along[:, 0], along[:, 1]))
            velocity = np.where(stays[:, None], along, velocity)
        time, stops = 0.0, speed / FIRM
        while len(people) and time <= stops + _LOOK:
            moves = min(time, stops)
            at = front + moves * (speed - 0.5 * FIRM * moves)
            places = people.position + time * velocity
            station, _ = self._corridor.closest_now(places, front)
            if station <= at + AT_REST:
                return True
            time += _LOOK
        return False


class Safeguards:
    """The layers between one ego's controller and its vehicle.

    Args:
        waiting: Ego before its departure.
        corridor: Corridor about its path.
        shape: Length and width of its body [m].
        time_step: Time step of the co-simulation [s].
    """

    def __init__(
        self, waiting: WaitingEgo, corridor: Corridor, shape: VehicleShape, time_step: float
    ) -> None:
        config, limits = waiting.config, waiting.safety
        self._people = (
            None
            if limits is None
            else EgoSafetyLayer(limits, config, corridor.path, shape, time_step)
        )
        self._vehicles = vehicle_layer_of(config, time_step)
        self._entry = GentleEntry(config, corridor, time_step) if self._vehicles else None

    @property
    def watch_people(self) -> bool:
        """True if the safety layer for people is on."""
        return self._people is not None

    def decide(
        self, asked: Decision, front: float, speed: float, seen: Perceived, slower: float = 0.0
    ) -> Decision:
        """Return the decision that acts, which is the controller's or one of a layer.

        Args:
            asked: Decision of the controller.
            front: Station of the front bumper [m].
            speed: Largest speed [m/s] that the ego may have.
            seen: World as the ego perceives it, and what the rules of the road demand.
            slower: Speed [m/s] by which the ego may be slower.
        """
        vehicles, decision = self._vehicles, asked
        if vehicles is not None:
            force = vehicles.filter(asked.force, speed, seen.followed)
            if force < asked.force:
                decision = asked._replace(force=force, acting="safety", reason=vehicles.REASON)
        followed = decision
        if self._people is not None:
            self._people.may_be_slower(slower)
            safe = self._people.overrule(
                decision, front, speed, seen.percept, seen.kerbs, seen.hidden
            )
            decision = decision if safe is None else safe
        if self._entry is not None:
            least = self._entry.least_force(front, speed, seen)
            if least is not None and decision.force < least:
                gentle = asked._replace(force=least, reason="has just entered")
                harder = followed if seen.followed is not None else gentle  # for a vehicle ahead
                decision = min(harder, gentle, key=lambda one: one.force)
                if self._people is not None:
                    self._people.applied(decision.force)
        if vehicles is not None:
            vehicles.applied(decision.force)
        return decision
