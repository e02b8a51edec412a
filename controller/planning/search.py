"""The search: which manoeuvre costs least, among driving on, the last plan, and a few others.

A manoeuvre is a path in the plane of time and station, in which everybody who crosses the ego's
corridor occupies a region. To pass before somebody or behind is to pass that region on one side or
the other, so a handful of manoeuvres stands for the choices there are (a small enumeration, as in
Werling et al., ICRA 2010). Since people answer to the ego, each manoeuvre is judged by how the
crowd would move under it.
"""

from math import inf
from typing import Any

import numpy as np

from controller._jit import Array, kernel
from controller.foresight import Foresight, Manoeuvre
from controller.model import LongitudinalModel
from controller.planning.parameters import PlannerParameters, Weights

_EASING = 0.4  # [s] in which an acceleration is taken back before standstill or the wanted speed
_SLOWING = 3.0  # [m/s^2] with which a speed above the wanted one is given up: as adaptive cruise
# control does at most (ISO 15622: 3.5 m/s^2 at speed); obstacles have harder manoeuvres
_WORSE = 1e-6  # [m] by which a smoothed plan may come closer than the manoeuvre it follows


def copy(source: Manoeuvre, to: Manoeuvre) -> None:
    """Fill a manoeuvre with another one of the same length."""
    to.distance[:] = source.distance
    to.speed[:] = source.speed
    to.acceleration[:] = source.acceleration


class Search:
    """Tries manoeuvres, and remembers what was decided on the last time.

    Args:
        model: the vehicle.
        parameters: the horizon, the manoeuvres and their weights.

    Attributes:
        weights: of the cost, a plain tuple of :class:`Weights`.
        best: the manoeuvre of least cost.
        gap: (N,) [m] what it would lead to, as in :class:`Prospect`.
        conflicts: (N,) persons, likewise.
        calm: (N,) [m/s], likewise.
        tried: manoeuvres that the crowd was predicted under.
    """

    def __init__(self, model: LongitudinalModel, parameters: PlannerParameters) -> None:
        N, m, v_r = parameters.horizon, parameters.manoeuvres, parameters.reference_speed
        self._manoeuvres, self._time_step = m, model.time_step
        self._weights = Weights.of(parameters, m)
        self.weights = tuple(self._weights)
        self._kinds = [
            (a, share * v_r) for a, share in zip(m.accelerations, m.slowest, strict=True)
        ]
        self._last, self._trial, self.best = (Manoeuvre.empty(N) for _ in range(3))
        self.gap, self.conflicts, self.calm = np.full(N, inf), np.zeros(N), np.full(N, inf)
        self._free, self._nobody = np.full(N, inf), np.zeros(N)
        self.reset()

    def reset(self) -> None:
        """Forget everything."""
        self._planned, self._holds, self._drives_on = False, True, True
        self._turn, self.tried = 0, 0

    def forget(self) -> None:
        """There is no plan to go on with."""
        self._planned = False

    def keep(self, plan: Manoeuvre) -> None:
        """Remember what was decided on: it is tried again at the next step."""
        copy(plan, self._last)
        self._planned = True
        self._holds = self._may_hold(plan)

    def choose(
        self,
        speed: float,
        before: float,
        fastest: float,
        allowed: Array,
        foresight: Foresight | None,
    ) -> str:
        """Search: driving on, what was planned, and the others in turn or all at once.

        All are tried where the best so far comes too close to somebody. Else, what is best
        changes slowly: besides the plan, driving on and one of the others are tried by turns, so
        that the search stays as quick as the loop.
        """
        persistence = self._manoeuvres.persistence
        kinds = self._kinds
        others = [(a, least) for a, least in kinds[1:] if a >= 0.0 or speed > least]
        self._lowest, self._missing, self.tried = inf, inf, 0
        name = ""
        self._turn += 1
        drive_on = not self._planned or self._drives_on or self._turn % 2 == 1
        if drive_on:
            self._aim(speed, before, *kinds[0], fastest)
            name = "drive on"
            if self._try(allowed, foresight, persistence) <= 0.0:
                self._drives_on = True
                return "clear"
        if self._planned:
            self._shift(speed)
            self._try(allowed, foresight, 0.0)
            if self._is_best:
                name = "as planned"
        if self._planned and self._missing <= 0.0:
            others = [] if self._turn % 2 else [others[self._turn // 2 % len(others)]]
        elif not drive_on:
            others = [kinds[0], *others]
        for wanted, least in others:
            self._aim(speed, before, wanted, least, fastest)
            self._try(allowed, foresight, persistence)
            if self._is_best:
                name = "drive on" if wanted > 0.0 else f"{wanted:+g} m/s^2 to {least:g} m/s"
        self._drives_on = name == "drive on"
        return name

    def follow(
        self,
        speed: float,
        before: float,
        fastest: float,
        allowed: Array,
        foresight: Foresight | None,
    ) -> str:
        """Without a search: the crowd answers to the last plan, the plan keeps d_safe."""
        self._lowest, self._missing, self.tried = inf, inf, 0
        if self._planned:
            self._shift(speed)
        else:
            self._aim(speed, before, 0.0, 0.0, fastest)
        disturbed = self._try(allowed, foresight, 0.0)
        return "clear" if disturbed <= 0.0 else "as planned"

    def _aim(
        self, speed: float, before: float, wanted: float, slowest: float, fastest: float
    ) -> None:
        trial, jerk = self._trial, self._manoeuvres.jerk
        dt = self._time_step
        to = (trial.distance, trial.speed, trial.acceleration)
        aim(speed, before, wanted, slowest, fastest, jerk, dt, *to)

    def _shift(self, speed: float) -> None:
        trial, b = self._trial, self._manoeuvres.deceleration
        copy(self._last, trial)
        to = (trial.distance, trial.speed, trial.acceleration)
        shift(speed, self._holds, b, self._time_step, *to)

    def _try(self, allowed: Array, foresight: Foresight | None, handicap: float) -> float:
        """Judge the trial, and keep it if it is the best; what others cost it [s]."""
        trial = self._trial
        gap, conflicts, calm = self._free, self._nobody, self._free
        if foresight is not None:
            gap, conflicts, calm = foresight.prospect(trial)
            self.tried += 1
        whole, disturbed, missing = cost(
            trial.distance,
            trial.speed,
            trial.acceleration,
            gap,
            conflicts,
            calm,
            allowed,
            self._time_step,
            self.weights,
        )
        self._is_best = whole + handicap < self._lowest
        if self._is_best:
            self._lowest, self._missing = whole + handicap, missing
            copy(trial, self.best)
            self.gap[:], self.conflicts[:], self.calm[:] = gap, conflicts, calm
            if foresight is not None:
                foresight.prefer()
        return disturbed

    def comes_closer(self, plan: Manoeuvre, allowed: Array) -> bool:
        """Whether a plan lacks more stopping distance to anybody than the manoeuvre does."""
        _, _, missing = cost(
            plan.distance,
            plan.speed,
            plan.acceleration,
            self.gap + self.best.distance[1:] - plan.distance[1:],
            self.conflicts,
            self.calm,
            allowed,
            self._time_step,
            self.weights,
        )
        return missing > self._missing + _WORSE

    def _may_hold(self, plan: Manoeuvre) -> bool:
        """Whether a stop stays possible if the plan's last speed is kept on."""
        v = plan.speed[-1]
        gap = self.gap[-1] + self.best.distance[-1] - plan.distance[-1]
        return bool(gap - self._time_step * v >= stopping_need(v, self._weights))


@kernel
def aim(
    speed: float,
    before: float,
    wanted: float,
    slowest: float,
    fastest: float,
    jerk: float,
    time_step: float,
    distance: Array,
    speeds: Array,
    accelerations: Array,
) -> None:
    """Fill a manoeuvre that goes over to the acceleration ``wanted``, up to rest or ``fastest``.

    Args:
        speed: now [m/s].
        before: the acceleration before [m/s^2].
        wanted: [m/s^2].
        slowest: [m/s] where braking ends.
        fastest: [m/s] not exceeded by driving on.
        jerk: [m/s^3] of changes.
        time_step: [s].
        distance: (N + 1,) [m] receives the manoeuvre.
        speeds: (N + 1,) [m/s] likewise.
        accelerations: (N + 1,) [m/s^2] likewise.
    """
    s, v, a = 0.0, speed, before
    most = jerk * time_step
    for i in range(len(speeds)):
        distance[i], speeds[i] = s, v
        if wanted > 0.0 or v > fastest:
            goal = min(wanted, max((fastest - v) / _EASING, -_SLOWING))
        else:
            goal = max(wanted, min(0.0, (slowest - v) / _EASING))
        a += min(max(goal - a, -most), most)
        after = max(v + time_step * a, 0.0)
        if after > fastest:
            after = max(fastest, min(after, v))
        accelerations[i] = (after - v) / time_step
        s += time_step * v
        v = after


@kernel
def shift(
    speed: float,
    holds: bool,
    deceleration: float,
    time_step: float,
    distance: Array,
    speeds: Array,
    accelerations: Array,
) -> None:
    """Move a plan on by one step, in place: what it had planned for then is now.

    Args:
        speed: now [m/s]; where it differs from what was planned, it counts.
        holds: the last speed is kept beyond the former horizon; else it is braked.
        deceleration: b [m/s^2] of that.
        time_step: [s].
        distance: (N + 1,) [m] of the plan.
        speeds: (N + 1,) [m/s].
        accelerations: (N + 1,) [m/s^2].
    """
    N = len(speeds) - 1
    for i in range(N):
        speeds[i] = speeds[i + 1]
    if not holds:
        speeds[N] = max(0.0, speeds[N] - deceleration * time_step)
    speeds[0] = speed
    distance[0] = 0.0
    for i in range(N):
        distance[i + 1] = distance[i] + time_step * speeds[i]
        accelerations[i] = (speeds[i + 1] - speeds[i]) / time_step
    accelerations[N] = 0.0


@kernel
def stopping_need(speed: float, w: Weights) -> float:
    """The distance [m] to somebody in front from which a comfortable stop is possible."""
    need = w.minimum_distance + w.headway * speed
    if w.terminal:
        need += speed * speed / (2.0 * w.deceleration)
    return need


@kernel
def cost(
    distance: Array,
    speeds: Array,
    accelerations: Array,
    gap: Array,
    conflicts: Array,
    calm: Array,
    allowed: Array,
    time_step: float,
    weights: tuple[Any, ...],
) -> tuple[float, float, float]:
    """What a manoeuvre costs [s].

    Args:
        distance: (N + 1,) [m] of the manoeuvre.
        speeds: (N + 1,) [m/s].
        accelerations: (N + 1,) [m/s^2].
        gap: (N,) [m] to the closest person in front at steps 1 ... N.
        conflicts: (N,) persons.
        calm: (N,) [m/s].
        allowed: (N,) [m] that may be driven until then: vehicles, lights.
        time_step: [s].
        weights: the numbers of :class:`Weights`.

    Returns:
        The whole cost; the part of it that other people and vehicles cause; the longest missing
        stopping distance [m].
    """
    w, N = Weights(*weights), len(gap)
    own, others, missing = 0.0, 0.0, 0.0
    for i in range(N):
        v = speeds[i + 1]
        share = v / w.reference_speed
        own += w.time * max(0.0, 1.0 - share) + w.acceleration * accelerations[i] ** 2
        others += w.conflict * conflicts[i]
        others += w.threat * max(0.0, v - calm[i]) / w.reference_speed
        if gap[i] < w.safe_distance:
            others += w.nearness * (1.0 - max(gap[i], 0.0) / w.safe_distance) * share
            lacking = stopping_need(v, w) - gap[i]
            if lacking > 0.0 and v > 0.0:
                others += w.closeness * lacking * share
                missing = max(missing, lacking)
        beyond = distance[i + 1] - allowed[i]
        if beyond > 0.0:
            others += w.closeness * beyond
            missing = max(missing, beyond)
    own = time_step * own + w.final * max(0.0, 1.0 - speeds[N] / w.reference_speed)
    return own + time_step * others, time_step * others, missing


@kernel
def corridor(
    distance: Array,
    speeds: Array,
    gap: Array,
    allowed: Array,
    chosen: bool,
    weights: tuple[Any, ...],
    room: Array,
) -> None:
    """Fill ``room`` (N,) [m]: how far a plan may have driven at steps 1 ... N.

    Behind everybody who is in front of the manoeuvre then: with the stopping distance of its own
    speed where it was chosen by what it leads to, and never less than itself; else with d_safe.
    """
    w = Weights(*weights)
    for i in range(len(gap)):
        station = distance[i + 1] + gap[i]
        if chosen:
            room[i] = max(station - stopping_need(speeds[i + 1], w), distance[i + 1])
        else:
            room[i] = station - w.safe_distance
        room[i] = min(room[i], allowed[i])
