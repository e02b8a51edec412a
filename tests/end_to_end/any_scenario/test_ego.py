"""The ego: where it is taken over or inserted, its way, its headings, other vehicles in front."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shapely

from giveway.run_data.progress import Ending

if TYPE_CHECKING:
    from pathlib import Path

    from giveway import RunResult

Drive = Callable[..., tuple[Any, Any]]  # the result of a run, and what was seen on the way
NOBODY = {"crowd": {"zone": "none"}}
ALONE = {"traffic_lights": False, "following": False}  # [rules]
ROUND_THE_BLOCK = ("B1C1", "C1C2", "C2B2", "B2B1", "B1C1", "C1D1")  # east, north, west, south


def headings_from_track(track: Any, length: float) -> np.ndarray:
    """Direction from where the front was ``length`` [m] ago to where it is; nan at first."""
    s = track.position
    before = s - length
    x, y = np.interp(before, s, track.front_x), np.interp(before, s, track.front_y)
    heading = np.arctan2(track.front_y - y, track.front_x - x)
    return np.where(before >= 0.0, heading, np.nan)


def difference(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.abs((a - b + np.pi) % (2 * np.pi) - np.pi)


# --- taken over --------------------------------------------------------------------------------


def test_sumo_has_the_ego_where_we_have_it(crowded: tuple[RunResult, Any]) -> None:
    result, look = crowded
    track = result.ego_track
    for k in range(0, len(track.time), 20):
        i = int(np.argmin(np.abs(np.array(look.times) - track.time[k])))
        x, y, angle, *_ = look.cars[i]["car10"]
        assert math.dist((x, y), (track.front_x[k], track.front_y[k])) < 1e-6
        ours = math.degrees(math.pi / 2 - track.heading[k])
        assert abs((angle - ours + 180) % 360 - 180) < 1e-6


def test_metres_driven_are_metres_of_lane(drive: Drive, city: Callable[[float], Path]) -> None:
    ego = {"route": ("A1B1", "B1C1", "C1D1"), "initial_speed": 10.0}
    own = {"regulation": {"reference_speed": 12.0}, "rules": ALONE, **NOBODY}
    result, look = drive(city(0.1), ego=ego, **own, time_limit=12.0)
    track = result.ego_track
    lanes = [shapely.LineString(shape) for shape in look.lanes.values()]
    tree = shapely.STRtree(lanes)
    points = shapely.points(np.column_stack([track.front_x, track.front_y]))
    measured = 0
    assert track.position[-1] > 100.0
    for k in range(len(points) - 1):
        for i in tree.query(points[k], "dwithin", 1e-6):
            if shapely.dwithin(lanes[i], points[k + 1], 1e-6):
                along = lanes[i].project(points[k + 1]) - lanes[i].project(points[k])
                driven = track.position[k + 1] - track.position[k]
                assert along == pytest.approx(driven, abs=1e-6)
                measured += 1
                break
    assert measured > 0.9 * len(points)  # the rest is steps over the end of a lane


def test_the_ego_looks_ahead_on_roads_of_every_direction(
    drive: Drive, city: Callable[[float], Path]
) -> None:
    result, _ = drive(
        city(0.1),
        ego={"route": ROUND_THE_BLOCK, "initial_speed": 8.0, "travel_distance": 430.0},
        regulation={"reference_speed": 12.0},
        rules=ALONE,
        **NOBODY,
    )
    track = result.ego_track
    assert result.ending is Ending.COMPLETED
    expected = headings_from_track(track, result.shape.length)
    assert np.nanmax(difference(track.heading, expected)) < 0.02
    seen = {round(math.degrees(h)) % 360 for h in track.heading}
    assert {0, 90, 180, 270} <= seen
    towards = np.arctan2(np.diff(track.front_y), np.diff(track.front_x))
    straight = difference(expected[1:], expected[:-1]) < 1e-9
    assert straight.sum() > 100
    assert difference(track.heading[:-1], towards)[straight].max() < 1e-6
    at_the_end = np.array([track.front_x[-1], track.front_y[-1]])  # B1 and B1C1 a second time
    before = np.column_stack([track.front_x, track.front_y])[track.position < 200.0]
    assert np.hypot(*(before - at_the_end).T).min() < 4.0


def test_it_drives_diagonals_bends_and_a_net_without_sidewalks(
    drive: Drive,
    scenario: Callable[..., Path],
    call_sumo: Callable[..., str],
    tmp_path: Path,
) -> None:
    (tmp_path / "n.nod.xml").write_text(
        '<nodes><node id="a" x="0" y="0"/><node id="b" x="-80" y="-60"/>'
        '<node id="c" x="-80" y="60"/><node id="d" x="0" y="100"/></nodes>'
    )
    (tmp_path / "e.edg.xml").write_text(
        '<edges><edge id="ab" from="a" to="b"/><edge id="bc" from="b" to="c" '
        'shape="-80,-60 -100,-40 -110,0 -100,40 -80,60"/><edge id="cd" from="c" to="d"/></edges>'
    )
    net = tmp_path / "bent.net.xml"
    call_sumo("netconvert", "-n", "n.nod.xml", "-e", "e.edg.xml", "-o", net, cwd=tmp_path)
    config = scenario("", net=net)
    ego = {"route": ("ab", "bc", "cd"), "depart_position": 7.0}
    result, _ = drive(config, ego=ego, regulation={"reference_speed": 10.0})
    track = result.ego_track
    assert result.ending is Ending.COMPLETED
    expected = headings_from_track(track, result.shape.length)
    assert np.nanmax(difference(track.heading, expected)) < 0.03
    degrees = np.degrees(track.heading) % 360
    assert degrees[0] == pytest.approx(216.87, abs=0.01)  # (-4, -3)
    assert degrees[-1] == pytest.approx(26.57, abs=0.01)  # (2, 1)
    assert any("neither sidewalks nor walkingareas" in remark for remark in result.remarks)


CLASSES = """
    <vType id="coach" vClass="bus" length="12"/> <vType id="lorry" vClass="truck" length="9"/>
    <vType id="bike" vClass="bicycle" maxSpeed="6"/> <vType id="any"/>
    <trip id="bus" type="coach" depart="0" from="A0B0" to="C0D0"/>
    <trip id="truck" type="lorry" depart="1" from="A1B1" to="C1C2"/>
    <trip id="bicycle" type="bike" depart="2" from="A2B2" to="C2D2"/>
    <flow id="flow" type="any" begin="3" end="100" period="2" from="A3B3" to="C3C2"/>
"""


BUS = {"mass": 12000.0, "force_limit": 60_000.0}


@pytest.mark.parametrize("options", ["", '<lateral-resolution value="0.8"/>'])
def test_several_egos_of_all_kinds_each_with_its_own_driver(
    drive: Drive, scenario: Callable[..., Path], options: str
) -> None:
    config = scenario(CLASSES, options)
    result, look = drive(
        config,
        crowd={"zone": "none"},
        time_limit=12.0,
        egos=(
            {"ego": {"take_over": "bus"}, "vehicle": BUS, "controller": "pid"},
            {"ego": {"take_over": "truck"}, "vehicle": {"fmu": "fmi3"}, "controller": "mpc-paper"},
            {"ego": {"take_over": "bicycle"}, "regulation": {"reference_speed": 5.0}},
            {"ego": {"take_over": "flow.3"}},
            {"ego": {"id": "own", "route": ["D0C0", "C0B0"], "depart_time": 4.0}},
        ),
    )
    egos = {ego.id: ego for ego in result.egos}
    assert list(egos) == ["bus", "truck", "bicycle", "own", "flow.3"]  # as they departed
    assert (egos["bus"].shape.length, egos["truck"].shape.length) == (12.0, 9.0)
    assert egos["bicycle"].shape.width < 1.0
    assert set(egos["bus"].track.controller) == {"pid"}
    assert "mpc" in egos["truck"].track.controller
    fmus = {name: entry["fmi_version"] for name, entry in result.manifest["vehicles"].items()}
    assert fmus == {**dict.fromkeys(egos, "2.0"), "truck": "3.0"}
    assert egos["own"].track.time[0] == pytest.approx(4.0)
    for name, ego in egos.items():
        jumps = np.hypot(np.diff(ego.track.front_x), np.diff(ego.track.front_y))
        assert jumps.max() <= 0.05 * ego.track.speed.max() + 1e-9
        assert not look.collided(name)
    assert len(result.summary_table) == 5


@pytest.mark.parametrize("speed", [4.0, 13.0])
@pytest.mark.parametrize("leader", ["slow", "standing"])
@pytest.mark.parametrize("controller", ["mpc", "mpc-paper"])
def test_the_ego_keeps_behind_the_vehicle_in_front(
    drive: Drive, scenario: Callable[..., Path], speed: float, leader: str, controller: str
) -> None:
    standing = '<stop edge="B0C0" endPos="60" duration="15"/>' if leader == "standing" else ""
    config = scenario(
        f"""<vType id="van" maxSpeed="3"/>
        <vehicle id="leader" type="van" depart="0" departPos="30" departLane="1">
            <route edges="A0B0 B0C0 C0D0"/>{standing}
        </vehicle>"""
    )
    ego = {"route": ("A0B0", "B0C0"), "lane": 1, "depart_time": 1.0, "travel_distance": 120.0}
    regulation = {"reference_speed": speed}
    result, look = drive(
        config,
        ego=ego,
        regulation=regulation,
        rules={"traffic_lights": False},
        controller=controller,
        time_limit=60.0,
        **NOBODY,
    )
    assert "leader" in look.cars[20]
    assert not look.collided("ego")
    gap = result.ego["vehicle_gap"]
    assert 1.0 < gap.min() < 12.0  # it came near, and not too near
    assert result.ego_track.speed[-1] < 5.0
    if controller == "mpc":
        assert result.summary["hard_brakes"] == 0  # it closes in comfortably
    standing = result.ego[result.ego["speed"] < 0.2]
    assert set(standing["waits_for"]) <= {"vehicle", ""}


# --- who never departs --------------------------------------------------------------------------


@pytest.mark.parametrize("controller", ["mpc", "mpc-paper"])
def test_a_left_turn_gives_way_to_oncoming_traffic(
    drive: Drive, scenario: Callable[..., Path], controller: str
) -> None:
    config = scenario(
        '<flow id="on" begin="0" end="100" period="3" departLane="random" departSpeed="max">'
        '<route edges="C1B1 B1A1"/></flow>'
    )
    ego = {"route": ("A1B1", "B1B2"), "depart_time": 5.0, "initial_speed": 4.0}
    _, look = drive(config, ego=ego, controller=controller, time_limit=70.0, **NOBODY)
    assert look.collided("ego") == set()
