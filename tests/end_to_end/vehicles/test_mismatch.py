"""A vehicle that answers otherwise than the controller thinks is said at the end, with numbers."""

from __future__ import annotations

import re

import pytest
import tomlkit

import giveway as library


@pytest.fixture
def remarks(zoo, tmp_path, own_temp):
    """The remarks of a short run of a car about how it answered."""

    def run(values=None, vehicle=None, controller="mpc-paper", **model):
        car = zoo.car(values=values or {})
        profile = zoo.profile(car)
        if model:
            profile["model"] = {"r_squared": 1.0, "speed_error": 0.0, "horizon": 0.75,
                                "time_step": 0.05, **model}  # fmt: skip
        path = tmp_path / "car.toml"
        path.write_text(tomlkit.dumps(profile), encoding="utf-8")
        settings = {"fmu": str(car), "profile": str(path), "isolation": "none", **(vehicle or {})}
        result = library.run(
            {"seed": 4, "time_limit": 12.0, "controller": controller, "vehicle": settings}
        )
        return [remark for remark in result.remarks if "does not answer" in remark]

    return run


HEAVY = {"mass": 1600.0, "friction": 40.0}


def test_a_car_as_the_controller_thinks_is_not_remarked(remarks):
    assert remarks() == []


def test_a_heavier_car_is_told_with_what_it_is(remarks):
    (remark,) = remarks({"mass": 1400.0, "friction": 40.0}, {"mass": 1001.0})
    assert "the controller's M = 1001 kg, alpha = 100 N.s/m" in remark
    mass, friction = map(
        float, re.search(r"M = ([\d.]+) kg and alpha = ([\d.]+) N\.s/m fit", remark).groups()
    )
    assert mass == pytest.approx(1400.0, rel=0.02)
    assert friction == pytest.approx(40.0, abs=20.0)
    assert "giveway fmu identify" in remark


def test_a_heavier_car_of_which_nothing_is_told_is_identified_before(remarks):
    assert remarks(HEAVY) == []


def test_the_controller_that_is_told_so_is_content(remarks):
    assert remarks(HEAVY, {"mass": 1600.0, "friction": 40.0}) == []


def test_a_profile_that_knows_it_is_content(remarks):
    assert remarks(HEAVY, position_error=0.01, mass=1600.0, friction=40.0) == []


def test_an_error_that_the_margin_covers_is_content(remarks):
    assert remarks({"mass": 1100.0}, position_error=1.0, mass=1000.0, friction=100.0) == []


def test_the_pid_has_no_model_to_be_wrong(remarks):
    assert remarks(HEAVY, controller="pid") == []


def test_our_own_vehicle_is_not_remarked(own_temp):
    result = library.run({"seed": 4, "time_limit": 3.0})
    assert not [remark for remark in result.remarks if "does not answer" in remark]
