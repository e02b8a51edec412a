"""Smooth bends on an ego's path: where they help, and where the path stays as it is drawn."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import giveway
from giveway.config import EgoRunConfig
from giveway.cosimulation.entry.smoothing import smoothed
from giveway.ego.rules.speed_profile import in_bends
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import EgoPath
from giveway.scenario_files.configuration_text import configuration_of
from giveway.scenario_files.path_network import network_along
from giveway.sumo.network.lane_path import LanePath, LaneWidth, Light, Passage, SpeedLimit

if TYPE_CHECKING:
    from pathlib import Path

CAR = VehicleShape(5.0, 1.8)
LIMIT = 16.67  # [m/s]


def ego(**settings: Any) -> Any:
    """An ego with these settings."""
    return SimpleNamespace(config=EgoRunConfig.model_validate(settings))


def corner(degrees: float) -> np.ndarray:
    """A lane's middle with a corner of so many degrees after 200 m."""
    turn = math.radians(degrees)
    end = (200 + 200 * math.cos(turn), 200 * math.sin(turn))
    return np.array([(0.0, 0.0), (200.0, 0.0), end])


def lanes(degrees: float, width: float = 3.2) -> tuple[EgoPath, LanePath]:
    """The path along lanes with a corner, and what lies on it."""
    path = EgoPath.through(corner(degrees))
    return path, LanePath(
        points=path.vertices,
        lights=(Light(200.0, "J", 0),),
        first="ab_0",
        edges=(0.0, 230.0),
        limits=(SpeedLimit(0.0, LIMIT),),
        passages=(Passage(200.0, 230.0, (":J_0",), (210.0,)),),
        lanes=(("ab_0", "ab_0"), ("bc_0", "bc_0")),
        widths=(LaneWidth(0.0, width),),
    )


@pytest.mark.parametrize("degrees", [3.0, 5.0, 10.0])
def test_a_small_corner_is_driven_at_the_limit(degrees: float) -> None:
    drawn, lane_path = lanes(degrees)
    stations = np.arange(0.0, 400.0, 0.5)
    assert in_bends(drawn, 5.0, stations).min() < 0.7 * LIMIT
    path, _ = smoothed(ego(), drawn, lane_path, 10.0, CAR)
    assert in_bends(path, 5.0, stations[:-2]).min() > 0.98 * LIMIT


def test_what_lies_on_the_path_stays_beside_its_place() -> None:
    drawn, lane_path = lanes(15.0)
    path, found = smoothed(ego(), drawn, lane_path, 10.0, CAR)
    assert found.points is path.vertices
    for new, old in [
        (found.lights[0].station, 200.0),
        (found.edges[1], 230.0),
        (found.passages[0].entry, 200.0),
        (found.passages[0].waiting[0], 210.0),
        (found.widths[0].station, 0.0),
    ]:
        x, y, _ = drawn.pose(old)
        station, aside = path.locate(x, y, near=new)
        assert station == pytest.approx(new, abs=0.05)
        assert abs(aside) < 0.55  # a corner itself may be a little farther off


@pytest.mark.parametrize(
    ("degrees", "settings"),
    [(0.0, {}), (10.0, {"regulation": {"reference_speed": 4.0}}), (0.05, {})],
    ids=["straight", "a speed of its own", "a bend that costs no speed"],
)
def test_the_path_stays_as_it_is_drawn(degrees: float, settings: dict[str, Any]) -> None:
    drawn, lane_path = lanes(degrees)
    path, found = smoothed(ego(**settings), drawn, lane_path, 10.0, CAR)
    assert path is drawn
    assert found is lane_path


def test_the_body_stays_in_a_narrow_lane() -> None:
    for width, shape in ((2.4, CAR), (3.2, VehicleShape(12.0, 2.55))):
        drawn, lane_path = lanes(15.0, width)
        path, _ = smoothed(ego(), drawn, lane_path, 10.0, shape)
        _, aside = drawn.project(path.vertices)
        assert np.abs(aside).max() <= 1.02 * ((width - shape.width) / 2.0 - 0.1)


def test_a_right_angle_turn_keeps_the_body_in_its_lane() -> None:
    turn = np.linspace(-np.pi / 2, 0.0, 12)
    bend = np.column_stack([100.0 + 9.0 * np.cos(turn), 9.0 + 9.0 * np.sin(turn)])
    drawn = EgoPath.through([(0.0, 0.0), *bend, (109.0, 109.0)])
    lane_path = replace(lanes(0.0)[1], points=drawn.vertices)
    path, _ = smoothed(ego(), drawn, lane_path, 10.0, CAR)
    stations = np.arange(60.0, 160.0, 0.5)
    for share in (0.0, 0.5, 1.0):  # rear, middle and front of the body
        poses = [path.pose(station, CAR.length) for station in stations]
        back = (1.0 - share) * CAR.length
        points = [(x - back * math.cos(h), y - back * math.sin(h)) for x, y, h in poses]
        _, aside = drawn.project(points)
        assert np.abs(aside).max() + CAR.width / 2.0 < 1.6
    slowest = in_bends(drawn, 5.0, stations).min()
    assert in_bends(path, 5.0, stations).min() > slowest - 0.1


def test_the_place_of_the_departure_is_kept() -> None:
    drawn, lane_path = lanes(10.0)
    path, _ = smoothed(ego(), drawn, lane_path, 190.0, CAR)
    assert path.pose(190.0, 5.0) == pytest.approx(drawn.pose(190.0, 5.0), abs=1e-9)
    assert not np.array_equal(path.vertices, drawn.vertices)


@pytest.mark.parametrize("controller", ["idm", "careful-driver", "pid-tuned"])
def test_a_corner_of_10_degrees_costs_no_time(tmp_path: Path, controller: str) -> None:
    (tmp_path / "kink.net.xml").write_text(network_along(corner(10.0), LIMIT))
    (tmp_path / "kink.sumocfg").write_text(configuration_of("kink", 60.0))
    result = giveway.run(
        {
            "scenario": str(tmp_path / "kink.sumocfg"),
            "controller": controller,
            "ego": {"route": ["drive"], "initial_speed": LIMIT, "depart_position": 20.0},
            "crowd": {"pedestrians": 0},
        }
    )
    drive = result.egos[0].track
    assert drive.speed.min() > 0.97 * LIMIT
    assert drive.time[-1] - drive.time[0] == pytest.approx(380.0 / LIMIT, rel=0.01)
