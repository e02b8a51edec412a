"""The causes of the event: the inputs given it, its likeliest runs, and the picture of both."""

from __future__ import annotations

from io import StringIO

import numpy as np
import pytest
from rich.console import Console

from giveway.cli.screen.risk_summary import print_risk
from giveway.risk.cause_tables import given_event_frame, likeliest_frame
from giveway.risk.causes import components_of, conditions, events_known, likeliest
from giveway.risk.pictures import pictures


def printed(folder):
    console = Console(width=150, record=True, file=StringIO())
    print_risk(console, folder)
    return " ".join(console.export_text().split())


@pytest.mark.parametrize(("method", "runs"), [("monte-carlo", 1500), ("subset", 3000)])
def test_the_inputs_that_matter_differ_given_the_event(known_risk, method, runs):
    folder = known_risk(method, runs)
    assert events_known(folder) >= 50
    speed, mass, *others = conditions(folder)
    assert [speed.component.name, mass.component.name] == ["ego.initial_speed", "vehicle.mass"]
    assert speed.own == pytest.approx((1.35, 4.5, 7.65))
    assert speed.given[1] > 6.0
    assert 0.0 < speed.index.low < speed.index.index < speed.index.high
    assert all(one.index.low == 0.0 for one in others[4:])
    preset = next(one for one in others if one.component.name == "crowd.preset")
    assert preset.shares == pytest.approx({"MIXED": 0.5, "SIM": 0.5}, abs=0.15)


def test_the_table_has_each_input_and_each_component_of_a_person(known_risk):
    folder = known_risk()
    table = given_event_frame(folder)
    assert len(table) == len(components_of(folder)) == 3 + 3 * 2
    assert table["index"].is_monotonic_decreasing
    assert table["input"].str.startswith("crowd 2 ").sum() == 3


def test_the_likeliest_runs_with_the_event_are_the_nearest_to_the_usual_ones(known_risk):
    folder = known_risk()
    ten = likeliest(folder)
    assert len(ten) == 10
    assert [one.distance for one in ten] == sorted(one.distance for one in ten)
    assert ten[0].distance == pytest.approx(np.linalg.norm(ten[0].run.vector[1:]))
    first = likeliest_frame(folder).iloc[0]
    again = f"giveway replay {folder.path}/reruns/{ten[0].run.id}"
    assert first["reproduce"] == f"giveway rerun {folder.path} {ten[0].run.id} && {again}"


def test_the_region_of_the_event_is_drawn_in_the_plane_of_two_inputs(known_risk):
    drawn = pictures(known_risk())
    assert list(drawn) == ["convergence", "region"]
    axes = drawn["region"].axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("ego.initial_speed", "vehicle.mass")


def test_why_prints_the_inputs_given_the_event(known_risk):
    told = printed(known_risk(why=1))
    assert "the share of its variance that each explains alone" in told
    assert "vehicle.mass" in told


def test_too_few_events_are_said_in_one_line(known_risk):
    folder = known_risk(runs=20, why=1)
    assert conditions(folder) == []
    assert list(pictures(folder)) == ["convergence"]
    assert "vectors have it; expected 50 or more: raise the budget" in printed(folder)
