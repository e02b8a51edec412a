"""Traffic, people and departure drawn from the seed, and alike for all controllers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import giveway

SHORT = 2.0  # [s]


def drive(folder: Path, scenario: str, seed: int, **settings: Any) -> dict[str, Any]:
    """What was drawn, and the bytes of the tables of a short drive."""
    run = {"scenario": scenario, "seed": seed, "time_limit": SHORT, **settings}
    result = giveway.run(run, results=folder, pictures=False)
    everybody = result.trajectories
    first = everybody[everybody.time == everybody.time.iloc[0]]
    tables = sorted(file for file in folder.glob("*.csv") if file.name != "timing.csv")
    return {
        "departure": result.manifest["vehicles"]["ego"]["depart_time"],
        "seed": result.manifest["sumo"]["seed"],
        "people": sorted(zip(*(first[first.type == "pedestrian"][k] for k in "xy"), strict=True)),
        "cars": sorted(zip(*(first[first.type != "pedestrian"][k] for k in "xy"), strict=True)),
        "tables": [file.read_bytes() for file in tables],
    }


@pytest.mark.parametrize("scenario", ["junction", "crossings"])
def test_every_seed_is_another_drive_and_each_is_the_same_again(
    tmp_path: Path, scenario: str
) -> None:
    one = drive(tmp_path / "one", scenario, 1)
    again = drive(tmp_path / "again", scenario, 1)
    other = drive(tmp_path / "other", scenario, 2)
    assert one == again
    for what in ("departure", "seed", "people", "cars"):
        assert one[what] != other[what]
    assert min(one["departure"], other["departure"]) >= 60.0
    assert max(one["departure"], other["departure"]) <= 120.0


def test_all_controllers_meet_the_same_drive(tmp_path: Path) -> None:
    one, other = (
        drive(tmp_path / name, "junction", 1, controller=name) for name in ("mpc", "pid-tuned")
    )
    assert one["people"]
    for what in ("departure", "seed", "people", "cars"):
        assert one[what] == other[what]
    assert one["tables"] != other["tables"]
