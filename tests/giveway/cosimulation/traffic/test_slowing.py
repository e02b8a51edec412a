"""Where vehicles are that go on slowing down."""

import numpy as np
import pytest

from giveway.cosimulation.traffic.slowing import Slowing, slow_down, slowing_travel

STEP, DT = 1.0, 0.05  # [s]


def test_a_vehicle_slows_down_if_it_has_braked_in_the_last_step() -> None:
    watch = Slowing(STEP)
    names = ["brakes", "drives on", "dawdles", "speeds up"]
    assert not watch.read(names, np.array([10.0, 10.0, 10.0, 5.0])).any()
    found = watch.read([*names, "new"], np.array([7.0, 10.0, 9.5, 7.0, 3.0]))
    assert found == pytest.approx([3.0, 0.0, 0.0, 0.0, 0.0])
    assert not watch.read(names, np.array([7.0, 10.0, 9.5, 7.0])).any()


@pytest.mark.parametrize("slows", [1.0, 3.0, 4.5])
def test_it_is_where_sumo_puts_it_next(slows: float) -> None:
    """SUMO's speed falls at the begin of each step (semi-implicit Euler)."""
    speed, place = 9.0, 0.0
    for number in (1, 2):
        speed = max(0.0, speed - slows * STEP)
        place += speed * STEP
        assert slowing_travel(9.0, slows, STEP, number * STEP) == pytest.approx(place)


def test_it_stops_and_never_goes_back() -> None:
    travel = np.array([slowing_travel(4.0, 3.0, STEP, time) for time in np.arange(0.0, 5.0, DT)])
    assert (np.diff(travel) >= -1e-12).all()
    assert travel[-1] == pytest.approx(travel[-40])
    assert slowing_travel(1.0, 3.0, STEP, 3.0) == 0.0  # it stands within the step


def test_only_vehicles_that_slow_down_are_moved() -> None:
    news = np.zeros((2, 7))
    news[:, 3] = 8.0
    poses = np.full((4, 3, 7), 99.0)
    slow_down(poses, news, 1, np.array([0.0, 2.0]), (0.5, DT, STEP))
    assert (poses[:, :2] == 99.0).all()
    times = 0.5 + DT * np.arange(4)
    assert poses[:, 2, 0] == pytest.approx([slowing_travel(8.0, 2.0, STEP, t) for t in times])
    assert poses[:, 2, 3] == pytest.approx(8.0 - 2.0 * times)
