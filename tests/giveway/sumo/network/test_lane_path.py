"""A lane path along another line: all that lies on it moves along."""

import numpy as np

from giveway.sumo.network.heights import Height
from giveway.sumo.network.lane_path import LanePath, LaneWidth, Light, Passage, SpeedLimit


def test_all_that_lies_on_it_moves_to_its_new_station() -> None:
    lane_path = LanePath(
        points=np.array([[0.0, 0.0], [100.0, 0.0]]),
        lights=(Light(60.0, "J", 2),),
        first="ab_0",
        edges=(0.0, 65.0),
        limits=(SpeedLimit(0.0, 13.9), SpeedLimit(65.0, 8.3)),
        passages=(Passage(60.0, 65.0, (":J_0",), (62.0,)),),
        lanes=(("ab_0", "ab_0"), ("bc_0", "bc_0")),
        heights=(Height(65.0, 4.0),),
        widths=(LaneWidth(65.0, 3.2),),
    )
    line = np.array([[0.0, 1.0], [50.0, 1.0]])
    moved = lane_path.moved(line, lambda station: station / 2.0)
    assert moved.points is line
    assert moved.lights == (Light(30.0, "J", 2),)
    assert moved.edges == (0.0, 32.5)
    assert moved.limits == (SpeedLimit(0.0, 13.9), SpeedLimit(32.5, 8.3))
    assert moved.passages == (Passage(30.0, 32.5, (":J_0",), (31.0,)),)
    assert moved.heights == (Height(32.5, 4.0),)
    assert moved.widths == (LaneWidth(32.5, 3.2),)
    assert (moved.first, moved.lanes) == (lane_path.first, lane_path.lanes)
