"""Plain SUMO drives the ego's vehicle in a child process, once for the same inputs."""

import math
import re
import shutil
import time
from pathlib import Path

import numpy as np
import pytest

import sumo_scenarios
from giveway.scenario_files import StartOptions, read_scenario
from giveway.sumo import plain_drive
from giveway.sumo.plain_drive import PlainDrives, Trip, plain_drives
from giveway.sumo.types import all_types

JUNCTION = Path(sumo_scenarios.__file__).parent / "junction"
CAR = Trip("westbound.0")


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache."""
    monkeypatch.setattr(plain_drive, "cache_folder", lambda: tmp_path / "cache")
    return tmp_path / "cache" / "plain_drives"


@pytest.fixture
def junction(tmp_path: Path) -> Path:
    """A copy of the bundled scenario."""
    shutil.copytree(JUNCTION, tmp_path / "mine")
    return tmp_path / "mine" / "junction.sumocfg"


def drive(config: Path, trip: Trip = CAR, seed: int = 1, patience: float = 120.0) -> PlainDrives:
    options = StartOptions(seed=seed)
    return plain_drives(read_scenario(config), options, trip, all_types({}), patience=patience)


def test_the_car_arrives_by_its_own_factor_and_at_the_limit(cache, junction) -> None:
    before = sorted(junction.parent.rglob("*"))
    as_is, at_limit = drive(junction)
    assert as_is is not None
    assert at_limit is not None
    assert as_is.arrived
    assert math.isnan(as_is.teleported)
    assert as_is.speed_factor != 1.0 == at_limit.speed_factor
    assert as_is.position[0] == 0.0
    assert 240.0 < as_is.position[-1] < 260.0
    assert np.all(np.diff(as_is.time) > 0.0)
    assert as_is.vehicle_gap.min() >= 2.0
    assert sorted(junction.parent.rglob("*")) == before  # nothing is written beside it


def test_it_drives_once_for_all_that_it_depends_on(cache, junction, monkeypatch) -> None:
    first = drive(junction)
    drive(junction, seed=2)
    assert len(list(cache.iterdir())) == 2
    monkeypatch.setattr(plain_drive, "_let_drive", lambda *_: pytest.fail("it drove again"))
    again = drive(junction)
    for one, other in zip(first, again, strict=True):
        assert one is not None
        assert other is not None
        assert np.array_equal(one.time, other.time)
    routes = junction.with_name("junction.rou.xml")
    routes.write_text(routes.read_text() + "<!-- changed -->")
    with pytest.raises(pytest.fail.Exception, match="it drove again"):
        drive(junction)


def test_a_vehicle_that_never_departs_has_no_drive(cache, junction) -> None:
    assert drive(junction, Trip("nobody")) == (None, None)
    assert not cache.exists()


def test_a_crash_and_a_hang_cost_the_numbers_only(cache, junction) -> None:
    began = time.monotonic()
    assert drive(junction, patience=0.05) == (None, None)
    assert time.monotonic() - began < 30.0
    net = junction.with_name("junction.net.xml")
    net.write_text(net.read_text().replace('via=":zebra_0_0"', 'via=":centre_17_0"'))  # SIGSEGV
    assert drive(junction) == (None, None)
    assert not cache.exists()


def test_an_inserted_vehicle_drives_its_route(cache, junction) -> None:
    route = ("west_in", "east_out", "far_east_out")
    trip = Trip("mine", route=route, kind="giveway_ego_passenger", depart=5.0, speed=4.0)
    as_is, at_limit = drive(junction, trip)
    assert as_is is not None
    assert at_limit is not None
    assert as_is.arrived
    assert 5.0 <= as_is.time[0] < 8.0
    assert as_is.speed[0] == 4.0
    assert np.array_equal(as_is.time, at_limit.time)  # its type drives at the limit anyway


def test_the_car_that_sumo_teleports_is_told(cache, junction) -> None:
    net = junction.with_name("junction.net.xml")
    net.write_text(re.sub('state="[Ggry]+"', 'state="rrrrrrrrrrrrrrrr"', net.read_text()))
    config = junction.read_text()
    assert "</configuration>" in config
    patient = '<time-to-teleport value="20"/></configuration>'
    junction.write_text(config.replace("</configuration>", patient))
    as_is, _ = drive(junction)
    assert as_is is not None
    assert not as_is.arrived
    assert as_is.teleported > 20.0
