"""Background vehicles on the lanes beside an ego's in a bend, while SUMO steps once a second."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

if TYPE_CHECKING:
    from pathlib import Path

Drive = Callable[..., tuple[Any, Any]]  # the result of a run, and what was seen on the way
STAY = 'lcStrategic="-1" lcCooperative="0" lcSpeedGain="0" lcKeepRight="0" sigma="0"'
RADIUS = 35.0  # [m]


@pytest.fixture(scope="module")
def bend(tmp_path_factory: pytest.TempPathFactory, call_sumo: Callable[..., str]) -> Path:
    """Three lanes, 40 m straight and half a circle to the left."""
    folder = tmp_path_factory.mktemp("bend")
    turn = np.linspace(0.0, math.pi, 46)
    arc = [
        f"{40.0 + RADIUS * math.sin(a):.3f},{RADIUS * (1.0 - math.cos(a)):.3f}" for a in turn[:-1]
    ]
    (folder / "n.nod.xml").write_text(
        f'<nodes><node id="a" x="0" y="0"/><node id="b" x="40" y="{2 * RADIUS}"/></nodes>'
    )
    (folder / "e.edg.xml").write_text(
        '<edges><edge id="ab" from="a" to="b" numLanes="3" speed="13.9" '
        f'shape="0,0 {" ".join(arc)} 40,{2 * RADIUS}"/></edges>'
    )
    net = folder / "bend.net.xml"
    call_sumo("netconvert", "-n", "n.nod.xml", "-e", "e.edg.xml", "-o", net, cwd=folder)
    return net


def test_an_ego_in_a_bend_does_not_brake_for_an_overtaking_car(
    drive: Drive, scenario: Callable[..., Path], bend: Path
) -> None:
    flows = "".join(
        f'<flow id="on{lane}" type="stay" begin="0" end="60" period="3" departSpeed="max" '
        f'departLane="{lane}"><route edges="ab"/></flow>'
        for lane in (0, 2)
    )
    config = scenario(f'<vType id="stay" {STAY}/>{flows}', net=bend, step=1.0)
    ego = {"route": ("ab",), "lane": 1, "depart_time": 6.0, "travel_distance": 120.0}
    result, look = drive(config, ego=ego, time_limit=35.0, crowd={"zone": "none"})
    beside = [
        math.dist(cars["ego"][:2], car[:2])
        for cars in look.cars
        if "ego" in cars
        for name, car in cars.items()
        if name != "ego"
    ]
    assert min(beside) < 5.0
    assert result.ego["vehicle_gap"].isna().all()
    assert result.summary["hard_brakes"] == 0
    assert result.summary["travelled_distance"] > 110.0
