"""Whether people ever slowed an ego."""

import numpy as np
import pytest

from giveway.metrics.slowing import slowed

TIME = 0.1 * np.arange(100)


def drive(ego, speed: np.ndarray, **columns):
    position = np.concatenate([[0.0], np.cumsum(0.05 * (speed[1:] + speed[:-1]))])
    return ego(TIME, speed=speed, position=position, **columns)


@pytest.mark.parametrize(("lowest", "expected"), [(4.0, False), (3.25, False), (3.15, True)])
def test_below_four_fifths_of_the_reference_speed_it_is_slowed(ego, lowest, expected) -> None:
    speed = np.full(100, 4.0)
    speed[40:45] = lowest
    assert slowed(drive(ego, speed), 4.0) is expected


def test_setting_off_is_no_slowing_but_setting_off_late_is(ego) -> None:
    prompt = np.minimum(1.5 * TIME, 4.0)
    assert not slowed(drive(ego, prompt), 4.0)
    late = np.minimum(0.2 * TIME, 4.0)
    assert slowed(drive(ego, late), 4.0)


@pytest.mark.parametrize("cause", ["vehicle_gap", "stop_gap"])
def test_what_holds_an_ego_up_without_people_does_not_count(ego, cause) -> None:
    speed = np.concatenate(
        [np.full(30, 4.0), np.full(20, 0.0), np.minimum(0.15 * np.arange(50), 4)]
    )
    gaps = np.full(100, np.inf)
    gaps[25:50] = 8.0
    assert slowed(drive(ego, speed), 4.0)
    assert not slowed(drive(ego, speed, **{cause: gaps}), 4.0)


def test_where_lanes_say_how_fast_a_bend_is_no_slowing(ego) -> None:
    speed = np.concatenate([np.full(40, 8.0), np.full(30, 4.0), np.full(30, 8.0)])
    gap = np.full(100, np.inf)
    assert not slowed(drive(ego, speed, reference_speed=speed, gap=gap), None)
    gap[45:55] = 5.0
    held = speed.copy()
    held[45:55] = 2.0
    wanted = speed.copy()
    wanted[45:55] = 2.0  # a controller that aims lower for somebody in front
    assert slowed(drive(ego, held, reference_speed=wanted, gap=gap), None)
