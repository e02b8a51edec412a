"""Where lanes become one, an ego and SUMO's cars go one behind the other, and nobody is stuck.

drop, zipper  a === two lanes, 200 m === b --- one lane --- c
ramp          a ---------- m === two lanes, 130 m === b --- one lane --- c
              r ----------'     the ramp's lane is the right one, which ends
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest
from support.priority import NO_PRIORITY

if TYPE_CHECKING:
    from pathlib import Path

Drive = Callable[..., tuple[Any, Any]]  # the result of a run, and what was seen on the way
EDGE = '<edge id="{0}{1}" from="{0}" to="{1}" numLanes="{2}" speed="13.9" priority="{3}"/>'
LINK = '<connection from="{}" to="{}" fromLane="{}" toLane="{}"/>'
NODE = '<node id="{}" x="{}" y="{}" type="{}"/>'
NETS = {
    "drop": (
        (("a", 0, 0), ("b", 200, 0), ("c", 400, 0)),
        (("a", "b", 2, 5), ("b", "c", 1, 5)),
        (("ab", "bc", 1, 0),),
    ),
    "zipper": (
        (("a", 0, 0), ("b", 200, 0, "zipper"), ("c", 400, 0)),
        (("a", "b", 2, 5), ("b", "c", 1, 5)),
        (("ab", "bc", 0, 0), ("ab", "bc", 1, 0)),
    ),
    "ramp": (
        (("a", 0, 0), ("r", 0, -60), ("m", 120, 0), ("b", 250, 0), ("c", 400, 0)),
        (("a", "m", 1, 5), ("r", "m", 1, 3), ("m", "b", 2, 5), ("b", "c", 1, 5)),
        (("am", "mb", 0, 1), ("rm", "mb", 0, 0), ("mb", "bc", 1, 0)),
    ),
}
ROAD = '<flow id="{}" begin="0" end="200" period="{}" departSpeed="max" departLane="random"><route \
edges="{}"/></flow>'
DENSE = {
    "drop": ROAD.format("f", 1.7, "ab bc"),
    "zipper": ROAD.format("f", 1.7, "ab bc"),
    "ramp": ROAD.format("f", 3.2, "am mb bc") + ROAD.format("g", 5, "rm mb bc"),
}


@pytest.fixture(scope="module")
def narrow(
    tmp_path_factory: pytest.TempPathFactory, call_sumo: Callable[..., str]
) -> Callable[[str], Path]:
    """The network of one of NETS, built once."""
    built: dict[str, Path] = {}

    def build(name: str) -> Path:
        if name not in built:
            folder = tmp_path_factory.mktemp(name)
            nodes, edges, links = NETS[name]
            parts = (
                ("nodes", (NODE.format(*(*node, "priority")[:4]) for node in nodes)),
                ("edges", (EDGE.format(*edge) for edge in edges)),
                ("connections", (LINK.format(*link) for link in links)),
            )
            for kind, lines in parts:
                (folder / f"{kind}.xml").write_text(f"<{kind}>{''.join(lines)}</{kind}>")
            files = ("-n", "nodes.xml", "-e", "edges.xml", "-x", "connections.xml")
            call_sumo("netconvert", *files, "-o", "net.net.xml", cwd=folder)
            built[name] = folder / "net.net.xml"
        return built[name]

    return build


@pytest.fixture
def merge(
    drive: Drive, scenario: Callable[..., Path], narrow: Callable[[str], Path]
) -> Callable[..., tuple[Any, Any]]:
    """Drive an ego through one of NETS in dense traffic."""

    def run(name: str, lane: int, controller: str, seed: int, **config: Any) -> tuple[Any, Any]:
        begin = "rm" if name == "ramp" and lane == 0 else "am" if name == "ramp" else "ab"
        ego = {
            "route": (begin, "mb", "bc") if name == "ramp" else ("ab", "bc"),
            "lane": 0 if name == "ramp" else lane,
            "depart_time": 20.0 + 0.7 * seed,
            "depart_position": 10.0 + 15.0 * (seed % 3),
        }
        step = config.pop("step", 0.1)
        place = scenario(DENSE[name], net=narrow(name), step=step)
        settings = {"sumo": {"seed": seed}, "crowd": {"zone": "none"}, "time_limit": 40.0}
        return drive(place, ego=ego, controller=controller, **(settings | config))

    return run


# Without giving way, each of these touched somebody or braked with up to 9 m/s^2.
@pytest.mark.parametrize(
    ("name", "lane", "speed", "controller", "seed", "step"),
    [
        ("drop", 0, 13.9, "mpc", 5, 0.1),
        ("drop", 0, 8.0, "pid-tuned", 2, 0.1),
        ("ramp", 0, 8.0, "mpc", 3, 0.1),
        ("ramp", 0, 8.0, "pid-tuned", 2, 0.1),
        ("ramp", 0, 13.9, "pid-tuned", 2, 1),
        ("zipper", 0, 13.9, "mpc", 3, 0.1),
        ("zipper", 1, 13.9, "mpc", 5, 0.1),
    ],
)
def test_nobody_touches_an_ego_that_merges_and_it_gets_through(
    merge: Callable[..., tuple[Any, Any]],
    name: str,
    lane: int,
    speed: float,
    controller: str,
    seed: int,
    step: float,
) -> None:
    regulation = {"reference_speed": speed}
    result, look = merge(name, lane, controller, seed, step=step, regulation=regulation)
    assert result.summary["vehicle_contacts"] == 0
    assert look.collided("ego") == set()
    track = result.ego_track
    assert track.acceleration.min() > -4.1
    assert track.front_x[-1] > 220.0  # it is beyond the place
    assert len(look.cars[-1]) > 3


def test_an_ego_is_let_in_by_those_who_can_brake_in_comfort(
    merge: Callable[..., tuple[Any, Any]],
) -> None:
    """It departs slowly, close behind where fast cars enter, and waits for a gap."""
    regulation = {"reference_speed": 8.0}
    result, look = merge("drop", 0, "pid-tuned", 5, regulation=regulation, time_limit=30.0)
    assert result.manifest["traffic"]["vehicles_that_yielded"] >= 1
    assert result.summary["vehicle_contacts"] == 0
    assert look.collided("ego") == set()
    standing = result.ego_track.speed < 0.1
    assert 1.0 < standing.sum() * 0.05 < 15.0
    assert set(result.ego_track.waits_for[standing]) <= {"yield", "vehicle"}
    assert result.ego_track.front_y[-1] == pytest.approx(-1.6, abs=0.3)


def test_a_car_on_the_ramp_beside_the_road_is_not_expected_on_it(
    merge: Callable[..., tuple[Any, Any]],
) -> None:
    """Straight on, it would come into the ego's lane: the ego braked with 9 m/s^2 for nobody."""
    result, _ = merge("ramp", 1, "mpc", 1, regulation={"reference_speed": 13.9}, time_limit=15.0)
    assert result.ego_track.front_x[-1] > 140.0
    assert result.ego_track.acceleration.min() > -3.0


def test_without_the_law_of_the_road_an_ego_forces_its_way(
    merge: Callable[..., tuple[Any, Any]],
) -> None:
    own = {"regulation": {"reference_speed": 13.9}, "rules": NO_PRIORITY}
    result, _ = merge("drop", 0, "mpc", 5, **own, time_limit=12.0)
    assert result.summary["vehicle_contacts"] == 1
