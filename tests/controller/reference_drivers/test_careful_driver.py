"""The careful and competent driver: the regulation's times, and comfort where nothing is urgent."""

from types import SimpleNamespace

import numpy as np
import pytest

from controller import Observation, ParameterError, Setup
from controller.reference_drivers.careful_driver import CarefulDriver, CarefulOptions
from giveway.plug_ins.conformance import check_controller

SETUP = Setup(0.05, 1000.0, 100.0, 13.9, 2.0, 8000.0, 2.0)


class Straight:
    def __init__(self, x):
        self.x = x

    def remaining(self):
        return 1e3

    def poses(self, distances):
        return np.column_stack([self.x + distances, np.zeros((len(distances), 2))])


def drive(speed, person=None, steps=200, appears=0.0, **gaps):
    """(t, x, v, a, reason) of each step; the person stands on the way from ``appears`` [s] on."""
    driver, x, v, rows = CarefulDriver(SETUP, CarefulOptions()), 0.0, speed, []
    for k in range(steps):
        there = person is not None and k * 0.05 >= appears
        people = SimpleNamespace(
            position=np.array([[person, 0.0]]) if there else np.empty((0, 2)),
            velocity=np.zeros((int(there), 2)),
        )
        seen = {name: place - x for name, place in gaps.items()}
        observation = Observation(x, v, np.inf, np.empty(0), path=Straight(x), people=people)
        answer = driver.control(observation.replaced(speed_limit=speed, **seen))
        rows.append((k * 0.05, x, v, answer.value, answer.reason))
        after = max(0.0, v + 0.05 * answer.value)
        x, v = x + 0.025 * (v + after), after
    return rows


def test_who_cuts_in_is_braked_for_after_the_regulations_times():
    """0.4 s to perceive and 0.75 s of delay; 0.774 g after another 0.6 s."""
    rows = drive(13.9, person=27.0 + 13.9, appears=1.0)
    begins = next(t for t, *_, a, _ in rows if a < -0.1)
    hardest = next(t for t, *_, a, _ in rows if a <= -0.774 * 9.81 + 1e-9)
    assert begins - 1.0 == pytest.approx(0.4 + 0.75, abs=0.051)
    assert hardest - begins == pytest.approx(0.6, abs=0.06)
    assert min(a for *_, a, _ in rows) == pytest.approx(-0.774 * 9.81)


@pytest.mark.parametrize(
    ("speed", "seconds", "preventable"), [(7.0, 1.95, True), (4.0, 1.2, False), (13.9, 1.9, False)]
)
def test_what_it_can_prevent_and_what_not(speed, seconds, preventable):
    """Braking distance by hand: v (0.4 + 0.75), v^2 / 2 / 0.774 g, and the ramp."""
    rows = drive(speed, person=speed * seconds)
    hardest = 0.774 * 9.81
    needs = speed * (1.15 + 0.3) + speed**2 / (2.0 * hardest) - hardest * 0.6**2 / 24.0
    assert (needs < speed * seconds) == preventable
    stopped = min(v for _, x, v, *_ in rows if x < speed * seconds) == 0.0
    assert stopped == preventable


def test_who_is_seen_early_is_no_emergency():
    rows = drive(8.0, person=60.0, steps=600)
    assert min(a for *_, a, _ in rows) >= -1.2 * 1.5 - 1e-9
    assert {reason for *_, reason in rows} == {"free", "person"}
    assert 60.0 - rows[-1][1] == pytest.approx(2.0, abs=0.3)
    assert rows[-1][2] == pytest.approx(0.0, abs=0.01)


def test_stop_lines_and_leaders():
    line = drive(8.0, steps=600, stop_gap=60.0)
    assert 60.0 - line[-1][1] == pytest.approx(0.5, abs=0.3)
    leader = drive(8.0, steps=600, leader_gap=60.0)
    assert 60.0 - leader[-1][1] == pytest.approx(2.0, abs=0.3)
    assert {row[-1] for row in leader} == {"free", "vehicle"}


def test_it_keeps_to_the_rules_and_its_options_to_theirs():
    findings = check_controller(lambda setup: CarefulDriver(setup, CarefulOptions()), SETUP)
    assert [finding for finding in findings if finding.problem] == []
    with pytest.raises(ParameterError, match="ramp"):
        CarefulOptions(ramp=0.0)
    with pytest.raises(ParameterError, match="delay"):
        CarefulOptions(delay=-0.1)
