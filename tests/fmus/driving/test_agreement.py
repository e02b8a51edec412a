"""A position and a speed that tell of different motions end the drive; an odometer does not."""

from __future__ import annotations

import pytest

from fmus import FmuOutputError
from fmus.driving.agreement import Agreement

H = 0.05  # [s]


def cruise(car, seconds, force=400.0):
    """Drive on; the zoo's car keeps 4 m/s under 400 N."""
    for _ in range(round(seconds / H)):
        car.step(force)


@pytest.mark.parametrize("fmi", ["2.0", "3.0"])
@pytest.mark.parametrize(
    ("behaviour", "force"),
    [("position_stands", 400.0), ("speed_stands", -3000.0), ("frozen", 400.0)],
)
def test_frozen_position_or_speed_is_a_fault_within_a_second(zoo, open_car, fmi, behaviour, force):
    car = open_car(zoo.car(fmi=fmi, behaviour=behaviour, at=1.0))
    car.start(speed=4.0)
    cruise(car, 1.0)
    with pytest.raises(FmuOutputError, match=r"position has moved by .* speed accounts for"):
        cruise(car, 2.0, force)
    assert 1.0 < car.time <= 2.0


def test_steady_speed_at_a_fixed_position_names_time_and_way(zoo, open_car):
    path = zoo.car(behaviour="position_stands", at=0.0)
    car = open_car(path)
    car.start(speed=4.0)
    with pytest.raises(FmuOutputError) as caught:
        cruise(car, 2.0)
    message = str(caught.value)
    assert message.startswith(f"{path}: position has moved by 0 m in 0.3")
    assert "check the units of both, or leave out [outputs.position]" in message


def test_zero_speed_while_the_position_moves_is_a_fault(zoo, open_car):
    car = open_car(zoo.car(behaviour="speed_stands", at=0.0))
    car.start()
    with pytest.raises(FmuOutputError, match="where speed accounts for 0 m"):
        cruise(car, 3.0, 3000.0)


def test_a_speed_that_is_filtered_as_the_profile_says_is_none(zoo, open_car):
    path = zoo.car(outputs=("speed", "position"), values={"sensor_lag": 0.5}, file="filtered")
    model = {"mass": 1000.0, "friction": 100.0, "r_squared": 1.0, "speed_error": 0.0,
             "position_error": 0.0, "horizon": 0.75, "time_step": H}  # fmt: skip
    for lag in (0.0, 0.5):
        car = open_car(path, model={**model, "sensor_lag": lag})
        car.start(speed=12.0)
        if lag:
            cruise(car, 2.0, -6000.0)
            assert car.position == pytest.approx(10.5, abs=0.1)
        else:
            with pytest.raises(FmuOutputError, match="where speed accounts for"):
                cruise(car, 2.0, -6000.0)


@pytest.mark.parametrize("quantum", [0.01, 0.1, 0.5, 1.0])
@pytest.mark.parametrize("speed", [0.3, 1.5, 4.0, 12.0])
def test_an_odometer_that_counts_in_steps_is_none(zoo, open_car, quantum, speed):
    path = zoo.car(values={"position_step": quantum, "initial_position": 0.37})
    car = open_car(path)
    car.start(speed=speed)
    cruise(car, 6.0, 100.0 * speed)
    cruise(car, 2.0, 3000.0)
    cruise(car, 4.0, -1000.0)
    assert car.speed > 0.0 or speed < 4.0


def test_an_odometer_that_stops_counting_is_a_fault(zoo, open_car):
    path = zoo.car(behaviour="position_stands", at=5.0, values={"position_step": 0.5})
    car = open_car(path)
    car.start(speed=4.0)
    cruise(car, 5.0)
    with pytest.raises(FmuOutputError, match=r"position has moved by 0\.?5? m in 0\.5 s"):
        cruise(car, 1.0)


@pytest.mark.parametrize(
    ("share", "fine"), [(1.19, True), (0.81, True), (1.3, False), (0.7, False)]
)
@pytest.mark.parametrize("speed", [4.0, 20.0])
def test_a_fifth_of_the_way_may_slip(share, fine, speed):
    agreement = Agreement(1.0)
    way = speed * H
    lost = [agreement.lost(share * way, way, 0.0, H) for _ in range(12)]
    assert (lost == [None] * 12) == fine


def test_half_a_metre_may_be_lost_in_half_a_second_and_no_more():
    for off, fine in ((0.49, True), (0.51, False)):
        agreement = Agreement(1.0)
        lost = [agreement.lost(0.04 + (off if k == 5 else 0.0), 0.04, 0.0, H) for k in range(20)]
        assert (lost == [None] * 20) == fine


def test_a_wider_jump_of_the_profile_allows_more():
    agreement = Agreement(1e9)
    assert agreement.lost(1e6, 0.2, 0.0, H) is None


def test_steps_longer_than_the_window_are_judged_one_by_one():
    agreement = Agreement(1.0)
    assert agreement.lost(4.1, 4.0, 0.0, 1.0) is None
    assert agreement.lost(0.2, 4.0, 0.0, 1.0) == pytest.approx((0.2, 4.0, 1.0))
