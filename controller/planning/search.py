"""The search: which manoeuvre costs least, among driving on, the last plan, and a few others."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING

import numpy as np

from controller.foresight import Manoeuvre
from controller.planning.manoeuvre import Weights, aim, cost, shift, stopping_need

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from controller.foresight import Foresight
    from controller.model import LongitudinalModel
    from controller.planning.parameters import PlannerParameters

    Array = NDArray[np.float64]

_WORSE = 1e-6  # [m] by which a smoothed plan may come closer than the manoeuvre it follows


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
        self._last.copy_from(plan)
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
        trial.copy_from(self._last)
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
            self.best.copy_from(trial)
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
