"""The scenario's own people: taken over in the zone, handed back outside, none lost."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import shapely

import giveway

if TYPE_CHECKING:
    from pathlib import Path

    from giveway import RunResult
    from giveway.walkways import WalkNetwork

Drive = Callable[..., tuple[Any, Any]]  # the result of a run, and what was seen on the way


def adds_up(ledger: dict[str, int]) -> bool:
    came = ledger["added"] + ledger["taken_over"]
    return came == sum(ledger[k] for k in ("handed_back", "arrived", "continued", "walking"))


def share_within(area: shapely.Geometry, margin: float, result: RunResult) -> float:
    grown = area.buffer(margin)
    shapely.prepare(grown)
    crowd = result.crowd_track
    return float(shapely.contains_xy(grown, crowd.x, crowd.y).mean())


def test_people_stay_where_people_walk(
    crowded: tuple[RunResult, Any], network: WalkNetwork
) -> None:
    result, _ = crowded
    assert len(result.crowd_track.ids) > 200
    area = network.walkable
    assert share_within(area, 0.27, result) > 0.97  # a body's radius: pushed about by others
    assert share_within(area, 1.5, result) > 0.999


def test_people_keep_to_the_walkways_by_default(
    drive: Drive, city: Callable[[float], Path], network: WalkNetwork
) -> None:
    driven = {"ego": {"take_over": ("car10",)}, "controller": "pid-tuned"}
    result, _ = drive(city(0.1), crowd={"zone": "everywhere"}, time_limit=40.0, **driven)
    assert share_within(network.walkable, 0.05, result) > 0.995
    assert adds_up(result.manifest["pedestrians"])


def test_without_walls_people_step_aside_from_cars_by_less_than_a_metre(
    drive: Drive, city: Callable[[float], Path], network: WalkNetwork
) -> None:
    driven = {"ego": {"take_over": ("car10",)}, "controller": "pid-tuned"}
    crowd = {"zone": "everywhere", "walls": False}
    result, _ = drive(city(0.1), crowd=crowd, time_limit=40.0, **driven)
    assert 0.85 < share_within(network.walkable, 0.27, result) < 0.97
    assert share_within(network.walkable, 1.0, result) > 0.999


def test_with_walls_nobody_leaves_the_walkways(
    drive: Drive, city: Callable[[float], Path], network: WalkNetwork
) -> None:
    crowd = {"zone": "everywhere", "walls": True}
    driven = {"ego": {"take_over": ("car10",)}, "controller": "pid-paper"}
    result, _ = drive(city(0.1), crowd=crowd, time_limit=40.0, **driven)
    assert len(result.crowd_track.ids) > 150
    assert share_within(network.walkable, 0.05, result) > 0.9995
    assert adds_up(result.manifest["pedestrians"])


def test_two_runs_are_the_same_to_the_byte(city: Callable[[float], Path], tmp_path: Path) -> None:
    config = {
        "scenario": str(city(1)),
        "ego": {"take_over": ("car10",)},
        "crowd": {"zone": "60", "walls": True},
        "time_limit": 25.0,
    }
    for name in ("one", "other"):
        giveway.run(config, results=tmp_path / name, pictures=False)
    for table in ("trajectories", "ego", "pedestrians", "summary"):
        one, other = ((tmp_path / name / f"{table}.csv").read_bytes() for name in ("one", "other"))
        assert one == other
    assert (tmp_path / "one" / "trajectories.csv").stat().st_size > 50_000
