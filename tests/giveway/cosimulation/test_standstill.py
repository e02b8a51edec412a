"""A scenario without an end is ended when no ego moves."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from support.streets import EASTWARDS, NOBODY, ROUTE

import giveway
from giveway.run_data.progress import Ending

if TYPE_CHECKING:
    from collections.abc import Callable

    Scenario = Callable[..., str]


def test_an_endless_scenario_ends_when_the_path_stays_blocked(
    street_scenario: Scenario, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("giveway.cosimulation.standstill.LONGEST", 20.0)  # an hour, in earnest
    stop = '<stop lane="A0B0_0" endPos="40" duration="1000000"/>'
    broken_down = f'<vehicle id="broken" depart="0" departLane="0">{ROUTE}{stop}</vehicle>'
    ego = {"route": EASTWARDS, "lane": 0, "depart_time": 30}
    result = giveway.run({"scenario": street_scenario(broken_down, end=-1), "ego": ego} | NOBODY)
    assert result.ending is Ending.TIME_LIMIT
    assert result.ego_track.speed[-1] == 0
    assert any("no ego moved for 20 s" in remark for remark in result.remarks)
