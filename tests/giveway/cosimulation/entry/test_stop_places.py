"""A bus that is taken over halts at its stops; other vehicles do so if they are asked to."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

if TYPE_CHECKING:
    from pathlib import Path

Drive = Callable[..., tuple[Any, Any]]  # the result of a run, and what was seen on the way
QUICKLY = {
    "crowd": {"zone": "none"},
    "regulation": {"reference_speed": 8.0},
    "time_limit": 60.0,
}
FREELY = {**QUICKLY, "rules": {"traffic_lights": False}}

LINE = """
    <vType id="twelve" vClass="{kind}" length="12" sigma="0" speedDev="0"/>
    <vehicle id="line" type="twelve" depart="0" departPos="15" departLane="1">
    <route edges="A0B0 B0C0"/>
    <stop lane="A0B0_1" startPos="45" endPos="60" duration="5"/>
    <stop lane="B0C0_2" startPos="40" endPos="55" until="38"/></vehicle>
"""


def halts(track: Any) -> list[tuple[float, float, float]]:
    """Time [s], duration [s] and place of the front (x) [m] of each standstill."""
    stands = np.concatenate([[0], (track.speed < 0.2).astype(int), [0]])
    begins, ends = np.flatnonzero(np.diff(stands) == 1), np.flatnonzero(np.diff(stands) == -1)
    last = len(track.time) - 1
    return [
        (track.time[a], track.time[min(b, last)] - track.time[a], track.front_x[a])
        for a, b in zip(begins, ends, strict=True)
    ]


@pytest.mark.parametrize("controller", ["mpc", "pid-tuned", "mpc-paper"])
def test_a_bus_serves_its_stops(
    drive: Drive, scenario: Callable[..., Path], controller: str
) -> None:
    config = scenario(LINE.format(kind="bus"))
    result, look = drive(config, ego={"take_over": ("line",)}, controller=controller, **FREELY)
    track = result.ego_track
    first, second = look.lanes["A0B0_1"], look.lanes["B0C0_2"]
    assert result.completed
    served = [halt for halt in halts(track) if halt[1] > 1.0]
    assert len(served) == 2
    (_, doors, x), (arrived, until, x_2) = served
    assert first[0, 0] + 45.0 <= x <= first[0, 0] + 61.0
    assert 5.0 <= doors < 8.0
    assert second[0, 0] + 40.0 <= x_2 <= second[0, 0] + 56.0
    assert 38.0 <= arrived + until < 41.0
    at_stop = track.front_y[np.searchsorted(track.time, arrived)]
    assert at_stop == pytest.approx(second[0, 1], abs=0.01)  # on the lane of the stop
    assert any("halts at 2 stop(s)" in remark for remark in result.remarks)


@pytest.mark.parametrize(
    ("kind", "keep", "served"), [("passenger", None, 0), ("passenger", True, 2), ("bus", False, 0)]
)
def test_whose_stops_are_kept(
    drive: Drive, scenario: Callable[..., Path], kind: str, keep: bool | None, served: int
) -> None:
    config = scenario(LINE.format(kind=kind))
    ego, rules = {"take_over": ("line",)}, {"traffic_lights": False, "stops": keep}
    result, _ = drive(config, ego=ego, rules=rules, controller="pid-tuned", **QUICKLY)
    assert result.completed
    assert len([halt for halt in halts(result.ego_track) if halt[1] > 1.0]) == served
    assert any("its 2 stop(s) are left out" in remark for remark in result.remarks) == (not served)


def test_a_stop_in_a_parking_area_or_behind_the_ego_is_left_out(
    drive: Drive, scenario: Callable[..., Path]
) -> None:
    area = '<additional><parkingArea id="p" lane="A0B0_1" startPos="40" endPos="60"/></additional>'
    config = scenario(
        LINE.format(kind="bus").replace(
            '<stop lane="A0B0_1" startPos="45" endPos="60" duration="5"/>',
            '<stop parkingArea="p" duration="5"/>',
        ),
        '<additional-files value="area.add.xml"/>',
    )
    config.with_name("area.add.xml").write_text(area)
    ego = {"take_over": ("line",)}
    result, _ = drive(config, ego=ego, controller="pid-tuned", **FREELY)
    assert len([halt for halt in halts(result.ego_track) if halt[1] > 1.0]) == 1
    assert any("halts at 1 stop(s)" in remark for remark in result.remarks)
    assert any("its 1 stop(s) are left out" in remark for remark in result.remarks)
