"""The paths of the turning tests: a right angle of clothoids and an arc, as in the protocol."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.ncap.protocol import read_protocol
from giveway.ncap.turning import BEGIN, meeting, path_of

PROTOCOL = read_protocol("euroncap-2023")
TURNS = [cell for cell in PROTOCOL.cells if cell.test.turn is not None]


@pytest.mark.parametrize("cell", TURNS, ids=lambda cell: cell.label)
def test_a_path_turns_by_a_right_angle_with_the_radius_of_its_arc(cell):
    turn = cell.test.turn
    path = path_of(turn, cell.speed)
    way = 1.0 if turn.side == "left" else -1.0
    assert path.headings[0] == 0.0
    assert path.headings[-1] == pytest.approx(way * np.pi / 2.0, abs=1e-3)
    turned = np.diff(path.headings) / np.diff((path.stations[:-1] + path.stations[1:]) / 2.0)
    bend = next(one for one in turn.bends if one.speed == cell.speed)
    assert np.abs(turned).max() == pytest.approx(1.0 / bend.radius, rel=1e-3)
    begin, end = path.vertices[1], path.vertices[-2]
    assert begin.tolist() == [BEGIN, 0.0]
    assert way * end[1] == pytest.approx(end[0] - BEGIN, rel=1e-2)


@pytest.mark.parametrize("cell", TURNS, ids=lambda cell: cell.label)
def test_the_car_meets_the_dummy_on_its_line_before_the_end_of_the_turn(cell):
    turn, dummy = cell.test.turn, PROTOCOL.dummy(cell.test)
    path = path_of(turn, cell.speed)
    station, middle, crossed = meeting(turn, path, dummy, 1.0, 4.5)
    pose = path.pose(station, 4.5)
    assert abs(pose.y) < abs(turn.line) < abs(pose.y) + 0.5
    assert abs(middle - crossed) < 0.3
    assert station < path.stations[-2] + 1.0
