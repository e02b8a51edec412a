"""The influence of vehicles on pedestrians: distance to a contour that grows with speed.

Contour, in the vehicle's frame (X forward): a rear face, two sides, and a nose of two slanted
edges from the shoulders (X_s, +-h) to the tip (X_s + alpha_x |u|, 0). Below ``static_speed`` the
nose is flat and the contour a rectangle. TSAS 2020 for the form, Yang & Özgüner 2019 for the
rectangle and the vehicle's role as a potential field that changes with its speed.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from pedestrian_model._jit import fma, inlined
from pedestrian_model._mathematics import cosine_sine, exponential
from pedestrian_model._rows import PX, PY, VFX, VFY, VX, VY, S

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

#: Columns of the array of vehicles.
X, Y, HEADING, SPEED, FRONT, REAR, WIDTH = range(7)

_LEAST_EXPONENT = -700.0  # exp underflows below; nothing is felt long before


@inlined
def add_vehicle(
    rows: NDArray[np.float64], n: int, vehicle: NDArray[np.float64], travelled: float, c: Any
) -> None:
    """Add one vehicle's force to the first n rows and lower their signed distance.

    Args:
        rows: the workspace.
        n: how many rows, dummies included.
        vehicle: (7,) its columns; the reference point lies ``travelled`` further on.
        travelled: [s] times the speed.
        c: the constants.
    """
    cos, sin = cosine_sine(vehicle[HEADING])
    u = vehicle[SPEED]
    wheel_x, wheel_y = u * cos, u * sin
    x_v, y_v = vehicle[X] + travelled * wheel_x, vehicle[Y] + travelled * wheel_y
    # In reverse the contour is mirrored: its nose points backwards.
    front, rear = vehicle[FRONT], vehicle[REAR]
    ahead_x, ahead_y = cos, sin
    if u < 0.0:
        front, rear = rear, front
        ahead_x, ahead_y = -cos, -sin
    nose, dx0 = c.alpha_x * abs(u), c.dx0
    if abs(u) < c.u_static:
        nose, dx0 = 0.0, 0.0
    X_r, X_s, h = -(rear + c.le), front + c.le + dx0, vehicle[WIDTH] / 2.0 + c.le
    tip, edge = X_s + nose, math.sqrt(nose * nose + h * h)
    N_x, N_y = h / edge, nose / edge  # outward normal of a slanted edge, on the left
    R, A, b, a_v, b_v, cap = c.R, c.A, c.b, c.a_v, c.b_v, c.cap
    x, y, vx, vy = rows[PX], rows[PY], rows[VX], rows[VY]
    f_x, f_y, s_min = rows[VFX], rows[VFY], rows[S]
    for k in range(n):
        dx, dy = x[k] - x_v, y[k] - y_v
        local_x = fma(ahead_x, dx, ahead_y * dy)
        local_y = fma(cos, dy, -(sin * dx))
        lateral = abs(local_y)
        # The vector from the influence point q where q is a corner or on the rear face ...
        behind = local_x < X_r
        beyond = local_x >= X_s
        along = fma(local_x - X_s, N_y, -((lateral - h) * N_x))  # from the shoulder to the tip
        at_shoulder = along < 0.0
        q_x = X_r if behind else (X_s if at_shoulder else tip)
        q_y = min(lateral, h) if behind else (h if at_shoulder else 0.0)
        to_x, to_y = local_x - q_x, lateral - q_y
        distance = math.sqrt(fma(to_x, to_x, to_y * to_y))
        inverse = 1.0 / distance
        # ... and where it lies within an edge, whose normal also serves for s = 0 and inside.
        on_edge = beyond & (along >= 0.0) & (along <= edge)
        at_corner = (behind | (beyond & ~on_edge)) & (distance > 0.0)
        normal_x, normal_y = (N_x, N_y) if beyond else (0.0, 1.0)
        plane = fma(local_x - X_s, normal_x, (lateral - h) * normal_y)
        plane = plane if beyond else lateral - h
        s = distance if at_corner else plane
        e_x = to_x * inverse if at_corner else normal_x
        e_y = to_y * inverse if at_corner else normal_y
        e_y = e_y if local_y >= 0.0 else -e_y
        # As(phi_v; l_v) between the direction to the vehicle and the velocity relative to it
        w_x, w_y = vx[k] - wheel_x, vy[k] - wheel_y
        lengths = math.sqrt(fma(dx, dx, dy * dy) * fma(w_x, w_x, w_y * w_y))
        cosine = -fma(dx, w_x, dy * w_y) / lengths
        cosine = min(1.0, max(-1.0, cosine)) if lengths > 0.0 else 1.0  # at rest: seen
        anisotropy = 1.0 if s < R else fma(b_v, cosine, a_v)
        exponent = max(min(-b * (s - R), cap), _LEAST_EXPONENT)
        f = A * exponential(exponent) * anisotropy
        f_x[k] += f * fma(e_x, ahead_x, -(e_y * sin))
        f_y[k] += f * fma(e_x, ahead_y, e_y * cos)
        s_min[k] = min(s_min[k], s)
