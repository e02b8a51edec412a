"""The counterfactual run: what a run's people would have done without the ego."""

from __future__ import annotations

import csv
import json
from typing import TYPE_CHECKING

import numpy as np
import pytest

import giveway
from giveway.cosimulation.mirror import Mirror
from pedestrian_model import Vehicles

if TYPE_CHECKING:
    from pathlib import Path


OPEN = {"controller": "pid-tuned", "crowd": {"pedestrians": 10}, "seed": 3}


STREET = {"scenario": "street", "controller": "pid-tuned", "crowd": {"pedestrians": 10}}


FOLLOWING = {
    "scenario": "junction",
    "controller": "pid-tuned",
    "egos": [{"ego": {"take_over": ["westbound.0"]}}, {"ego": {"id": "shuttle"}}],
    "crowd": {"zone": "50"},
    "sumo": {"step_length": 0.2},
    "time_step": 0.1,
}


def test_a_person_alone_loses_nothing(run_once):
    """He starts within 30 m of the ego's way and walks away from it."""
    crowd = {"pedestrians": 1, "spawn_area": (20.0, -29.0, 21.0, -28.0), "walk": (0.0, -20.0)}
    result = run_once(twin=True, crowd=crowd, controller="pid-tuned")
    (row,) = result.pedestrians.to_dict("records")
    assert row["delay_by"] == "arrival"
    assert row["delay"] == pytest.approx(0.0, abs=1e-9)
    assert row["detour"] == pytest.approx(0.0, abs=1e-9)
    assert row["gave_way"] == row["passed_first"] == ""
    assert result.summary["people_delay"] == pytest.approx(0.0, abs=1e-9)


def test_people_add_up_to_their_run(run_once):
    result = run_once(twin=True, **OPEN)
    people, summary = result.pedestrians, result.summary
    known = people["delay"].dropna()
    assert len(known) == summary["people_delayed"] == 10
    assert summary["people_delay"] == pytest.approx(known.sum(), abs=1e-9)
    assert summary["mean_people_delay"] == pytest.approx(known.mean(), abs=1e-9)
    assert summary["worst_people_delay"] == known.max() > 0.0
    yielded = people["gave_way"]
    assert summary["share_gave_way"] == (yielded == "yes").sum() / (yielded != "").sum()
    assert (people.loc[yielded == "yes", "delay"] > 0.0).all()


@pytest.mark.parametrize("config", [OPEN, STREET], ids=["open", "street"])
def test_a_counterfactual_run_leaves_the_other_columns_unchanged(config, tmp_path):
    giveway.run(config, results=tmp_path / "alone", pictures=False)
    giveway.run(config | {"twin": True}, results=tmp_path / "twin", pictures=False)
    before, after = ({f.name for f in (tmp_path / n).glob("*")} for n in ("alone", "twin"))
    assert before == after
    for name in before - {"timing.csv"}:
        if name.endswith(".csv"):
            alone, twin = columns(tmp_path / "alone" / name), columns(tmp_path / "twin" / name)
            assert alone == {column: twin[column] for column in alone}, name
    manifests = [
        json.loads((tmp_path / n / "manifest.json").read_text()) for n in ("alone", "twin")
    ]
    for key in ("pedestrians", "traffic", "ending", "vehicles"):
        assert manifests[0][key] == manifests[1][key], key
    assert set(manifests[1]["twin"]) == {"is", "until"}


def columns(file: Path) -> dict[str, list[str]]:
    with file.open(newline="") as text:
        names, *rows = csv.reader(text)
    return {name: [row[i] for row in rows] for i, name in enumerate(names)}


@pytest.mark.parametrize("config", [STREET, FOLLOWING], ids=["street", "zones that follow egos"])
def test_a_twin_whose_people_feel_the_egos_is_the_run_itself(config, monkeypatch):
    """Zone, lights, traffic, egos taken over and people drawn: nothing else may differ."""
    show = Mirror._show

    def with_egos(mirror: Mirror) -> None:
        show(mirror)
        mirror.others = Vehicles(mirror.poses[0])

    monkeypatch.setattr(Mirror, "_show", with_egos)
    result = giveway.run(config | {"twin": True})
    effect = result.effect
    assert effect is not None
    assert not effect.traffic_differs
    counted = effect.delays.delay[effect.run.near]
    assert len(counted) > 5
    assert np.nanmax(np.abs(counted)) <= 1e-6
    assert np.nanmax(np.abs(effect.delays.detour)) <= 1e-6


def test_without_an_ego_there_is_no_twin(run_once):
    result = run_once(twin=True, **(OPEN | {"ego": {"none": True}, "time_limit": 1.0}))
    assert result.effect is None
    assert any("twin: no ego" in remark for remark in result.remarks)
    assert result.manifest["remarks"] == list(result.remarks)
