"""What an ego knows of the vehicle ahead, between two steps of SUMO."""

import numpy as np
import pytest

from controller import VehicleAhead
from giveway.ego.perception.leader import NOT_FOLLOWING, Followed, Leader
from giveway.ego.vehicle_ahead import VehicleNews

DT, STEP = 0.05, 0.5  # [s]
FRONT = 100.0  # [m]


def news(speeds: tuple[float, ...], names: tuple[str, ...] = ("a",)) -> VehicleAhead:
    """The vehicle ahead after news of its speeds, one every step of SUMO."""
    known = VehicleNews(DT)
    found = None
    for speed in speeds:
        known.tell(names, np.full(len(names), 7.5), STEP)
        found = known.look(Followed(FRONT + 20.0, speed, 1), FRONT, 1 + len(names))
    assert found is not None
    return found


def test_the_vehicle_is_described() -> None:
    assert news((10.0,)) == VehicleAhead(20.0, 10.0, 7.5, 0.0, 0.0, True, STEP)


def test_its_deceleration_is_that_between_two_news() -> None:
    assert news((10.0, 9.0)).decelerates == pytest.approx(2.0)
    assert news((10.0, 12.0)).decelerates == 0.0
    assert not news((10.0, 9.0)).new


def test_the_news_grow_older() -> None:
    known = VehicleNews(DT)
    known.tell(["a"], np.array([9.0]), STEP)
    for step in range(3):
        found = known.look(Followed(FRONT + 20.0, 10.0, 1), FRONT, 2)
        assert found is not None
        assert found.age == pytest.approx(step * DT)
        known.advance()


def test_another_vehicle_is_new_and_without_one_there_is_none() -> None:
    known = VehicleNews(DT)
    known.tell(["a", "b"], np.array([9.0, 5.0]), STEP)
    assert known.look(Followed(120.0, 10.0, 1), FRONT, 3).new  # type: ignore[union-attr]
    other = known.look(Followed(110.0, 4.0, 2), FRONT, 3)
    assert other is not None
    assert (other.new, other.braking, other.decelerates) == (True, 5.0, 0.0)
    assert known.look(NOT_FOLLOWING, FRONT, 3) is None


def test_news_of_another_ego_are_never_old() -> None:
    known = VehicleNews(DT)
    known.tell(["a"], np.array([7.5]), STEP)
    known.advance()
    found = known.look(Followed(FRONT + 20.0, 10.0, 1), FRONT, 3)
    assert found is not None
    assert (found.age, found.step, found.braking) == (0.0, DT, 9.0)


def test_a_leader_that_brakes_is_expected_to_go_on_braking() -> None:
    known = VehicleNews(DT)
    seen = Leader(FRONT + 20.0, 10.0)
    steady = VehicleAhead(20.0, 10.0, age=0.2, step=STEP)
    brakes = steady._replace(decelerates=4.0)
    assert known.estimated(seen, steady, FRONT) == seen
    assert known.estimated(seen, brakes, FRONT) == pytest.approx((119.6, 9.2))
    closer = Leader(FRONT + 30.0, 3.0)  # another one, beyond
    assert known.estimated(closer, brakes, FRONT) == closer
    at = known.stations(Leader(120.0, 8.0), brakes, np.array([0.0, 1.0, 2.0, 5.0]))
    assert at == pytest.approx([120.0, 126.0, 128.0, 128.0])
