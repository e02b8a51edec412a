"""Who goes first where two roads cross: egos and SUMO's cars."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest
from support.priority import NO_PRIORITY

if TYPE_CHECKING:
    from pathlib import Path

Drive = Callable[..., tuple[Any, Any]]  # the result of a run, and what was seen on the way
STREAM = (  # a car every 3 s on the road with priority, for half a minute
    '<vType id="car" sigma="0" speedDev="0"/><flow id="east" type="car" begin="0" end="30" '
    'period="3" departSpeed="max"><route edges="{}"/></flow>'
)
EGO = {"depart_position": 40.0, "depart_time": 8.0, "initial_speed": 8.0, "travel_distance": 80.0}
SPEED: dict[str, Any] = {"regulation": {"reference_speed": 8.0}, "vehicle": {"speed_max": 8.0}}


@pytest.fixture(scope="module")
def crossroads(
    tmp_path_factory: pytest.TempPathFactory, call_sumo: Callable[..., str]
) -> Callable[[str], Path]:
    """Two roads of one lane each way that cross, of 100 m each; the one along x has priority."""
    nets: dict[str, Path] = {}

    def build(kind: str) -> Path:
        if kind not in nets:
            folder = tmp_path_factory.mktemp(kind)
            places = {"w": (-1, 0), "e": (1, 0), "s": (0, -1), "n": (0, 1)}
            nodes = "".join(
                f'<node id="{name}" x="{100 * x}" y="{100 * y}"/>'
                for name, (x, y) in places.items()
            )
            edges = "".join(
                f'<edge id="{name}{end}" from="{a}" to="{b}" speed="13.9" '
                f'priority="{1 + (y == 0)}"/>'
                for name, (_, y) in places.items()
                for end, a, b in (("_in", name, "c"), ("_out", "c", name))
            )
            (folder / "n.nod.xml").write_text(
                f'<nodes><node id="c" x="0" y="0" type="{kind}"/>{nodes}</nodes>'
            )
            (folder / "e.edg.xml").write_text(f"<edges>{edges}</edges>")
            nets[kind] = net = folder / "x.net.xml"
            call_sumo("netconvert", "-n", "n.nod.xml", "-e", "e.edg.xml", "-o", net, cwd=folder)
        return nets[kind]

    return build


def test_from_a_side_road_it_waits_for_the_stream_to_end(
    drive: Drive, scenario: Callable[..., Path], crossroads: Callable[[str], Path]
) -> None:
    config = scenario(STREAM.format("e_in w_out"), net=crossroads("priority"))
    ego = {**EGO, "route": ("s_in", "n_out")}
    result, _ = drive(config, ego=ego, time_limit=60.0, **SPEED)
    assert result.summary["completed"]
    assert result.summary["vehicle_contacts"] == 0
    assert result.summary["hard_brakes"] == 0
    waits = result.ego[result.ego.waits_for == "yield"]
    front_of_line = waits.position.max()
    assert 40.0 < front_of_line < 60.0  # before the junction
    assert waits.time.max() > 30.0  # until the last of them has passed
    assert result.manifest["traffic"]["vehicles_that_yielded"] == 0
    first, _ = drive(config, ego=ego, time_limit=60.0, **_without_law())
    assert first.ego.time.max() < waits.time.max()


def _without_law() -> dict[str, Any]:
    return {**SPEED, "rules": NO_PRIORITY}


def test_a_left_turn_at_green_waits_for_who_comes_towards_it(
    drive: Drive, scenario: Callable[..., Path], crossroads: Callable[[str], Path]
) -> None:
    config = scenario(STREAM.format("e_in w_out"), net=crossroads("traffic_light"))
    ego = {**EGO, "route": ("w_in", "n_out")}
    result, _ = drive(config, ego=ego, time_limit=90.0, **SPEED)
    assert result.summary["completed"]
    assert result.summary["vehicle_contacts"] == 0
    waits = result.ego[result.ego.waits_for == "yield"]
    assert waits.time.max() > 30.0  # until the last of them has passed


def test_a_car_from_a_side_road_yields_to_an_ego_on_the_main(
    drive: Drive, scenario: Callable[..., Path], crossroads: Callable[[str], Path]
) -> None:
    config = scenario(STREAM.format("s_in n_out"), net=crossroads("priority"))
    result, _ = drive(config, ego={**EGO, "route": ("w_in", "e_out")}, time_limit=60.0, **SPEED)
    assert result.summary["vehicle_contacts"] == 0
    assert result.summary["peak_deceleration"] < 1.0
    assert result.ego.speed.min() > 7.5
