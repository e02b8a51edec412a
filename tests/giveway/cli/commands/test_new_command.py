"""``giveway new`` as a user types it: an example, a scenario, the doctor's remarks, a drive."""

from __future__ import annotations

from pathlib import Path

from giveway.api import run
from giveway.cli.commands.new_command import new_command
from giveway.scenario_builder import Demand

MAP = Path(__file__).parents[4] / "docs" / "tutorials" / "helsinki.osm"


def test_the_example_becomes_a_scenario_in_which_the_ego_yields(type_here, tmp_path) -> None:
    assert "giveway new street.toml" in type_here("new").stdout
    done = type_here("new", "street.toml")
    assert done.returncode == 0, done.stderr
    assert "Drive there: giveway run street/" in done.stdout
    assert "warning" not in done.stdout
    drive = run(tmp_path / "street")
    assert drive.summary["completed"]
    assert drive.summary["yielding_rate"] == 1.0
    assert drive.summary["overlaps"] == 0


def test_an_example_that_was_edited_is_kept(type_here) -> None:
    type_here("new")
    done = type_here("new")
    assert done.returncode == 2
    assert done.stderr == "error: street.toml: exists; edit it, or replace it with --force\n"


def test_a_source_that_is_not_there_is_one_line(type_here) -> None:
    done = type_here("new", "town.osm")
    assert done.returncode == 2
    assert done.stderr.startswith("error: town.osm: cannot be read")
    assert done.stderr.count("\n") == 1


def test_a_map_becomes_a_scenario(tmp_path: Path) -> None:
    demand = Demand(duration=90.0)
    new_command(MAP, tmp_path / "town", demand, force=False, quiet=True)
    drive = run({"scenario": str(tmp_path / "town"), "time_limit": 5.0})
    assert drive.summary["pedestrians"] > 0
