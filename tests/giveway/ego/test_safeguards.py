"""The last word on an ego's force, and the gentle entry of a vehicle that is taken over."""

from __future__ import annotations

from math import inf
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import giveway
from controller.driving_constants import FIRM
from giveway.config import EgoRunConfig
from giveway.ego.perception.corridor import Corridor
from giveway.ego.perception.kerbs import NO_KERBS
from giveway.ego.safeguards import ENTRY, GentleEntry
from giveway.geometry.path import EgoPath
from pedestrian_model import Crowd

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

CONFIG = EgoRunConfig.model_validate({"controller": "mpc"})
STEP = 0.05  # [s]
NOBODY = Crowd.empty()


def entry() -> GentleEntry:
    corridor = Corridor(
        EgoPath.through([(0.0, 0.0), (100.0, 0.0)]),
        half_width=1.3,
        horizon=10,
        time_step=STEP,
        walking_speed_limit=2.5,
        body_length=5.0,
    )
    return GentleEntry(CONFIG, corridor, STEP)


def person(x: float, y: float, v_y: float = 0.0, v_x: float = 0.0) -> Crowd:
    return Crowd.create([(x, y)], [(v_x, v_y)], 1.4, [[(x, y)]])


def seen(stop: float = inf, people: Crowd = NOBODY, kerb: float = 0.0) -> Any:
    """Return what the ego sees; people are ``kerb`` [m] from one that is to their right."""
    kerbs = np.array([(0.0, -1.0, kerb)] * len(people)) if kerb else NO_KERBS
    percept = SimpleNamespace(people=people)
    return SimpleNamespace(stop=stop, percept=percept, kerbs=kerbs)


def braking(**view: Any) -> float | None:
    """Return the hardest braking [m/s^2] of an ego at 10 m and 10 m/s, or None without a limit."""
    force = entry().least_force(10.0, 10.0, seen(**view))
    vehicle = CONFIG.vehicle
    return None if force is None else -(force - vehicle.friction * 10.0) / vehicle.mass


@pytest.mark.parametrize("people", [NOBODY, person(30.0, 3.0), person(30.0, 3.0, 0.5)])
def test_it_brakes_firmly_for_what_people_could_do(people: Crowd) -> None:
    assert braking(people=people) == pytest.approx(FIRM)


@pytest.mark.parametrize("people", [person(25.0, 0.0), person(22.0, 3.0, -1.5)])
def test_it_brakes_as_hard_as_it_can_for_who_is_about_to_be_hit(people: Crowd) -> None:
    assert braking(people=people) is None


def test_who_walks_along_a_kerb_is_not_about_to_be_hit() -> None:
    """Others there make them swerve towards the road for a moment."""
    swerves, crosses = person(24.0, 2.0, -0.5, -1.3), person(22.0, 2.0, -1.0, 0.4)
    assert braking(people=swerves) is None
    assert braking(people=swerves, kerb=0.4) == pytest.approx(FIRM)
    assert braking(people=crosses, kerb=0.4) is None


def test_who_stands_behind_the_firm_stop_is_not_about_to_be_hit() -> None:
    assert braking(people=person(10.0 + 50.0 / FIRM + 2.0, 0.0)) == pytest.approx(FIRM)


def test_it_brakes_harder_for_a_demanded_stop() -> None:
    hardest = braking(stop=20.0)
    assert hardest is not None
    assert 5.0 < hardest < 5.5


def test_the_entry_is_over_after_its_time() -> None:
    one = entry()
    steps = round(ENTRY / STEP)
    limits = [one.least_force(10.0, 10.0, seen()) for _ in range(steps + 2)]
    assert None not in limits[: steps - 1]
    assert limits[-1] is None


# One street with a sidewalk beside the right lane; people walk towards the car, 0.4 m from the kerb
NODES = '<nodes><node id="w" x="0" y="0"/><node id="e" x="150" y="0"/></nodes>'
EDGES = '<edges><edge id="we" from="w" to="e" speed="13.89" sidewalkWidth="2"/></edges>'
ROUTES = """<routes><personFlow id="p" begin="0" end="60" period="2" departPos="110">
    <walk edges="we" arrivalPos="10"/></personFlow>
    <vehicle id="car" depart="40" departPos="60" departSpeed="13"><route edges="we"/></vehicle>
    </routes>"""


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory, call_sumo: Callable[..., str]) -> Path:
    folder = tmp_path_factory.mktemp("street")
    (folder / "n.nod.xml").write_text(NODES)
    (folder / "e.edg.xml").write_text(EDGES)
    files = ("-n", "n.nod.xml", "-e", "e.edg.xml", "-o", "street.net.xml")
    call_sumo("netconvert", *files, cwd=folder)
    (folder / "r.rou.xml").write_text(ROUTES)
    config = folder / "street.sumocfg"
    config.write_text(
        '<configuration><net-file value="street.net.xml"/><route-files value="r.rou.xml"/>'
        '<end value="70"/><step-length value="0.1"/></configuration>'
    )
    return config


@pytest.mark.parametrize("controller", ["mpc", "pid-tuned", "idm"])
def test_taking_over_beside_people_at_the_kerb_is_not_felt(street: Path, controller: str) -> None:
    result = giveway.run(
        {
            "scenario": str(street),
            "ego": {"take_over": ["car"]},
            "crowd": {"zone": "everywhere"},
            "controller": controller,
        }
    )
    track = result.ego_track
    first = track.time - track.time[0] < ENTRY
    assert result.completed
    assert track.speed[0] == pytest.approx(13.0, abs=0.5)
    assert np.diff(track.speed[first]).min() / STEP > -FIRM - 0.05
    assert "safety" not in set(track.controller[first])
    assert result.summary["frontal_contacts"] == 0
