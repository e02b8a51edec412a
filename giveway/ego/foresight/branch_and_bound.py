"""Best-first branch and bound over candidate manoeuvres, in one compiled call.

The candidate with the lowest cost so far is advanced by one prediction step, again and again. A
candidate's cost never falls as it is advanced. Its cost so far is therefore a lower bound, and the
first candidate that reaches the horizon as the cheapest one is the best. Candidates whose first
steps are equal share the predicted crowd of these steps. The result is the same as if every
candidate were evaluated in full.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from controller.kernels import Weights, add_cost_of_others, later_cost, own_cost
from giveway.ego.foresight.assessment import View, assess_step, interval_of
from giveway.ego.foresight.expected_motions import keep_on, step_yielding
from giveway.ego.foresight.later_crossings import fill_later_crossings
from giveway.ego.foresight.threats import Alarm
from giveway.ego.foresight.workspace import Arrays
from giveway.ego.perception.corridor import set_pose
from giveway.geometry.kernel import Array, inlined, inner, kernel
from pedestrian_model.kernels import borrowed, desired_velocity, rollout_step, start

_FINE = -1  # result that says that all predicted states are finite


@kernel
def branch_and_bound(
    path: Arrays,
    people: Arrays,
    law: tuple[Any, ...],
    ego: tuple[Array, int, float],
    sight: tuple[tuple[float, ...], tuple[Any, ...]],
    search: tuple[Arrays, Arrays, NDArray[np.int64], bool],
    judged: tuple[Array, float, tuple[Any, ...]],
) -> tuple[int, bool, int]:
    """Find the cheapest candidate by branch and bound.

    Args:
        path: Vertices, stations and headings of the ego's path.
        people: Arrays of the crowd, as :func:`pedestrian_model.kernels.start` takes them.
        law: Constants of the pedestrian model; positions (M, n, 2) [m] that are predicted already,
            or M = 0; and :attr:`IntentEstimator.yielding`.
        ego: Poses of all vehicles, (M, m, 7), in which the ego's row is changed; index of that
            row; station of the ego's front bumper [m].
        sight: Fields of a ``View`` and of an ``Alarm``.
        search: Arrays of ``Trials``; arrays of a
            :class:`giveway.ego.foresight.workspace.Workspace`; rows to evaluate, as its ``rows_of``
            returns them; and whether to probe, that is, to evaluate the first candidate alone until
            a person or vehicle is in its way, and to accept it at once if none is.
        judged: Distances [m] that may be driven, (N,); speed [m/s] that lost time refers to;
            weights of the cost.

    Returns:
        Row of the cheapest candidate, or -1 if no cost is finite; whether the first candidate was
        accepted at once; number of candidates that were compared.
    """
    (poses, row, front), (view, alarm) = ego, sight
    (trials, memory, rows, probe), (allowed, wanted, weights) = search, judged
    path, people, trials, memory = borrowed((path, people, trials, memory))
    poses, alarm, rows, allowed = borrowed((poses, alarm, rows, allowed))
    distance, speed, acceleration, penalty = trials
    sums, steps, alike, _, ends, later_crossings, bad = memory[3:]
    M, time_step = poses.shape[0], View(*view).time_step
    ahead, scene, scratch = start(people)
    n = ahead.state.position.shape[0]
    bad[0] = _FINE
    steps[:] = -1
    running = np.empty(rows.shape[1], dtype=np.int64)
    count, tried, best, first = 0, 0, -1, rows[0, 0]
    for batch in range(2):
        row_of = 0
        if batch == 1:
            running[0], count = best, 1
            row_of = 1 if sums[2, best] <= 0.0 else 2
        for k in rows[row_of]:
            if k < 0:
                break
            enter(k, distance, speed, steps, alike)
            sums[3, k] = own_cost(speed[k], acceleration[k], wanted, time_step, weights)
            ending = distance[k, -1], speed[k, -1], wanted, allowed, time_step, weights
            without = later_cost(later_crossings[:0], *ending)
            sums[0, k] = sums[3, k] + without
            sums[1, k], sums[2, k] = 0.0, 0.0
            running[count] = k
            count += 1
            tried += 1
        probing = probe and batch == 0
        while True:
            best, least = -1, np.inf
            if probing:
                best = first
                if time_step * sums[1, first] > 0.0:
                    probing = False
                    continue
                if steps[1, first] == M:
                    return first, True, tried
            else:
                for e in range(count):
                    k = running[e]
                    bound = sums[0, k] + time_step * sums[1, k] + penalty[k]
                    if bound < least:
                        best, least = k, bound
                if best < 0 or steps[1, best] == M:
                    break
            bad[0] = advance(
                best,
                path,
                (people, ahead, scene, scratch, law),
                (poses, row, front),
                (view, alarm),
                memory,
                (distance, speed, allowed, weights),
            )
            if bad[0] != _FINE:
                return -1, False, tried
            if steps[1, best] == M:
                fill_ends(memory[0], memory[1], best * M + M - 1, scene, ends[:n])
                end = front + distance[best, -1]
                half_width = View(*view).half_width
                fill_later_crossings(
                    path[0], path[1], end, half_width, ends[:n], later_crossings[:n]
                )
                ending = distance[best, -1], speed[best, -1], wanted, allowed, time_step, weights
                sums[0, best] = sums[3, best] + later_cost(later_crossings[:n], *ending)
        if best < 0:
            break
    return best, False, tried


@inlined
def fill_ends(state: Array, index: NDArray[np.int64], row: int, scene: Any, ends: Array) -> None:
    """Fill ``ends`` (n, 5): positions in a ``row`` of the memory, and desired velocities.

    The columns are x, y [m], the desired velocity [m/s], and the time [s] for which it is kept.
    """
    n = ends.shape[0]
    for p in range(n):
        at = row * n + p
        x, y = state[4 * at], state[4 * at + 1]
        w_x, w_y, until = desired_velocity(x, y, index[at], p, scene)
        ends[p, 0], ends[p, 1], ends[p, 2], ends[p, 3], ends[p, 4] = x, y, w_x, w_y, until


@inner
def enter(
    k: int, distance: Array, speed: Array, steps: NDArray[np.int64], alike: NDArray[np.int64]
) -> None:
    """Set manoeuvre k to its start, and count its leading steps in common with the others.

    Args:
        k: Row of the manoeuvre.
        distance: Distances (k, N + 1) [m] of the manoeuvres.
        speed: Speeds (k, N + 1) [m/s] of the manoeuvres.
        steps: Steps (2, k) that were predicted and assessed; -1 of a manoeuvre not started.
        alike: Number (k, k) of leading steps that two manoeuvres have in common, filled.
    """
    steps[0, k] = steps[1, k] = 0
    for other in range(steps.shape[1]):
        if other == k or steps[0, other] < 0:
            continue
        same, N = 0, distance.shape[1] - 1
        while (
            same <= N
            and distance[k, same] == distance[other, same]
            and speed[k, same] == speed[other, same]
        ):
            same += 1
        alike[k, other] = alike[other, k] = same


@inner
def follow(there: Array, time_step: float, position: Array, velocity: Array) -> None:
    """Move people to where they are predicted, at the mean velocity of this step.

    Args:
        there: Predicted positions (n, 2) [m].
        time_step: Time [s] of the step.
        position: Positions (n, 2) [m], changed.
        velocity: Velocities (n, 2) [m/s], changed.
    """
    for p in range(there.shape[0]):
        for axis in range(2):
            velocity[p, axis] = (there[p, axis] - position[p, axis]) / time_step
            position[p, axis] = there[p, axis]


@inlined
def advance(
    k: int,
    path: Arrays,
    crowd: tuple[Arrays, Any, Any, Any, tuple[Any, ...]],
    ego: tuple[Array, int, float],
    sight: tuple[tuple[float, ...], tuple[Any, ...]],
    memory: Arrays,
    judged: tuple[Array, Array, Array, tuple[Any, ...]],
) -> int:
    """Advance manoeuvre k by one prediction step.

    Returns:
        -1, or the index of a pedestrian whose predicted state is not finite.
    """
    vertices, stations, headings = path
    people, ahead, scene, scratch, law = crowd
    (poses, row, front), (distance, speed, allowed, weights) = ego, judged
    view = sight[0]
    state, index, evaluations, sums, steps, alike, between = memory[:7]
    x, v, at = ahead.state
    M, n, N, every = poses.shape[0], x.shape[0], distance.shape[1] - 1, int(View(*view).every)
    j = steps[0, k]
    here, step = (k * M + j) * n, j * every
    late = step + every - 1
    donor = -1
    for other in range(steps.shape[1]):
        if other != k and steps[0, other] > j and alike[k, other] > late:
            donor = other
    if donor >= 0:
        there = (donor * M + j) * n
        for i in range(4 * n):
            state[4 * here + i] = state[4 * there + i]
        for p in range(n):
            index[here + p] = index[there + p]
    else:
        if j == 0:
            start(people)
        else:
            before = here - n
            for p in range(n):
                base = 4 * (before + p)
                x[p, 0], x[p, 1] = state[base], state[base + 1]
                v[p, 0], v[p, 1] = state[base + 2], state[base + 3]
                at[p] = index[before + p]
        station = front + 0.5 * (distance[k, step] + distance[k, late])
        pace = 0.5 * (speed[k, step] + speed[k, late])
        set_pose((vertices, stations, headings), station, pace, View(*view).length, poses[j, row])
        given = law[-2]
        if given.shape[0] > 0:
            follow(given[j], law[1] * law[2], x, v)
        else:
            bad = rollout_step(ahead, scene, poses[j], scratch, law[:-2])
            if bad != _FINE:
                return bad
        if j > 0:  # step 0 is the walking model's: intent estimation compares people with it
            step_yielding(law[-1], 4 * (here - n), state, scene, x, v)
            creeps, unaware = Weights(*weights).unaware > 0.0, Alarm(*sight[1]).unaware
            keep_on(law[-1], j, people, (creeps, unaware), x, v)
        for p in range(n):
            base = 4 * (here + p)
            state[base], state[base + 1] = x[p, 0], x[p, 1]
            state[base + 2], state[base + 3] = v[p, 0], v[p, 1]
            index[here + p] = at[p]
    steps[0, k] = j + 1
    predicted = state[4 * k * M * n : 4 * (k + 1) * M * n].reshape(M, n, 4)
    begin, end = interval_of(j, every, M, N)
    donor = -1
    for other in range(steps.shape[1]):
        if other != k and steps[1, other] > j and alike[k, other] > end:
            donor = other
    if donor >= 0:
        for which in range(3):
            for i in range(begin, end):
                evaluations[which, k, i] = evaluations[which, donor, i]
    else:
        assess_step(
            (vertices, stations, headings),
            (predicted[j - 1] if j > 0 else people[0], predicted[j], between[:n]),
            (j, M),
            front,
            (distance[k], speed[k]),
            (sight[0], sight[1], Weights(*weights).unaware),
            (evaluations[0, k], evaluations[1, k], evaluations[2, k]),
        )
    for i in range(begin, end):
        so_far, beyond = (sums[1, k], sums[2, k]), distance[k, i + 1] - allowed[i]
        met = evaluations[0, k, i], evaluations[1, k, i], evaluations[2, k, i]
        sums[1, k], sums[2, k] = add_cost_of_others(so_far, speed[k, i + 1], met, beyond, weights)
    steps[1, k] = j + 1
    return _FINE
