"""The risk that a command line describes."""

from __future__ import annotations

import pytest

from giveway.errors import ConfigError
from giveway.risk.requested import requested_risk


def test_a_scenario_with_flags_is_a_risk():
    risk, origin = requested_risk(
        "junction",
        {"event": "red-light", "runs": 5, "method": None},
        ["crowd.pedestrians=3", "controller=idm"],
        ["vehicle.mass=normal:1000,100", "crowd=false"],
    )
    assert origin == risk.name == "junction"
    assert (risk.event, risk.runs, risk.method) == ("red-light", 5, "monte-carlo")
    assert risk.run == {"scenario": "junction", "crowd": {"pedestrians": 3}, "controller": "idm"}
    assert risk.inputs == {"vehicle.mass": {"normal": [1000, 100]}, "crowd": False}


def test_flags_change_what_a_file_says(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text('name = "mine"\nruns = 7\n[run]\n"crowd.pedestrians" = 4\n', encoding="utf-8")
    risk, _ = requested_risk(str(file), {"event": "side"}, ["crowd.pedestrians=5"], [])
    assert (risk.name, risk.runs, risk.event) == ("mine", 7, "side")
    assert risk.run == {"crowd": {"pedestrians": 5}}


def test_texts_that_say_nothing_are_refused():
    with pytest.raises(ConfigError, match=r"--fix mass: expected an option and its value"):
        requested_risk("junction", {}, ["mass"], [])
    with pytest.raises(ConfigError, match=r"--random vehicle.mass=5: expected an option, a distr"):
        requested_risk("junction", {}, [], ["vehicle.mass=5"])
