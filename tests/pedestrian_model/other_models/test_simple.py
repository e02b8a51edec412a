"""Models of people besides VCI: what their papers say they do, and what every model owes."""

import numpy as np
import pytest

from pedestrian_model import (
    PLAIN_MODELS,
    SIM,
    Crowd,
    DivergenceError,
    PlainModel,
    Surroundings,
    SurroundingsError,
    Vehicles,
    Walls,
)

DT, NOBODY = 0.05, Vehicles.empty()


def walk(name, crowd, steps, vehicles=lambda t: NOBODY, surroundings=None, dt=DT):
    """(steps + 1, n, 2) [m] where everybody was."""
    model, places = PlainModel(name, SIM, dt), [crowd.position.copy()]
    for k in range(steps):
        model.advance(crowd, vehicles(k * dt), surroundings or Surroundings())
        places.append(crowd.position.copy())
    return np.array(places)


def people(places, goals, speed=1.4, moving=True):
    places, goals = np.atleast_2d(places).astype(float), np.atleast_2d(goals).astype(float)
    way = goals - places
    v = speed * way / np.hypot(*way.T)[:, None] if moving else np.zeros_like(way)
    return Crowd.create(places, v, speed, [goal[None] for goal in goals])


def group(n=12):
    random = np.random.default_rng(5)
    places = random.uniform(-4.0, 4.0, (n, 2)) + (0.0, -6.0)
    return people(places, places + (0.0, 14.0))


def car(speed, start, y=0.0):
    """Drives along x; its front is at ``start`` [m] at the beginning."""
    return lambda t: Vehicles.create(start - 2.5 + speed * t, y, 0.0, speed)


@pytest.mark.parametrize("name", PLAIN_MODELS)
def test_somebody_alone_is_at_pace_in_half_a_second_and_arrives(name):
    crowd = people((0.0, 0.0), (20.0, 0.0), moving=False)
    places = walk(name, crowd, 10)
    assert crowd.velocity[0, 0] == pytest.approx(1.4 * (1.0 - 0.9**10), rel=2e-3)
    assert (places[:, 0, 1] == 0.0).all()
    walk(name, crowd, 400)
    assert crowd.position[0, 0] == pytest.approx(20.0, abs=0.1)


@pytest.mark.parametrize("name", PLAIN_MODELS)
def test_order_and_frame_do_not_matter_and_speeds_are_bounded(name):
    vehicles = car(3.0, -8.0)
    usual = walk(name, group(), 120, vehicles)
    crowd = group()
    turned = people(crowd.position[::-1], crowd.waypoints[::-1])
    assert np.allclose(walk(name, turned, 120, vehicles)[:, ::-1], usual, atol=1e-6)
    place, angle = np.array([70.0, -30.0]), 1.1
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    goals = crowd.waypoints @ turn + place
    elsewhere = Crowd.create(
        crowd.position @ turn + place, crowd.velocity @ turn, 1.4, list(goals[:, None])
    )

    def there(t):
        x, y = np.array([-10.5 + 3.0 * t, 0.0]) @ turn + place
        return Vehicles.create(x, y, angle, 3.0)

    assert np.allclose(walk(name, elsewhere, 120, there), usual @ turn + place, atol=1e-5)
    pace = np.hypot(*np.diff(usual, axis=0).T) / DT
    assert pace.max() <= 1.3 * 1.4 + 1e-9


def test_at_constant_velocity_nothing_is_in_the_way():
    both = people([(0.0, 0.0), (10.0, 0.0)], [(30.0, 0.0), (-20.0, 0.0)])
    places = walk("constant-velocity", both, 100, lambda t: Vehicles.create(5.0, 0.0, 0.0, 0.0))
    assert np.allclose(places[:, 0, 0], 1.4 * DT * np.arange(101), atol=1e-3)
    assert (places[:, :, 1] == 0.0).all()


@pytest.mark.parametrize("name", ["social-force", "gap-acceptance", "orca"])
def test_people_who_meet_pass_each_other(name):
    both = people([(0.0, 0.02), (10.0, -0.02)], [(20.0, 0.0), (-10.0, 0.0)])
    places = walk(name, both, 220)
    assert np.hypot(*(places[:, 0] - places[:, 1]).T).min() > 0.3
    assert places[-1, 0, 0] > 14.0
    assert places[-1, 1, 0] < -4.0


def test_the_force_of_somebody_who_stands_is_the_papers():
    """V_0 / sigma exp(-|r| / sigma), seen ahead; half of it from behind."""
    for at, share in ((1.0, 1.0), (-1.0, 0.5)):
        both = people([(0.0, 0.0), (at, 0.0)], [(20.0, 0.0), (at, 20.0)])
        both.velocity[1] = 0.0
        PlainModel("social-force").advance(both, NOBODY)
        pushed = share * 2.1 / 0.3 * np.exp(-1.0 / 0.3)
        assert (1.4 - both.velocity[0, 0]) / DT == pytest.approx(np.sign(at) * pushed, abs=1e-3)


def test_a_vehicle_that_comes_pushes_people_off_its_way():
    there = people((12.0, 0.5), (12.0, 20.0), moving=False)
    places = walk("social-force", there, 60, car(4.0, 0.0))
    beside = people((12.0, 0.5), (12.0, 20.0), moving=False)
    alone = walk("social-force", beside, 60)
    assert places[40, 0, 1] > alone[40, 0, 1]


STRIP = 1.0 + SIM.body_radius + 0.3  # [m] half of what a car of 2 m sweeps, and stays clear
CRITICAL = 2.0 * STRIP / 1.4 + 3.0  # [s] HCM 2010, 19-69


@pytest.mark.parametrize("later", [-0.4, 0.4])
def test_a_gap_is_accepted_from_the_critical_headway_on(later):
    """The car arrives so much later than the critical headway after the person at the strip."""
    start = -STRIP - 4.0  # [m]
    seconds = 4.0 / 1.4 + CRITICAL + later
    who = people((0.0, start), (0.0, 10.0))
    places = walk("gap-acceptance", who, 400, car(4.0, -4.0 * seconds))
    y = places[:, 0, 1]
    stops = np.diff(y)[:140].min() < 0.2 * 1.4 * DT
    assert stops == (later < 0.0)
    assert y[-1] > 9.0  # everybody crosses in the end
    if stops:
        before = int((seconds + 1.0) / DT)
        assert y[: before - 40].max() < -1.0  # waits beside the strip until the car has passed


def test_who_is_on_the_strip_goes_on_and_who_leaves_is_not_held():
    inside = people((0.0, -0.8), (0.0, 10.0))
    assert walk("gap-acceptance", inside, 40, car(4.0, -6.0))[-1, 0, 1] > 1.0
    away = people((0.0, 2.0), (0.0, 10.0))
    assert walk("gap-acceptance", away, 40, car(4.0, -6.0))[-1, 0, 1] > 4.5


def test_gaps_at_a_kerb_with_a_signal_are_judged_by_who_sets_it():
    kerb, far = (0.0, -STRIP - 1.0), (0.0, 10.0)
    comes, seen = car(4.0, -8.0), {}
    for signal in (-1, 0):
        crowd = Crowd.create(
            [(0.0, -STRIP - 1.5)], [(0.0, 1.4)], 1.4, [[kerb, far]], signals=[[signal, -1]]
        )
        opened = Surroundings(closed=np.array([False]))
        walk("gap-acceptance", crowd, 30, comes, surroundings=opened)
        seen[signal] = crowd.position[0, 1]
    assert seen[-1] < -1.0 < seen[0]


@pytest.mark.parametrize("name", PLAIN_MODELS)
def test_way_points_are_passed_and_a_closed_signal_holds(name):
    route = np.array([[5.0, 0.0], [5.0, 10.0]])
    crowd = Crowd.create([(0.0, 0.0)], [(1.4, 0.0)], 1.4, [route], signals=[np.array([0, -1])])
    closed = Surroundings(closed=np.array([True]))
    walk(name, crowd, 200, surroundings=closed)
    assert crowd.position[0] == pytest.approx([5.0, 0.0], abs=0.1)
    closed.closed[0] = False
    walk(name, crowd, 200, surroundings=closed)
    assert crowd.position[0] == pytest.approx([5.0, 10.0], abs=0.1)
    with pytest.raises(SurroundingsError, match="signal 0"):
        PlainModel(name).advance(crowd, NOBODY)


def test_walls_hold_people_and_steps_may_be_long():
    walls = Surroundings(walls=Walls.create([[-20.0, -1.0, 20.0, -1.0]]))  # walkable above it
    who = people((0.0, 0.0), (10.0, -3.0))
    assert walk("social-force", who, 200, surroundings=walls)[:, 0, 1].min() > -1.0
    again = people((0.0, 0.0), (10.0, -3.0))
    assert walk("orca", again, 200, surroundings=walls)[:, 0, 1].min() > -1.0 + SIM.body_radius / 2
    long, short = (walk("social-force", group(), n, car(3.0, -8.0), dt=dt)
                   for n, dt in ((40, 0.1), (80, 0.05)))  # fmt: skip
    assert np.abs(long[-1] - short[-1]).max() < 1e-9


@pytest.mark.parametrize("name", PLAIN_MODELS)
def test_a_state_that_is_no_number_is_told(name):
    crowd = group()
    crowd.velocity[3, 0] = np.nan
    with pytest.raises(DivergenceError, match="3"):
        PlainModel(name).advance(crowd, NOBODY)
