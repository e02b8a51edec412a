"""The zoo is what its menu says."""

from __future__ import annotations

import re
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu

from support.fmus import FAULTS

HERE = Path(__file__).parent / "fmus"
ROLES = ("force", "drive_brake", "acceleration", "throttle_brake", "speed_setpoint")
VERSIONS_AND_KINDS = [
    ("1.0", "co-simulation"),
    ("2.0", "co-simulation"),
    ("2.0", "model-exchange"),
    ("3.0", "co-simulation"),
    ("3.0", "both"),
]


def test_the_menu_and_the_source_know_every_fault():
    menu = (HERE / "README.md").read_text(encoding="utf-8").partition("## What it can do wrong")[2]
    source = (HERE / "source" / "faults.c").read_text(encoding="utf-8").partition("FAULTS[]")[2]
    assert re.findall(r"^\| `(\w+)`", menu, re.M) == list(FAULTS)
    assert set(re.findall(r'\{"(\w+)", \w+\}', source)) == set(FAULTS)


@pytest.mark.parametrize("role", ROLES)
@pytest.mark.parametrize(("fmi", "kind"), VERSIONS_AND_KINDS)
def test_its_cars_are_valid_fmus(zoo, fmi, kind, role):
    assert validate_fmu(str(zoo.car(fmi=fmi, kind=kind, role=role))) == []


def test_a_car_is_built_once(zoo):
    assert zoo.car(role="force") is zoo.car(role="force")
    assert zoo.car(role="force") != zoo.car(role="force", units={"force": ("kN", 1e3, 0.0)})


@pytest.mark.parametrize(("fmi", "kind"), VERSIONS_AND_KINDS)
def test_it_moves_by_the_analytic_solution(zoo, fmi, kind):
    """Judged by FMPy, so that the yardstick is not of our making."""
    path = zoo.car(fmi=fmi, kind=kind)
    start = {"initial_speed": 2.0, "mass": 500.0, "friction": 50.0}
    ramp = np.array([(0.0, 1000.0), (1.0, 1000.0)], dtype=[("time", float), ("force", float)])
    last = fmpy.simulate_fmu(
        str(path),
        stop_time=1.0,
        output_interval=0.05,
        relative_tolerance=1e-10,
        start_values={**start, "force": 1000.0},
        input=ramp,
        output=["speed", "position"],
    )[-1]
    end, rate = 1000.0 / 50.0, 50.0 / 500.0  # [m/s], [1/s]
    speed = end + (2.0 - end) * np.exp(-rate)
    tolerance = 1e-9 if kind == "co-simulation" else 1e-5
    assert last["speed"] == pytest.approx(speed, abs=tolerance)
    assert last["position"] == pytest.approx(end + (2.0 - speed) / rate, abs=tolerance)
