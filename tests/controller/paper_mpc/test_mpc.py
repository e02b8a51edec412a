"""The MPC against independent exact solvers: every plan, and every "there is none"."""

from __future__ import annotations

import numpy as np
import pytest

from controller import (
    LongitudinalModel,
    Mpc,
    MpcParameters,
    ParameterError,
)

SOLVERS = ("osqp", "daqp")
FORCE_TOLERANCE = 0.05  # [N] of 8000; we ask for 1 N, the bounds' slack is worth 2e-5 N a row


def check(mpc, problem, edge):
    """Solve and compare; returns whether there is a plan, or None on the knife's edge."""
    arguments = (
        problem.position,
        problem.speed,
        problem.previous_force,
        problem.obstacle_positions,
    )
    solution = mpc.solve(*arguments)
    U = problem.forces()
    if solution.found is not (U is not None):
        assert abs(problem.margin()) < edge, (solution.status, arguments)
        return None
    if not solution.found:
        assert solution.status.startswith("infeasible: "), arguments
        assert np.isnan(solution.force)
        assert solution.forces is None
        assert solution.speeds is None
        return False
    assert solution.status == "solved"
    assert solution.force == solution.forces[0]
    assert solution.residual <= 1.0
    per_tonne = problem.model.mass / 1000.0
    assert abs(solution.force - U[0]) < FORCE_TOLERANCE * per_tonne, arguments
    forces, speeds = solution.forces, solution.speeds
    before = np.concatenate([[problem.speed], speeds[:-1]])
    driven = problem.model.decay * before + problem.model.speed_per_force * forces
    np.testing.assert_allclose(driven, speeds, atol=1e-9)
    np.testing.assert_allclose(forces, U, atol=20.0 * FORCE_TOLERANCE * per_tonne)
    return True


def test_thousands_of_problems_are_solved_exactly(draw, edge):
    model, parameters = LongitudinalModel(), MpcParameters()
    mpc, generator = Mpc(model, parameters), np.random.default_rng(1)
    judged = [check(mpc, draw(generator, model, parameters), edge) for _ in range(2100)]
    assert judged.count(True) > 700
    assert judged.count(False) > 700
    assert judged.count(None) < 10


@pytest.mark.parametrize(
    ("horizon", "count"), [(2, 400), (3, 400), (5, 400), (10, 300), (20, 150), (30, 80), (50, 25)]
)
def test_every_horizon(horizon, count, draw, edge):
    model, parameters = LongitudinalModel(), MpcParameters(horizon=horizon)
    mpc, generator = Mpc(model, parameters), np.random.default_rng(horizon)
    judged = [check(mpc, draw(generator, model, parameters), edge) for _ in range(count)]
    assert judged.count(True) > count // 4
    assert judged.count(False) > count // 20


@pytest.mark.parametrize(
    ("mass", "friction", "time_step"),
    [
        (1000.0, 0.0, 0.05),
        (300.0, 3000.0, 0.1),  # decay 0
        (300.0, 2000.0, 0.1),
        (40000.0, 4000.0, 0.001),  # a newton moves it by 2.5e-8 m/s a step
        (1500.0, 100.0, 0.01),
        (1000.0, 100.0, 0.5),
    ],
)
def test_every_vehicle(mass, friction, time_step, draw, edge):
    model = LongitudinalModel(mass, friction, time_step)
    parameters = MpcParameters(
        force_limit=8.0 * mass, force_rate_limit=mass * min(8.0, 20.0 * time_step)
    )
    mpc, generator = Mpc(model, parameters), np.random.default_rng(7)
    judged = [check(mpc, draw(generator, model, parameters), edge) for _ in range(200)]
    assert judged.count(True) > 30
    assert judged.count(False) > 10


@pytest.mark.parametrize("offset", [-1.0, -1e-2, -1e-4, -1e-5, 1e-5, 1e-4, 1e-2, 1.0])
def test_the_edge_of_feasibility_is_found_to_ten_micrometres(offset, draw, reference):
    """The LP tells how far all obstacles may come closer; there, a hair decides."""
    model, parameters = LongitudinalModel(), MpcParameters()
    mpc, generator = Mpc(model, parameters), np.random.default_rng(11)
    decided = 0
    while decided < 25:
        problem = draw(generator, model, parameters)
        spare = problem.margin(only_positions=True)
        if not abs(spare) < 100.0:  # nobody in front, or infeasible whoever is
            continue
        moved = problem.obstacle_positions - spare + offset
        solution = mpc.solve(problem.position, problem.speed, problem.previous_force, moved)
        assert solution.found is (offset > 0.0), (solution.status, problem)
        if solution.found:
            exact = reference(
                model, parameters, problem.position, problem.speed, problem.previous_force, moved
            ).forces()
            assert abs(solution.force - exact[0]) < FORCE_TOLERANCE
        decided += 1


def test_agrees_with_a_solver_of_another_family(draw):
    model = LongitudinalModel()
    mpc, generator = Mpc(model, MpcParameters()), np.random.default_rng(5)
    compared = 0
    while compared < 80:
        problem = draw(generator, model, MpcParameters())
        if not problem.margin() > 1e-3:
            continue
        solution = mpc.solve(
            problem.position, problem.speed, problem.previous_force, problem.obstacle_positions
        )
        U = problem.forces_by_least_distance()
        assert solution.force == pytest.approx(U[0], abs=0.05)
        compared += 1


@pytest.mark.parametrize(
    ("speed", "previous", "gap", "status"),
    [
        (4.0, 0.0, 8.19, "infeasible: too close"),  # x_1(k+1) = 0.2 m, whatever u
        (4.0, 0.0, 8.3, "infeasible: speed bounds"),  # c6 of x_1(k+2) against c2
        (4.0, 400.0, 8.9, "infeasible: cannot stop"),
        (20.0, 8000.0, np.inf, "infeasible: speed bounds"),  # cannot ease off before v_max
        (0.01, -8000.0, np.inf, "infeasible: speed bounds"),  # nor release before v_min
        (0.6, -8000.0, np.inf, "infeasible: cannot hold speed"),
    ],
)
def test_says_why_there_is_no_plan(speed, previous, gap, status, reference):
    model, parameters = LongitudinalModel(), MpcParameters()
    x_p = np.full(15, gap)
    solution = Mpc(model, parameters).solve(0.0, speed, previous, x_p)
    assert solution.status == status
    assert solution.iterations == 0
    assert reference(model, parameters, 0.0, speed, previous, x_p).margin() < 0.0


def test_a_pedestrian_at_the_safe_distance_of_a_standing_car():
    solution = Mpc(LongitudinalModel()).solve(0.0, 0.0, 0.0, np.full(15, 8.0))
    assert solution.found
    assert solution.force == pytest.approx(0.0, abs=1e-3)


def test_nobody_in_front_means_the_reference_speed():
    solution = Mpc(LongitudinalModel()).solve(0.0, 4.0, 400.0, np.full(15, np.inf))
    assert solution.force == pytest.approx(400.0, abs=1e-6)  # alpha v_r
    np.testing.assert_allclose(solution.speeds, 4.0, atol=1e-9)


def test_the_weight_does_not_move_the_optimum():
    problem = (0.0, 5.0, 0.0, np.full(15, 14.0))
    force = Mpc(LongitudinalModel()).solve(*problem).force
    weighted = Mpc(LongitudinalModel(), MpcParameters(speed_weight=1e4)).solve(*problem)
    assert weighted.force == pytest.approx(force, abs=1e-6)


def test_equal_problems_give_equal_bytes_whatever_came_before(draw):
    model, parameters = LongitudinalModel(), MpcParameters()
    generator = np.random.default_rng(3)
    problems = [draw(generator, model, parameters) for _ in range(150)]

    def answers(mpc):
        solutions = [
            mpc.solve(p.position, p.speed, p.previous_force, p.obstacle_positions) for p in problems
        ]
        return [
            (s.status, s.iterations, np.float64(s.force).tobytes(), s.forces is None)
            for s in solutions
        ]

    mpc = Mpc(model, parameters)
    first = answers(mpc)
    assert mpc.solve(0.0, 4.0, 400.0, np.full(15, 10.2)).found  # with many constraints active
    mpc.reset()
    assert answers(mpc) == first
    assert answers(Mpc(model, parameters)) == first


def test_a_plan_outlives_the_next_solve():
    mpc = Mpc(LongitudinalModel())
    plan = mpc.solve(0.0, 4.0, 400.0, np.full(15, np.inf)).forces
    kept = plan.copy()
    mpc.solve(0.0, 1.0, 0.0, np.full(15, 9.0))
    np.testing.assert_array_equal(plan, kept)


def test_the_solver_is_silent(capfd):
    for mpc in (Mpc(LongitudinalModel(), MpcParameters()),):
        mpc.solve(0.0, 4.0, 400.0, np.full(15, 10.5))
        mpc.solve(0.0, 4.0, 400.0, np.full(15, 8.5))
    assert capfd.readouterr() == ("", "")


def test_refuses_a_problem_of_another_horizon():
    with pytest.raises(ParameterError, match="obstacle_positions has 14 entries: expected 15"):
        Mpc(LongitudinalModel()).solve(0.0, 4.0, 0.0, np.full(14, np.inf))


@pytest.mark.parametrize("place", range(4))
def test_refuses_what_is_no_number(place):
    arguments = [0.0, 4.0, 0.0, np.full(15, np.inf)]
    arguments[place] = np.nan if place < 3 else np.full(15, np.nan)
    with pytest.raises(ParameterError, match="expected numbers"):
        Mpc(LongitudinalModel()).solve(*arguments)


def test_refuses_a_step_too_long_for_forward_euler():
    with pytest.raises(ParameterError, match=r"friction \* time_step / mass = 2"):
        Mpc(LongitudinalModel(mass=100.0, friction=2000.0, time_step=0.1))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("horizon", 1),
        ("horizon", 15.0),
        ("reference_speed", 0.0),
        ("safe_distance", -1.0),
        ("speed_min", -0.1),
        ("speed_max", 0.0),
        ("force_limit", np.inf),
        ("force_rate_limit", 0.0),
        ("speed_weight", np.nan),
        ("iteration_limit", 0),
        ("iteration_limit", 10.5),
        ("position_tolerance", 0.0),
    ],
)
def test_refuses_senseless_parameters(name, value):
    with pytest.raises(ParameterError, match=f"{name} = .*: expected "):
        MpcParameters(**{name: value})
