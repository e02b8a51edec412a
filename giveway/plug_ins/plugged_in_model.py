"""The wrapper of a pedestrian model of another package: it checks and limits its answers."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from giveway.plug_ins.faults import blamed, read_only, shown
from pedestrian_model import (
    OFF_WALKWAYS,
    OPEN_GROUND,
    Accelerations,
    Crowd,
    Goals,
    ModelPlugIn,
    ModelSetup,
    PlugInError,
    Surroundings,
    VciParameters,
    Vehicles,
    Velocities,
    Walkers,
    WallsAround,
)
from pedestrian_model.other_models.preferred import first_insane_of, preferred_velocities
from pedestrian_model.stepping import FINE, divergence, unknown_signal

Array = NDArray[np.float64]

_NO_WALLS = read_only(np.empty((0, 4)))


class PluggedInModel:
    """A pedestrian model of another package, which the co-simulation asks like giveway's own.

    Giveway follows way-points, lines and signals. The model decides how people react to each other,
    to walls and to vehicles. Accelerations and speeds are limited to those of the parameters, which
    the guarantee of the safety layer assumes.

    Args:
        name: Name of the model, for messages.
        make: Function that makes the plug-in.
        setup: Setup of the run.
        parameters: Bodies and limits of people.
        who: Function that returns the ids of the people in the crowd, or None to number them by
            their rows.

    Raises:
        PlugInError: it cannot be made, or is no model.
    """

    def __init__(
        self,
        name: str,
        make: Callable[[], object],
        setup: ModelSetup,
        parameters: VciParameters,
        who: Callable[[], NDArray[np.int64]] | None = None,
    ) -> None:
        self.name, self.parameters, self.time_step = name, parameters, setup.time_step
        self._who = who
        with blamed(name, PlugInError, " when it was made"):
            plug_in = make()
        if not isinstance(plug_in, ModelPlugIn):
            msg = f"{name} made {shown(plug_in)}: expected an object with a method step"
            raise PlugInError(msg)
        self._plug_in = plug_in

    def reset(self) -> None:
        """Forget the past."""
        reset = getattr(self._plug_in, "reset", None)
        if reset is not None:
            with blamed(self.name, PlugInError, " in reset"):
                reset()

    def advance(
        self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings = OPEN_GROUND
    ) -> None:
        """Advance position, velocity and waypoint_index of ``crowd`` in place by one time step.

        Raises:
            DivergenceError: if a pedestrian's state is not finite.
            PlugInError: the model raises, or answers no finite numbers, one pair for each.
            SurroundingsError: if a way-point's signal is not one of the surroundings.
        """
        if crowd.signals > surroundings.closed.shape[0]:
            raise unknown_signal(crowd, surroundings)
        if not len(crowd):
            return
        bad = first_insane_of(crowd.position, crowd.velocity)
        if bad != FINE:
            raise divergence(bad, crowd, vehicles)
        walkers = self._seen(crowd, vehicles, surroundings)
        with blamed(self.name, PlugInError):
            answer = self._plug_in.step(walkers)
        self._move(crowd, self._velocities(answer, crowd))

    def _seen(self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings) -> Walkers:
        """Return the input of the model, after passing the way-points that were reached."""
        n, p = len(crowd), self.parameters
        preferred, goal, stops = np.empty((n, 2)), np.empty((n, 2)), np.empty(n, dtype=np.bool_)
        preferred_velocities(
            crowd.state,
            crowd.desired_speed,
            crowd.routes,
            surroundings.closed,
            (p.waypoint_radius, p.body_radius),
            (preferred, goal, stops),
        )
        walls = surroundings.walls
        if walls is None:
            distance, normal, segments = np.full(n, np.inf), np.zeros((n, 2)), _NO_WALLS
        else:
            distance, normal = walls.nearest(crowd.position)
            next_ones = crowd.waypoint_start[:-1] + crowd.waypoint_index
            distance[crowd.waypoint_signal[next_ones] == OFF_WALKWAYS] = np.inf
            segments = walls.segments
        ids = np.arange(n) if self._who is None else self._who()
        return Walkers(
            position=read_only(crowd.position),
            velocity=read_only(crowd.velocity),
            desired_speed=read_only(crowd.desired_speed),
            preferred=read_only(preferred),
            goals=Goals(read_only(goal), read_only(stops)),
            ids=read_only(ids),
            vehicles=read_only(vehicles.array),
            walls=WallsAround(read_only(distance), read_only(normal), read_only(segments)),
        )

    def _velocities(self, answer: object, crowd: Crowd) -> Array:
        """Return the velocities at the end of the step, within the limits, (n, 2) [m/s]."""
        before, h = crowd.velocity, self.time_step
        if isinstance(answer, Velocities):
            change = self._numbers(answer, answer.values, len(crowd), "m/s") - before
        else:
            values = answer.values if isinstance(answer, Accelerations) else answer
            change = h * self._numbers(answer, values, len(crowd), "m/s^2")
        after: Array = before + change * _within(change, h * self.parameters.max_acceleration)
        after *= _within(after, self.parameters.max_speed)
        return after

    def _move(self, crowd: Crowd, velocity: Array) -> None:
        crowd.position[:] += 0.5 * self.time_step * (crowd.velocity + velocity)
        crowd.velocity[:] = velocity

    def _numbers(self, answer: object, values: object, n: int, unit: str) -> Array:
        try:
            array = np.asarray(values, dtype=np.float64)
        except (TypeError, ValueError):
            array = np.empty(0)
        if array.shape != (n, 2):
            raise PlugInError(
                f"{self.name} returned {shown(answer)}: expected Accelerations or Velocities of "
                f"({n}, 2) numbers [{unit}], a pair for each pedestrian"
            )
        finite = np.isfinite(array).all(axis=1)
        if not finite.all():
            i = int(np.argmin(finite))
            msg = f"{self.name} returned {array[i].tolist()}: expected finite numbers [{unit}]"
            raise PlugInError(msg, i)
        return array


def _within(vectors: Array, longest: float) -> Array:
    """Return factors (n, 1) that shorten each vector (n, 2) to at most ``longest``."""
    length = np.sqrt((vectors**2).sum(axis=1))[:, None]
    return np.asarray(longest / np.maximum(length, longest))
