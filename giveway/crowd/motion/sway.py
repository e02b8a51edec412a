"""The sway: a random acceleration that lasts, in addition to the model's; no predictor knows it.

The acceleration of each person is an Ornstein-Uhlenbeck process on each axis, as in Gardiner,
"Stochastic Methods" (Springer 2009), section 3.8.4. Its standard deviation and its correlation time
are parameters of the preset, and they are fitted to recorded people (docs/validation.md).
"""

import math

import numpy as np
from numpy.typing import NDArray

from giveway.config import RunConfig
from giveway.config.tables.crowd import VCI
from giveway.geometry.kernel import Array, inlined, kernel
from pedestrian_model import Crowd, PedestrianModel, Surroundings, Vehicles

_MORE = 1.001  # Factor by which a wall's acceleration is surely above a_max
_STREAM = 0xACC  # key of the random stream of sways, which differs from all others


class Sway:
    """A random acceleration of each pedestrian, with a correlation time.

    It is drawn for all people who ever were in the crowd, present or not. A pedestrian thus gets
    the same accelerations at the same instants with every controller.

    Args:
        model: Model of the crowd. Its limits of speed and acceleration still hold.
        seed: Seed of the draws.
    """

    def __init__(self, model: PedestrianModel, seed: int) -> None:
        p = model.parameters
        self._model = model
        keep = math.exp(-model.time_step / p.sway_time)
        share = p.sway * math.sqrt(1.0 - keep * keep)
        self._law = keep, share, model.time_step, p.max_acceleration, p.max_speed
        self._deviation = p.sway
        self._random = np.random.default_rng((seed, _STREAM))
        self._sway = np.empty((0, 2))
        self._draws = np.empty((0, 2))

    def advance(
        self,
        crowd: Crowd,
        vehicles: Vehicles,
        surroundings: Surroundings,
        person_ids: NDArray[np.int64],
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
        new = known - len(self._sway)
        if new > 0:
            begun = self._deviation * self._random.standard_normal((new, 2))
            self._sway = np.concatenate([self._sway, begun])
            self._draws = np.empty_like(self._sway)
        self._random.standard_normal(out=self._draws)
        _add_sway(
            (crowd.position, crowd.velocity, before), self._sway, self._draws, person_ids, self._law
        )


def pushed(model: PedestrianModel, crowd: Crowd, before: Array, push: Array) -> None:
    """Change the velocities after a model's step by ``push``, within the model's limits.

    The change of the whole step, the model's plus the added one, is limited by a_max, or by the
    model's own if a wall makes that larger. The result is
    limited by v_max, which does not increase the change, because ``before`` is within v_max.
    Positions change by half of the added velocity times the step, as for a constant acceleration.

    Args:
        model: Model that made the step.
        crowd: Crowd after its step, changed.
        before: Velocities (n, 2) [m/s] before the step.
        push: Changes of velocity (n, 2) [m/s] to add.
    """
    p = model.parameters
    limits = model.time_step, p.max_acceleration, p.max_speed
    _add_pushes((crowd.position, crowd.velocity, before), push, limits)


def sway_of(config: RunConfig, model: PedestrianModel, seed: int) -> Sway | None:
    """Return the sway of a crowd, or None if it has none: only people of VCI sway.

    Args:
        config: Configuration of the run.
        model: Model that moves the crowd.
        seed: Seed of the sway.
    """
    sways = config.crowd.model == VCI and model.parameters.sway > 0.0
    return Sway(model, seed) if sways else None


@inlined
def _add(
    moved: tuple[Array, Array, Array], k: int, push: tuple[float, float], limits: tuple[float, ...]
) -> None:
    """Add a change of velocity to pedestrian ``k``; see :func:`pushed`."""
    position, velocity, before = moved
    time_step, most, fastest = limits
    x, y = velocity[k, 0] - before[k, 0], velocity[k, 1] - before[k, 1]
    own, most = math.hypot(x, y), most * time_step  # changes [m/s] in a step
    if own > _MORE * most:  # a wall holds people with more than they accelerate by
        most = own
    x, y = velocity[k, 0] + push[0] - before[k, 0], velocity[k, 1] + push[1] - before[k, 1]
    within = most / max(math.hypot(x, y), most)
    x, y = before[k, 0] + x * within, before[k, 1] + y * within
    within = fastest / max(math.hypot(x, y), fastest)
    x, y = x * within, y * within
    position[k, 0] += 0.5 * time_step * (x - velocity[k, 0])
    position[k, 1] += 0.5 * time_step * (y - velocity[k, 1])
    velocity[k, 0], velocity[k, 1] = x, y


@kernel
def _add_pushes(
    moved: tuple[Array, Array, Array], push: Array, limits: tuple[float, float, float]
) -> None:
    for k in range(push.shape[0]):
        _add(moved, k, (push[k, 0], push[k, 1]), limits)


@kernel
def _add_sway(
    moved: tuple[Array, Array, Array],
    sway: Array,
    draws: Array,
    person_ids: NDArray[np.int64],
    law: tuple[float, float, float, float, float],
) -> None:
    """Draw everybody's next accelerations (known, 2), and add those of the people present."""
    keep, share, time_step, most, fastest = law
    for i in range(sway.shape[0]):
        for axis in range(2):
            sway[i, axis] = keep * sway[i, axis] + share * draws[i, axis]
    for k in range(person_ids.shape[0]):
        i = person_ids[k]
        _add(moved, k, (sway[i, 0] * time_step, sway[i, 1] * time_step), (time_step, most, fastest))
