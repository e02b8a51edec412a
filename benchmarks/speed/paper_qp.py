"""The paper's QP, in its own unknowns and units: the definition that everything is tested against.

The solvers get the same problem in speeds (``controller.paper_mpc.speed_problem``), where it is
well
conditioned. The tests of ``controller`` and bench_qp.py use this file.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from controller.model import LongitudinalModel
    from controller.parameters import MpcParameters

    Array = NDArray[np.float64]


@dataclass(frozen=True)
class QuadraticProgram:
    """min 1/2 U'PU + q'U subject to lower <= G U <= upper, U in newtons.

    Rows of G, N each: c1 the forces, c2/c3 their differences, c4/c5 the speeds, c6 the positions.
    """

    P: Array  # (N, N)
    q: Array  # (N,)
    G: Array  # (4N, N)
    lower: Array  # (4N,)
    upper: Array  # (4N,)

    def violation(self, forces: Array) -> float:
        """The largest amount by which ``forces`` (N,) [N] miss a constraint, each in its unit."""
        values = self.G @ forces
        return float(np.maximum(self.lower - values, values - self.upper).max(initial=0.0))


def state_matrices(model: LongitudinalModel) -> tuple[Array, Array]:
    """A (2, 2) and B (2, 1) of x(k+1) = A x(k) + B u(k), eqs. (2) and (3)."""
    A = np.array([[1.0, model.time_step], [0.0, model.decay]])
    return A, np.array([[0.0], [model.speed_per_force]])


def prediction_matrices(model: LongitudinalModel, horizon: int) -> tuple[Array, Array]:
    """S_x (2N, 2) and S_u (2N, N) of X = S_x x_k + S_u U, eq. (5).

    S_x holds the powers A, A^2, ..., A^N; S_u holds A^(i-j) B at step i + 1 and input j.
    """
    A, B = state_matrices(model)
    powers, impulse = [A], [B]
    for _ in range(horizon - 1):
        powers.append(A @ powers[-1])
        impulse.append(A @ impulse[-1])
    response = np.concatenate(impulse)  # of all steps to the first input
    S_u = np.zeros((2 * horizon, horizon))
    for j in range(horizon):
        S_u[2 * j :, j : j + 1] = response[: 2 * (horizon - j)]
    return np.concatenate(powers), S_u


def quadratic_program(
    model: LongitudinalModel,
    parameters: MpcParameters,
    state: Array,
    previous_force: float,
    obstacle_positions: Array,
) -> QuadraticProgram:
    """The QP of Yang & Özgüner 2019, eqs. (9) to (16), with its misprints corrected.

    Corrected: c5 has V_min where V_max is printed; M_u is the N x N lower bidiagonal difference
    matrix; X_p runs from k+1 to k+N; the cost U'HU + 2FU is written in standard form.

    Args:
        model: the vehicle.
        parameters: weights and limits.
        state: x_k = [position [m], speed [m/s]].
        previous_force: u(k-1) [N].
        obstacle_positions: (N,) x_p(k+1) ... x_p(k+N) [m]; inf where nobody is in front.
    """
    N = parameters.horizon
    S_x, S_u = prediction_matrices(model, N)
    A_r = np.kron(np.eye(N), [[0.0, 1.0]])  # picks the speeds; it is also the paper's M_v
    M_x = np.kron(np.eye(N), [[1.0, 0.0]])  # picks the positions
    M_u = np.eye(N) - np.eye(N, k=-1)
    u_0 = np.zeros(N)
    u_0[0] = previous_force
    Q = parameters.speed_weight * np.eye(N)
    V_r = np.full(N, parameters.reference_speed)

    free = S_x @ state
    H = S_u.T @ A_r.T @ Q @ A_r @ S_u
    F = (A_r @ free - V_r) @ Q @ A_r @ S_u
    ones = np.ones(N)
    return QuadraticProgram(
        P=2.0 * H,
        q=2.0 * F,
        G=np.concatenate([np.eye(N), M_u, A_r @ S_u, M_x @ S_u]),
        lower=np.concatenate(
            [
                -parameters.force_limit * ones,  # c1
                u_0 - parameters.force_rate_limit,  # c3
                parameters.speed_min - A_r @ free,  # c5
                -np.inf * ones,
            ]
        ),
        upper=np.concatenate(
            [
                parameters.force_limit * ones,  # c1
                u_0 + parameters.force_rate_limit,  # c2
                parameters.speed_max - A_r @ free,  # c4
                obstacle_positions - parameters.safe_distance - M_x @ free,  # c6
            ]
        ),
    )
