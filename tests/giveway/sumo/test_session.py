"""A session of SUMO: what is mirrored into it, and that there is one per process."""

import pytest

from giveway.errors import GivewayError, SumoError
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import Pose
from giveway.scenario_files import StartOptions, read_scenario
from giveway.sumo.session import SumoSession
from giveway.sumo.types import all_types, inserted_type
from sumo_scenarios import find

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
