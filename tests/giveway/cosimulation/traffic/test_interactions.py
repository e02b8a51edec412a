"""SUMO's own cars and the people whom giveway moves: who yields, who is run over."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest

from sumo_scenarios import find

if TYPE_CHECKING:
    from pathlib import Path

    from giveway import RunResult

Drive = Callable[..., tuple[Any, Any]]  # the result of a run, and what was seen on the way

# Two streams of people over a crossing without lights, and a car every few seconds each way.
NODES = """<nodes><node id="w" x="-150" y="0"/><node id="m" x="0" y="0" type="priority"/>
    <node id="e" x="150" y="0"/></nodes>"""
EDGES = "".join(
    f'<edge id="{a}{b}" from="{a}" to="{b}" speed="13.89" sidewalkWidth="2"/>'
    for a, b in ("wm", "me", "em", "mw")
)
PEOPLE = """
    <flow id="east" begin="0" end="60" period="4" departSpeed="max"><route edges="wm me"/></flow>
    <personFlow id="north" begin="0" end="60" period="0.8" departPos="130">
        <walk edges="wm mw" arrivalPos="100"/></personFlow>
    <personFlow id="south" begin="1" end="60" period="0.8" departPos="20">
        <walk edges="me em" arrivalPos="100"/></personFlow>
    <flow id="west" begin="2" end="60" period="5" departSpeed="max"><route edges="em mw"/></flow>
"""


@pytest.fixture(scope="session")
def zebra(tmp_path_factory: pytest.TempPathFactory, call_sumo: Callable[..., str]) -> Path:
    folder = tmp_path_factory.mktemp("zebra")
    (folder / "n.nod.xml").write_text(NODES)
    (folder / "e.edg.xml").write_text(f"<edges>{EDGES}</edges>")
    (folder / "c.con.xml").write_text(
        '<connections><crossing node="m" edges="me em" priority="true"/></connections>'
    )
    files = ("-n", "n.nod.xml", "-e", "e.edg.xml", "-x", "c.con.xml", "-o", "zebra.net.xml")
    call_sumo("netconvert", *files, "--walkingareas", cwd=folder)
    (folder / "a.rou.xml").write_text(f"<routes>{PEOPLE}</routes>")
    for step in (0.1, 1):
        (folder / f"zebra_{step}.sumocfg").write_text(
            f"""<configuration><net-file value="zebra.net.xml"/><route-files value="a.rou.xml"/>
            <begin value="0"/><end value="70"/><step-length value="{step}"/></configuration>"""
        )
    return folder


def crossing(drive: Drive, zebra: Path, step: float, yielding: bool) -> tuple[RunResult, Any]:
    return drive(
        zebra / f"zebra_{step}.sumocfg",
        ego={"none": True},
        crowd={"zone": "everywhere", "preset": "SIM"},  # few people of MIXED come before cars
        traffic={"yielding": yielding},
    )


@pytest.mark.parametrize("step", [0.1, 1])
def test_cars_that_yield_run_nobody_over_and_others_do(
    drive: Drive, zebra: Path, step: float
) -> None:
    result, look = crossing(drive, zebra, step, True)
    ours = set(result.crowd_track.ids)
    assert len(ours) > 100
    assert look.touched(ours, faster_than=2.0) == set()
    assert result.manifest["traffic"]["vehicles_that_yielded"] >= 3
    assert result.manifest["traffic"]["time_yielding"] > 10.0
    assert "people_touched" not in result.manifest["traffic"]
    result, look = crossing(drive, zebra, step, False)
    touched = look.touched(ours, faster_than=2.0)
    assert len(touched) >= (5 if step == 1 else 1)
    assert len(touched) <= result.manifest["traffic"]["people_touched"]
    (note,) = (text for text in result.remarks if "touched people" in text)
    assert any(f"touched '{name}'" in note for name in ours)


def test_cars_that_yielded_drive_on(drive: Drive) -> None:
    # At the bundled junction people come and go, so that every car gets its turn.
    ego, crowd = {"none": True}, {"zone": "everywhere"}
    result, look = drive(find("junction").config_file, ego=ego, crowd=crowd, time_limit=120.0)
    assert result.manifest["traffic"]["vehicles_that_yielded"] >= 5
    last = look.cars[-1]
    seen = set().union(*look.cars)
    assert len(seen - set(last)) > 15
    early = {name for cars in look.cars[:600] for name in cars}
    assert not early & set(last)  # who was there in the first minute has left in the second


def test_in_the_city_nobody_drives_through_anybody(crowded: tuple[RunResult, Any]) -> None:
    result, look = crowded
    assert look.touched(set(result.crowd_track.ids), faster_than=0.5) == set()
    assert look.collided("car10") == set()
    assert result.manifest["traffic"]["vehicles_that_yielded"] > 5


def test_cars_follow_the_ego(drive: Drive) -> None:
    _, look = drive(
        find("junction").config_file,
        ego={"depart_time": 0.0, "depart_position": 20.0, "initial_speed": 1.0},
        regulation={"reference_speed": 1.0},
        rules={"traffic_lights": False},
        crowd={"zone": "none"},
        time_limit=50.0,
    )
    assert look.collided("ego") == set()
    gaps = [c["ego"][0] - 5.0 - c["eastbound.0"][0] for c in look.cars if "eastbound.0" in c]
    assert min(gaps) > 0.5
    assert gaps[-1] < 6.0  # it has caught up and stays behind
