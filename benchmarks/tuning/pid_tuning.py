"""How the gains of the tuned PID are found: a grid of pole placements, constraints, an objective.

Robust tuning in the manner of MIGO (Åström, Panagopoulos & Hägglund 1998): of all candidates whose
loop stays robust and whose steps do not overshoot, the one that gets rid of a load soonest.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import TYPE_CHECKING

import numpy as np

from controller import TunedPid, TunedPidParameters

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from controller import LongitudinalModel

    Array = NDArray[np.float64]

SENSITIVITY_LIMIT = 1.6  # M_s [-]: distance 1/1.6 to the critical point
OVERSHOOT_LIMIT = 0.02  # of the step
ERROR_LIMIT = 1e-3  # [m/s] that may be left at the end of a step
MASS_ERRORS = (0.7, 1.0, 1.3)  # the vehicle's mass over the controller's
DELAY = 1  # [steps] that the force comes late, of the robustness: a vehicle's own lag
LOAD = 500.0  # [N] that comes from nowhere: a slope of 5 %
BANDWIDTHS = (1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 3.5, 4.0)  # [rad/s]
DAMPINGS = (0.7, 0.85, 1.0, 1.25, 1.5, 2.0)  # [-]

_SPAN = 12.0  # [s] of a step
_NEAR = 0.02  # of the step: settled


@dataclass(frozen=True, slots=True)
class Merits:
    """What a candidate is worth; each number the worst over the masses, but the times' mean."""

    bandwidth: float  # omega_0 [rad/s]
    damping: float  # zeta [-]
    rise_time: float  # [s] from 10 to 90 % of 0 -> v_r
    settling_time: float  # [s] until it stays within 2 %, the slower of 0 -> v_r and v_r -> 0
    overshoot: float  # [-] of the step
    steady_state_error: float  # [m/s]
    sensitivity: float  # M_s [-]
    rms_jerk: float  # [m/s^3] of the two steps
    load_error: float  # [m] integral of |e| after a load

    @property
    def admissible(self) -> bool:
        """Whether all constraints hold."""
        return (
            self.sensitivity <= SENSITIVITY_LIMIT
            and self.overshoot < OVERSHOOT_LIMIT
            and self.steady_state_error < ERROR_LIMIT
        )


def candidates(base: TunedPidParameters) -> list[TunedPidParameters]:
    """The grid of pole placements."""
    return [replace(base, bandwidth=w, damping=z) for w in BANDWIDTHS for z in DAMPINGS]


def tune(model: LongitudinalModel, base: TunedPidParameters | None = None) -> list[Merits]:
    """Every candidate's merits, the best first, then the admissible ones, then the others."""
    base = base or TunedPidParameters()
    return ranked(merits(candidate, model) for candidate in candidates(base))


def ranked(found: Iterable[Merits]) -> list[Merits]:
    """In the order of the objective: the least error after a load, then the least jerk."""
    return sorted(found, key=lambda m: (not m.admissible, round(m.load_error, 3), m.rms_jerk))


def merits(parameters: TunedPidParameters, model: LongitudinalModel) -> Merits:
    """One candidate's merits, over the vehicles whose mass is not the controller's."""
    v_r, dt = parameters.reference.reference_speed, model.time_step
    masses = [model.mass * share for share in MASS_ERRORS]
    up = [step(parameters, model, 0.0, inf, mass) for mass in masses]
    down = [step(parameters, model, v_r, 0.0, mass) for mass in masses]
    loaded = step(parameters, model, v_r, inf, model.mass, load=LOAD)
    return Merits(
        parameters.bandwidth,
        parameters.damping,
        float(np.mean([rise_time(speed, v_r, dt) for speed in up])),
        float(
            np.mean(
                [
                    max(settling_time(u, v_r, v_r, dt), settling_time(d, 0.0, v_r, dt))
                    for u, d in zip(up, down, strict=True)
                ]
            )
        ),
        max(float(speed.max()) / v_r - 1.0 for speed in up),
        max(max(abs(float(u[-1]) - v_r), abs(float(d[-1]))) for u, d in zip(up, down, strict=True)),
        max(sensitivity(parameters, model, mass) for mass in masses),
        float(np.sqrt(np.mean([np.mean(np.diff(s, 2) ** 2) for s in up + down]))) / dt**2,
        float(np.abs(loaded - v_r).sum() * dt),
    )


def step(
    parameters: TunedPidParameters,
    model: LongitudinalModel,
    start: float,
    limit: float,
    mass: float,
    *,
    load: float = 0.0,
) -> Array:
    """(n,) [m/s] speeds of a vehicle that is ``mass`` heavy and that the PID takes for ``model``.

    Args:
        parameters: of the PID.
        model: what the PID knows.
        start: speed [m/s].
        limit: speed limit from then on [m/s]: 0 is a stop, inf the reference speed.
        mass: the vehicle's [kg].
        load: a force against it [N].
    """
    pid, vehicle = TunedPid(parameters, model), replace(model, mass=mass)
    speeds = np.empty(round(_SPAN / model.time_step))
    v = start
    for k in range(len(speeds)):
        speeds[k] = v
        u = pid.control(v, inf, limit) - load
        v = max(0.0, vehicle.decay * v + vehicle.speed_per_force * u)
    return speeds


def rise_time(speed: Array, target: float, dt: float) -> float:
    """From 10 to 90 % of a step from rest [s]; inf if it does not get there."""
    if speed.max() < 0.9 * target:
        return inf
    return dt * float(np.argmax(speed >= 0.9 * target) - np.argmax(speed >= 0.1 * target))


def settling_time(speed: Array, target: float, size: float, dt: float) -> float:
    """Until the speed stays within 2 % of the step's ``size`` of its ``target`` [s]."""
    outside = np.flatnonzero(np.abs(speed - target) > _NEAR * size)
    return dt * float(outside[-1] + 1) if outside.size else 0.0


def sensitivity(
    parameters: TunedPidParameters, model: LongitudinalModel, mass: float, delay: int = DELAY
) -> float:
    """M_s = max |1 / (1 + L)| of the sampled loop, the force ``delay`` steps late.

    L(z) = z^-delay (K_p + K_i dt / (z - 1)) (dt / M) / (z - 1 + alpha dt / M). Infinite where the
    closed loop is not stable.
    """
    K_p, K_i = parameters.gains(model)
    vehicle, dt = replace(model, mass=mass), model.time_step
    controller = np.array([K_p, K_i * dt - K_p])
    denominator = np.polymul([1.0, -1.0], [1.0, -vehicle.decay])
    denominator = np.polymul(denominator, [1.0] + [0.0] * delay)
    loop = vehicle.speed_per_force * controller
    if np.abs(np.roots(np.polyadd(denominator, loop))).max() >= 1.0:
        return inf
    z = np.exp(1j * np.linspace(1e-3, np.pi, 4000))
    own = np.polyval(denominator, z)
    return float(np.abs(own / (own + np.polyval(loop, z))).max())


def table(found: Sequence[Merits]) -> str:
    """The candidates as lines of text."""
    head = "omega_0  zeta  rise [s]  settling [s]  overshoot  error [m/s]    Ms  RMS jerk  load [m]"
    lines = [
        f"{m.bandwidth:7.2f}{m.damping:6.2f}{m.rise_time:10.2f}{m.settling_time:14.2f}"
        f"{m.overshoot:11.2%}{m.steady_state_error:13.1e}{m.sensitivity:6.2f}{m.rms_jerk:10.2f}"
        f"{m.load_error:10.3f}{'' if m.admissible else '  -'}"
        for m in found
    ]
    return "\n".join([head, *lines])
