"""The constants of the kernels: the parameters and derived factors in one numpy record."""

import math
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import kernel
from pedestrian_model._mathematics import (
    COS_PI_8,
    DEGREE,
    SIN_PI_8,
    angle_decay_coefficients,
    exponential,
)
from pedestrian_model.parameters import VciParameters
from pedestrian_model.vci.vehicle_force import LEAST_FORCE

_PI_8 = 0.39269908169872414

# fmt: off
_NAMES = (
    # the body, between pedestrians
    "m", "R", "two_R", "r_max", "d_rep", "s_rep_2", "a_rep", "b_rep", "k_col", "d_nav", "s_nav_2",
    "decay_0", "decay_1", "decay_2", "decay_3", "cos_pi_8", "sin_pi_8",
    # vehicle influence
    "le", "dx0", "alpha_x", "A", "b", "a_v", "b_v", "cap", "u_static", "u_angle", "reach",
    # walls
    "A_w", "b_w",
    # destination, limits
    "k_des", "s_des_2", "F_2", "inverse_F", "a_max", "v_max", "r_waypoint", "detour", "u_detour",
)
# fmt: on
_DTYPE = np.dtype([*((name, np.float64) for name in _NAMES), ("g", np.float64, (DEGREE + 1,))])


@kernel
def _exp(x: float) -> float:
    return exponential(x)


@lru_cache(maxsize=32)
def pack(
    parameters: VciParameters, *, detour: bool = True, creep: bool = True, longer: float = 0.0
) -> NDArray[Any]:
    """Return the constants of the kernels for ``parameters``, a read-only array of one record.

    Args:
        parameters: Parameters of the model.
        detour: Whether people walk around a standing car.
        creep: Whether the angle of f_v treats a car below the static speed as moving.
        longer: Time [s] by which a step is longer than the crowd's own. One step of 2 h gives the
            same speed as two steps of h under the same forces if the mass is
            m/(1 - k_des h/(2 m)). In the second of them the part -k_des v of the destination force
            has changed.
    """
    p = parameters
    l_nav = p.navigation_anisotropy
    # flm(d; d0, M, s) = M/(2 d0) ((d0 - d) + sqrt((d0 - d)^2 + s^2)), Ae(phi; l) = exp(-l phi)
    k_rep = p.repulsion_strength / (2.0 * p.repulsion_distance)
    k_nav = p.navigation_strength / (2.0 * p.navigation_distance)
    values = {
        "m": p.mass / (1.0 - 0.5 * p.destination_gain * longer / p.mass),
        "R": p.body_radius,
        "two_R": 2.0 * p.body_radius,
        "r_max": p.interaction_radius,
        # As(phi; l) = l + (1 - l)(1 + cos phi)/2 = a + b cos phi, times the factor of flm
        "d_rep": p.repulsion_distance,
        "s_rep_2": p.repulsion_smoothing**2,
        "a_rep": k_rep * (1.0 + p.repulsion_anisotropy) / 2.0,
        "b_rep": k_rep * (1.0 - p.repulsion_anisotropy) / 2.0,
        "k_col": p.collision_stiffness,
        "d_nav": p.navigation_distance,
        "s_nav_2": p.navigation_smoothing**2,
        "decay_0": k_nav * _exp(-l_nav * _PI_8),
        "decay_1": k_nav * _exp(-l_nav * 3.0 * _PI_8),
        "decay_2": k_nav * _exp(-l_nav * 5.0 * _PI_8),
        "decay_3": k_nav * _exp(-l_nav * 7.0 * _PI_8),
        "cos_pi_8": COS_PI_8,
        "sin_pi_8": SIN_PI_8,
        "le": p.vehicle_clearance,
        "dx0": p.vehicle_nose,
        "alpha_x": p.vehicle_lookahead,
        "A": p.vehicle_strength,
        "b": p.vehicle_decay,
        "a_v": (1.0 + p.vehicle_anisotropy) / 2.0,
        "b_v": (1.0 - p.vehicle_anisotropy) / 2.0,
        "cap": p.vehicle_exponent_cap,
        "u_static": p.static_speed,
        "u_angle": 0.0 if creep else p.static_speed,  # speed below which phi_v is that of a stand
        "reach": p.body_radius
        + math.ceil(math.log(max(p.vehicle_strength / LEAST_FORCE, 1.0))) / p.vehicle_decay,
        "A_w": p.wall_strength,
        "b_w": p.wall_decay,
        "k_des": p.destination_gain,
        "s_des_2": p.destination_smoothing**2,
        "F_2": p.influence_high,
        "inverse_F": 1.0 / (p.influence_high - p.influence_low),
        "a_max": p.max_acceleration,
        "v_max": p.max_speed,
        "r_waypoint": p.waypoint_radius,
        "u_detour": p.static_speed if detour else 0.0,  # speed below which people walk around it
        "detour": p.vehicle_clearance + p.body_radius + p.detour_margin,
    }
    constants = np.zeros(1, dtype=_DTYPE)
    for name in _NAMES:
        constants[0][name] = values[name]
    constants[0]["g"] = angle_decay_coefficients(float(l_nav))
    constants.flags.writeable = False
    return constants
