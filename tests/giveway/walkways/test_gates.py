"""Gates: where people cross them, and from which direction."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.walkways.gates import (
    BODY_RADIUS,
    gate,
    passages,
    places,
    side_at,
    signals,
    track_of,
    turned,
)

EAST = np.array([1.0, 0.0])
TWO = np.concatenate([gate((5.0, 0.0), EAST, 1.0), gate((9.0, 0.0), EAST, 0.5, signal=3)])


@given(st.floats(-1.0, 1.0))
def test_a_side_is_kept_through_all_gates(side: float) -> None:
    assert places(TWO, side) == pytest.approx(np.array([(5.0, side), (9.0, 0.5 * side)]))
    assert side_at(TWO, (0.0, side)) == pytest.approx(side)


def test_from_beyond_its_end_a_gate_is_crossed_at_its_end() -> None:
    assert side_at(TWO, (0.0, 7.0)) == 1.0
    assert side_at(gate((5.0, 0.0), EAST), (0.0, 7.0)) == 0.0


def test_turned_gates_are_met_in_reverse_and_without_signals() -> None:
    back = turned(TWO)
    assert back[:, 0].tolist() == [9.0, 5.0]
    assert back[:, 4].tolist() == [-1.0, -1.0]
    assert signals(TWO).tolist() == [-1, 3]
    assert signals(back).tolist() == [-1, -1]
    assert places(back, 1.0) == pytest.approx(places(TWO, -1.0)[::-1])


def test_a_line_is_as_wide_as_the_walkway() -> None:
    rows = passages(TWO, (0.0, 0.0))
    assert rows[:, 2] == pytest.approx([1.0 + BODY_RADIUS, 0.5 + BODY_RADIUS])
    assert rows[:, :2] == pytest.approx(np.array([EAST, EAST]))


def test_from_behind_its_line_a_gate_is_passed_as_people_come() -> None:
    rows = passages(TWO[:1], (8.0, 4.0))
    assert rows[0, :2] == pytest.approx([-0.6, -0.8])


def test_tracks_are_counted_from_the_middle() -> None:
    assert [track_of(side) for side in (-1.0, -0.3, 0.1, 0.6, 1.0)] == [-2, -1, 0, 1, 2]
