"""A run that goes wrong on the way: what was computed is kept, SUMO is free again."""

import math
from contextlib import ExitStack
from pathlib import Path

import numpy as np
import pytest

import giveway
from giveway.config.files.layers import Layer
from giveway.config.files.loading import load
from giveway.cosimulation.assembly import Parts, assemble
from giveway.cosimulation.loop import Loop
from giveway.cosimulation.preflight import preflight
from giveway.errors import ConfigError, GivewayError, SumoError
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import Pose
from giveway.journal.recorder import Recorder
from giveway.processes.interrupts import DeferredInterrupt
from giveway.run_data.progress import Ending
from giveway.scenario_files import StartOptions, read_scenario
from giveway.sumo.session import SumoSession
from giveway.sumo.types import all_types, inserted_type
from sumo_scenarios import find

PLAZA = find("shared_space").config_file


def parts_of(stack: ExitStack, **settings: object) -> Parts:
    return assemble(preflight(*load([Layer("test", settings)])), stack)


def session(step_length: float | None = None) -> SumoSession:
    types = all_types({inserted_type("ego"): VehicleShape()})
    return SumoSession(read_scenario(PLAZA), StartOptions(step_length=step_length), types)


def test_a_nan_in_the_crowd_is_named_by_id_and_step() -> None:
    with ExitStack() as stack:
        parts = parts_of(stack, controller="pid")
        recorder = Recorder()
        loop = Loop(parts, recorder)
        parts.roster.crowd.position[3] = np.nan
        with pytest.raises(GivewayError, match=r"ped3.*step 0"):
            loop.run(None, DeferredInterrupt())
        assert len(recorder.rows().time) == 1


def test_after_a_failure_the_next_run_is_unharmed(tmp_path: Path) -> None:
    test_a_nan_in_the_crowd_is_named_by_id_and_step()
    assert giveway.run({"crowd": {"pedestrians": 3}}).ending is Ending.COMPLETED


def test_rows_up_to_a_failure_are_written(tmp_path: Path) -> None:
    # A watcher of the user's that fails stands for anything that fails on the way.
    def fail_at_one_second(progress: object) -> None:
        if progress.time > 1.0:  # type: ignore[attr-defined]
            raise SumoError("the disk under SUMO burns")

    with pytest.raises(SumoError, match="burns") as caught:
        giveway.run({}, results=tmp_path / "r", watcher=fail_at_one_second)
    assert caught.value.result is not None
    assert caught.value.result.ending is Ending.FAILED
    rows = (tmp_path / "r" / "ego.csv").read_text().splitlines()
    assert len(rows) == 1 + 22  # the header, and 0 ... 1.05 s


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


def test_time_steps_that_do_not_fit_sumos_are_refused() -> None:
    with ExitStack() as stack, pytest.raises(ConfigError, match="whole multiple"):
        parts_of(stack, time_step=0.03)


def test_an_impatient_ctrl_c_is_noted_and_python_goes_on() -> None:
    import signal

    with DeferredInterrupt() as interrupt:
        assert not interrupt.requested
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        assert interrupt.requested
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_angles_convert_between_the_conventions() -> None:
    from giveway.geometry.path import angle_to_heading, heading_to_angle

    assert heading_to_angle(0.0) == 90.0
    assert heading_to_angle(math.pi / 2) == pytest.approx(0.0)
    assert heading_to_angle(math.pi) == pytest.approx(270.0)
    for angle in (0.0, 45.0, 133.0, 359.0):
        assert heading_to_angle(angle_to_heading(angle)) == pytest.approx(angle)


def test_a_watcher_that_fails_costs_no_rows(tmp_path: Path) -> None:
    def fail(progress: object) -> None:
        raise ZeroDivisionError("the user's own")

    with pytest.raises(ZeroDivisionError, match="own"):
        giveway.run({}, results=tmp_path / "r", watcher=fail)
    assert len((tmp_path / "r" / "ego.csv").read_text().splitlines()) == 2
