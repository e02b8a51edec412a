"""The Python API in a run."""

from __future__ import annotations

import sys

import libsumo
import pytest

import giveway
from fmus.isolation import watchdog_process
from giveway.errors import SumoError


def test_what_sumo_refuses_is_one_line_and_the_rows_are_kept():
    def asks(progress):
        if progress.time >= 1.0:
            libsumo.vehicle.getSpeed("nobody")

    with pytest.raises(
        SumoError, match=r"shared_space.*SUMO failed: .*'nobody'.* not known"
    ) as told:
        giveway.run({"crowd.pedestrians": 2, "time_limit": 3.0}, watcher=asks)
    assert "\n" not in str(told.value)
    assert told.value.result.ego["time"].max() == pytest.approx(1.0)


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux has watchdogs")
def test_one_watchdog_serves_all_the_drives_of_a_foreign_fmu(zoo, monkeypatch):
    spawned, spawn = [], watchdog_process.spawn

    def counted(*arguments, **named):
        spawned.append(arguments)
        return spawn(*arguments, **named)

    monkeypatch.setattr(watchdog_process, "spawn", counted)
    car = zoo.car(values={"mass": 2000.0})
    vehicle = {"fmu": str(car), "profile": str(car.with_suffix(".toml"))}
    giveway.run({"crowd.pedestrians": 2, "time_limit": 0.2, "vehicle": vehicle})
    assert len(spawned) == 1
