"""The part of a crossing beside a lane that runs along it."""

import numpy as np
import pytest

from giveway.walkways.beside_lanes import part_beside

CROSSING = np.array([[0.0, 0.0], [0.0, 7.0]])  # northwards; w counts to the west


def lane(x: float, *, bulge: float = 0.0) -> np.ndarray:
    """A lane to the north beside the whole crossing."""
    return np.array([[x, -3.0], [x + bulge, 3.5], [x, 10.0]])


@pytest.mark.parametrize("turn", [1, -1])
def test_people_use_the_other_side_of_a_crossing_along_a_lane(turn: int) -> None:
    ends, width = part_beside(CROSSING, 4.0, [lane(-0.5)[::turn]])
    assert ends == pytest.approx(CROSSING + [1.35, 0.0])  # from 0.7 m to 2 m to the east
    assert width == pytest.approx(1.3)
    mirrored, same = part_beside(CROSSING, 4.0, [-lane(-0.5)[::turn] + [0.0, 7.0]])
    assert mirrored[0, 0] == pytest.approx(-1.35)
    assert same == pytest.approx(1.3)


def test_it_keeps_off_the_nearest_point_of_a_bend() -> None:
    ends, width = part_beside(CROSSING, 4.0, [lane(-0.9, bulge=0.4)])
    assert ends[0, 0] - width / 2 == pytest.approx(-0.5 + 1.2)


@pytest.mark.parametrize(
    "lanes",
    [
        [],
        [np.array([[-5.0, 3.0], [5.0, 3.0]])],  # crosses
        [np.array([[-3.0, -3.0], [2.0, 4.0]])],  # ends on the crossing
        [lane(-1.3)],  # leaves the middle line free
        [lane(0.1, bulge=-0.2)],  # leaves too little on either side
        [lane(-0.6), lane(1.2)],  # on both sides
        [np.array([[-0.5, -3.0], [-0.5, 5.0], [-0.4, 4.0], [-0.5, 9.0]])],  # turns back
    ],
)
def test_else_the_whole_crossing_is_used(lanes: list) -> None:
    ends, width = part_beside(CROSSING, 4.0, lanes)
    assert ends is CROSSING
    assert width == 4.0
