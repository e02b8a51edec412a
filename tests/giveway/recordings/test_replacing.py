"""The scenario in which an ego drives in place of a recorded vehicle."""

from __future__ import annotations

import tomllib
from typing import TYPE_CHECKING

import numpy as np
import pytest

from giveway.errors import ConfigError, DatasetError
from giveway.recordings import CITR, read_recording
from giveway.recordings.replacing import scenario_for

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from giveway.recordings import Recording

RATE = 29.97  # [1/s]


@pytest.fixture
def recording(tmp_path: Path, write_clip: Callable, straight_walks: Callable) -> Recording:
    """A cart that comes after 1 s, stands for 2 s on the way, and one that is parked."""
    time = np.arange(300) / RATE
    at = np.where(time < 4.0, time, np.where(time < 6.0, 4.0, time - 2.0)) * 3.0
    speed = np.where((time >= 4.0) & (time < 6.0), 0.0, 3.0)
    shaking = 0.02 * np.sin(40.0 * time)
    cart = np.column_stack([at, 5.0 + shaking, np.zeros(300), speed])
    people = straight_walks(331, [(0, 0)], [(1, 0)])
    write_clip(tmp_path, "one", *people, cart, first_frame=131)
    file = write_clip(tmp_path, "one", *people)  # the people's file again, from frame 101 on
    vehicles = tmp_path / "one_traj_veh_filtered.csv"
    vehicles.write_text(vehicles.read_text() + "2,131,veh,40,5,0,0\n2,160,veh,40,5,0,0\n")
    return read_recording(file, CITR)


def test_the_ego_starts_where_when_and_as_fast(recording: Recording) -> None:
    files = scenario_for(recording, "1", "mine", "citr")
    assert set(files) == {"mine.net.xml", "mine.sumocfg", "mine.giveway.toml"}
    settings = tomllib.loads(files["mine.giveway.toml"])
    ego, (entry,) = settings["ego"], settings["crowd"]["recorded"]
    assert ego["initial_speed"] == 3.0
    assert ego["travel_distance"] == pytest.approx(3.0 * (299 / RATE - 2.0), abs=0.05)
    assert ego["depart_position"] == pytest.approx(1.2 + 1.0 + 1.0)
    assert settings["vehicle"] == {"length": 2.2, "width": 1.2}
    assert settings["regulation"]["reference_speed"] == 3.0
    assert entry["begin"] == pytest.approx(-30 / RATE, abs=1e-6)
    assert (entry["clip"], entry["vehicle"], entry["dataset"]) == ("one", "1", "citr")
    shape = files["mine.net.xml"].split('shape="')[2].split('"')[0]
    points = np.array([point.split(",") for point in shape.split()], dtype=float)
    assert np.abs(points[:, 1] - 5.0).max() < 0.1
    steps = np.diff(points[1:-1, 0])
    assert steps.min() > 0.9  # none from shaking on the spot
    assert steps.max() < 3.1


@pytest.mark.parametrize(
    ("vehicle", "said", "kind"),
    [
        (None, "--vehicle missing in 'one'; expected one of 1", ConfigError),
        ("9", "--vehicle 9: no such id in 'one'; expected one of 1", ConfigError),
        ("2", "--vehicle 2: is parked in 'one'; expected a vehicle that drives: 1", DatasetError),
    ],
)
def test_a_wrong_vehicle_is_named(
    recording: Recording, vehicle: str | None, said: str, kind: type[Exception]
) -> None:
    with pytest.raises(kind) as error:
        scenario_for(recording, vehicle, "mine", "citr")
    assert str(error.value) == said
