"""Pedestrians that giveway adds to those of a scenario."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from giveway.run_data.progress import Ending

if TYPE_CHECKING:
    from pathlib import Path


Drive = Callable[..., tuple[Any, Any]]  # the result of a run, and what was seen on the way


def adds_up(ledger: dict[str, int]) -> bool:
    came = ledger["added"] + ledger["taken_over"]
    return came == sum(ledger[k] for k in ("handed_back", "arrived", "continued", "walking"))


def test_pedestrians_of_ours_join_those_of_the_scenario(
    drive: Drive, city: Callable[[float], Path]
) -> None:
    crowd = {
        "zone": "30",
        "pedestrians": 10,
        "spawn_area": (120.0, 88.0, 180.0, 94.0),
        "walk": (0.0, 18.0),
        "host_edge": "B1C1",
    }
    result, look = drive(city(0.1), ego={"take_over": ("car10",)}, crowd=crowd, time_limit=20.0)
    ledger = result.manifest["pedestrians"]
    assert adds_up(ledger)
    assert ledger["added"] == 10
    assert ledger["taken_over"] > 0
    assert result.ending is Ending.TIME_LIMIT
    assert look.ours[-1] == ledger["walking"]
