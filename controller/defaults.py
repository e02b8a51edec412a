"""The defaults that several parts of this package share, each with its unit and its source."""

from typing import Final

# Yang & Özgüner 2019, table 1.
REFERENCE_SPEED: Final = 4.0  # v_r [m/s]
SAFE_DISTANCE: Final = 8.0  # d_safe [m]
BUFFER_DISTANCE: Final = 10.0  # d_buffer [m]
SPEED_MAX: Final = 20.0  # v_max [m/s]
FORCE_LIMIT: Final = 8000.0  # u_max [N]
FORCE_RATE_LIMIT: Final = 1000.0  # du_max [N per step]
TIME_STEP: Final = 0.05  # dt [s]

# Giveway's own.
ITERATION_LIMIT: Final = 4000  # largest number of iterations of the QP solver

#: Speed [m/s] below which the vehicle stands and the brake's force does no work.
STANDSTILL: Final = 1e-9
