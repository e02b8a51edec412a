"""A car whose speed output lags behind its motion drives like the same car without that lag."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import tomlkit

import giveway as library


@pytest.fixture(scope="module")
def driven(zoo, tmp_path_factory):
    """The result of a drive of a car whose speed output is filtered; equal ones once."""

    @cache
    def run(lag):
        values = {"mass": 1200.0, "sensor_lag": lag}
        car = zoo.car(outputs=("speed", "position"), values=values, file=f"filtered{lag}")
        path = tmp_path_factory.mktemp("car") / "car.toml"
        path.write_text(tomlkit.dumps(zoo.profile(car)), encoding="utf-8")
        vehicle = {"fmu": str(car), "profile": str(path), "isolation": "none"}
        return library.run({"seed": 2, "controller": "mpc", "vehicle": vehicle})

    return run


def test_it_arrives_as_soon_and_no_promise_is_broken(driven):
    late, usual = driven(0.3), driven(0.0)
    assert late.completed
    assert usual.completed
    ratio = late.summary["completion_time"] / usual.summary["completion_time"]
    assert ratio == pytest.approx(1.0, abs=0.1)
    assert late.summary["frontal_contacts"] == 0
    assert "unavoidable" not in set(late.ego["reason"])
    assert not [remark for remark in late.remarks if "does not answer" in remark]


def test_the_table_has_the_speed_that_the_fmu_puts_out(driven):
    rows = driven(0.3).ego
    speed, position = rows["speed"].to_numpy(), rows["position"].to_numpy()
    behind = np.gradient(position, 0.05) - speed
    slope = np.gradient(speed, 0.05)
    assert behind @ slope / (slope @ slope) == pytest.approx(0.3, abs=0.02)
