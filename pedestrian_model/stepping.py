"""The sub-steps, and the errors of states and signals, that all models share."""

import math

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined
from pedestrian_model.crowd import Crowd
from pedestrian_model.errors import DivergenceError, ParameterError, SurroundingsError
from pedestrian_model.surroundings import Surroundings
from pedestrian_model.vehicles import COLUMNS, Vehicles

#: The result of a step without an error; otherwise a step returns the index of a pedestrian.
FINE = -1
_SANE = 1e12  # number [m] or [m/s] above which a state counts as diverged
#: Longest step [s] of the integration: k_col dt^2 / m = 0.31 is stable.
LONGEST_STEP = 0.05


@inlined
def first_insane(position: NDArray[np.float64], velocity: NDArray[np.float64]) -> int:
    """Return the first pedestrian whose state is not finite or too large, or ``FINE``."""
    for i in range(position.shape[0]):
        largest = abs(position[i, 0]) + abs(position[i, 1])
        if not largest + abs(velocity[i, 0]) + abs(velocity[i, 1]) <= _SANE:
            return i
    return FINE


def substeps(time_step: float, longest: float = LONGEST_STEP) -> int:
    """Return the number of equal sub-steps of at most ``longest`` [s] in ``time_step`` [s].

    Raises:
        ParameterError: if the time step is not positive and finite.
    """
    if not 0.0 < time_step < math.inf:
        raise ParameterError(f"time_step = {time_step} s, expected a finite number > 0 s")
    return max(1, math.ceil(time_step / longest - 1e-9))


def unknown_signal(crowd: Crowd, surroundings: Surroundings) -> SurroundingsError:
    """Return the error of a way-point whose signal is not in ``surroundings.closed``."""
    at = int(np.argmax(crowd.waypoint_signal))
    i = int(np.searchsorted(crowd.waypoint_start, at, side="right")) - 1
    return SurroundingsError(
        f"pedestrian {i}: a way-point has signal {crowd.signals - 1}, but "
        f"surroundings.closed has {surroundings.closed.shape[0]}: give one for each signal"
    )


def divergence(i: int, crowd: Crowd, vehicles: Vehicles) -> DivergenceError:
    """Return the error of a state that is not finite, with the most likely cause."""
    bad = np.argwhere(~np.isfinite(vehicles.array))
    if bad.size:
        return DivergenceError(
            f"vehicle {bad[0, 0]}, column {COLUMNS[bad[0, 1]]} is not finite: "
            "check the vehicles given"
        )
    x, v = crowd.position[i], crowd.velocity[i]
    return DivergenceError(
        f"pedestrian {i}: the state is not finite (position {x} m, velocity {v} m/s); "
        "check its state before the step"
    )
