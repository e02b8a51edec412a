"""A route over a junction: the ego's path is continuous and runs through the junction's lane."""

import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
import sumo as sumo_wheel

from giveway.errors import ScenarioError
from giveway.scenario_files import StartOptions, read_scenario
from giveway.sumo.network.painted_marks import stop_lines
from giveway.sumo.session import SumoSession


@pytest.fixture(scope="module")
def crossroads(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A 3 x 3 grid, 100 m a block, as netgenerate makes it."""
    folder = tmp_path_factory.mktemp("grid")
    home = Path(sumo_wheel.__file__).parent
    command = [home / "bin" / "netgenerate", "--grid", "--grid.number", "3"]
    command += ["--grid.length", "100", "-o", "grid.net.xml"]
    environment = os.environ | {"SUMO_HOME": str(home)}
    subprocess.run(command, cwd=folder, env=environment, check=True, capture_output=True)
    config = folder / "grid.sumocfg"
    config.write_text(
        '<configuration><input><net-file value="grid.net.xml"/></input></configuration>'
    )
    return config


def test_a_left_turn_is_one_continuous_line(crossroads: Path) -> None:
    with SumoSession(read_scenario(crossroads), StartOptions(), "<additional/>") as session:
        points = session.lanes.along(["A1B1", "B1B2"], 0).points
    jumps = np.hypot(*np.diff(points, axis=0).T)
    east, north = points[0], points[-1]
    assert east[0] < 20
    assert north[1] > 180
    inside = (np.abs(points - (100, 100)) < 6).all(axis=1)
    assert inside.any(), "the junction's own lane belongs to the path; the roads end before it"
    assert jumps[jumps < 50].max() < 6


def test_limits_begin_where_their_lanes_do(crossroads: Path) -> None:
    with SumoSession(read_scenario(crossroads), StartOptions(), "<additional/>") as session:
        path = session.lanes.along(["A1B1", "B1B2"], 0)
        before, inside, *_ = path.limits
        after = path.limits[-1]
        assert (before.station, before.speed) == (0.0, session.lanes.speed_limit("A1B1_0"))
        assert inside.station == pytest.approx(session.lanes.length("A1B1_0"))
        assert inside.speed < before.speed  # netconvert limits the turn
        assert after.station == path.edges[1]


def test_lanes_that_do_not_connect_are_named(crossroads: Path) -> None:
    with (
        SumoSession(read_scenario(crossroads), StartOptions(), "<additional/>") as session,
        pytest.raises(ScenarioError, match=r"'A1B1' has no connection to edge 'C1C2'"),
    ):
        session.lanes.along(["A1B1", "C1C2"], 0)


@pytest.fixture
def lit(tmp_path: Path) -> Path:
    """A 2 x 2 grid with lights, whose stop lines are 6 m before the ends of the lanes."""
    home = Path(sumo_wheel.__file__).parent
    command = [home / "bin" / "netgenerate", "--grid", "--grid.number", "2", "--grid.length", "100"]
    command += ["--default-junction-type", "traffic_light", "-o", "grid.net.xml"]
    environment = os.environ | {"SUMO_HOME": str(home)}
    subprocess.run(command, cwd=tmp_path, env=environment, check=True, capture_output=True)
    net = tmp_path / "grid.net.xml"
    offset = '<stopOffset value="6" exceptions="bicycle"/>'
    net.write_text(re.sub(r'(<edge id="[A-Z]\d[^>]*>)', rf"\1{offset}", net.read_text()))
    config = tmp_path / "grid.sumocfg"
    config.write_text(
        '<configuration><input><net-file value="grid.net.xml"/></input></configuration>'
    )
    return config


def test_a_stop_line_is_where_the_network_says(lit: Path) -> None:
    with SumoSession(read_scenario(lit), StartOptions(), "<additional/>") as session:
        lanes, edges = session.lanes, ["A0A1", "A1B1"]
        length = lanes.length("A0A1_0")
        (light,) = lanes.along(edges, 0).lights
        (bicycle,) = lanes.along(edges, 0, kind="bicycle").lights
        (passage,) = lanes.along(edges, 0).passages
        lines = {line.ends for line in stop_lines(lanes)}
        end = lanes.shape("A0A1_0")[-1][1]
    assert light.station == pytest.approx(length - 6.0)
    assert bicycle.station == pytest.approx(length)
    assert passage.entry - passage.offset == pytest.approx(light.station)
    assert len(lines) == 8
    assert min(abs(one[1] - (end - 6.0)) for one, _ in lines) < 0.02
