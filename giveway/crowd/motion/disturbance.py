"""The disturbance: a random acceleration in addition to the model's, which cannot be predicted."""

import numpy as np
from numpy.typing import NDArray

from giveway.config import RunConfig
from giveway.crowd.motion.noise import planar_noise
from giveway.geometry.kernel import Array
from pedestrian_model import Crowd, PedestrianModel, Surroundings, Vehicles

_STREAM = 0xACC  # key of the random stream of disturbances, which differs from all others


class Disturbance:
    """A random acceleration of each pedestrian, constant over a step and new in the next one.

    It is drawn for all people who ever were in the crowd, present or not. A pedestrian thus gets
    the same accelerations at the same instants with every controller.

    Args:
        model: Model of the crowd. Its limits of speed and acceleration still hold.
        deviation: Standard deviation [m/s^2] on each axis, before the cut-off at twice this value.
        seed: Seed of the draws.
    """

    def __init__(self, model: PedestrianModel, deviation: float, seed: int) -> None:
        self._model = model
        self._deviation = deviation
        self._random = np.random.default_rng((seed, _STREAM))

    def advance(
        self,
        crowd: Crowd,
        vehicles: Vehicles,
        surroundings: Surroundings,
        person_ids: NDArray[np.integer],
        known: int,
    ) -> None:
        """Step the crowd in place as the model does, and add the random accelerations.

        Args:
            crowd: Crowd of n pedestrians.
            vehicles: Vehicles that pedestrians react to.
            surroundings: Walls and lights that pedestrians heed.
            person_ids: Index (n,) of each person among all ``known`` pedestrians.
            known: Number of pedestrians who ever were in the crowd.
        """
        before = crowd.velocity.copy()
        self._model.advance(crowd, vehicles, surroundings)
        push = planar_noise(self._random, known)[person_ids]
        push *= self._deviation * self._model.time_step
        pushed(self._model, crowd, before, push)


def pushed(model: PedestrianModel, crowd: Crowd, before: Array, push: Array) -> None:
    """Change the velocities after a model's step by ``push``, within the model's limits.

    The change of the whole step, the model's plus the added one, is limited by a_max. The result is
    limited by v_max, which does not increase the change, because ``before`` is within v_max.
    Positions change by half of the added velocity times the step, as for a constant acceleration.

    Args:
        model: Model that made the step.
        crowd: Crowd after its step, changed.
        before: Velocities (n, 2) [m/s] before the step.
        push: Changes of velocity (n, 2) [m/s] to add.
    """
    most = model.parameters.max_acceleration * model.time_step  # largest change [m/s] in a step
    change = crowd.velocity + push - before
    wanted = before + change * _within(change, most)
    wanted *= _within(wanted, model.parameters.max_speed)
    crowd.position[:] += 0.5 * model.time_step * (wanted - crowd.velocity)
    crowd.velocity[:] = wanted


def disturbance_of(config: RunConfig, model: PedestrianModel) -> Disturbance | None:
    """Return the disturbance of a run's crowd, or None if it has none."""
    noise = config.crowd.acceleration_noise
    return Disturbance(model, noise, config.seed) if noise else None


def _within(vectors: Array, longest: float) -> Array:
    """Return factors (n, 1) that shorten each vector (n, 2) to at most ``longest``."""
    length = np.hypot(vectors[:, 0], vectors[:, 1])[:, None]
    return np.asarray(longest / np.maximum(length, longest))
