"""The safety layer: what it lets through, and what it costs nobody."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from late_plants import late

from controller import LongitudinalModel, ParameterError, SafetyLayer, SafetyParameters

MODEL = LongitudinalModel()
EAST = np.array([[0.0, 0.0, 1.0, 0.0]])  # the front's middle at the origin, heading east
NOBODY = np.zeros((0, 2))
RESOLUTION = 4.0  # N
TO_HOLD_4_M_S = 400.0  # N
SIMULATED = {"walking_acceleration": 5.0, "walking_speed": 2.5}  # all that simulated people can


def let_through(force, speed, position, velocity=None, way=EAST, **parameters):
    layer = SafetyLayer(MODEL, SafetyParameters(**(SIMULATED | parameters)))
    position = np.asarray(position, dtype=float).reshape(-1, 2)
    velocity = np.zeros_like(position) if velocity is None else np.asarray(velocity, dtype=float)
    return layer.filter(force, speed, (way, 0.25), position, velocity.reshape(-1, 2))


relaxed = settings(max_examples=60)
forces = st.floats(-8000.0, 8000.0)
speeds = st.one_of(st.just(0.0), st.floats(0.0, 15.0))
ahead = st.tuples(st.floats(-6.0, 25.0), st.floats(-6.0, 6.0))
walks = st.tuples(st.floats(0.0, 2.5), st.floats(-math.pi, math.pi)).map(
    lambda polar: (polar[0] * math.cos(polar[1]), polar[0] * math.sin(polar[1]))
)
person = st.tuples(ahead, walks)
people = st.lists(person, min_size=1, max_size=4)


def apart(crowd):
    return np.array([x for x, _ in crowd]), np.array([v for _, v in crowd])


@relaxed
@given(force=forces, speed=speeds)
def test_with_nobody_there_nothing_is_changed(force, speed):
    assert let_through(force, speed, NOBODY) == (force, False, "")


@relaxed
@given(
    force=forces,
    speed=st.floats(0.0, 8.0),
    away=st.floats(16.0, 200.0),
    angle=st.floats(-math.pi, math.pi),
)
def test_with_nobody_near_nothing_is_changed(force, speed, away, angle):
    """From 8.4 m/s it stops in 1.05 s: 5 m, and a person walks 2.7 m in that time."""
    where = [(away * math.cos(angle), away * math.sin(angle))]
    assert let_through(force, speed, where, [(2.5, 0.0)]) == (force, False, "")


@relaxed
@given(force=forces, speed=speeds, crowd=people)
def test_it_never_drives_harder_than_the_controller(force, speed, crowd):
    safe = let_through(force, speed, *apart(crowd))
    assert safe.force <= force
    assert safe.acted or safe.force == force
    assert safe.acted == (safe.reason != "")


@relaxed
@given(pair=st.tuples(forces, forces), speed=speeds, crowd=people)
def test_who_asks_for_more_gets_no_less(pair, speed, crowd):
    less, more = (let_through(force, speed, *apart(crowd)) for force in sorted(pair))
    if "unavoidable" not in (less.reason, more.reason):
        assert less.force <= more.force + RESOLUTION


@relaxed
@given(force=forces, speed=speeds, crowd=people)
def test_it_takes_no_more_than_it_must(force, speed, crowd):
    """What it lets through it lets through again; a little more it cuts back to the same."""
    safe = let_through(force, speed, *apart(crowd))
    if safe.reason == "safety layer" and safe.force > -8000.0:
        assert let_through(safe.force, speed, *apart(crowd)) == (safe.force, False, "")
        more = let_through(min(force, safe.force + 2.0 * RESOLUTION), speed, *apart(crowd))
        assert more.force == pytest.approx(safe.force, abs=2.0 * RESOLUTION)


@relaxed
@given(force=forces, speed=speeds, crowd=people, another=person)
def test_one_more_person_never_lets_it_drive_harder(force, speed, crowd, another):
    few = let_through(force, speed, *apart(crowd))
    more = let_through(force, speed, *apart([*crowd, another]))
    if more.reason != "unavoidable":
        assert more.force <= few.force + RESOLUTION


@relaxed
@given(force=forces, crowd=people)
def test_a_standing_ego_may_always_stand(force, crowd):
    """Who is walked into while standing has not moved into anybody."""
    safe = let_through(force, 0.0, *apart(crowd))
    assert safe.reason != "unavoidable"
    assert let_through(-8000.0, 0.0, *apart(crowd)) == (-8000.0, False, "")


@pytest.mark.parametrize("where", [(1.5, 0.0), (0.2, 1.6), (-1.0, 1.3)])
def test_a_standing_ego_starts_when_nobody_can_be_reached(where):
    assert let_through(4000.0, 0.0, [where]) == (4000.0, False, "")


@pytest.mark.parametrize("where", [(0.3, 0.0), (0.1, 1.2), (0.3, -0.9)])
def test_a_standing_ego_stays_when_somebody_is_at_its_front(where):
    safe = let_through(4000.0, 0.0, [where])
    assert (safe.acted, safe.reason) == (True, "safety layer")
    assert safe.force <= RESOLUTION


@relaxed
@given(
    along=st.floats(-6.0, -0.8),
    aside=st.floats(1.3, 1.6),
    v_x=st.floats(0.0, 0.8),
    v_y=st.floats(-2.0, 0.0),
)
def test_who_walks_into_the_side_is_no_reason_to_brake(along, aside, v_x, v_y):
    assert let_through(TO_HOLD_4_M_S, 4.0, [(along, aside)], [(v_x, v_y)]).acted is False


def test_somebody_walking_beside_the_front_is_passed_slowly():
    """0.3 m from its side: at 1.5 m/s it drives past, at 4 m/s it slows down first."""
    beside, along = [(0.8, 1.0 + 0.27 + 0.3)], [(1.3, 0.0)]
    assert let_through(150.0, 1.5, beside, along).acted is False
    assert let_through(TO_HOLD_4_M_S, 4.0, beside, along).acted is True


@pytest.mark.parametrize(
    ("speed", "walking"), [(1.0, 0.0), (4.0, 0.0), (9.0, 0.0), (1.0, -1.4), (4.0, -1.4), (9.0, 1.4)]
)
def test_somebody_straight_ahead_by_hand(speed, walking):
    """On a line: at the end of each step the front is R + margin before where the person may be.

    The front goes s(j+1) = s(j) + v(j) dt, the person a_max t^2/2 or v_max t towards it; at 9 m/s
    the motion within a step asks for more than the margin.
    """
    decay, push = math.exp(-0.005), (1.0 - math.exp(-0.005)) / 0.005 * 0.05 / 1000.0
    v, s, nearest, t = speed, 0.0, 0.0, 0.0
    while v > 0.0:
        t += 0.05
        s += 0.05 * v
        between = math.hypot(0.27, 0.025 * (v + 2.5)) + 5.0 * 0.05**2 / 8.0
        v = max(0.0, decay * v - 8000.0 * push)
        walked = min(-walking * t + 2.5 * t**2, 2.5 * t)
        nearest = max(nearest, s + max(0.27 + 0.05, between) + walked)
    just_right = [(nearest + 1e-6, 0.0)]
    assert let_through(-8000.0, speed, just_right, [(walking, 0.0)]).acted is False
    safe = let_through(TO_HOLD_4_M_S, speed, just_right, [(walking, 0.0)])
    assert -8000.0 <= safe.force < -7900.0
    assert safe.reason == "safety layer"
    too_near = let_through(TO_HOLD_4_M_S, speed, [(nearest - 1e-6, 0.0)], [(walking, 0.0)])
    assert too_near == (-8000.0, True, "unavoidable")


@relaxed
@given(force=forces, speed=speeds, crowd=people, angle=st.floats(-3.0, 3.0))
def test_east_is_like_any_other_direction(force, speed, crowd, angle):
    x, v = apart(crowd)
    cos, sin = math.cos(angle), math.sin(angle)
    turn = np.array([[cos, sin], [-sin, cos]])
    place = np.array([70.0, -30.0])
    way = np.array([[*place, cos, sin]])
    here = let_through(force, speed, x, v)
    there = let_through(force, speed, x @ turn + place, v @ turn, way)
    if here.reason == there.reason:  # on the very edge, rounding decides
        assert there.force == pytest.approx(here.force, abs=2.0 * RESOLUTION)


@relaxed
@given(force=forces, speed=speeds, crowd=people)
def test_a_straight_way_may_be_given_in_pieces(force, speed, crowd):
    pieces = np.array([[0.25 * i, 0.0, 1.0, 0.0] for i in range(12)])
    whole, parts = (let_through(force, speed, *apart(crowd), way) for way in (EAST, pieces))
    if whole.reason == parts.reason:
        assert parts.force == pytest.approx(whole.force, abs=2.0 * RESOLUTION)


@pytest.mark.parametrize(
    "worse",
    [
        {"margin": 0.5},
        {"position_error": 0.4},
        {"actuator": late(0.2)},
        {"force_rate_limit": 1000.0},
        {"force_limit": 5000.0},
        {"walking_acceleration": 9.0},
        {"width": 2.6},
    ],
)
def test_what_is_worse_keeps_it_further_away(worse):
    """The nearest place beside the way of somebody standing at whom it drives by at 4 m/s."""

    def passes(aside, **parameters):
        where = [(2.0, aside)]
        return not let_through(TO_HOLD_4_M_S, 4.0, where, **parameters).acted

    def nearest(**parameters):
        return next(y for y in np.arange(1.0, 8.0, 0.01) if passes(y, **parameters))

    assert nearest(**worse) > nearest() + 0.02


def test_a_vehicle_with_weak_brakes_stays_where_people_are():
    weak = {"force_limit": 10.0}
    assert let_through(10.0, 5.0, [(30.0, 0.0)], **weak).reason == "unavoidable"
    assert let_through(10.0, 5.0, NOBODY, **weak).acted is False


@pytest.mark.parametrize("friction", [0.0, 500.0])
def test_its_fastest_speed_is_what_full_braking_ends_in_20_s(friction):
    model = LongitudinalModel(mass=10_000.0, friction=friction)
    layer = SafetyLayer(model, SafetyParameters(force_limit=4000.0))
    speeds = [layer.fastest]
    while speeds[-1] > 0.0:  # the slower of the two motions that the layer holds for
        lost = 4000.0 if friction == 0.0 else (4000.0 + friction * speeds[-1])
        speeds.append(speeds[-1] - model.time_step * lost / model.mass)
    assert len(speeds) * model.time_step == pytest.approx(20.0, abs=0.3)
    delayed = SafetyLayer(model, SafetyParameters(force_limit=4000.0, actuator=late(2.0)))
    assert 0.0 < delayed.fastest < layer.fastest


def test_its_braking_keeps_to_the_rate_limit_if_it_is_to():
    layer = SafetyLayer(MODEL, SafetyParameters(force_rate_limit=1000.0))
    blocked, still = np.array([[1.0, 0.0]]), np.zeros((1, 2))
    told = [layer.filter(400.0, 4.0, (EAST, 0.25), blocked, still).force for _ in range(10)]
    assert told == [-1000.0 * k for k in range(1, 9)] + [-8000.0, -8000.0]
    layer.reset()
    assert layer.filter(400.0, 4.0, (EAST, 0.25), blocked, still).force == -1000.0


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("walking_acceleration", 0.0),
        ("walking_speed", math.nan),
        ("body_radius", -0.1),
        ("width", 0.0),
        ("margin", math.inf),
        ("position_error", -1.0),
        ("force_limit", 0.0),
        ("force_rate_limit", 0.0),
    ],
)
def test_refuses_senseless_parameters(name, value):
    with pytest.raises(ParameterError, match=rf"{name} = {value}: expected"):
        SafetyParameters(**{name: value})
