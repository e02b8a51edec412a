"""The safety layer of one ego on its path: it replaces forces that are not safe."""

from dataclasses import replace
from typing import Any

import numpy as np

from controller import (
    Actuator,
    Decision,
    LongitudinalModel,
    SafetyLayer,
    SafetyParameters,
    VehicleLayer,
    VehicleLimits,
)
from controller.driving_constants import FIRM
from controller.kernels import largest_safe_force
from giveway.config import EgoRunConfig
from giveway.ego.perception.hidden_people import NOWHERE, Hidden
from giveway.ego.perception.kerbs import NO_KERBS
from giveway.ego.perception.protocol import Percept
from giveway.ego.vehicle_model import actuator_of
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array, inner, kernel
from giveway.geometry.path import EgoPath, body_pose, segment_at

_FINEST = 0.25  # least spacing [m] of poses; in a bend of 5 m radius its chord is 1.6 mm off
MOST_POSES = 256  # largest number of poses of the front ahead
RUSHES = 2.0  # speed [m/s] up to which people out of hiding stop nobody, above `CRAWL`
OUT_OF_HIDING = "hidden people"
_EXACT = np.zeros(0)
UNAVOIDABLE = SafetyLayer.REASONS[-1]


class EgoSafetyLayer:
    """The safety layer of one ego: it checks each force, and replaces it if it is not safe.

    Args:
        limits: Limits of pedestrians and of the brake.
        config: Configuration of the ego.
        path: Path of the ego.
        shape: Shape of its body.
        time_step: Time step of the co-simulation [s].
    """

    def __init__(
        self,
        limits: SafetyParameters,
        config: EgoRunConfig,
        path: EgoPath,
        shape: VehicleShape,
        time_step: float,
    ) -> None:
        self._actuator = limits.actuator
        model = LongitudinalModel(config.vehicle.mass, config.vehicle.friction, time_step)
        limits = replace(limits, width=shape.width)
        self._layer = SafetyLayer(model, limits)
        self._hidden_speed = config.safety.hidden_speed
        self._for_hidden: SafetyLayer | None = None
        if config.perception.plugged_in_sensor and self._hidden_speed:
            slowly = min(limits.setting_out, limits.walking_acceleration)
            self._for_hidden = SafetyLayer(model, replace(limits, walking_acceleration=slowly))
        self._way = path.vertices, path.stations, path.headings
        self._length = shape.length
        self._poses = np.zeros((MOST_POSES, 4))
        self._firm = -FIRM * config.vehicle.mass

    def overrule(
        self,
        decision: Decision,
        front: float,
        speed: float,
        percept: Percept,
        kerbs: Array = NO_KERBS,
        hidden: Hidden = NOWHERE,
    ) -> Decision | None:
        """Return the decision of the safety layer, or None if the controller's force is safe.

        Args:
            decision: Decision of the controller.
            front: Station of the front bumper [m].
            speed: Speed of the ego [m/s].
            percept: Pedestrians as the ego perceives them.
            kerbs: Kerbs (n, 3) of people on sidewalks, as
                :meth:`giveway.ego.perception.kerbs.Kerbs.of` returns them.
            hidden: Places where people could come out of hiding.
        """
        people, errors, off = percept.people, percept.position_bound, percept.velocity_bound
        errors = self._layer.errors(len(people.position)) if errors is None else errors
        crowd = people.position, people.velocity, errors, kerbs, _EXACT if off is None else off
        safe = self._checked(self._layer, decision, front, speed, crowd)
        if self._for_hidden is None:
            return safe
        places = (hidden if speed > RUSHES else NOWHERE).position
        n = len(places)
        paces = np.full(n, self._hidden_speed)
        unseen = places, np.zeros((n, 2)), np.full(n, hidden.error), NO_KERBS, paces
        asked = safe or decision
        slower = self._checked(self._for_hidden, asked, front, speed, unseen)
        if slower is not None:
            force = slower.force
            if slower.reason == UNAVOIDABLE:  # the place has just come into sight
                force = min(asked.force, max(force, self._firm))
            safe = slower._replace(force=force, reason=OUT_OF_HIDING)
        self.applied((safe or decision).force)
        return safe

    def _checked(
        self,
        layer: SafetyLayer,
        decision: Decision,
        front: float,
        speed: float,
        people: tuple[Array, Array, Array, Array, Array],
    ) -> Decision | None:
        """Return the decision of one layer, or None if the force of ``decision`` is safe."""
        safe, verdict = watch(
            self._way,
            (front, self._length, layer.reach(speed)),
            self._poses,
            self._actuator.acting(decision.force),
            speed,
            people,
            layer.memory,
        )
        if not verdict:
            return None
        safe = self._actuator.command(safe)
        return decision._replace(force=safe, acting="safety", reason=layer.REASONS[verdict])

    @property
    def _layers(self) -> list[SafetyLayer]:
        return [self._layer] if self._for_hidden is None else [self._layer, self._for_hidden]

    def may_be_slower(self, by: float) -> None:
        """Let the next speed be the largest one that the ego may have.

        Args:
            by: Speed [m/s] by which it may be slower, until another one is told.
        """
        for layer in self._layers:
            layer.may_be_slower(by)

    def applied(self, force: float) -> None:
        """Remember a force [N] that acts in this step instead of the layer's."""
        for layer in self._layers:
            layer.memory[1][-1] = self._actuator.acting(force)


def vehicle_layer_of(config: EgoRunConfig, time_step: float) -> VehicleLayer | None:
    """The safety layer for vehicles ahead, or None if it is off.

    Args:
        config: Configuration of the ego.
        time_step: Time step of the co-simulation [s].
    """
    if not config.vehicle_layer:
        return None
    vehicle = config.vehicle
    return VehicleLayer(
        LongitudinalModel(vehicle.mass, vehicle.friction, time_step),
        VehicleLimits(
            force_limit=vehicle.force_limit,
            actuator=actuator_of(config, time_step) or Actuator(),
        ),
    )


@kernel
def watch(
    path: tuple[Array, Array, Array],
    place: tuple[float, float, float],
    poses: Array,
    force: float,
    speed: float,
    people: tuple[Array, Array, Array, Array, Array],
    memory: tuple[Any, ...],
) -> tuple[float, int]:
    """Return the largest safe force on a path, see :func:`controller.kernels.largest_safe_force`.

    Args:
        path: Vertices, stations and headings of the ego's path.
        place: Station of the front bumper, length of the body and distance ahead that matters [m].
        poses: Scratch, (k, 4).
        force: Force [N] that the controller asks for.
        speed: Speed of the ego [m/s].
        people: Positions (n, 2), velocities (n, 2), errors (n,) or more, kerbs (n, 3) or none, and
            errors of the velocities (n,) or none.
        memory: Memory of the safety layer.
    """
    front, length, reach = place
    spacing = spacing_of(reach, poses.shape[0])
    count = fill_front_poses(path, front, length, reach, spacing, poses)
    return largest_safe_force(force, speed, (poses[:count], spacing), people, memory)


@inner
def spacing_of(reach: float, most: int) -> float:
    """The spacing [m] of at most ``most`` poses that cover a distance of ``reach`` [m]."""
    return max(_FINEST, reach / (most - 2))


@inner
def fill_front_poses(
    path: tuple[Array, Array, Array],
    front: float,
    length: float,
    reach: float,
    spacing: float,
    poses: Array,
) -> int:
    """Fill ``poses`` with x, y, cos, sin at front, front + spacing, ..., and return their number.

    One pose is enough if the path is straight from the rear bumper to ``reach`` [m] ahead of the
    front.
    """
    vertices, stations, headings = path
    straight = segment_at(stations, front - length) == segment_at(stations, front + reach)
    count = 1 if straight else min(2 + int(reach / spacing), poses.shape[0])
    for i in range(count):
        x, y, heading = body_pose(vertices, stations, headings, front + i * spacing, length)
        poses[i, 0], poses[i, 1] = x, y
        poses[i, 2], poses[i, 3] = np.cos(heading), np.sin(heading)
    return count
