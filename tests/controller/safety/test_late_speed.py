"""The speed of a vehicle whose speed output is late: an estimate between two bounds."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from controller import Actuator, LateSpeed, LongitudinalModel

H, LAG = 0.05, 0.3  # [s]
MODEL = LongitudinalModel(friction=0.0)


def filtered(speeds):
    """The outputs of a first-order filter; the speed changes by straight lines."""
    outputs, left = [speeds[0]], np.exp(-H / LAG)
    for before, after in pairwise(speeds):
        behind = LAG * (after - before) / H
        outputs.append(after - behind + (outputs[-1] - before + behind) * left)
    return outputs


def looks(speeds, force):
    """The estimates and bounds of a drive under one force."""
    late = LateSpeed(MODEL, LAG, Actuator(), 8000.0)
    for output in filtered(speeds):
        yield late.look(output), late.least, late.most
        late.applied(force)


def test_an_output_that_does_not_change_is_the_speed():
    *_, (estimate, least, most) = looks([5.0] * 10, 0.0)
    assert estimate == most == 5.0
    assert least == pytest.approx(4.8)  # it may have braked fully since half a step


def test_a_vehicle_that_brakes_is_slower_than_its_output():
    speeds = list(10.0 - 3.0 * H * np.arange(40))
    *_, (estimate, least, most) = looks(speeds, -3000.0)
    assert estimate == pytest.approx(speeds[-1], abs=0.01)
    assert least - 1e-9 <= speeds[-1] <= most + 1e-9
    assert most == pytest.approx(speeds[-1])  # the forces tell it, if nothing else decelerates
    assert filtered(speeds)[-1] > speeds[-1] + 0.8


def test_a_vehicle_that_stands_is_known_to_while_its_output_falls():
    speeds = [*np.linspace(2.0, 0.0, 9), *[0.0] * 3]
    *_, (estimate, least, most) = looks(speeds, -5000.0)
    assert estimate == least == most == 0.0
    assert filtered(speeds)[-1] > 0.3


def test_where_the_forces_tell_another_story_the_output_counts():
    """It rolls downhill faster and faster, although nothing drives it."""
    speeds = list(2.0 + 2.0 * H * np.arange(60))
    *_, (estimate, _, most) = looks(speeds, 0.0)
    assert most > filtered(speeds)[-1] - 0.2
    assert estimate == pytest.approx(speeds[-1], abs=0.01)
