"""What a run leaves behind, as arrays: the ego's track and the crowd's.

The recorder fills these; metrics, tables and figures read them. Everything is SI, angles are
mathematical (radians, counter-clockwise from +x) and x, y are the network's coordinates.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True)
class VehicleShape:
    """A rectangle, placed by the centre of its front bumper and its heading."""

    length: float = 5.0  # [m]
    width: float = 2.0  # [m]


@dataclass(frozen=True)
class EgoTrack:
    """The ego at the T control instants t_k; ``front_*`` is the centre of its front bumper."""

    time: NDArray[np.float64]  # (T,) [s]
    position: NDArray[np.float64]  # (T,) [m] travelled along its path since the start
    front_x: NDArray[np.float64]  # (T,) [m]
    front_y: NDArray[np.float64]  # (T,) [m]
    heading: NDArray[np.float64]  # (T,) [rad]
    speed: NDArray[np.float64]  # (T,) [m/s]
    acceleration: NDArray[np.float64]  # (T,) [m/s^2]
    force: NDArray[np.float64]  # (T,) [N] the command applied during [t_k, t_k+1]
    gap: NDArray[np.float64]  # (T,) [m] bumper to closest pedestrian in front; inf: nobody
    reference_speed: NDArray[np.float64]  # (T,) [m/s] of the controller that acted
    acting: NDArray[np.str_]  # (T,) which controller acted: "mpc" or "pid"
    reason: NDArray[np.str_]  # (T,) why it acted, e.g. "optimal", "infeasible", "selected"


@dataclass(frozen=True)
class CrowdTrack:
    """The crowd as flat records, one per pedestrian present at a control instant, in time order."""

    step: NDArray[np.int64]  # (R,) index into ``EgoTrack.time``
    pedestrian: NDArray[np.int64]  # (R,) index into ``ids``
    x: NDArray[np.float64]  # (R,) [m] body centre
    y: NDArray[np.float64]  # (R,) [m]
    vx: NDArray[np.float64]  # (R,) [m/s]
    vy: NDArray[np.float64]  # (R,) [m/s]
    ids: tuple[str, ...]  # one per pedestrian
