"""The search for the manoeuvre of least cost, among driving on, the last plan and a few others.

A manoeuvre is a curve in the plane of time and station. Each person who crosses the ego's corridor
occupies a region of this plane, and the ego passes it on one side or the other. A few manoeuvres
are therefore enough to cover the choices (a small enumeration, as in Werling et al., ICRA 2010).
People react to the ego, so each manoeuvre is evaluated by how the crowd would move under it.
"""

from bisect import bisect_left
from math import inf

import numpy as np

from controller._jit import Array, kernel
from controller.actuator import Ahead
from controller.foresight import Batches, Evaluation, Foresight, Manoeuvre, Trials
from controller.model import LongitudinalModel
from controller.planning.costs import cost, cost_of_blocking
from controller.planning.motions import aim, approach, shift
from controller.planning.parameters import PlannerParameters, Weights

_DRIVE_ON = 0  # row of driving on among the trials; the last plan has the last row


class Search:
    """Compares manoeuvres, and remembers the last plan.

    Args:
        model: Longitudinal model of the vehicle.
        parameters: Horizon, manoeuvres and weights.
        dead_steps: Number of steps until a force begins to act.

    Attributes:
        weights: Weights of the cost, a plain tuple of the fields of :class:`Weights`.
        creeps: Whether the ego may come nearer to people in front, :meth:`creep`.
        best: Distance, speed and acceleration of the manoeuvre of least cost, from where a force
            begins to act. This and what follows is valid until the next search.
        gap: Gaps (N,) [m] of its predicted outcome, as in :class:`Evaluation`.
        threat_free: Threat-free speeds (N,) [m/s], as in :class:`Evaluation`.
        passing: Passing speeds (N,) [m/s], as in :class:`Evaluation`.
        missing: Largest part [m] of the stopping distance for which it has no room.
        tried: Number of manoeuvres that were compared.
        jerks: Jerks [m/s^3] with which accelerations of manoeuvres fall and rise.
        goals: Wanted acceleration [m/s^2] of each kind of manoeuvre, and the speed [m/s] at which
            it ends, (k, 2).
    """

    def __init__(
        self, model: LongitudinalModel, parameters: PlannerParameters, dead_steps: int = 0
    ) -> None:
        N, m, v_r = parameters.horizon, parameters.manoeuvres, parameters.reference_speed
        self._manoeuvres, self._time_step = m, model.time_step
        self.jerks, self._dead_steps = (m.jerk, m.jerk), dead_steps
        usual = Weights.of(parameters, m)
        self._weights = tuple(usual), tuple(usual.creeping())
        # Lost time refers to at least half of v_r, also where a bend or a light allows less.
        self._slowest = 0.5 * v_r
        self._kinds = [
            (a, share * v_r) for a, share in zip(m.accelerations, m.slowest, strict=True)
        ]
        self._names = [f"{a:+g} m/s^2 to {end:g} m/s" for a, end in self._kinds]
        self._names[_DRIVE_ON] = "drive on"
        self._names += ["up to the end", "as planned"]
        self.goals = np.array(self._kinds)
        # Braking to a speed is tried only from a higher one. The index of _others counts the
        # target speeds below the present speed.
        self._slower = sorted({least for a, least in self._kinds if a < 0.0})
        self._others = [
            tuple(
                k for k, (a, least) in enumerate(self._kinds) if k and (a >= 0.0 or least in lower)
            )
            for lower in (self._slower[:count] for count in range(len(self._slower) + 1))
        ]
        self._last = Manoeuvre.empty(N)
        count = len(self._names)
        penalty = np.full(count, m.persistence)
        self._up_to_end, self._as_planned = count - 2, count - 1
        penalty[self._as_planned] = 0.0
        self._penalty, self._charged = penalty, False
        self._trials = Trials.empty(count, N, penalty.copy())
        self._motions = (self._trials.distance, self._trials.speed, self._trials.acceleration)
        self._each = [self._trials.of(trial) for trial in range(count)]
        # The motions from where a force begins to act; the trials begin now
        x, v, a = self._motions
        self._later = (x.copy(), v.copy(), a.copy()) if dead_steps else self._motions
        self.gap, self.threat_free, self.passing = np.full((3, N), inf)
        self._free = np.full(N, inf)
        self._take(_DRIVE_ON)
        self.reset()

    def reset(self) -> None:
        """Forget the last plan and the results."""
        self.creep(False)
        self._planned, self._holds, self._drives_on = False, True, True
        self._turn, self.tried, self.missing = 0, 0, inf

    @property
    def least(self) -> float:
        """The distance [m] kept to people in front who see the ego."""
        return Weights(*self.weights).minimum_distance

    def creep(self, creeps: bool) -> None:
        """Let the ego stop nearer to people in front from now on, or no longer."""
        self.creeps, self.weights = creeps, self._weights[creeps]

    def keep(self, plan: Manoeuvre, holds: bool) -> None:
        """Remember a plan, which is tried again at the next step.

        Args:
            plan: Plan; its arrays are read at the next step.
            holds: Whether a stop stays possible if its last speed is kept.
        """
        self._last, self._planned, self._holds = plan, True, holds

    def choose(
        self,
        speed: float,
        before: float,
        fastest: float,
        allowed: Array,
        foresight: Foresight | None,
        end: float,
        to_clear: float = 0.0,
        ahead: Ahead | None = None,
    ) -> str:
        """Choose the manoeuvre of least cost, and return its name.

        The last plan is tried at every step. Driving on and one of the others are tried by turns,
        because the best manoeuvre changes slowly. All are tried if the best of them comes too
        close to a person or a vehicle.

        Args:
            speed: Speed [m/s] where a force begins to act: now, without a dead time.
            before: Acceleration before [m/s^2].
            fastest: Speed [m/s] with nobody in the way.
            allowed: Distances (N,) [m] that may be driven until steps 1 ... N.
            foresight: Foresight of the crowd, or None if nobody can get in the way.
            end: Distance [m] from there to the end of the way. If it is within the horizon,
                driving up to it is tried as well.
            to_clear: Keep-clear distance [m]. To stand within it costs extra.
            ahead: Motion until a force begins to act, or None without a dead time.
        """
        planned = self._planned
        others = self._others[bisect_left(self._slower, speed)]
        self._turn += 1
        drive_on = not planned or self._drives_on or self._turn % 2 == 1
        ends = bool(end < fastest * self._time_step * len(allowed))
        first = (_DRIVE_ON,) * drive_on + (self._as_planned,) * planned + (self._up_to_end,) * ends
        content = others
        if planned:
            content = () if self._turn % 2 else (others[self._turn // 2 % len(others)],)
        batches = Batches(first, content, others if drive_on else (_DRIVE_ON, *others))
        self._lay_out(speed, before, fastest, end if ends else inf)
        if self._dead_steps and ahead is not None:
            self._prepend(ahead)
        if to_clear > 0.0 or self._charged:
            self._charge(fastest, min(to_clear, float(allowed[-1])))
        if self._compare(batches, drive_on, fastest, allowed, foresight):
            self._drives_on = True
            return "clear"
        name = self._names[self._best]
        self._drives_on = name == "drive on"
        return name

    def _lay_out(self, speed: float, before: float, fastest: float, end: float) -> None:
        """Fill all trials, for a way that ends after ``end`` [m]."""
        m, last = self._manoeuvres, self._last
        lay_out(
            (speed, before, fastest, end, *self.jerks, m.deceleration, self._time_step),
            self.goals,
            self._planned,
            self._holds,
            (last.distance, last.speed),
            self._later,
        )

    def _prepend(self, ahead: Ahead) -> None:
        """Fill the trials: the motion until a force begins to act, and then each manoeuvre."""
        d = self._dead_steps
        distance, speed, acceleration = self._motions
        for whole, later in zip(self._motions, self._later, strict=True):
            whole[:, d:] = later[:, : whole.shape[1] - d]
        distance[:, d:] += ahead.travel
        distance[:, :d], speed[:, :d] = ahead.travels[:d], ahead.speeds[:d]
        acceleration[:, :d] = np.diff(ahead.speeds) / self._time_step

    def from_there(self, ahead: Ahead) -> None:
        """Let the outcome of the best manoeuvre begin where a force begins to act.

        What is beyond the horizon stays as it is at its end.
        """
        d = self._dead_steps
        whole, later = self._motions[0][self._best], self._later[0][self._best]
        beyond = self.gap[-1] + whole[-1] - (ahead.travel + later[-d:])
        self.gap = np.concatenate([self.gap[d:], beyond])
        self.threat_free = postponed(self.threat_free, d)
        self.passing = postponed(self.passing, d)
        self.best = tuple(motion[self._best] for motion in self._later)

    def _charge(self, fastest: float, to_clear: float) -> None:
        """Add the cost of standing within the first ``to_clear`` [m] to each trial's penalty."""
        self._charged = to_clear > 0.0
        penalty = self._trials.penalty
        penalty[:] = self._penalty
        if self._charged:
            distance, speeds, _ = self._motions
            wanted = max(fastest, self._slowest)
            cost_of_blocking(distance, speeds, wanted, to_clear, self._time_step, penalty)

    def _compare(
        self,
        batches: Batches,
        probe: bool,
        fastest: float,
        allowed: Array,
        foresight: Foresight | None,
    ) -> bool:
        """Find the cheapest of the trials, and keep it with its predicted outcome.

        Args:
            batches: Rows of the trials that are compared.
            probe: Whether the first one is evaluated alone first.
            fastest: Speed [m/s] with nobody in the way.
            allowed: Distances (N,) [m] that may be driven.
            foresight: Foresight of the crowd, or None.

        Returns:
            Whether the first one was accepted at once, because nobody is in its way.
        """
        wanted = max(fastest, self._slowest)
        cheapest = getattr(foresight, "cheapest", None)
        if cheapest is None:
            return self._one_by_one(batches, probe, wanted, allowed, foresight)
        result = cheapest(self._trials, batches, probe, allowed, wanted, self.weights)
        self.tried, self.missing = result.tried, result.missing
        if result.best >= 0:
            self._take(result.best)
            self.gap, self.threat_free, self.passing, _ = result.evaluation
        return bool(result.clear)

    def _one_by_one(
        self,
        batches: Batches,
        probe: bool,
        wanted: float,
        allowed: Array,
        foresight: Foresight | None,
    ) -> bool:
        """Evaluate each of the trials in full, for pedestrian models without a compiled search."""
        self.tried, self.missing, lowest = 0, inf, inf
        for batch in (0, 1):
            if batch == 0:
                trials = batches.first
            else:
                trials = batches.content if self.missing <= 0.0 else batches.wanting
            self.tried += len(trials)
            for trial in trials:
                manoeuvre = self._trials.of(trial)
                evaluation = Evaluation(self._free, self._free, self._free)
                if foresight is not None:
                    evaluation = foresight.evaluate(Manoeuvre(*manoeuvre), creeps=self.creeps)
                whole, disturbed, missing = cost(
                    manoeuvre,
                    evaluation,
                    allowed,
                    wanted,
                    self._time_step,
                    self.weights,
                )
                whole += self._trials.penalty[trial]
                if whole < lowest:
                    lowest, self.missing = whole, missing
                    self._take(trial)
                    self.gap, self.threat_free, self.passing = (a.copy() for a in evaluation[:3])
                    if foresight is not None:
                        foresight.prefer()
                if probe and disturbed <= 0.0 and trial == batches.first[0]:
                    return True
        return False

    def _take(self, trial: int) -> None:
        """Keep a trial as the best one."""
        self._best, self.best = trial, self._each[trial]


def postponed(values: Array, steps: int) -> Array:
    """Return ``values`` (N,) from ``steps`` steps later on; the last one stays to the end."""
    return np.concatenate([values[steps:], np.full(steps, values[-1])])


@kernel
def lay_out(
    state: tuple[float, ...],
    goals: Array,
    planned: bool,
    holds: bool,
    last: tuple[Array, Array],
    motions: tuple[Array, Array, Array],
) -> None:
    """Fill all trials: each kind of manoeuvre, driving up to the end, and the last plan.

    Args:
        state: Speed [m/s], acceleration before [m/s^2], wanted speed [m/s], distance to the end of
            the way [m] (inf without this trial), jerks [m/s^3] with which accelerations fall and
            rise, deceleration b [m/s^2], and time step [s].
        goals: Wanted acceleration [m/s^2] and speed [m/s] at which braking ends, (k, 2).
        planned: Whether there is a last plan. If not, the last trial keeps the speed.
        holds: Whether the last speed of this plan is kept beyond its horizon.
        last: Distances [m] and speeds [m/s] of this plan.
        motions: Distances, speeds and accelerations, (k + 2, N + 1) each, filled.
    """
    speed, before, fastest, end, falls, rises, b, time_step = state
    jerks = falls, rises
    distance, speeds, accelerations = motions
    k = goals.shape[0]
    aim(speed, before, goals, fastest, jerks, time_step, motions)
    if np.isfinite(end):
        to = (distance[k], speeds[k], accelerations[k])
        approach(speed, before, end, (goals[0, 0], fastest, jerks), time_step, to)
    k += 1
    to = (distance[k], speeds[k], accelerations[k])
    if planned:
        for i in range(distance.shape[1]):
            distance[k, i], speeds[k, i] = last[0][i], last[1][i]
        shift(speed, holds, b, time_step, to)
    else:
        keeping = distance[k:], speeds[k:], accelerations[k:]
        aim(speed, before, np.zeros((1, 2)), fastest, jerks, time_step, keeping)
