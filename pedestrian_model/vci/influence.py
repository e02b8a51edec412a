"""The force of vehicles alone, at any point, as in the paper's figure 2."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pedestrian_model._check import as_floats, check_shape, check_values
from pedestrian_model._jit import kernel
from pedestrian_model.errors import CrowdError
from pedestrian_model.parameters import SIM, VciParameters
from pedestrian_model.vci.buffers import PX, PY, VFX, VFY, VX, VY, S, Workspace
from pedestrian_model.vci.constants import pack
from pedestrian_model.vci.vehicle_force import add_vehicle
from pedestrian_model.vehicles import Vehicles


def vehicle_influence(
    points: ArrayLike,
    velocities: ArrayLike,
    vehicles: Vehicles,
    parameters: VciParameters = SIM,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the force of all vehicles on pedestrians at ``points``.

    Args:
        points: Points (k, 2) [m].
        velocities: Velocities (k, 2) [m/s] of the pedestrians there.
        vehicles: Vehicles.
        parameters: Parameters of the model.

    Returns:
        Forces (k, 2) [N] and signed distances (k,) [m] to the nearest contour: negative inside,
        inf without vehicles.

    Raises:
        CrowdError: if the points or velocities are not finite or have a wrong shape.
    """
    x = as_floats(points, "points", CrowdError)
    check_shape(x, (None, 2), "points", CrowdError)
    check_values(x, "points", CrowdError)
    v = as_floats(velocities, "velocities", CrowdError)
    check_shape(v, x.shape, "velocities", CrowdError)
    check_values(v, "velocities", CrowdError)
    out = np.empty((x.shape[0], 3))
    if x.shape[0] > 0:
        work = Workspace()
        work.reserve(x.shape[0])
        _fill_influence(x, v, vehicles.array, pack(parameters), work.arrays[0], out)
    return out[:, :2].copy(), out[:, 2].copy()


@kernel
def _fill_influence(
    points: NDArray[np.float64],
    velocities: NDArray[np.float64],
    vehicles: NDArray[np.float64],
    constants: NDArray[Any],
    rows: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Fill ``out`` (k, 3) with the vehicles' force x, y and the signed distance at each point."""
    n = points.shape[0]
    for i in range(rows.shape[1]):
        rows[PX, i], rows[PY, i] = points[min(i, n - 1), 0], points[min(i, n - 1), 1]
        rows[VX, i], rows[VY, i] = velocities[min(i, n - 1), 0], velocities[min(i, n - 1), 1]
        rows[VFX, i], rows[VFY, i], rows[S, i] = 0.0, 0.0, np.inf
    for v in range(vehicles.shape[0]):
        add_vehicle(rows, 0, n, vehicles[v], 0.0, False, constants[0])
    for i in range(n):
        out[i, 0], out[i, 1], out[i, 2] = rows[VFX, i], rows[VFY, i], rows[S, i]
