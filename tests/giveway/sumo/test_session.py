"""A session of SUMO: what is mirrored into it, and that there is one per process."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from giveway.errors import GivewayError, SumoError
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import EgoPath, Pose
from giveway.scenario_files import StartOptions, read_scenario
from giveway.sumo.session import SumoSession
from giveway.sumo.types import all_types, inserted_type
from sumo_scenarios import find

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

PLAZA = find("shared_space").config_file


def session(step_length: float | None = None) -> SumoSession:
    types = all_types({inserted_type("ego"): VehicleShape()})
    return SumoSession(read_scenario(PLAZA), StartOptions(step_length=step_length), types)


def test_sumo_stands_where_we_do() -> None:
    with session() as sumo:
        sumo.vehicles.insert("ego", ["plaza"], lane=0, position=22.5, speed=4.0)
        sumo.add_persons(["a", "b"], "gate")
        x, y, angles = [25.0, 31.125], [-13.25, 7.0], [0.0, 271.0]
        sumo.mirror([("ego", Pose(2.7, 0.0, 0.0))], ["a", "b"], x, y, angles)
        import libsumo

        assert libsumo.person.getPosition("b") == pytest.approx((31.125, 7.0), abs=1e-9)
        assert libsumo.person.getAngle("b") == pytest.approx(271.0)
        assert libsumo.vehicle.getPosition("ego") == pytest.approx((2.7, 0.0), abs=1e-9)
        assert libsumo.vehicle.getAngle("ego") == pytest.approx(90.0)


@pytest.mark.parametrize("aside", [-0.45, -0.3, 0.3, 0.45])
@pytest.mark.parametrize("edges", ["A1B1 B1B2 B2A2", "A1B1 B1B0 B0C0", "A1B1 B1C1 C1C2"])
def test_an_ego_beside_its_line_keeps_its_route(
    city: Callable[[str], Path], tmp_path: Path, edges: str, aside: float
) -> None:
    import libsumo

    config = tmp_path / "grid.sumocfg"
    config.write_text(f'<configuration><net-file value="{city("turnarounds")}"/></configuration>')
    types, way = all_types({inserted_type("ego"): VehicleShape()}), tuple(edges.split())
    with SumoSession(read_scenario(config), StartOptions(step_length=0.1), types) as sumo:
        lane_path = sumo.lanes.along(way, None)
        path = EgoPath.through(lane_path.points)
        sumo.vehicles.insert("ego", way, lane=1, position=5.0, speed=7.0)
        for station in np.arange(6.0, 115.0, 0.7):
            x, y, heading = path.pose(station, 5.0)
            along = path.pose(station + 0.5, 1.0).heading
            there = Pose(x - aside * np.sin(along), y + aside * np.cos(along), heading)
            sumo.mirror([("ego", there)], [], [], [], [])
            assert libsumo.vehicle.getPosition("ego") == pytest.approx(there[:2], abs=1e-9)
            assert libsumo.vehicle.getRoute("ego") == way
            assert libsumo.vehicle.getLaneID("ego")


def test_sumo_disagreeing_is_an_error() -> None:
    with session() as sumo:
        sumo.vehicles.insert("ego", ["plaza"], lane=0, position=22.5, speed=4.0)
        sumo.mirror([("ego", Pose(2.7, 0.0, 0.0))], [], [], [], [])
        with pytest.raises(SumoError, match=r"ego.*away from our state"):
            sumo._check([("ego", Pose(2.8, 0.0, 0.0))], [], [], [])


def test_two_simulations_at_once_are_refused() -> None:
    with session(), pytest.raises(SumoError, match="one per process"):
        session()


def test_names_that_the_scenario_has_already_are_refused() -> None:
    with session() as sumo:
        sumo.add_persons(["a"], "gate")
        sumo.mirror([], ["a"], [25.0], [-13.0], [0.0])
        with pytest.raises(GivewayError, match="'a'"):
            sumo.add_persons(["a"], "gate")


def test_many_sessions_in_one_process() -> None:
    for _ in range(20):
        with session(1.0) as sumo:
            sumo.add_persons(["a"], "gate")
            sumo.mirror([], ["a"], [25.0], [-13.0], [0.0])
            assert sumo.time == 1.0
