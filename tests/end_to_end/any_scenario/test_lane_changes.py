"""Background vehicles on the lane that an ego changes to keep behind it, and nobody is stuck.

a === two lanes, 200 m === b --- one lane --- c      the right lane ends at b
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from pathlib import Path

Drive = Callable[..., tuple[Any, Any]]  # the result of a run, and what was seen on the way
FLOW = """<flow id="f" begin="0" end="200" period="2.5" departSpeed="max" departLane="random">
    <route edges="ab bc"/></flow>"""


@pytest.fixture(scope="module")
def narrowing(tmp_path_factory: pytest.TempPathFactory, call_sumo: Callable[..., str]) -> Path:
    """The network."""
    folder = tmp_path_factory.mktemp("narrowing")
    (folder / "n.nod.xml").write_text(
        '<nodes><node id="a" x="0" y="0"/><node id="b" x="200" y="0"/><node id="c" x="400" y="0"/>'
        "</nodes>"
    )
    (folder / "e.edg.xml").write_text(
        '<edges><edge id="ab" from="a" to="b" numLanes="2" speed="13.9"/>'
        '<edge id="bc" from="b" to="c" numLanes="1" speed="13.9"/></edges>'
    )
    net = folder / "narrowing.net.xml"
    call_sumo("netconvert", "-n", "n.nod.xml", "-e", "e.edg.xml", "-o", net, cwd=folder)
    return net


def changes_lanes(
    drive: Drive, config: Path, place: float, seconds: float, controller: str = "pid-tuned"
) -> tuple[Any, Any]:
    """Insert an ego on the lane that ends, ``place`` [m] from a, and drive on at 4 m/s."""
    ego = {"route": ("ab", "bc"), "lane": 0, "depart_time": 20.0, "depart_position": place}
    return drive(config, ego=ego, controller=controller, time_limit=seconds, crowd={"zone": "none"})


def test_vehicles_on_the_lane_an_ego_changes_to_keep_behind_it(
    drive: Drive, scenario: Callable[..., Path], narrowing: Path
) -> None:
    result, look = changes_lanes(drive, scenario(FLOW, net=narrowing), 100.0, 15.0)
    y = result.ego_track.front_y
    assert y[0] == pytest.approx(-4.8, abs=0.01)
    assert y[-1] == pytest.approx(-1.6, abs=0.01)
    assert look.collided("ego") == set()
    assert result.summary["vehicle_contacts"] == 0
    assert result.manifest["traffic"]["vehicles_that_yielded"] >= 1


def test_who_touches_an_ego_all_the_same_pulls_away_from_it(
    drive: Drive, scenario: Callable[..., Path], narrowing: Path
) -> None:
    """An ego of the paper gives way to nobody beside it: it turns into the side of a car."""
    config = scenario(FLOW, net=narrowing)
    result, _ = changes_lanes(drive, config, 180.0, 20.0, "mpc-paper")
    assert 1.0 < result.summary["vehicle_contact_time"] < 5.0
    assert result.ego_track.position[-1] > 40.0
