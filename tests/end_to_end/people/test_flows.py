"""People who come in during a run, through the real SUMO, FMU and solver."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from support.flows import PLAZA, STREET, with_crowd

import giveway

DOCS = Path(__file__).parents[3] / "docs"


@pytest.mark.parametrize("config", [PLAZA, STREET], ids=["open ground", "a street"])
def test_the_twin_has_the_very_same_arrivals(config: dict) -> None:
    """Who does not mind the ego loses nothing: where, when and how everybody came is the same."""
    blind = with_crowd(config, model="constant-velocity")
    result = giveway.run({**blind, "twin": True})
    delays = result.pedestrians.delay.dropna()
    assert len(delays) > 10
    assert delays.abs().max() < 1e-9
    assert not result.remarks


def test_only_people_who_react_to_egos_lose_time_before_one() -> None:
    result = giveway.run({**with_crowd(PLAZA, flow_scale=2.0), "twin": True})
    assert result.effect is not None
    pairs = zip(result.effect.run.ids, result.effect.twin.ids, strict=False)
    assert all(one == other for one, other in pairs)  # up to the shorter one's end
    assert result.summary["people_delay"] != 0.0
    assert result.summary["frontal_contacts"] == 0


def test_the_same_seed_has_the_same_bytes_and_another_has_not(tmp_path: Path) -> None:
    people = {"elderly": 0.3, "distracted": 0.3}
    preset = tmp_path / "swaying.toml"
    preset.write_text("base = 'SIM'\n[parameters]\nsway = 0.2\n")
    mixed = with_crowd(PLAZA, groups=0.6, people=people, preset=str(preset))
    for name, seed in (("one", 3), ("same", 3), ("other", 4)):
        giveway.run({**mixed, "seed": seed}, results=tmp_path / name, pictures=False)
    for table in ("ego", "trajectories", "pedestrians", "summary"):
        one, same, other = (
            (tmp_path / name / f"{table}.csv").read_bytes() for name in ("one", "same", "other")
        )
        assert one == same != other


def test_they_wait_for_their_light() -> None:
    """At a crossing that has green in the same part of every 60 s."""
    way = {"from": [5.0, -9.0, 7.5, -7.0], "to": [5.0, 7.0, 7.5, 9.0]}
    flow = {"name": "lit", **way, "rate": 900.0}
    crowd = {"flow": [flow], "zone": "none"}
    config = {"scenario": "junction", "seed": 2, "crowd": crowd, "time_limit": 180.0}
    result = giveway.run({**config, "ego.none": True})
    people = result.trajectories.query("type == 'pedestrian'")
    stood = people.groupby("id")["speed"].apply(lambda speed: (speed < 0.1).sum() * 0.05)
    assert stood.max() > 10.0  # [s]
    before, on = people[people["y"] < -3.5], people[people["y"].abs() < 2.5]
    assert before.groupby("id")["y"].max().max() > -4.5  # they come up to the kerb
    entered = on.groupby("id")["time"].min().to_numpy() % 60.0
    assert len(entered) > 20
    share, _ = np.histogram(entered, bins=12, range=(0.0, 60.0))
    assert (share == 0).sum() >= 6  # nobody sets out while it is red


def test_they_have_priority_on_a_zebra() -> None:
    zebra = {"name": "zebra", "from": [58.5, -6.3, 61.5, -5.5], "to": [58.5, 5.5, 61.5, 6.3]}
    crowd = {"flow": [{**zebra, "rate": 900.0}], "zone": "none"}
    config = {"scenario": "junction", "seed": 4, "crowd": crowd}
    result = giveway.run(config)
    judged = result.ledger
    given_way = judged[judged["other"].str.startswith("zebra.")]
    assert (given_way["kind"] == "encounter").any()
    assert result.summary["failures_to_yield"] == 0
    assert result.summary["overlaps"] == 0


def test_a_study_varies_their_number_and_who_they_are(study_of, tmp_path: Path) -> None:
    study = study_of(
        """
        name = "flows"
        replications = 3
        [run]
        scenario = "shared_space"
        controller = "pid-tuned"
        time_limit = 4.0
        crowd.pedestrians = 0
        [[run.crowd.flow]]
        from = [[18.0, -16.0], [36.0, -16.0]]
        to = [18.0, 14.0, 36.0, 16.0]
        rate = 1800
        begin = -40
        [factors]
        "crowd.flow_scale" = [1.0, 2.0]
        "crowd.people.elderly" = [0.0, 1.0]
        [comparison]
        minimum_pairs = 3
        resamples = 99
        """,
        tmp_path / "study",
    )
    assert len(study.runs) == 12
    assert study.failures.empty
    clearance = study.runs.groupby(["crowd.flow_scale", "crowd.people.elderly"])[
        "minimum_clearance"
    ]
    assert clearance.mean().nunique() == 4


def test_what_docs_print_runs_and_can_be_replayed(tmp_path: Path) -> None:
    (block,) = re.findall(
        r"```toml\n(.*?)```", (DOCS / "pedestrians.md").read_text(), flags=re.DOTALL
    )
    config = tmp_path / "plaza.toml"
    config.write_text(block, encoding="utf-8")
    result = giveway.run(config, results=tmp_path / "run", pictures=False)
    names = {flow["name"] for flow in tomllib.loads(block)["crowd"]["flow"]}
    assert {name.partition(".")[0] for name in result.pedestrians["id"]} == names
    assert result.pedestrians.query("id.str.startswith('school')")["kind"].eq("child").mean() > 0.5
    page = tmp_path / "page.html"
    result.replay().save(page)
    assert "north.1" in page.read_text(encoding="utf-8")
    written = tomllib.loads((tmp_path / "run" / "config.toml").read_text(encoding="utf-8"))
    again = giveway.run(tmp_path / "run" / "config.toml")
    assert len(written["crowd"]["flow"]) == 2
    assert again.summary == result.summary
