"""Whose ways through a junction come near a path, in a network that netgenerate makes."""

import os
import subprocess
from pathlib import Path

import pytest
import sumo as sumo_wheel

from giveway.ego.rules.junctions import PathJunction, junctions_on
from giveway.geometry.path import EgoPath
from giveway.scenario_files import StartOptions, read_scenario
from giveway.sumo.session import SumoSession


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> PathJunction:
    """The middle of a 3 x 3 grid of two lanes each way, straight on to the east on the left one."""
    folder = tmp_path_factory.mktemp("grid")
    home = Path(sumo_wheel.__file__).parent
    command = [home / "bin" / "netgenerate", "--grid", "--grid.number", "3"]
    command += ["--default.lanenumber", "2", "--no-turnarounds", "-o", "grid.net.xml"]
    environment = os.environ | {"SUMO_HOME": str(home)}
    subprocess.run(command, cwd=folder, env=environment, check=True, capture_output=True)
    config = folder / "grid.sumocfg"
    config.write_text(
        '<configuration><input><net-file value="grid.net.xml"/></input></configuration>'
    )
    with SumoSession(read_scenario(config), StartOptions(), "<additional/>") as session:
        lanes = session.lanes.along(["A1B1", "B1C1"], 1)
        path = EgoPath.through(lanes.points)
        found = junctions_on(path, lanes.passages, 1.8, session.junctions, session.lanes)
    return found[0]


def ways(place: PathJunction, numbers: object) -> set[tuple[str, str]]:
    return {
        (movement.source, movement.target)
        for number, movement in place.movements.items()
        if number in numbers
    }


def test_who_turns_into_the_lane_beside_the_path_passes_it(place):
    beside = ways(place, place.beside)
    assert ("B0B1_0", "B1C1_0") in beside  # right, into the right lane
    assert ("C1B1_0", "B1A1_0") in beside  # towards it
    assert ("B2B1_0", "B1A1_0") in beside  # right, into the road that it comes from


def test_who_crosses_the_path_or_joins_it_does_not(place):
    across = ways(place, place.conflicts)
    assert ("B0B1_0", "B1B2_0") in across
    assert ("B2B1_1", "B1C1_1") in across
    assert not across & ways(place, place.beside)


def test_who_comes_along_the_path_is_neither(place):
    own = place.movement
    assert own.source == "A1B1_1"
    assert own.number not in place.beside | place.conflicts.keys()
