"""An ego behind a queue and in it, on a road of its own, at each of SUMO's steps."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import giveway

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

HARDEST = 4.5  # m/s^2
CARS = """<routes><vType id="t" sigma="0"/><vType id="late" sigma="0" accel="1.5"/>
<vehicle id="first" type="late" depart="0" departPos="330" departSpeed="0"><route edges="ab"/>
<stop lane="ab_0" endPos="340" duration="45"/></vehicle>
<vehicle id="second" type="t" depart="0" departPos="318" departSpeed="0">
<route edges="ab"/></vehicle>
<vehicle id="ahead" type="t" depart="1" departSpeed="max"><route edges="ab"/></vehicle>
<vehicle id="car" type="t" depart="3" departSpeed="max"><route edges="ab"/></vehicle></routes>"""


@pytest.fixture(scope="module")
def queue(tmp_path_factory: pytest.TempPathFactory, call_sumo: Callable[..., str]) -> Path:
    """A straight road of 50 km/h, on which a car stands and others queue: its .sumocfg."""
    folder = tmp_path_factory.mktemp("queue")
    (folder / "n.nod.xml").write_text(
        '<nodes><node id="a" x="0" y="0"/><node id="b" x="600" y="0"/></nodes>'
    )
    (folder / "e.edg.xml").write_text(
        '<edges><edge id="ab" from="a" to="b" speed="13.89"/></edges>'
    )
    call_sumo("netconvert", "-n", "n.nod.xml", "-e", "e.edg.xml", "-o", "net.xml", cwd=folder)
    (folder / "cars.rou.xml").write_text(CARS)
    configuration = folder / "s.sumocfg"
    configuration.write_text(
        '<configuration><input><net-file value="net.xml"/>'
        '<route-files value="cars.rou.xml"/></input></configuration>'
    )
    return configuration


@pytest.mark.parametrize("step", [0.1, 0.5, 1.0])
@pytest.mark.parametrize("controller", ["mpc", "pid-tuned", "careful-driver"])
def test_it_stops_behind_a_queue_and_follows_it(queue: Path, controller: str, step: float) -> None:
    result = giveway.run(
        {
            "scenario": str(queue),
            "ego": {"take_over": ["car"]},
            "controller": controller,
            "sumo": {"step_length": step},
            "time_limit": 90.0,
        }
    )
    ego = result.ego
    assert result.summary["completed"]
    assert result.summary["vehicle_contacts"] == 0
    assert ego.acceleration.min() >= -HARDEST
    assert ego.acceleration[ego.time < ego.time[0] + 2.0].min() >= -3.01  # nobody feels it
    stands = ego.vehicle_gap[(ego.speed < 0.05) & (ego.vehicle_gap < 5.0)]
    assert 1.0 <= np.median(stands) <= 3.0
