"""An ego enters where there is room, SUMO inserts it where there is none yet; and what touched it.

a ---------- one lane, 400 m, 13.9 m/s ---------- b
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest

import giveway

if TYPE_CHECKING:
    from pathlib import Path

Drive = Callable[..., tuple[Any, Any]]  # the result of a run, and what was seen on the way
NOBODY = {"crowd": {"zone": "none"}}
EVERY_3_S = (
    '<flow id="f" begin="0" end="100" period="3" departSpeed="max"><route edges="ab"/></flow>'
)
QUIET = '<vType id="even" sigma="0" speedDev="0"/>'


@pytest.fixture(scope="module")
def lane(tmp_path_factory: pytest.TempPathFactory, call_sumo: Callable[..., str]) -> Path:
    """The network of one lane."""
    folder = tmp_path_factory.mktemp("lane")
    (folder / "n.nod.xml").write_text(
        '<nodes><node id="a" x="0" y="0"/><node id="b" x="400" y="0"/></nodes>'
    )
    (folder / "e.edg.xml").write_text(
        '<edges><edge id="ab" from="a" to="b" numLanes="1" speed="13.9"/></edges>'
    )
    net = folder / "lane.net.xml"
    call_sumo("netconvert", "-n", "n.nod.xml", "-e", "e.edg.xml", "-o", net, cwd=folder)
    return net


def about(result: Any, *words: str) -> list[str]:
    return [remark for remark in result.remarks if all(word in remark for word in words)]


@pytest.mark.parametrize("step", [1, 0.1])
def test_no_car_that_departs_in_the_same_step_ends_in_the_ego(
    drive: Drive, scenario: Callable[..., Path], lane: Path, step: float
) -> None:
    config = scenario(EVERY_3_S, net=lane, step=step)
    result, look = drive(config, ego={"route": ("ab",)}, time_limit=12.0, **NOBODY)
    assert look.collided("ego") == set()
    assert result.summary["vehicle_contacts"] == 0
    assert result.ego_track.time[0] == step  # the ego came first in SUMO's own order
    assert result.ego_track.speed[0] == 4.0
    assert about(result, "SUMO inserted it") == []  # there was room; its insertion takes a step


def test_where_there_is_room_it_enters_at_its_time(
    drive: Drive, scenario: Callable[..., Path], lane: Path
) -> None:
    config = scenario(EVERY_3_S, net=lane)
    ego = {"route": ("ab",), "depart_time": 1.5}
    result, look = drive(config, ego=ego, time_limit=3.0, **NOBODY)
    assert look.collided("ego") == set()
    assert (result.ego_track.time[0], result.ego_track.front_x[0]) == (1.5, 0.0)
    assert about(result, "room") == []


def test_nobody_is_made_to_brake_harder_than_it_can(
    drive: Drive, scenario: Callable[..., Path], lane: Path
) -> None:
    """A car at 13.9 m/s is 20 m behind the place where the ego would enter at 4 m/s."""
    config = scenario(
        f'{QUIET}<vehicle id="fast" type="even" depart="0" departSpeed="max" departPos="5">'
        '<route edges="ab"/></vehicle>',
        net=lane,
    )
    ego = {"route": ("ab",), "depart_time": 9.3, "depart_position": 150.0}
    result, look = drive(config, ego=ego, time_limit=4.0, **NOBODY)
    first = look.times.index(9.3)
    speeds = [cars["fast"][3] for cars in look.cars[first:]]
    assert look.cars[first]["fast"][0] == pytest.approx(125.0, abs=10.0)
    assert min(speeds) > 13.0
    assert look.collided("ego") == set()
    assert 10.0 < result.ego_track.time[0] < 14.0  # once it had driven by
    assert about(result, "no room on lane 'ab_0' at 9.3 s")


def test_an_ego_without_room_ends_the_run_with_what_to_do(
    scenario: Callable[..., Path], lane: Path, refused: Any
) -> None:
    config = scenario(
        '<vehicle id="block" depart="0" departPos="20"><route edges="ab"/>'
        '<stop lane="ab_0" endPos="20" duration="5000"/></vehicle>',
        net=lane,
        end=400,
        step=1,
    )
    ego = {"route": ("ab",), "depart_time": 5.0, "depart_position": 18.0}
    with refused(giveway.GivewayError, "'ego'", "'ab_0' at 18 m", "300 s from 5 s", "--ego-depart"):
        giveway.run({"scenario": str(config), "ego": ego, **NOBODY})


def test_who_overlaps_somebody_is_taken_over_when_it_is_free(
    drive: Drive, scenario: Callable[..., Path], lane: Path
) -> None:
    config = scenario(
        """<vehicle id="block" depart="0" departPos="23"><route edges="ab"/>
        <stop lane="ab_0" endPos="23" duration="8"/></vehicle>
        <vehicle id="late" depart="2" departPos="20" departSpeed="0" insertionChecks="none">
        <route edges="ab"/></vehicle>""",
        "<collision.action value='none'/>",
        net=lane,
    )
    result, look = drive(config, ego={"take_over": ("late",)}, time_limit=5.0, **NOBODY)
    since, taken = 2.1, result.ego_track.time[0]
    assert "late" in look.cars[look.times.index(since)]
    assert 8.0 < taken < 15.0
    assert result.summary["vehicle_contacts"] == 0
    (remark,) = about(result, "'late'", "overlapped another vehicle at 2.1 s")
    assert f"{taken - since:.12g} s later" in remark


def test_contact_with_a_background_vehicle_is_counted_and_said(
    drive: Drive, scenario: Callable[..., Path], lane: Path
) -> None:
    config = scenario(
        '<vehicle id="block" depart="0" departPos="40"><route edges="ab"/>'
        '<stop lane="ab_0" endPos="40" duration="500"/></vehicle>',
        net=lane,
    )
    ego = {"route": ("ab",), "depart_time": 1.0, "depart_position": 10.0, "travel_distance": 80.0}
    blind = {"following": False}
    result, look = drive(config, ego=ego, rules=blind, time_limit=60.0, **NOBODY)
    assert look.collided("ego") == {"block"}
    summary, track = result.summary, result.ego_track
    inside = (track.front_x > 35.0) & (track.front_x - 5.0 < 40.0)
    assert summary["vehicle_contacts"] == 1
    assert summary["vehicle_contact_time"] == pytest.approx(0.05 * inside.sum(), abs=0.2)
    first = track.time[inside][0]
    (remark,) = about(result, "contact with 1 background vehicle(s): 'block'")
    assert f"from {first:.2g}" in remark
