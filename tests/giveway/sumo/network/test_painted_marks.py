"""Crossings and stop lines of a bundled scenario, as its network has them."""

import numpy as np

from giveway.scenario_files import StartOptions, read_scenario
from giveway.sumo.network.painted_marks import road_marks
from giveway.sumo.session import SumoSession
from sumo_scenarios import find


def test_a_junction_has_crossings_on_its_arms_with_stop_lines() -> None:
    files = read_scenario(find("junction").config_file)
    with SumoSession(files, StartOptions(), "<additional/>") as session:
        marks = road_marks(session.lanes)
        states = session.light_states({head.system for head in marks.heads})
    assert len(marks.zebras) == 5  # four arms, and a zebra down the road
    assert {zebra.width for zebra in marks.zebras} == {4.0}
    centres = sorted(np.mean(zebra.ends, axis=0).tolist() for zebra in marks.zebras)
    assert centres == [[-6.0, 0.0], [0.0, -6.0], [0.0, 6.0], [6.0, 0.0], [60.0, 0.0]]
    assert len(marks.heads) == 4
    west = next(head for head in marks.heads if np.mean(head.ends, axis=0)[0] == -8.0)
    assert west.ends == ((-8.0, 0.0), (-8.0, -3.5))
    for head in marks.heads:
        assert head.links
        assert max(head.links) < len(states[head.system])
