"""The ledger as a whole: a lawless drive, in any frame, and one in which nothing happens."""

from dataclasses import asdict, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.crossing_world import ZEBRA, drive, ego, to_a_stand, turned, walker

from giveway.metrics import VehicleContact
from giveway.metrics.law import LAW_FIELDS, count, ledger
from giveway.run_data.way import StopLine

PEOPLE = (walker(-4.3, since=3.6), walker(4.3, speed=-1.4, since=1.9))
RED = {"lines": (StopLine(15.0, "tls", 0),), "lights": [(0.0, "r")]}


def lawless(turn=0.0, crossing=ZEBRA):
    """It runs a red light, does not yield to two people and stands on the crossing for nothing."""
    track = to_a_stand(27.0, (4.0, 0.0), (5.0, 1.5))
    x, y = turned(track.front_x, track.front_y, turn)
    moved = {"front_x": x, "front_y": y, "heading": track.heading + turn}
    track = replace(track, **moved)
    return ledger(drive(track, *PEOPLE, crossings=[crossing], turn=turn, **RED))


def test_every_violation_is_found_exactly_once():
    found = lawless()
    assert count(found.violations) == {
        "red light": 1,
        "failure to yield": 2,
        "blocked crossing": 1,
        "stop without cause": 1,
    }
    assert count(found.events) == count(found.violations) | {"encounter": 2}
    assert [event.time for event in found.events] == sorted(event.time for event in found.events)
    assert list(asdict(found.summary)) == [column.name for column in LAW_FIELDS]


def test_nothing_happens_where_nobody_is():
    found = ledger(drive(ego((15.0, 0.0))))
    assert found.events == ()
    numbers = asdict(found.summary)
    empty = {name for name, value in numbers.items() if np.isnan(value)}
    assert empty == {"yielding_rate", "mean_zebra_wait", "longest_zebra_wait"}
    assert all(value == 0 for name, value in numbers.items() if name not in empty)


def test_contacts_with_vehicles_are_rows():
    contact = VehicleContact("truck", 4.0, 0.5)
    (event,) = ledger(drive(ego((15.0, 0.0))), [contact]).violations
    assert (event.kind, event.other, event.time) == ("vehicle contact", "truck", 4.0)
    assert event.x == pytest.approx(16.0)


@settings(max_examples=10)
@given(turn=st.floats(-np.pi, np.pi), swapped=st.booleans())
def test_neither_the_frame_nor_the_crossings_direction_matters(turn, swapped):
    crossing = ZEBRA._replace(ends=ZEBRA.ends[::-1]) if swapped else ZEBRA
    here, there = lawless(), lawless(turn, crossing)
    assert count(there.events) == count(here.events)
    for one, other in zip(here.events, there.events, strict=True):
        assert other.value == pytest.approx(one.value, abs=0.03)
        assert other.time == pytest.approx(one.time, abs=0.03)
