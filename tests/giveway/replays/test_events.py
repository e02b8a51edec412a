"""Events of a replay: stops, fallbacks, encounters, and the planner's reasons."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import pytest

from giveway.replays.events import events, why
from giveway.run_data.columns import SIGHT_COLUMNS

if TYPE_CHECKING:
    from pathlib import Path


NO_SIGHTS = pd.DataFrame(columns=[column.name for column in SIGHT_COLUMNS])


@pytest.mark.parametrize(
    ("reason", "text"),
    [
        ("clear", "nobody is in the way"),
        ("drive on", "driving on costs least"),
        ("as planned", "keeps to its plan"),
        ("+0 m/s^2 to 0 m/s", "keeping the speed costs least"),
        ("-2.5 m/s^2 to 1.4 m/s", "slowing down to 1.4 m/s at 2.5 m/s^2 costs least"),
        ("safety layer", "the safety layer brakes"),
    ],
)
def test_what_the_planning_mpc_chose_is_told_in_words(reason: str, text: str) -> None:
    told = why(reason, "solved")
    assert text in told["text"]
    assert not told["infeasible"]


def test_events_are_stops_fallbacks_and_encounters(recorded: Path) -> None:
    from giveway.config import EgoRunConfig

    time = np.arange(6) * 0.5
    rows = pd.DataFrame(
        {
            "time": time,
            "speed": [1.0, 0.1, 0.1, 1.0, 1.0, 0.0],
            "controller": ["mpc", "pid", "pid", "mpc", "mpc", "mpc"],
            "reason": ["optimal", "infeasible", "infeasible", "optimal", "optimal", "optimal"],
            "solver_status": ["solved", *2 * ["infeasible: too close"], *3 * ["solved"]],
        }
    )
    people = pd.DataFrame(
        {
            "id": ["p", "q"],
            "minimum_clearance": [-0.1, 0.4],
            "time_of_minimum_clearance": [1.0, 2.0],
        }
    )
    told = [
        (e["kind"], e["from"], e["to"]) for e in events(rows, people, EgoRunConfig(), NO_SIGHTS)
    ]
    assert told == [
        ("pid", 0.5, 1.5),
        ("stop", 0.5, 1.5),
        ("overlap", 1.0, 1.0),
        ("stop", 2.5, 2.5),
    ]


@pytest.mark.parametrize("controller", ["pid-tuned", "mpc-paper"])
def test_the_safety_layers_braking_is_an_event_whoever_drives(controller: str) -> None:
    from giveway.config import EgoRunConfig

    acting = ["pid", "safety", "safety", "pid", "safety", "safety"]
    rows = pd.DataFrame(
        {
            "time": np.arange(6) * 0.5,
            "speed": 1.0,
            "controller": acting,
            "reason": ["", *2 * ["safety layer"], "", *2 * ["unavoidable"]],
            "solver_status": "infeasible: too close",
        }
    )
    found = events(rows, pd.DataFrame(), EgoRunConfig(controller=controller), NO_SIGHTS)
    assert [(e["from"], e["to"], e["text"]) for e in found if e["kind"] == "safety"] == [
        (0.5, 1.5, "the safety layer brakes: a stop must stay possible"),
        (2.0, 2.5, "the safety layer brakes: no braking is surely enough"),
    ]


def test_who_comes_in_sight_during_the_drive_is_an_event_once() -> None:
    from giveway.config import EgoRunConfig

    same = {"speed": 1.0, "controller": "mpc", "reason": "optimal", "solver_status": "solved"}
    rows = pd.DataFrame({"time": np.arange(6) * 0.5} | same)
    sights = pd.DataFrame(
        [("ego", "p", 0.0, 9.0, 8.0), ("ego", "q", 1.0, 1.5, 5.12), ("ego", "q", 2.0, np.nan, 4.0)],
        columns=NO_SIGHTS.columns,
    )
    (found,) = events(rows, pd.DataFrame(), EgoRunConfig(), sights)
    assert (found["kind"], found["from"], found["who"]) == ("sight", 1.0, "q")
    assert found["text"] == "in sight, 5.1 m from the front: q"
    sights["id"] = sights["id"].replace("q", "false:1")
    (found,) = events(rows, pd.DataFrame(), EgoRunConfig(), sights)
    assert found["text"] == "false detection, 5.1 m from the front: false:1"
