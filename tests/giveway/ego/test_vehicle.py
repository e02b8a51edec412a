"""A truck is told which forces and gains are still those of the paper's car."""

from __future__ import annotations

import pytest

from giveway.config import EgoRunConfig
from giveway.ego.vehicle import model_remark
from giveway.ego.vehicle_model import driven_model

PROFILE = """
[inputs.force]
variable = "F"
[outputs.speed]
variable = "v"
[model]
mass = {mass}
friction = 100.0
r_squared = 0.999
speed_error = 0.01
position_error = 0.1
horizon = 0.75
time_step = 0.05
"""


@pytest.fixture
def remark(tmp_path):
    def of(mass, **limits):
        path = tmp_path / "car.toml"
        path.write_text(PROFILE.format(mass=mass), encoding="utf-8")
        vehicle = {"profile": str(path), "mass": mass, "friction": 100.0, **limits}
        values = {"controller": "pid-paper", "vehicle": vehicle}
        return model_remark(EgoRunConfig.model_validate(values), 0.05)

    return of


@pytest.mark.parametrize("mass", [600.0, 1000.0, 1900.0])
def test_a_car_keeps_the_defaults(remark, mass):
    assert "--" not in remark(mass)


def test_a_truck_gets_the_same_accelerations(remark):
    assert remark(18_000.0).endswith(
        "for the same accelerations the PID needs --set proportional_gain=43000"
    )


def test_what_has_been_set_is_not_advised(remark):
    text = remark(18_000.0, force_limit=1e5, force_rate_limit=18_000.0)
    assert text.endswith("for the same accelerations the PID needs --set proportional_gain=43000")


def test_the_fmus_own_steps_are_part_of_the_dead_time(tmp_path):
    """A force waits for up to 20 ms if the FMU does steps of 30 ms; the fit has seen 10 ms."""
    path = tmp_path / "car.toml"
    text = PROFILE.format(mass=1000.0).replace('"F"', '"force"').replace('"v"', '"speed"')
    text = text.rstrip() + "\ndelay = 0.01\n"
    delays = []
    for step in ("", "[fmu]\nstep = 0.03\n"):
        path.write_text(text + step, encoding="utf-8")
        config = EgoRunConfig.model_validate({"vehicle": {"profile": str(path)}})
        delays.append(driven_model(config, 0.05).delay)
    assert delays == pytest.approx([0.01, 0.02])
