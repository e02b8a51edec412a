"""On a drawn street people walk over its crossings, on green where there are lights."""

from __future__ import annotations

import os
import subprocess
import tomllib
from collections import defaultdict
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import pytest

from giveway.scenario_builder.description import Crossing, Street, StreetDemand
from giveway.scenario_builder.street import street_files
from sumo_scenarios.build import build, netconvert_and_home

if TYPE_CHECKING:
    from pathlib import Path

Track = list[tuple[float, float, float]]  # time [s], x [m], y [m]


def tracks(street: Street, folder: Path, end: float = 180.0) -> dict[str, Track]:
    """Where everybody on foot is at each second, by plain SUMO."""
    for name, text in street_files(street, "drawn").items():
        (folder / name).write_text(text)
    build(str(folder))
    home = netconvert_and_home()[1]
    words = [home / "bin" / "sumo", "-c", "drawn.sumocfg", "--end", f"{end:g}"]
    words += ["--fcd-output", "fcd.xml", "--device.fcd.period", "1", "--no-step-log"]
    subprocess.run(
        words,
        check=True,
        cwd=folder,
        capture_output=True,
        env=os.environ | {"SUMO_HOME": str(home)},
    )
    found: dict[str, Track] = defaultdict(list)
    for step in ElementTree.parse(folder / "fcd.xml").iter("timestep"):
        for person in step.iter("person"):
            x, y = float(person.get("x", "nan")), float(person.get("y", "nan"))
            found[person.get("id", "")].append((float(step.get("time", "nan")), x, y))
    return found


@pytest.mark.parametrize("traffic", ["right", "left"])
def test_everybody_crosses_at_the_zebra_meant(traffic: str, tmp_path: Path) -> None:
    """
    ======|======|======   zebras at 70 and 160 m, 4 m wide; a person of the flow ..._1 takes the
    ------|------|------   first, and one of ..._2 the second
    ======|======|======
    """
    zebras = Crossing(position=70.0), Crossing(position=160.0)
    street = Street(traffic=traffic, crossing=zebras)
    walked = tracks(street, tmp_path)
    over = 0
    for name, track in walked.items():
        middle = {"1": 70.0, "2": 160.0}[name.partition(".")[0][-1]]
        on_road = [x for _, x, y in track if abs(y) < 3.0]
        over += bool(on_road)
        assert all(abs(x - middle) <= 2.0 for x in on_road), name
    assert over > 30


def test_on_red_nobody_sets_foot_on_the_road(tmp_path: Path) -> None:
    """People's green is from 44 to 54 s of each cycle of 60 s; 7 m take 6 s at 1.2 m/s."""
    walked = tracks(Street(crossing=(Crossing(position=110.0, kind="signals"),)), tmp_path)
    edges = [
        next((time for time, _, y in track if abs(y) < 3.0), None) for track in walked.values()
    ]
    entered = [time % 60.0 for time in edges if time is not None]
    assert len(entered) >= 15
    assert all(44.0 <= time <= 56.0 for time in entered)


@pytest.mark.parametrize(("traffic", "side"), [("right", -1.0), ("left", 1.0)])
def test_vehicles_that_drive_east_are_on_their_side(
    traffic: str, side: float, tmp_path: Path
) -> None:
    for name, text in street_files(Street(traffic=traffic), "drawn").items():
        (tmp_path / name).write_text(text)
    network = ElementTree.parse(build(str(tmp_path)))
    lane = network.find(".//lane[@id='east_1_1']")
    assert lane is not None
    points = [point.split(",") for point in lane.get("shape", "").split()]
    assert float(points[0][0]) < float(points[-1][0])
    assert [float(y) for _, y in points] == [side * 1.75] * len(points)


def test_each_direction_ends_at_a_node_of_its_own() -> None:
    """Else people would walk round the end of the street, and not over its crossing."""
    text = street_files(Street(crossing=(Crossing(position=100.0),)), "drawn")["drawn.nod.xml"]
    ends = [node.get("id") for node in ElementTree.fromstring(text) if "end" in node.get("id", "")]
    assert ends == ["west_end_south", "west_end_north", "east_end_south", "east_end_north"]


@pytest.mark.parametrize("pavement", [3.0, 0.0])
def test_without_crossings_people_cross_half_way(pavement: float) -> None:
    street = Street(pavement=pavement, demand=StreetDemand(people=300.0))
    settings = tomllib.loads(street_files(street, "drawn")["drawn.giveway.toml"])
    assert settings["ego"]["lane"] == (1 if pavement else 0)
    north, south = settings["crowd"]["flow"]
    assert north["from"] == south["to"]
    assert north["rate"] == 150.0
    assert north["from"][0] == 95.0
    assert north["from"][3] < -3.5  # beside the lane, which is 3.5 m wide


def test_no_demand_makes_an_empty_street() -> None:
    empty = StreetDemand(people=0.0, vehicles=0.0)
    files = street_files(Street(crossing=(Crossing(position=90.0),), demand=empty), "drawn")
    tags = {element.tag for element in ElementTree.fromstring(files["drawn.rou.xml"])}
    assert tags == {"vType"}
