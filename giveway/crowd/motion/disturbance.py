"""A random acceleration on top of the model's: pedestrians walk as no model predicts."""

import numpy as np
from numpy.typing import NDArray

from giveway.config import RunConfig
from giveway.crowd.motion.noise import planar_noise
from giveway.geometry.kernel import Array
from pedestrian_model import Crowd, PedestrianModel, Surroundings, Vehicles

_STREAM = 0xACC  # tells these draws from others of the same seed


class Disturbance:
    """A random acceleration of each pedestrian, constant over a step and new in the next.

    It is drawn for all that ever were in the crowd, present or not: a pedestrian meets the same
    accelerations at the same instants whichever controller drives.

    Args:
        model: Model of the crowd; its limits of speed and acceleration still hold.
        deviation: Standard deviation on each axis [m/s^2], before it is cut off at twice that.
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
        """Step the crowd in place as the model does, and push each pedestrian.

        Args:
            crowd: Crowd of n pedestrians.
            vehicles: Vehicles that pedestrians react to.
            surroundings: Walls and lights that pedestrians heed.
            person_ids: (n,) Index of each among all ``known`` pedestrians.
            known: Number of pedestrians that ever were in the crowd.
        """
        before = crowd.velocity.copy()
        self._model.advance(crowd, vehicles, surroundings)
        push = planar_noise(self._random, known)[person_ids]
        push *= self._deviation * self._model.time_step
        pushed(self._model, crowd, before, push)


def pushed(model: PedestrianModel, crowd: Crowd, before: Array, push: Array) -> None:
    """Change the velocities after a model's step by ``push`` (n, 2) [m/s], within its limits.

    The whole change of the step, the model's own and the added one, keeps a_max, and the result
    v_max. Taking a velocity back to v_max shortens its way from ``before``, which lies within, so
    the second limit keeps the first. Positions follow: half the added velocity times the step, as
    constant acceleration has it.

    Args:
        model: Model that made the step.
        crowd: Crowd after its step.
        before: (n, 2) [m/s] Velocities before the step.
        push: (n, 2) [m/s] Velocity changes to add.
    """
    most = model.parameters.max_acceleration * model.time_step  # [m/s] in a step
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
