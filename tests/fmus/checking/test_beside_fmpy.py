"""The same drive by giveway and by FMPy, in a process of its own."""

from __future__ import annotations

import pytest

from fmus import make_profile, prepare
from fmus.checking.beside_fmpy import beside_fmpy

FORCES = [0.0] * 10 + [2000.0] * 40 + [-3000.0] * 40


def prepared(zoo, path, **fmu):
    values = zoo.profile(path)
    values["fmu"] = values.get("fmu", {}) | fmu
    return prepare(path, step_size=0.05, profile=make_profile(values, "the test's profile"))


@pytest.mark.parametrize("fmu", [{"step": 0.03}, {"step": 0.01, "start_time": 5.0}])
def test_both_drive_the_same_at_any_step(zoo, fmu):
    found = beside_fmpy(prepared(zoo, zoo.car(role="acceleration"), **fmu), FORCES)
    assert found.problem == ""
    assert found.duration == pytest.approx(4.5, abs=0.03)
    assert found.speed < 1e-9
    assert found.position < 1e-9


def test_model_exchange_agrees_within_the_solvers_tolerance(zoo):
    found = beside_fmpy(prepared(zoo, zoo.car(kind="model-exchange")), FORCES)
    assert found.problem == ""
    assert found.speed < 1e-2


def test_an_fmu_that_crashes_ends_its_own_process_alone(zoo):
    found = beside_fmpy(prepared(zoo, zoo.car(behaviour="segfault", at=0.1)), FORCES)
    assert found.problem == "the process of FMPy's drive ended with -11"


def test_what_fmpy_does_not_tick_is_not_compared(zoo):
    clock = {"intervalVariability": "constant", "intervalDecimal": "0.1"}
    path = zoo.car(fmi="3.0", clock=clock, flags={"hasEventMode": "true"})
    assert "clocks" in beside_fmpy(prepared(zoo, path), FORCES).problem


def test_elements_of_arrays_are_not_compared(zoo):
    path = zoo.car(fmi="3.0", array=True, define_units=True)
    values = zoo.profile(path)
    for table, unit in ((values["inputs"]["force"], "N"), (values["outputs"]["speed"], "m/s")):
        table["unit"] = unit
    values["outputs"] = {"speed": values["outputs"]["speed"]}
    profile = make_profile(values, "the test's profile")
    found = beside_fmpy(prepare(path, step_size=0.05, profile=profile), FORCES)
    assert "arrays" in found.problem
