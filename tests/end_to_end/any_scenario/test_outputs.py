"""What a run leaves behind, read by the tools of the field."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import pedpy
import pytest

import giveway

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


@pytest.fixture(scope="module")
def written(city: Callable[[float], Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("run") / "out"
    giveway.run(
        {
            "scenario": str(city(0.1)),
            "ego": {"take_over": ("car10", "car12")},
            "crowd": {"zone": "everywhere"},
            "record": {"near": 1e6},
            "sumo": {"outputs": ["fcd", "tripinfo", "ssm", "summary"]},
            "time_limit": 20.0,
        },
        results=folder,
        pictures=False,
    )
    return folder


def test_sumos_own_outputs_contain_the_egos_and_the_walkers(written: Path) -> None:
    sumo = written / "sumo"
    names = {"fcd.xml", "trips.out.xml", "ssm.xml", "summary.xml", "edges.xml"}
    assert {file.name for file in sumo.iterdir()} == names  # where the scenario has a name, its own
    for name in sorted(names):
        root = ET.parse(sumo / name).getroot()
        assert len(root) > (0 if name in {"ssm.xml", "trips.out.xml"} else 1), name
    steps = list(ET.parse(sumo / "fcd.xml").getroot())
    last = {element.get("id"): element for element in steps[-1]}
    assert {"car10", "car12"} <= set(last)
    rows = pd.read_csv(written / "trajectories.csv", dtype={"id": str})
    now = rows[np.isclose(rows["time"], float(steps[-1].get("time", "nan")) + 0.1)]
    walkers = now[now["type"] == "pedestrian"].set_index("id")
    assert len(walkers) > 50
    for name in ("car10", *walkers.index[:20]):
        ours = now[now["id"] == name].iloc[0]
        assert float(last[name].get("x", "nan")) == pytest.approx(ours["x"], abs=0.006)
        assert float(last[name].get("y", "nan")) == pytest.approx(ours["y"], abs=0.006)


def test_the_tables_are_what_the_data_package_says(written: Path) -> None:
    package = json.loads((written / "datapackage.json").read_text())
    for table in package["resources"]:
        frame = pd.read_csv(written / table["path"])
        assert list(frame.columns) == [field["name"] for field in table["schema"]["fields"]]
        assert len(frame) > 0
    assert set(pd.read_csv(written / "ego.csv")["id"]) == {"car10", "car12"}
    assert set(pd.read_csv(written / "summary.csv")["ego"]) == {"car10", "car12"}
    manifest = json.loads((written / "manifest.json").read_text())
    assert manifest["pedestrians"]["taken_over"] > 50
    assert "walkers.trips.xml.gz" in manifest["scenario"]["sha256"]


def walkers_of(folder: Path) -> tuple[pd.DataFrame, Any]:
    rows = pd.read_csv(folder / "trajectories.csv")
    walkers = rows[rows["type"] == "pedestrian"].copy()
    walkers["frame"] = (walkers["time"] / 0.05).round().astype(int)
    names = sorted(walkers["id"].unique())
    walkers["number"] = walkers["id"].map({name: i for i, name in enumerate(names)})
    data = walkers[["number", "frame", "x", "y"]].rename(columns={"number": "id"})
    return walkers, pedpy.TrajectoryData(data=data, frame_rate=20.0)


def test_pedpys_speed_is_ours(written: Path) -> None:
    walkers, data = walkers_of(written)
    speed = pedpy.compute_individual_speed(
        traj_data=data,
        frame_step=1,
        speed_calculation=pedpy.SpeedCalculation.BORDER_SINGLE_SIDED,
    )
    both = speed.merge(walkers, left_on=["id", "frame"], right_on=["number", "frame"])
    assert len(both) == len(walkers) > 10_000
    # PedPy's is the mean of the two steps round a frame, ours that of the step before it.
    deviation = (both["speed_x"] - both["speed_y"]).abs()
    assert deviation.median() < 0.01
    assert deviation.quantile(0.99) < 0.2


def test_pedpys_density_counts_our_people(written: Path) -> None:
    walkers, data = walkers_of(written)
    area = pedpy.MeasurementArea([(80, 80), (120, 80), (120, 120), (80, 120)])  # the junction B1
    density = pedpy.compute_classic_density(traj_data=data, measurement_area=area)
    inside = walkers[walkers["x"].between(80, 120) & walkers["y"].between(80, 120)]
    people = inside.groupby("frame").size()
    counted = density.reset_index().set_index("frame")["density"] * 1600.0
    assert people.max() >= 3
    np.testing.assert_allclose(counted.loc[people.index], people, atol=1e-6)
