"""Brake tests with SUMO and an FMU: the impact point of the protocol, and braking by the layer."""

from __future__ import annotations

import pytest

import giveway
from giveway.config.files.layers import Layer, merge
from giveway.ncap.plan import HOLDER, OBSTRUCTED, Planned, road_of, study_of
from giveway.ncap.protocol import read_protocol
from giveway.ncap.request import courses_of
from giveway.ncap.table import outcome_of
from giveway.studies.record import RunRecord

PROTOCOLS = [read_protocol(name) for name in ("euroncap-2026", "euroncap-2023")]


def outcome(folder, key, car, nobody=False):
    """Make the run of one cell, or of its road without the person."""
    protocol, cell = next((each, one) for each in PROTOCOLS for one in each.cells if one.key == key)
    width = car.get("vehicle", {}).get("width", 2.0)
    run = Planned(cell.label, HOLDER, road_of(cell), cell.speed, None if nobody else cell)
    courses = courses_of(folder, protocol, width)
    study = study_of("x", protocol, [run], car, courses, folder, 1)
    layers = [Layer("", study.run), Layer("", study.placed(study.factors["test"][cell.label]))]
    result = giveway.run(merge(layers))
    record = RunRecord("c1-s1", "", str(result.ending), tuple(result.summary_rows))
    return outcome_of(protocol, run, "c1-s1", record, width)


@pytest.mark.parametrize(
    ("key", "width"),
    [
        (("CPNA", 25, 10), 1.6),
        (("CPNA", 90, 60), 2.4),
        (("CPFA", 75, 30), 1.8),
        (("CPNCO", 50, 40), 1.8),
        (("CPLA", 25, 80), 2.0),
        (("CPTAfs", 50, 20), 1.8),
        (("CPTAno", 50, 10), 2.0),
    ],
)
def test_without_the_layer_the_car_hits_the_dummy_where_the_protocol_says(tmp_path, key, width):
    car = {"vehicle": {"width": width}, "safety": {"enabled": False}}
    found = outcome(tmp_path, key, car)
    assert abs(found.numbers["impact_point"] - key[1]) / 100.0 * width < 0.01
    assert found.impact == pytest.approx(key[2], abs=0.01)
    if not key[0].startswith("CPTA"):
        along = 5.0 if key[0] == "CPLA" else 0.0
        assert found.relative == pytest.approx(key[2] - along, abs=0.01)
    assert found.numbers["hardest_braking"] < 0.01


def test_a_child_behind_parked_cars_is_seen_late_and_hit_as_hard_as_physics_says(tmp_path):
    """From 60 km/h with 4 m/s^2 and the drag, from the step after the child is perceived on."""
    car = {"vehicle": {"width": 1.8, "force_limit": 4000.0}}
    found = outcome(tmp_path, ("CPNCO", 50, 60), car)
    seen = found.numbers["first_sight_distance"]
    assert 20.0 < seen < 26.0
    speed, left = 60.0 / 3.6, seen - 0.149 - 60.0 / 3.6 * 0.05
    while left > 0.0:  # M v' = -4 kN - 100 v
        left -= 0.001 * speed
        speed -= 0.001 * (4.0 + 0.1 * speed)
    assert found.impact == pytest.approx(3.6 * speed, abs=2.0)


def test_an_adult_in_the_open_is_spared_and_nobody_makes_it_brake(tmp_path):
    assert outcome(tmp_path, ("CPNA", 50, 60), {}).impact == 0.0
    alone = outcome(tmp_path, ("CPNCO", 50, 60), {}, nobody=True)
    assert alone.planned.road == OBSTRUCTED
    assert not alone.reacts_to_nobody
