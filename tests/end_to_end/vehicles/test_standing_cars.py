"""Cars that creep and feel the road stop on a hill, stand there, and do not roll back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import tomlkit

import giveway as library
from giveway.errors import VehicleError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

STOP = 6.0  # [s] scheduled stop on the ramp
CREEPS = {"mass": 1200.0, "creep": 900.0}


@pytest.fixture(scope="module")
def hill(tmp_path_factory: pytest.TempPathFactory, call_sumo: Callable[..., str]) -> Path:
    """40 m on the level, 60 m with 6 %, 30 m on the level; both ways with a stop on the ramp."""
    folder = tmp_path_factory.mktemp("hill")
    nodes = (("a", 0, 0), ("b", 40, 0), ("c", 100, 3.6), ("d", 130, 3.6))
    text = "".join(f'<node id="{n}" x="{x}" y="0" z="{z}"/>' for n, x, z in nodes)
    (folder / "n.nod.xml").write_text(f"<nodes>{text}</nodes>")
    ways = {"up": ("ab", "bc", "cd"), "down": ("dc", "cb", "ba")}
    text = "".join(
        f'<edge id="{e}" from="{e[0]}" to="{e[1]}"/>' for way in ways.values() for e in way
    )
    (folder / "e.edg.xml").write_text(f"<edges>{text}</edges>")
    files = ("-n", "n.nod.xml", "-e", "e.edg.xml", "-o", "hill.net.xml")
    call_sumo("netconvert", *files, cwd=folder)
    for way, edges in ways.items():
        (folder / f"{way}.rou.xml").write_text(
            f'<routes><vehicle id="v" depart="0" departSpeed="8"><route edges="{" ".join(edges)}"/>'
            f'<stop lane="{edges[1]}_0" endPos="40" duration="{STOP}"/></vehicle></routes>'
        )
        (folder / f"{way}.sumocfg").write_text(
            f'<configuration><net-file value="hill.net.xml"/><route-files value="{way}.rou.xml"/>'
            '<end value="200"/><step-length value="0.1"/></configuration>'
        )
    return folder


@pytest.fixture
def driven(zoo: Any, hill: Path, tmp_path: Path) -> Callable[..., Any]:
    """The result of a drive over the hill, with nobody on it."""

    def run(way: str, controller: str = "mpc", **options: Any) -> Any:
        car = zoo.car(role="throttle_brake", outputs=("speed", "position"), **options)
        path = tmp_path / "car.toml"
        path.write_text(tomlkit.dumps(zoo.profile(car)), encoding="utf-8")
        return library.run(
            {
                "scenario": str(hill / f"{way}.sumocfg"),
                "controller": controller,
                "time_limit": 40.0,
                "vehicle": {"fmu": str(car), "profile": str(path), "isolation": "none"},
                "ego": {"take_over": "v"},
                "crowd": {"zone": "none", "pedestrians": 0},
                "sumo.baseline": False,
                "rules.stops": True,
            }
        )

    return run


@pytest.mark.parametrize("way", ["up", "down"])
@pytest.mark.parametrize("controller", ["mpc", "pid-tuned"])
def test_it_stands_at_its_stop_and_drives_off(driven, way, controller):
    result = driven(way, controller, extra=("grade",), values=CREEPS)
    assert result.completed
    speed, position = (result.ego[name].to_numpy() for name in ("speed", "position"))
    assert 0.05 * (np.abs(speed) < 0.05).sum() >= STOP - 1.0
    assert (np.maximum.accumulate(position) - position).max() < 0.01  # it never rolls back
    (remark,) = (remark for remark in result.remarks if "its brakes are held" in remark)
    assert "creeps at 1 m/s without a demand and rolls at 1.9 m/s on" in remark


def test_brakes_that_do_not_hold_end_a_run_before_it_begins(driven):
    with pytest.raises(VehicleError, match=r"creeps at 1 m/s .* with the brake applied; see"):
        driven("up", values=CREEPS | {"holds": 0.0})
