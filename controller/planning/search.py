"""The search: which manoeuvre costs least, among driving on, the last plan, and a few others.

A manoeuvre is a path in the plane of time and station, in which everybody who crosses the ego's
corridor occupies a region. To pass before somebody or behind is to pass that region on one side or
the other, so a handful of manoeuvres stands for the choices there are (a small enumeration, as in
Werling et al., ICRA 2010). Since people answer to the ego, each manoeuvre is judged by how the
crowd would move under it.
"""

from math import inf

import numpy as np

from controller._jit import Array
from controller.foresight import Foresight, Manoeuvre, Prospect, Trials
from controller.model import LongitudinalModel
from controller.planning.costs import cost, stopping_need
from controller.planning.motions import aim, approach, shift
from controller.planning.parameters import PlannerParameters, Weights

_DRIVE_ON = 0  # its place among the trials; what was planned is the last
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
        tried: manoeuvres that were compared.
    """

    def __init__(self, model: LongitudinalModel, parameters: PlannerParameters) -> None:
        N, m, v_r = parameters.horizon, parameters.manoeuvres, parameters.reference_speed
        self._manoeuvres, self._time_step = m, model.time_step
        self._weights = Weights.of(parameters, m)
        self.weights = tuple(self._weights)
        self._kinds = [
            (a, share * v_r) for a, share in zip(m.accelerations, m.slowest, strict=True)
        ]
        self._names = [
            "drive on" if a > 0.0 else f"{a:+g} m/s^2 to {least:g} m/s" for a, least in self._kinds
        ]
        self._names += ["up to the end", "as planned"]
        self._last, self.best = Manoeuvre.empty(N), Manoeuvre.empty(N)
        count = len(self._names)
        handicap = np.full(count, m.persistence)
        self._up_to_end, self._as_planned = count - 2, count - 1
        handicap[self._as_planned] = 0.0
        self._trials = Trials.empty(count, N, handicap)
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

        Where the way ends within the horizon, driving up to there is among the first.

        All are tried where the best so far comes too close to somebody. Else, what is best
        changes slowly: besides the plan, driving on and one of the others are tried by turns, so
        that the search stays as quick as the loop.
        """
        kinds = self._kinds
        others = [k for k, (a, least) in enumerate(kinds) if k and (a >= 0.0 or speed > least)]
        self._begin()
        self._turn += 1
        drive_on = not self._planned or self._drives_on or self._turn % 2 == 1
        if drive_on:
            self._aim(_DRIVE_ON, speed, before, fastest)
        if self._planned:
            self._shift(speed)
        ends = allowed[-1] < fastest * self._time_step * len(allowed)
        if ends:
            self._approach(speed, before, fastest, float(allowed[-1]))
        first = [
            *([_DRIVE_ON] if drive_on else []),
            *([self._as_planned] if self._planned else []),
            *([self._up_to_end] if ends else []),
        ]
        if self._compare(first, drive_on, allowed, foresight):
            self._drives_on = True
            return "clear"
        if self._planned and self._missing <= 0.0:
            others = [] if self._turn % 2 else [others[self._turn // 2 % len(others)]]
        elif not drive_on:
            others = [_DRIVE_ON, *others]
        if others:
            for kind in others:
                self._aim(kind, speed, before, fastest)
            self._compare(others, False, allowed, foresight)
        name = self._names[self._best]
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
        self._begin()
        if self._planned:
            self._shift(speed)
        else:
            aim(speed, before, 0.0, 0.0, fastest, *self._limits, *self._trials.of(self._as_planned))
        clear = self._compare([self._as_planned], True, allowed, foresight)
        return "clear" if clear else "as planned"

    @property
    def _limits(self) -> tuple[float, float]:
        return self._manoeuvres.jerk, self._time_step

    def _begin(self) -> None:
        """Forget the comparisons of the step before."""
        self._lowest, self._missing, self.tried, self._best = inf, inf, 0, _DRIVE_ON

    def _aim(self, kind: int, speed: float, before: float, fastest: float) -> None:
        goal = (*self._kinds[kind], fastest)
        aim(speed, before, *goal, *self._limits, *self._trials.of(kind))

    def _approach(self, speed: float, before: float, fastest: float, end: float) -> None:
        goal = self._kinds[_DRIVE_ON][0], end, fastest
        approach(speed, before, *goal, *self._limits, *self._trials.of(self._up_to_end))

    def _shift(self, speed: float) -> None:
        trial, b = self._trials.of(self._as_planned), self._manoeuvres.deceleration
        trial[0][:], trial[1][:] = self._last.distance, self._last.speed
        shift(speed, self._holds, b, self._time_step, *trial)

    def _compare(
        self, trials: list[int], lead: bool, allowed: Array, foresight: Foresight | None
    ) -> bool:
        """Compare some more of the trials with the best so far; the cheapest becomes the best.

        Args:
            trials: which ones; of equal ones the first counts.
            lead: ask first whether anybody is in the way of the first one.
            allowed: (N,) [m] that may be driven.
            foresight: of the crowd, or None.

        Returns:
            Whether it was asked for and nobody is; then that one is the best.
        """
        self.tried += len(trials)
        race = getattr(foresight, "race", None)
        if race is None:
            return self._one_by_one(trials, lead, allowed, foresight)
        known = self.tried > len(trials)
        entrants = [self._best, *trials] if known else trials
        verdict = race(self._trials, entrants, known, lead, allowed, self.weights)
        if verdict.best >= 0 and not (known and verdict.best == self._best):
            self._best, self._lowest, self._missing = verdict.best, verdict.cost, verdict.missing
            self._take(verdict.best, verdict.prospect)
        return lead and bool(verdict.clear)

    def _one_by_one(
        self, trials: list[int], lead: bool, allowed: Array, foresight: Foresight | None
    ) -> bool:
        """Judge each of the trials to its end, whatever model people are believed to walk by."""
        for trial in trials:
            manoeuvre = self._trials.of(trial)
            prospect = Prospect(self._free, self._nobody, self._free)
            if foresight is not None:
                prospect = foresight.prospect(Manoeuvre(*manoeuvre))
            whole, disturbed, missing = cost(
                *manoeuvre, *prospect, allowed, self._time_step, self.weights
            )
            whole += self._trials.handicap[trial]
            if whole < self._lowest:
                self._best, self._lowest, self._missing = trial, whole, missing
                self._take(trial, prospect)
                if foresight is not None:
                    foresight.prefer()
            if lead and trial == trials[0] and disturbed <= 0.0:
                return True
        return False

    def _take(self, trial: int, prospect: Prospect) -> None:
        """Keep the best manoeuvre and what it would lead to."""
        copy(Manoeuvre(*self._trials.of(trial)), self.best)
        self.gap[:], self.conflicts[:], self.calm[:] = prospect

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
