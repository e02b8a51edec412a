"""The vehicle as the controllers see it: longitudinal, linear, discrete in time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from controller.parameters import require_not_negative, require_positive

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class LongitudinalModel:
    """M s'' + alpha s' = u by forward Euler (Yang & Özgüner 2019, eqs. (2) and (3)).

    The state is x = [position [m], speed [m/s]], the input u a force [N].

    Raises:
        ParameterError: a value is not finite or out of range.
    """

    mass: float = 1000.0  # M [kg]
    friction: float = 100.0  # alpha [N s/m]
    time_step: float = 0.05  # dt [s]

    def __post_init__(self) -> None:
        require_positive("mass", self.mass, "kg")
        require_not_negative("friction", self.friction, "N s/m")
        require_positive("time_step", self.time_step, "s")

    @property
    def decay(self) -> float:
        """What a free step leaves of the speed: 1 - alpha dt / M."""
        return 1.0 - self.friction * self.time_step / self.mass

    @property
    def speed_per_force(self) -> float:
        """What a step of unit force adds to the speed: dt / M [(m/s)/N]."""
        return self.time_step / self.mass

    @property
    def A(self) -> NDArray[np.float64]:  # noqa: N802 - the paper's symbol
        """(2, 2) of x(k+1) = A x(k) + B u(k)."""
        return np.array([[1.0, self.time_step], [0.0, self.decay]])

    @property
    def B(self) -> NDArray[np.float64]:  # noqa: N802 - the paper's symbol
        """(2, 1) of x(k+1) = A x(k) + B u(k)."""
        return np.array([[0.0], [self.speed_per_force]])

    def S_x(self, horizon: int) -> NDArray[np.float64]:  # noqa: N802 - the paper's symbol
        """(2N, 2) of X = S_x x_k + S_u U, eq. (5): the powers A, A^2, ..., A^N."""
        blocks = [self.A]
        for _ in range(horizon - 1):
            blocks.append(self.A @ blocks[-1])
        return np.concatenate(blocks)

    def S_u(self, horizon: int) -> NDArray[np.float64]:  # noqa: N802 - the paper's symbol
        """(2N, N) of X = S_x x_k + S_u U, eq. (5): A^(i-j) B at step i + 1, input j."""
        impulse = [self.B]
        for _ in range(horizon - 1):
            impulse.append(self.A @ impulse[-1])
        response = np.concatenate(impulse)  # of all steps to the first input
        S_u = np.zeros((2 * horizon, horizon))
        for j in range(horizon):
            S_u[2 * j :, j : j + 1] = response[: 2 * (horizon - j)]
        return S_u
