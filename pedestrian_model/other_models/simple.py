"""Pedestrian models other than VCI, to find out whether results depend on the model.

``constant-velocity``
    People walk to the next way-point at the desired speed and ignore everything else. This is the
    simplest model, and the assumption behind a time to collision.
``social-force``
    Helbing and Molnár, "Social force model for pedestrian dynamics" (Phys. Rev. E 51, 4282, 1995),
    with its parameters: a force to the goal, elliptical repulsion among people, repulsion by
    borders, and a lower weight of what is out of sight. A vehicle is a rectangle that repels as a
    border does, by the ellipse of its way in the next two seconds.
``gap-acceptance``
    People walk among each other by the same social force. For a moving vehicle they accept gaps:
    they stop before the strip that it will sweep, unless it arrives later than their critical
    headway t_c = L / v_0 + t_s of the Highway Capacity Manual (2010, equation 19-69: the length of
    the crossing over the walking speed, plus 3 s to start and to clear it). People who have begun
    to cross go on. A standing vehicle is a rectangle that repels as a wall does. At a kerb with a
    signal and behind it the signal decides: whoever sets it has judged the gap.
``orca``
    Optimal reciprocal collision avoidance (van den Berg et al. 2011): each person takes the
    velocity closest to the desired one that avoids collisions within the next 3 s, if the others
    make their half of the change. Vehicles do not avoid people.

All of them follow way-points, lines and signals, and keep the largest acceleration and speed of the
parameters. They have no detour around cars, and no priority.
"""

import math
from dataclasses import replace
from typing import Any, Final, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from pedestrian_model._jit import inlined, kernel
from pedestrian_model.arrays import FRONT, REAR, SPEED, WIDTH
from pedestrian_model.crowd import Crowd
from pedestrian_model.other_models.orca import LINES, orca_velocity
from pedestrian_model.other_models.social_force import (
    AHEAD,
    EPSILON,
    FASTER,
    RELAXATION,
    border,
    in_frame,
    of_people,
    of_vehicles,
)
from pedestrian_model.parameters import SIM, VciParameters
from pedestrian_model.routes import OFF_WALKWAYS, heading_for
from pedestrian_model.stepping import FINE, divergence, first_insane, substeps, unknown_signal
from pedestrian_model.surroundings import OPEN_GROUND, Surroundings
from pedestrian_model.vehicles import Vehicles
from pedestrian_model.walls import nearest_walls

PlainName = Literal["constant-velocity", "social-force", "gap-acceptance", "orca"]
PLAIN_MODELS: Final[tuple[PlainName, ...]] = get_args(PlainName)

_STRAIGHT, _FORCES, _GAPS, _ORCA = range(len(PLAIN_MODELS))
Array = NDArray[np.float64]

# Highway Capacity Manual 2010, equation 19-69
_START = 3.0  # time t_s [s] to start and to clear the strip
_HALT = 4.0 * RELAXATION  # time constant T [s]: v = room / T leads to a stop without overshoot
_BESIDE = 0.3  # distance [m] between the vehicle's side and a body that waits (ours)
_STANDS = 0.1  # speed [m/s] below which a vehicle stands
_ARRIVES = 0.3  # distance [m] over which people slow down to stop at a way-point (ours)


def unmoved(parameters: VciParameters) -> VciParameters:
    """Return VCI parameters with which VCI's predictor predicts as ``constant-velocity`` does.

    All repulsion is zero, so that people only walk to their next way-point.

    Args:
        parameters: Parameters from which body, limits and way-points are kept.
    """
    return replace(
        parameters,
        repulsion_strength=0.0,
        navigation_strength=0.0,
        collision_stiffness=0.0,
        vehicle_strength=0.0,
        wall_strength=0.0,
        destination_gain=parameters.mass / RELAXATION,
        destination_smoothing=_ARRIVES,
    )


class PlainModel:
    """One of the plain models with a time step. It keeps no state but scratch memory.

    Args:
        name: Name of the model.
        parameters: Parameters of VCI, of which body radius, largest speed and acceleration, and the
            radius of way-points are used.
        time_step: Time step [s]. Above 0.05 s it is divided into equal sub-steps, during which the
            vehicles drive straight on at constant speed.

    Raises:
        ParameterError: if the time step is not positive and finite.
    """

    def __init__(
        self, name: PlainName, parameters: VciParameters = SIM, time_step: float = 0.05
    ) -> None:
        self.name = name
        self.parameters = parameters
        self.time_step = float(time_step)
        self._kind = PLAIN_MODELS.index(name)
        self._substeps = substeps(self.time_step)
        self._limits = (
            parameters.body_radius,
            parameters.max_acceleration,
            parameters.max_speed,
            parameters.waypoint_radius,
        )
        self._next = np.empty((0, 4))
        self._walls = np.empty((3, 0))
        self._scratch = (np.empty((LINES, 4)), np.empty((LINES, 4)), np.empty((LINES, 2)))

    def advance(
        self, crowd: Crowd, vehicles: Vehicles, surroundings: Surroundings = OPEN_GROUND
    ) -> None:
        """Advance position, velocity and waypoint_index of ``crowd`` in place by one time step.

        Raises:
            DivergenceError: if a pedestrian's state is or becomes not finite.
            SurroundingsError: if a way-point's signal is not one of the surroundings.
        """
        if crowd.signals > surroundings.closed.shape[0]:
            raise unknown_signal(crowd, surroundings)
        n = len(crowd)
        if n == 0:
            return
        if n > len(self._next):
            self._next, self._walls = np.empty((2 * n, 4)), np.empty((3, 2 * n))
        closed, lines, cells = surroundings.arrays
        bad = _advance(
            self._kind,
            crowd.state,
            (crowd.desired_speed, *crowd.fixed_arrays[2:]),
            (closed, surroundings.walls is not None, lines, cells, vehicles.array),
            self._limits,
            (self.time_step / self._substeps, self._substeps),
            (self._next[:n], self._walls[:, :n], self._scratch),
        )
        if bad != FINE:
            raise divergence(bad, crowd, vehicles)


@kernel
def _advance(
    kind: int,
    state: tuple[Any, ...],
    wishes: tuple[Any, ...],
    scene: tuple[NDArray[np.bool_], bool, Array, NDArray[np.int64], Array],
    limits: tuple[float, ...],
    timing: tuple[float, int],
    memory: tuple[Array, Array, tuple[Array, Array, Array]],
) -> int:
    """Advance the state in place by some steps, and return ``FINE`` or the first bad index."""
    position, velocity, waypoint_index = state
    desired_speed, routes, start = wishes[0], wishes[1:], wishes[4]
    closed, walled, lines, cells, vehicles = scene
    radius, a_max, v_max, r_waypoint = limits
    dt, steps = timing
    after, walls, scratch = memory
    ahead = AHEAD if kind == _FORCES else 0.0
    n = position.shape[0]
    bad = first_insane(position, velocity)
    if bad != FINE:
        return bad
    for step in range(steps):
        if walled:
            nearest_walls(position[:, 0].copy(), position[:, 1].copy(), lines, cells, walls)
        for i in range(n):
            x, y = position[i, 0], position[i, 1]
            at, stops, to_x, to_y = heading_for(
                x,
                y,
                start[i] + waypoint_index[i],
                (start[i], start[i + 1] - 1),
                routes,
                closed,
                (r_waypoint, radius),
            )
            waypoint_index[i] = at - start[i]
            if walled and routes[2][at] == OFF_WALKWAYS:
                walls[0, i] = np.inf
            e_x, e_y = to_x - x, to_y - y
            left = math.sqrt(e_x * e_x + e_y * e_y)
            e_x, e_y = e_x / max(left, EPSILON), e_y / max(left, EPSILON)
            pace = desired_speed[i]
            if stops:
                pace *= left / math.sqrt(left * left + _ARRIVES * _ARRIVES)
            signal, kerb = routes[2], at > start[i] and routes[2][at - 1] >= 0
            if kind == _GAPS and not kerb and signal[at] < 0:
                before = speed_before((x, y), (e_x, e_y), pace, vehicles, radius, step * dt)
                pace = min(pace, before)
            a_x = (pace * e_x - velocity[i, 0]) / RELAXATION
            a_y = (pace * e_y - velocity[i, 1]) / RELAXATION
            fastest = min(FASTER * desired_speed[i], v_max)
            if kind == _ORCA:
                wall = (walls[0, i], walls[1, i], walls[2, i]) if walled else (np.inf, 0.0, 0.0)
                o_x, o_y = orca_velocity(
                    i,
                    (position, velocity),
                    (velocity[i, 0] + dt * a_x, velocity[i, 1] + dt * a_y),
                    (fastest, radius),
                    (vehicles, wall),
                    (step * dt, dt),
                    scratch,
                )
                a_x, a_y = (o_x - velocity[i, 0]) / dt, (o_y - velocity[i, 1]) / dt
            elif kind != _STRAIGHT:
                b_x, b_y = of_people(i, e_x, e_y, position, velocity)
                a_x, a_y = a_x + b_x, a_y + b_y
                b_x, b_y = of_vehicles((x, y), (e_x, e_y), vehicles, radius, step * dt, ahead)
                a_x, a_y = a_x + b_x, a_y + b_y
                if walled and walls[0, i] < np.inf:
                    push = border(walls[0, i] - radius)
                    a_x, a_y = a_x + push * walls[1, i], a_y + push * walls[2, i]
            a = math.sqrt(a_x * a_x + a_y * a_y)
            scale = a_max / a if a > a_max else 1.0
            v_x, v_y = velocity[i, 0] + dt * scale * a_x, velocity[i, 1] + dt * scale * a_y
            v = math.sqrt(v_x * v_x + v_y * v_y)
            scale = fastest / v if v > fastest else 1.0
            after[i, 2], after[i, 3] = scale * v_x, scale * v_y
            after[i, 0] = x + 0.5 * dt * (velocity[i, 0] + after[i, 2])
            after[i, 1] = y + 0.5 * dt * (velocity[i, 1] + after[i, 3])
        for i in range(n):
            position[i, 0], position[i, 1] = after[i, 0], after[i, 1]
            velocity[i, 0], velocity[i, 1] = after[i, 2], after[i, 3]
    return first_insane(position, velocity)


@inlined
def speed_before(
    place: tuple[float, float],
    direction: tuple[float, float],
    pace: float,
    vehicles: Array,
    radius: float,
    travelled: float,
) -> float:
    """Return the speed [m/s] at which a person stops before the strips of vehicles, or inf.

    A strip counts if its vehicle arrives before the person's critical headway is over.

    Args:
        place: Position [m] of the person.
        direction: Unit vector to the way-point.
        pace: Speed [m/s] at which the person walks there.
        vehicles: Vehicles (m, 7).
        radius: Radius of a body [m].
        travelled: Time [s] for which the vehicles have driven straight on.
    """
    (x, y), (e_x, e_y) = place, direction
    slowest = np.inf
    for k in range(vehicles.shape[0]):
        vehicle = vehicles[k]
        along, across, c, s = in_frame(x, y, vehicle, travelled)
        half = 0.5 * vehicle[WIDTH] + radius + _BESIDE
        forth, aside = e_x * c + e_y * s, e_y * c - e_x * s
        u = vehicle[SPEED]
        if u < _STANDS or abs(across) <= half or across * aside >= 0.0 or pace <= 0.0:
            continue
        room = (abs(across) - half) / abs(aside)  # distance [m] to walk to the strip
        if room > _HALT * pace:
            continue
        meets = along + room * forth - vehicle[FRONT]  # distance [m] ahead of the front
        if meets < -vehicle[REAR] - vehicle[FRONT]:
            continue
        critical = 2.0 * half / (abs(aside) * pace) + _START
        if max(meets, 0.0) / u - room / pace < critical:
            slowest = min(slowest, room / _HALT)
    return slowest
