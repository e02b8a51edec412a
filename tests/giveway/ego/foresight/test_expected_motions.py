"""Where people are after a prediction step, by each motion that they are expected to make."""

import numpy as np
import pytest

from giveway.ego.foresight.expected_motions import KEEPS_ON, STANDS, STOPS, WALKS, YIELDS, keep_on

DT = 0.1  # [s]
HERE, VELOCITY = (3.0, -1.0), (0.5, 1.2)  # [m], [m/s]
BY_THE_MODEL = (9.0, 9.0)


def after(motion, *, step=4, creeps=False, unaware=False, velocity=VELOCITY):
    """Position and velocity of one person after this prediction step."""
    marks = np.array([motion], dtype=np.int8), 0.0, 1.0, DT
    position, walks = np.array([BY_THE_MODEL]), np.array([BY_THE_MODEL])
    people = np.array([HERE]), np.array([velocity])
    keep_on(marks, step, people, (creeps, np.array([unaware])), position, walks)
    return position[0], walks[0]


@pytest.mark.parametrize("motion", [WALKS, YIELDS])
def test_others_are_where_the_model_has_them(motion):
    assert after(motion)[0] == pytest.approx(BY_THE_MODEL)


def test_who_keeps_on_walks_straight_and_who_stops_stays():
    position, velocity = after(KEEPS_ON)
    assert position == pytest.approx(np.add(HERE, 5 * DT * np.array(VELOCITY)))
    assert velocity == pytest.approx(VELOCITY)
    position, velocity = after(STOPS)
    assert position == pytest.approx(HERE)
    assert velocity == pytest.approx((0.0, 0.0))


@pytest.mark.parametrize("motion", [KEEPS_ON, STOPS])
def test_before_a_creeping_ego_who_walks_and_sees_it_makes_way(motion):
    assert after(motion, creeps=True)[0] == pytest.approx(BY_THE_MODEL)
    for unwilling in ({"unaware": True}, {"velocity": (0.9 * STANDS, 0.0)}):
        assert after(motion, creeps=True, **unwilling)[0] != pytest.approx(BY_THE_MODEL)
