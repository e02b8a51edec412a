"""A scenario whose only road is a given path, in real SUMO."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import giveway
from giveway.scenario_files.configuration_text import configuration_of
from giveway.scenario_files.path_network import network_along

if TYPE_CHECKING:
    from pathlib import Path

# A quarter of a circle of 20 m radius, from (0, 0) towards +x, and on towards +y
TURN = np.linspace(0.0, np.pi / 2, 16)
PATH = np.column_stack([20.0 * np.sin(TURN), 20.0 - 20.0 * np.cos(TURN)])


def test_the_ego_drives_along_the_path(tmp_path: Path) -> None:
    path = np.vstack([[-10.0, 0.0], PATH, [20.0, 40.0]])
    (tmp_path / "bend.net.xml").write_text(network_along(path, 13.89))
    (tmp_path / "bend.sumocfg").write_text(configuration_of("bend", 60.0))
    ego = {"route": ["drive"], "depart_position": 10.0, "travel_distance": 40.0}
    crowd = {"pedestrians": 1, "spawn_area": (50.0, 50.0, 51.0, 51.0), "host_edge": "gate"}
    result = giveway.run({"scenario": str(tmp_path), "ego": ego, "crowd": crowd})
    assert result.ending == "completed"
    places = result.ego[["x", "y"]].to_numpy()
    assert places[0] == pytest.approx([0.0, 0.0], abs=0.01)
    apart = places[:, None] - np.vstack([PATH, [20.0, 30.0]])
    nearest = np.hypot(apart[..., 0], apart[..., 1]).min(axis=1)
    on_the_bend = places[:, 1] < 20.0
    # half of the distance between two points, and the smooth path's distance of up to 0.5 m
    assert nearest[on_the_bend].max() < 1.25
    assert places[-1][0] == pytest.approx(20.0, abs=0.5)
