"""An MPC that plans with the crowd's answer inside its optimisation, as a rival for comparisons.

The idea is that of SICNav (Samavi, Han, Shkurti and Schoellig, "SICNav: Safe and Interactive Crowd
Navigation using Model Predictive Control and Bilevel Optimization", arXiv:2310.10982): the upper
level chooses the vehicle's motion, and the lower level is the ORCA problem of each person (van den
Berg et al. 2011), who avoids that motion. This is a small implementation of ours and not theirs.
The vehicle keeps to its path and chooses accelerations alone, and is three discs in a row. A person
has one half-plane of allowed velocities for each disc, at the predicted closest approach instead of
ORCA's cone, and does not avoid other people. The person's velocity is the present one, projected on
one half-plane after the other. It is therefore a smooth function of the vehicle's motion, which is
put into the upper level, where SICNav has the conditions of optimality. IPOPT solves what remains.

CasADi and IPOPT are the extra ``sicnav``. The driver is an example of a controller that uses the
plug-in protocol: ``--controller controller.reference_drivers.bilevel:BilevelMpc``.
"""

from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np

from controller._jit import Array
from controller.errors import PlugInError
from controller.observation import Observation
from controller.parameters import require_not_negative, require_positive
from controller.plug_in import Acceleration, Setup

_RADIUS = 0.27  # radius [m] of a person
_FAR = 1e3  # distance [m] of what is not there
_SIGHT = 20.0  # distance [m] up to which people are planned with
_BEHIND = 1.0  # distance [m] behind the vehicle up to which they are
_SPACING = 0.5  # spacing [m] of the path's points
_AT_LINE = 0.5  # distance [m] to a stop line at standstill
_BEHIND_LEADER = 2.0  # distance [m] to a leader at standstill
_DISC = 1.2  # radius of the vehicle's discs, in half widths
_ON_WAY = 1.5  # distance [m] from the path within which a person is on it
_GOOD = frozenset({"Solve_Succeeded", "Solved_To_Acceptable_Level"})


@dataclass(frozen=True)
class BilevelOptions:
    """Parameters of the driver.

    Attributes:
        people: Number of the closest people who are planned with.
        steps: Number of steps of the plan.
        step: Length [s] of a step.
        renewal: Time [s] after which the plan is renewed.
        anticipation: Time [s] for which people avoid the vehicle.
        share: Share of the avoidance that people are expected to take.
        margin: Distance [m] that the plan keeps to people.
        nearness: Cost of being closer, per square metre and step.
        courtesy: Cost of making a person deviate, per (m/s)^2 and step.
        effort: Cost of an acceleration, per (m/s^2)^2 and step.
        smoothness: Cost of its change from step to step.
        acceleration: Largest acceleration [m/s^2].
        deceleration: Largest deceleration [m/s^2].
        length: Length [m] of the vehicle.
        width: Width [m] of the vehicle.
        iterations: Largest number of IPOPT's iterations.

    Raises:
        ParameterError: a value is not finite or out of range.
    """

    people: int = 6
    steps: int = 10
    step: float = 0.4
    renewal: float = 0.2
    anticipation: float = 3.0
    share: float = 0.5
    margin: float = 0.6
    nearness: float = 100.0
    courtesy: float = 10.0
    effort: float = 2.0
    smoothness: float = 2.0
    acceleration: float = 1.5
    deceleration: float = 3.0
    length: float = 5.0
    width: float = 2.0
    iterations: int = 60

    def __post_init__(self) -> None:
        seconds = dict.fromkeys(("step", "renewal", "anticipation"), "s")
        sizes = dict.fromkeys(("length", "width"), "m")
        limits = dict.fromkeys(("acceleration", "deceleration"), "m/s^2")
        counts = dict.fromkeys(("people", "steps", "iterations", "effort"), "-")
        for name, unit in (seconds | sizes | limits | counts).items():
            require_positive(name, getattr(self, name), unit)
        for name in ("share", "margin", "nearness", "courtesy", "smoothness"):
            require_not_negative(name, getattr(self, name), "-")


class BilevelMpc:
    """An MPC whose plan contains how people answer it.

    Args:
        setup: Setup of the drive.
        options: Options of the driver.

    Attributes:
        solves: Number of plans so far.
        failures: Number of these without a solution, after which it brakes comfortably.
    """

    Options = BilevelOptions

    def __init__(self, setup: Setup, options: BilevelOptions) -> None:
        self._setup, self._options = setup, options
        self._solver: Any = None
        self._renewed_every = max(1, round(options.renewal / setup.time_step))
        self.reset()

    def reset(self) -> None:
        """Forget the past."""
        self._steps = 0  # number of control steps so far
        self._before = self._wanted = 0.0  # acceleration [m/s^2] of the last plan, and of this one
        self._reason = "free"
        self._plan = np.zeros(self._options.steps)
        self.solves = self.failures = 0

    def control(self, seen: Observation) -> Acceleration:
        """Return the acceleration, on a ramp from that of the last plan to that of this one."""
        since = self._steps % self._renewed_every
        if since == 0:
            self._before = self._wanted
            self._wanted, self._reason = self._planned(seen)
        self._steps += 1
        share = (since + 1) / self._renewed_every
        return Acceleration(self._before + share * (self._wanted - self._before), self._reason)

    def _planned(self, seen: Observation) -> tuple[float, str]:
        """Return the first acceleration [m/s^2] of a new plan, and the reason."""
        o = self._options
        if self._solver is None:
            self._solver = _solver(o)
        people, count = self._people(seen)
        given = [
            max(seen.speed, 0.0),
            self._before,
            min(self._setup.reference_speed, seen.speed_limit),
            min(seen.stop_gap - _AT_LINE, _FAR),
            min(seen.leader_gap - _BEHIND_LEADER, _FAR),
            seen.leader_speed,
        ]
        best, cost = None, inf
        for guess in (self._plan, np.full(o.steps, -self._setup.comfortable_deceleration)):
            found = self._solver(
                x0=guess, p=[*given, *people.ravel()], lbx=-o.deceleration, ubx=o.acceleration,
                lbg=0.0, ubg=inf,
            )  # fmt: skip
            if self._solver.stats()["return_status"] in _GOOD and float(found["f"]) < cost:
                best, cost = np.asarray(found["x"]).ravel(), float(found["f"])
        self.solves += 1
        if best is None:
            self.failures += 1
            self._plan = np.zeros(o.steps)
            return -self._setup.comfortable_deceleration, "no solution"
        self._plan = best
        return float(best[0]), "person" if count else "free"

    def _people(self, seen: Observation) -> tuple[Array, int]:
        """Return the people who are planned with, and their number.

        The rows (people, 4) are the station and the lateral offset [m] from the front bumper and
        along the path, and their rates [m/s]; far away if there are fewer.
        """
        o = self._options
        found = np.tile([_FAR, _FAR, 0.0, 0.0], (o.people, 1))
        if seen.path is None or seen.people is None or not len(seen.people.position):
            return found, 0
        stations = np.arange(-o.length - _BEHIND, _SIGHT + _SPACING, _SPACING)
        poses = np.array(seen.path.poses(np.maximum(stations, 0.0)))
        behind = np.minimum(stations, 0.0)
        poses[:, 0] += behind * np.cos(poses[:, 2])
        poses[:, 1] += behind * np.sin(poses[:, 2])
        apart = seen.people.position[:, None] - poses[None, :, :2]
        nearest = np.hypot(apart[..., 0], apart[..., 1]).argmin(axis=1)
        off, velocity = apart[np.arange(len(nearest)), nearest], seen.people.velocity
        c, s = np.cos(poses[nearest, 2]), np.sin(poses[nearest, 2])
        station = stations[nearest] + off[:, 0] * c + off[:, 1] * s
        offset = off[:, 1] * c - off[:, 0] * s
        along = velocity[:, 0] * c + velocity[:, 1] * s
        across = velocity[:, 1] * c - velocity[:, 0] * s
        ahead = np.maximum(np.maximum(station, -o.length - station), 0.0)
        gap = np.hypot(ahead, np.maximum(np.abs(offset) - o.width / 2.0, 0.0))
        counts = (np.abs(offset) < _ON_WAY) | (offset * across < 0.0)
        counts &= (gap < _SIGHT) & (station > -o.length - _BEHIND)
        whom = np.flatnonzero(counts)
        whom = whom[np.argsort(gap[whom], kind="stable")][: o.people]
        found[: len(whom)] = np.column_stack([station, offset, along, across])[whom]
        return found, len(whom)


def _solver(o: BilevelOptions) -> Any:
    """Return IPOPT on the plan's accelerations (steps,).

    Its parameters are the speed, the last acceleration, the reference speed, the distances to a
    stop line and to a leader, the leader's speed, and the rows of people.

    Raises:
        PlugInError: CasADi is not installed.
    """
    try:
        import casadi
    except ImportError:
        raise PlugInError(
            "BilevelMpc: needs CasADi, which is not installed; pip install 'giveway[sicnav]'"
        ) from None
    ca: Any = casadi
    plan, given = ca.SX.sym("plan", o.steps), ca.SX.sym("given", 6 + 4 * o.people)
    speed, last, reference, stop, leader, leader_speed = (given[i] for i in range(6))
    rows = [given[6 + 4 * i : 10 + 4 * i] for i in range(o.people)]
    position, own = [row[:2] for row in rows], [row[2:] for row in rows]
    velocity = list(own)
    reach = _DISC * o.width / 2.0 + _RADIUS
    first = 0.9 * o.width / 2.0
    discs = (-first, -o.length / 2.0, first - o.length)
    station, cost, speeds = ca.SX(0), ca.SX(0), []
    for k in range(o.steps):
        for i in range(o.people):
            answer = own[i]
            for disc in discs:
                apart = position[i] - ca.vertcat(station + disc, 0)
                closing = velocity[i] - ca.vertcat(speed, 0)
                answer += _avoidance(ca, (apart, closing, answer - velocity[i]), reach, o)
            velocity[i] = answer
            cost += o.courtesy * ca.sumsqr(answer - own[i])
        after = speed + o.step * plan[k]
        station += o.step * (speed + after) / 2.0
        speed = after
        speeds.append(speed)
        cost += (speed - reference) ** 2 + o.effort * plan[k] ** 2
        cost += o.smoothness * (plan[k] - last) ** 2
        last = plan[k]
        beyond = [station - stop, station - leader - leader_speed * o.step * (k + 1)]
        for i in range(o.people):
            position[i] += o.step * velocity[i]
            for disc in discs:
                apart = position[i] - ca.vertcat(station + disc, 0)
                beyond.append(reach + o.margin - ca.sqrt(ca.sumsqr(apart) + 1e-4))
        cost += o.nearness * sum(_positive(ca, one, 1e-3) ** 2 for one in beyond)
    problem = {"x": plan, "p": given, "f": cost, "g": ca.vertcat(*speeds)}
    ipopt = {"print_level": 0, "sb": "yes", "max_iter": o.iterations, "tol": 1e-3,
             "acceptable_tol": 1e-2, "acceptable_iter": 3,
             "hessian_approximation": "limited-memory"}  # fmt: skip
    return ca.nlpsol("bilevel", "ipopt", problem, {"print_time": False, "ipopt": ipopt})


def _avoidance(ca: Any, relative: tuple[Any, Any, Any], reach: float, o: BilevelOptions) -> Any:
    """Return what a person adds to the velocity, to keep clear of a disc at the closest approach.

    Args:
        ca: The module ``casadi``.
        relative: Position [m] and velocity [m/s] relative to the disc, and the change of velocity
            [m/s] so far.
        reach: Sum of both radii [m].
        o: Options of the driver.
    """
    apart, closing, change = relative
    until = _positive(ca, -ca.dot(apart, closing) / (ca.sumsqr(closing) + 0.05), 1e-2)
    until = o.anticipation - _positive(ca, o.anticipation - until, 1e-2)
    nearest = apart + closing * until
    distance = ca.sqrt(ca.sumsqr(nearest) + 1e-2)
    direction = nearest / distance
    needed = o.share * (reach - distance) / (until + o.step) - ca.dot(direction, change)
    return direction * _positive(ca, needed, 1e-2)


def _positive(ca: Any, value: Any, rounding: float) -> Any:
    """Return the positive part of a value, smooth within the root of ``rounding`` round zero."""
    return (value + ca.sqrt(value * value + rounding)) / 2.0
