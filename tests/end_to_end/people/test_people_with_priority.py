"""Somebody crosses the bundled junction's zebra from the south, where the ego's lane is first."""

import shutil
from typing import NamedTuple

import numpy as np
import pytest
from support.priority import rules_of

import giveway
from sumo_scenarios import find

KERB = 3.5  # [m] y at which the zebra ends, on both sides
ROUTES = """<routes>
    <vType id="adult" vClass="pedestrian" desiredMaxSpeed="1.4" maxSpeed="1.4" speedFactor="1"/>
    <person id="she" type="adult" depart="0" departPos="40">
        <walk from="east_out" to="far_east_in" arrivalPos="50"/>
    </person>
</routes>"""
CONFIG = """<configuration><input>
    <net-file value="junction.net.xml"/><route-files value="one.rou.xml"/>
</input></configuration>"""


class Crossing(NamedTuple):
    time: float  # [s] from kerb to kerb
    pushed_back: float  # [m] at most, against the way across


@pytest.fixture(scope="module")
def cross(tmp_path_factory):
    """Let her cross; ``position`` [m] is where the ego departs, None: there is none."""
    folder = tmp_path_factory.mktemp("one")
    shutil.copy(find("junction").config_file.with_name("junction.net.xml"), folder)
    (folder / "one.rou.xml").write_text(ROUTES)
    (folder / "one.sumocfg").write_text(CONFIG)

    def run(position, controller="mpc", priority="road", preset="MIXED"):
        ego = {"none": True}
        if position is not None:
            ego = {"route": ["east_out", "far_east_out"], "lane": 1, "depart_time": 1.0}
            ego |= {"depart_position": position, "initial_speed": 4.0}
        result = giveway.run(
            {
                "scenario": str(folder / "one.sumocfg"),
                "controller": controller,
                "regulation": {"reference_speed": 4.0},
                "rules": rules_of(priority),
                "crowd": {"zone": "everywhere", "preset": preset},
                "perception": {"preset": preset},
                "record": {"near": 200.0, "far_period": 0.05},
                "time_limit": 25.0,
                "ego": ego,
            }
        )
        track = result.crowd_track
        on = np.abs(track.y) <= KERB
        y, time = track.y[on], result.time[track.step[on]]
        back = (np.maximum.accumulate(y) - y).max()
        return Crossing(time[-1] - time[0], float(back))

    return run


@pytest.mark.parametrize("controller", ["mpc", "pid-tuned"])
@pytest.mark.parametrize("position", [5.0, 10.0])
def test_she_walks_on_before_an_ego_that_gives_way(cross, controller, position):
    alone, before_ego = cross(None), cross(position, controller)
    assert before_ego.pushed_back == 0.0
    assert before_ego.time == pytest.approx(alone.time, abs=0.3)


@pytest.mark.parametrize("controller", ["mpc-paper", "pid-tuned"])
def test_without_the_law_of_the_road_she_is_pushed_back(cross, controller):
    """The ego reaches the zebra when she is half across its lane."""
    pushed = cross(9.5, controller, priority="none", preset="SIM")
    assert pushed.pushed_back > 0.5
    assert pushed.time > cross(None, preset="SIM").time + 3.0
    assert cross(9.5, controller, preset="SIM").pushed_back < 0.01


def test_same_bytes_in_both_runs():
    settings = {"scenario": "junction", "seed": 12, "sumo": {"seed": "run"}, "time_limit": 8.0}
    one, other = (giveway.run(settings).trajectories for _ in range(2))
    assert one.equals(other)
