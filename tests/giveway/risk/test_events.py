"""The events and the criticality of a run."""

from __future__ import annotations

import math

import pytest

from giveway.errors import ConfigError
from giveway.risk.events import MEASURES, read_event
from giveway.studies.record import RunRecord


def record(**row):
    return RunRecord("r1", "k", "completed", rows=({"ego": "ego", **row},))


QUIET = {"minimum_clearance": 4.0, "maximum_drac": 0.0, "frontal_impact_speed": math.nan}
NEAR = QUIET | {"maximum_drac": 3.0, "clearance_ahead": 1.0, "minimum_ttc_moving": 0.5}
NEARER = QUIET | {"maximum_drac": 9.0, "clearance_ahead": 0.1, "minimum_ttc_moving": 0.1}
HIT = NEARER | {"frontal_impact_speed": 3.0, "minimum_clearance": -0.1}


@pytest.mark.parametrize("measure", MEASURES)
@pytest.mark.parametrize("event", ["frontal", "impact>5"])
def test_the_criticality_grows_towards_the_event(event, measure):
    found = [
        read_event(event, "x").criticality(record(**r), measure) for r in (QUIET, NEAR, NEARER, HIT)
    ]
    assert found == sorted(found)
    assert len(set(found)) == 4
    assert found[-2] < 0.0 <= found[-1]


def test_a_slower_impact_than_asked_for_is_not_the_event():
    event = read_event("impact>20", "x")
    assert event.criticality(record(**HIT), "ttc") < 0.0
    fast = HIT | {"frontal_impact_speed": 20.1 / 3.6}
    assert event.criticality(record(**fast), "ttc") > 0.0


def test_a_contact_is_any_overlap_and_a_side_contact_is_none_at_the_front():
    side = QUIET | {"minimum_clearance": -0.05, "side_impact_speed": 1.4}
    assert read_event("contact", "x").criticality(record(**side), "ttc") == pytest.approx(0.05)
    assert read_event("side", "x").criticality(record(**side), "ttc") == pytest.approx(1.4)
    assert read_event("frontal", "x").criticality(record(**side), "ttc") < 0.0
    assert read_event("side", "x").criticality(record(**HIT), "ttc") < 0.0


def test_the_worst_of_several_egos_counts():
    both = RunRecord("r1", "k", "completed", rows=(QUIET, HIT))
    assert read_event("frontal", "x").criticality(both, "deceleration") == 3.0


def test_a_run_without_a_result_has_no_criticality():
    failed = RunRecord("r1", "k", "failed", failure="it broke")
    assert math.isnan(read_event("frontal", "x").criticality(failed, "ttc"))


def test_an_injury_is_drawn_by_its_probability_and_graded_by_it():
    event = read_event("mais3", "x")
    hit = HIT | {"frontal_impact_speed": 12.0, "adult_impact_speed": 12.0}
    near, spared, injured = (
        event.criticality(record(**row), "ttc", draw)
        for row, draw in ((NEARER, 0.01), (hit, 0.9), (hit, 0.1))
    )
    assert near < -1.0 < spared < 0.0 <= injured < 1.0
    child = HIT | {"child_impact_speed": 3.0}
    assert math.isnan(event.criticality(record(**child), "ttc", 0.1))


def test_red_lights_are_counted_and_not_graded():
    event = read_event("red-light", "x")
    assert not event.is_graded
    assert event.criticality(record(red_lights_run=1), "ttc") > 0.0
    assert event.criticality(record(red_lights_run=0), "ttc") < 0.0
    assert event.criticality(record(), "ttc") < 0.0


@pytest.mark.parametrize("text", ["frontel", "impact>", "impact>SPEED", "impact<5"])
def test_an_unknown_event_is_refused_with_those_that_there_are(text):
    with pytest.raises(ConfigError, match="expected one of frontal, side, contact, impact>SPEED"):
        read_event(text, "mine.toml")
