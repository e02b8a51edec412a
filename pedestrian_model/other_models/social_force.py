"""The social force of Helbing and Molnár (Phys. Rev. E 51, 4282, 1995), with its parameters.

People repel each other by ellipses over their way in the next two seconds. People out of sight
count half. Borders repel by their distance. A vehicle is a rectangle that repels as a border does,
by the ellipse of its way in the next two seconds (ours).
"""

import math

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined
from pedestrian_model._mathematics import cosine_sine, exponential
from pedestrian_model.arrays import FRONT, HEADING, REAR, SPEED, WIDTH, X, Y

Array = NDArray[np.float64]

RELAXATION = 0.5  # relaxation time [s] of the velocity
AHEAD = 2.0  # time [s] of a person's way that its ellipse covers
FASTER = 1.3  # largest speed as a share of the desired speed
EPSILON = 1e-9  # least length [m], against a division by zero

_PERSON, _PERSON_RANGE = 2.1, 0.3  # V_0 [m^2/s^2] and sigma [m]
_BORDER, _BORDER_RANGE = 10.0, 0.2  # U_0 [m^2/s^2] and R [m]
_SIGHT, _UNSEEN = -0.17364817766693033, 0.5  # cos 100 degrees; weight of what is out of sight
_FAR = 8.0  # distance [m] beyond which forces of less than 1e-6 m/s^2 are left out


@inlined
def elliptical(r_x: float, r_y: float, s_x: float, s_y: float) -> tuple[float, float, float]:
    """Return the semi-minor axis b [m] of an ellipse, and its gradient.

    2 b = sqrt((|r| + |r - s|)^2 - |s|^2).

    Args:
        r_x: Vector r [m] from the other person.
        r_y: Vector r [m] from the other person.
        s_x: Step s [m] of the other person.
        s_y: Step s [m] of the other person.
    """
    first = max(math.sqrt(r_x * r_x + r_y * r_y), EPSILON)
    u_x, u_y = r_x - s_x, r_y - s_y
    second = max(math.sqrt(u_x * u_x + u_y * u_y), EPSILON)
    both = first + second
    b = 0.5 * math.sqrt(max(both * both - s_x * s_x - s_y * s_y, EPSILON))
    share = both / (4.0 * b)
    return b, share * (r_x / first + u_x / second), share * (r_y / first + u_y / second)


@inlined
def _seen(e_x: float, e_y: float, f_x: float, f_y: float) -> float:
    """Return the weight of a force f on a person who looks along e."""
    f = math.sqrt(f_x * f_x + f_y * f_y)
    return 1.0 if -(e_x * f_x + e_y * f_y) >= f * _SIGHT else _UNSEEN


@inlined
def of_people(
    i: int, e_x: float, e_y: float, position: Array, velocity: Array
) -> tuple[float, float]:
    """Return the acceleration [m/s^2] of pedestrian i by the force of all others."""
    a_x, a_y = 0.0, 0.0
    for j in range(position.shape[0]):
        r_x, r_y = position[i, 0] - position[j, 0], position[i, 1] - position[j, 1]
        if j == i or r_x * r_x + r_y * r_y > _FAR * _FAR:
            continue
        s_x, s_y = AHEAD * velocity[j, 0], AHEAD * velocity[j, 1]
        b, g_x, g_y = elliptical(r_x, r_y, s_x, s_y)
        push = _PERSON / _PERSON_RANGE * exponential(max(-b / _PERSON_RANGE, -700.0))
        f_x, f_y = push * g_x, push * g_y
        w = _seen(e_x, e_y, f_x, f_y)
        a_x, a_y = a_x + w * f_x, a_y + w * f_y
    return a_x, a_y


@inlined
def border(distance: float) -> float:
    """Return the acceleration [m/s^2] away from a border at a distance [m] from the body."""
    if distance > _FAR:
        return 0.0
    return _BORDER / _BORDER_RANGE * exponential(-max(distance, 0.0) / _BORDER_RANGE)


@inlined
def in_frame(
    x: float, y: float, vehicle: Array, travelled: float
) -> tuple[float, float, float, float]:
    """Return a point in the frame of a vehicle, and cosine and sine of the vehicle's heading.

    The vehicle has driven straight on for ``travelled`` [s].
    """
    c, s = cosine_sine(vehicle[HEADING])
    d_x = x - vehicle[X] - travelled * vehicle[SPEED] * c
    d_y = y - vehicle[Y] - travelled * vehicle[SPEED] * s
    return d_x * c + d_y * s, d_y * c - d_x * s, c, s


@inlined
def of_vehicles(
    place: tuple[float, float],
    direction: tuple[float, float],
    vehicles: Array,
    radius: float,
    travelled: float,
    ahead: float,
) -> tuple[float, float]:
    """Return the acceleration [m/s^2] of a person by the force of vehicles.

    Args:
        place: Position [m] of the person.
        direction: Unit vector to the way-point.
        vehicles: Vehicles (m, 7).
        radius: Radius of a body [m].
        travelled: Time [s] for which the vehicles have driven straight on.
        ahead: Time [s] of a vehicle's way that its ellipse covers; with 0 it is a border.
    """
    (x, y), (e_x, e_y) = place, direction
    a_x, a_y = 0.0, 0.0
    for k in range(vehicles.shape[0]):
        vehicle = vehicles[k]
        along, across, c, s = in_frame(x, y, vehicle, travelled)
        half = 0.5 * vehicle[WIDTH]
        off_x = along - min(max(along, -vehicle[REAR]), vehicle[FRONT])
        off_y = across - min(max(across, -half), half)
        distance = math.sqrt(off_x * off_x + off_y * off_y)
        step = ahead * vehicle[SPEED]
        if distance > _FAR + abs(step):
            continue
        if distance <= EPSILON:  # a person inside is pushed out by the nearer side
            off_x, off_y = 0.0, math.copysign(EPSILON, across)
        if step == 0.0:
            push = border(distance - radius)
            g_x, g_y = off_x / max(distance, EPSILON), off_y / max(distance, EPSILON)
        else:
            shrink = max(distance - radius, EPSILON) / max(distance, EPSILON)
            b, g_x, g_y = elliptical(shrink * off_x, shrink * off_y, step, 0.0)
            push = _BORDER / _BORDER_RANGE * exponential(max(-b / _BORDER_RANGE, -700.0))
        f_x, f_y = push * (c * g_x - s * g_y), push * (s * g_x + c * g_y)
        w = _seen(e_x, e_y, f_x, f_y)
        a_x, a_y = a_x + w * f_x, a_y + w * f_y
    return a_x, a_y
