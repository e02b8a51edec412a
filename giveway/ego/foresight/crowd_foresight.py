"""Predicts the outcome of a manoeuvre: the crowd's motion under it, as seen from the ego."""

from math import inf
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from controller import Evaluation, Manoeuvre, WorstMotion
from controller.driving_constants import CREEPS_NEARER
from controller.kernels import Batches, SearchResult, Trials
from giveway.ego.foresight.assessment import View, assess
from giveway.ego.foresight.branch_and_bound import branch_and_bound
from giveway.ego.foresight.contingency import BRANCHES, hedged
from giveway.ego.foresight.expected_motions import Yielding
from giveway.ego.foresight.intent import AlternativeHypothesis, IntentEstimator
from giveway.ego.foresight.later_crossings import fill_later_crossings
from giveway.ego.foresight.threats import ALL_SEE, Alarm
from giveway.ego.foresight.workspace import Workspace
from giveway.ego.perception.corridor import fill_poses
from giveway.ego.perception.kerbs import NO_KERBS, kerb_lines
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from pedestrian_model import (
    LONGEST_STEP,
    Crowd,
    CrowdPredictor,
    ParameterError,
    Predictor,
    Surroundings,
    VciParameters,
    require_steady,
)

_STEP = 0.1  # longest prediction step [s] of the crowd: twice the usual step of its simulation

_Judged = tuple[Array, float, tuple[Any, ...]]  # allowed distances, wanted speed, weights


def steps_at_once(time_step: float, horizon: int) -> int:
    """Return the number of a manoeuvre's steps in one prediction step of the crowd."""
    return min(max(1, int(_STEP / time_step + 1e-9)), horizon)


def plan_predictor(
    parameters: VciParameters, time_step: float, horizon: int, **readings: bool
) -> Predictor:
    """Return a predictor of the crowd for plans of ``horizon`` steps of ``time_step`` [s].

    A prediction step covers as many steps of a plan as fit into 0.1 s. It is integrated in one
    step, or in shorter ones if speeds would oscillate otherwise.

    Args:
        parameters: Parameters of the pedestrian model.
        time_step: Time step of the manoeuvres [s].
        horizon: Number N of a manoeuvre's steps.
        readings: Options of :class:`pedestrian_model.Predictor`.
    """
    every = steps_at_once(time_step, horizon)
    step, longest = every * time_step, _STEP
    try:
        require_steady(parameters, step, longest)
    except ParameterError:
        longest = LONGEST_STEP
    return Predictor(parameters, step, horizon // every, longest_step=longest, **readings)


class EgoAssumptions(NamedTuple):
    """The ego's body and brakes, and the motions of people that it prepares for."""

    shape: VehicleShape  # length and width of the body
    half_width: float  # half width [m] of the corridor
    clearance: float  # distance [m] that the safety layer keeps to pedestrians' bodies
    braking: float  # largest deceleration [m/s^2]
    worst: WorstMotion | None  # motion that the safety layer assumes; None without such a layer
    late: float = 0.0  # time [s] by which the brake acts later than in the next step


class CrowdForesight:
    """Predicts the crowd under one manoeuvre after the other.

    It keeps a copy of the vehicles' poses, so that other egos do not see the manoeuvres.

    Args:
        predictor: Predictor of M steps. Each covers a whole number of a manoeuvre's steps.
        path: Path of the ego.
        ego: Body and brakes of the ego, and the motions of people that it prepares for.
        horizon: Number N of a manoeuvre's steps.
        time_step: Time step of a manoeuvre [s].
        estimator: Intent estimator, or None to assume that all people walk on.
    """

    def __init__(
        self,
        predictor: CrowdPredictor,
        path: EgoPath,
        ego: EgoAssumptions,
        *,
        horizon: int,
        time_step: float,
        estimator: IntentEstimator | None = None,
    ) -> None:
        N, M = horizon, predictor.horizon
        every = round(predictor.time_step / time_step)
        self._predictor, self._every = predictor, every
        self._way = path.vertices, path.stations, path.headings
        shape, half_width, clearance, braking, worst, late = ego
        self._view = tuple(View(shape.length, shape.width, half_width, time_step, every))
        walking = predictor.parameters
        able = worst or WorstMotion(walking.max_acceleration, walking.max_speed)
        self._limits = Alarm(
            walking.body_radius,
            clearance,
            able.acceleration,
            able.speed,
            braking,
            worst is not None,
            min(able.setting_out, able.acceleration),
            late,
        )
        self._alarm = tuple(self._limits)
        self._clearance, self._off = clearance, 0.0
        self._estimator, self._soon = estimator, np.empty(0)
        self._length = shape.length
        self._distance, self._speed = np.empty(N + 1), np.empty(N + 1)
        self._evaluation = Evaluation(*np.zeros((3, N)))
        self._predicted = np.empty((M, 0, 2))
        self._best = np.empty((M, 0, 2))
        self._poses = np.empty((M, 0, 7))
        self._copied, self._preferred = False, False
        self._alternative: AlternativeHypothesis | None = None
        self._winner = -1  # row of the best manoeuvre of the latest search, in the workspace
        self._workspace = self._aside = Workspace(0, N, M, 0)
        # Only VCI is part of the compiled search. With other models manoeuvres are judged singly.
        self._vci = predictor if isinstance(predictor, Predictor) else None
        self.cheapest = self._cheapest if self._vci is not None else None

    def look(
        self,
        pedestrians: Crowd,
        surroundings: Surroundings,
        ego: tuple[Array, int, float],
        off: float = 0.0,
        kerbs: Array = NO_KERBS,
        numbers: NDArray[np.int64] | None = None,
    ) -> None:
        """Begin a control instant.

        Args:
            pedestrians: Pedestrians to be predicted. The routes of those who yield are changed.
            surroundings: Walls and lights that the pedestrians heed.
            ego: Poses (N, m, 7) of all vehicles at steps 0 ... N-1, not changed; row of the ego
                in them; station of its front bumper [m].
            off: Largest error [m] of people's positions that the clearance does not cover.
            kerbs: Kerbs (n, 3) of people on sidewalks, as
                :meth:`giveway.ego.perception.kerbs.Kerbs.of` returns them.
            numbers: Numbers (n,) that identify persons from step to step, or None if they cannot
                be identified.
        """
        if off != self._off:
            self._off = off
            self._limits = self._limits._replace(clearance=self._clearance + off)
        if self._estimator is not None and numbers is not None:
            self._alternative = self._estimator.update_both(
                pedestrians, numbers, ego[2], self._soon
            )
            self._yielding, self._soon = self._estimator.yielding, self._soon[:0]
            unaware = self._estimator.unaware
        else:
            self._alternative, unaware = None, ALL_SEE
            self._yielding = np.zeros(len(pedestrians), dtype=np.int8), 0.0, 1.0, 0.0
        self._alarm = (*self._limits[:-2], kerb_lines(pedestrians.position, kerbs), unaware)
        self._pedestrians, self._surroundings = pedestrians, surroundings
        self._given, self._row, self._front = ego
        self._copied, self._preferred = False, False
        self._winner = -1

    @property
    def best(self) -> Array | None:
        """The positions (N, n, 2) [m] at steps 1 ... N under the preferred manoeuvre, or None.

        Positions between two prediction steps are interpolated on straight lines.
        """
        if self._winner < 0 and not self._preferred:
            return None
        people, row = self._pedestrians.position, self._winner
        known = self._best if row < 0 else self._workspace.positions(row, len(people))
        known = np.concatenate([people[None], known])
        after = np.minimum(np.arange(1, len(self._distance)) / self._every, len(known) - 1.0)
        before = np.minimum(after.astype(np.int64), len(known) - 2)
        share = (after - before)[:, None, None]
        return np.asarray((1.0 - share) * known[before] + share * known[before + 1])

    def evaluate(self, manoeuvre: Manoeuvre, *, creeps: bool = False) -> Evaluation:
        """Return the predicted outcome of a manoeuvre, which is valid until the next call.

        Args:
            manoeuvre: Motion of the ego.
            creeps: Whether it creeps towards people, who count as nearer if they may not see it.
        """
        self._predict(manoeuvre.distance, manoeuvre.speed)
        assess(
            self._way,
            (self._pedestrians.position, self._predicted),
            self._front,
            (manoeuvre.distance, manoeuvre.speed),
            (self._view, self._alarm, CREEPS_NEARER if creeps else 0.0),
            self._evaluation[:3],
        )
        wishes = self._predictor.desired_velocities(self._pedestrians, self._surroundings)
        later_crossings = np.empty((len(wishes), 4))
        fill_later_crossings(
            *self._way[:2],
            self._front + manoeuvre.distance[-1],
            self._view[2],
            np.column_stack([self._predicted[-1], wishes]),
            later_crossings,
        )
        return self._evaluation._replace(later_crossings=later_crossings)

    def _cheapest(
        self,
        trials: Trials,
        batches: Batches,
        probe: bool,
        allowed: Array,
        wanted: float,
        weights: tuple[Any, ...],
    ) -> SearchResult:
        """Return the cheapest manoeuvre; see :class:`controller.foresight.SearchingForesight`.

        Raises:
            DivergenceError: a predicted state is not finite.
        """
        if not self._copied:
            self._copy()
        n, workspace = len(self._pedestrians), self._workspace
        if workspace.people < n or workspace.count < len(trials.penalty):
            workspace = self._workspace = Workspace(
                len(trials.penalty), len(allowed), len(self._poses), n
            )
        searched, whom = (workspace, trials, batches), (self._pedestrians, self._yielding)
        judged, other = (allowed, wanted, weights), self._alternative
        if other is not None:
            best, clear, tried = self._hedge(*searched, judged, other)
        else:
            best, clear, tried = self._run(*searched, probe, judged, *whom)
        if best >= 0:
            self._winner = best
            self._soon = workspace.soon(best, n)
        return workspace.result(best, clear, tried)

    def _run(
        self,
        workspace: Workspace,
        trials: Trials,
        batches: Batches,
        probe: bool,
        judged: _Judged,
        people: Crowd,
        yielding: Yielding,
    ) -> tuple[int, bool, int]:
        """Run :func:`branch_and_bound` with people who behave as one of the hypotheses says."""
        vci = self._vci
        assert vci is not None  # other models have no compiled search
        ended: tuple[int, bool, int] = branch_and_bound(
            self._way,
            vci.arrays(people, self._surroundings),
            (*vci.law, vci.given(people), yielding),
            (self._poses, self._row, self._front),
            (self._view, self._alarm),
            (tuple(trials), workspace.arrays, workspace.rows_of(batches), probe),
            judged,
        )
        if workspace.bad >= 0:
            raise vci.divergence(people, workspace.bad)
        return ended

    def _hedge(
        self,
        workspace: Workspace,
        trials: Trials,
        batches: Batches,
        judged: _Judged,
        other: AlternativeHypothesis,
    ) -> tuple[int, bool, int]:
        """Run the search over both hypotheses, for people whose intent is uncertain."""
        time_step, n = View(*self._view).time_step, len(other.people)
        if self._aside.people < n:  # outcomes under the other hypothesis have their own workspace
            self._aside = Workspace(BRANCHES, len(judged[0]), len(self._poses), n)
        likelier, less = (workspace, self._pedestrians, self._yielding), (self._aside, *other[:2])

        def cost(trials: Trials, rows: list[int], alternative: bool) -> float:
            among, people, yielding = less if alternative else likelier
            searched = among, trials, Batches(tuple(rows), (), ())
            best, _, _ = self._run(*searched, False, judged, people, yielding)
            own, others = among.arrays[3][:2, best]
            return float(own + time_step * others + trials.penalty[best]) if best >= 0 else inf

        rows = list(dict.fromkeys([*batches.first, *batches.content, *batches.wanting]))
        return hedged(cost, trials, rows, other.likely, judged[1], time_step), False, 1

    def prefer(self) -> None:
        """Keep the positions under the latest manoeuvre as those of the preferred one."""
        if self._best.shape != self._predicted.shape:
            self._best = np.empty_like(self._predicted)
        self._best[:] = self._predicted
        self._preferred = True

    def _predict(self, distance: Array, speed: Array) -> None:
        if not self._copied:
            self._copy()
        fill_poses(
            self._way,
            self._front,
            self._middle(distance),
            self._middle(speed),
            self._length,
            self._row,
            self._poses,
        )
        self._predicted = self._predictor.predict(
            self._pedestrians, self._poses, self._surroundings
        )

    def _middle(self, values: Array) -> Array:
        """The mean (M,) of the first and last value in each prediction step."""
        every, end = self._every, len(self._poses) * self._every
        return np.asarray(0.5 * (values[:end:every] + values[every - 1 : end : every]))

    def _copy(self) -> None:
        """Copy the poses of this instant."""
        M, vehicles = len(self._poses), self._given.shape[1]
        if self._poses.shape[1] != vehicles:
            self._poses = np.empty((M, vehicles, 7))
        self._poses[:] = self._given[: M * self._every : self._every]
        self._copied = True
