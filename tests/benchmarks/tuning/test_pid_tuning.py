"""The shipped gains are those that the documented method finds."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from pid_tuning import (
    OVERSHOOT_LIMIT,
    SENSITIVITY_LIMIT,
    Merits,
    merits,
    ranked,
    rise_time,
    sensitivity,
    settling_time,
    table,
    tune,
)

from controller import LongitudinalModel, TunedPidParameters

MODEL = LongitudinalModel()


@pytest.fixture(scope="module")
def found() -> list[Merits]:
    return tune(MODEL)


def test_the_defaults_are_what_the_tuning_finds(found):
    best, shipped = found[0], TunedPidParameters()
    assert (best.bandwidth, best.damping) == (shipped.bandwidth, shipped.damping)


def test_the_best_keeps_all_constraints(found):
    assert found[0].admissible
    assert found[0].overshoot < OVERSHOOT_LIMIT
    assert found[0].sensitivity <= SENSITIVITY_LIMIT
    assert found[0].steady_state_error < 1e-3


def test_no_admissible_candidate_overcomes_a_load_sooner(found):
    errors = [m.load_error for m in found if m.admissible]
    assert len(errors) > 5
    assert errors[0] == pytest.approx(min(errors), abs=1e-3)


def test_the_constraints_decide(found):
    """Without them more bandwidth would be taken: the limit of robustness is active."""
    quickest = min(found, key=lambda m: m.load_error)
    assert not quickest.admissible
    assert quickest.bandwidth > found[0].bandwidth


@pytest.mark.parametrize("mass", [200.0, 40_000.0])
def test_another_vehicle_is_tuned_to_the_same(mass):
    """The grid is in bandwidth and damping: with forces that scale, so does everything."""
    share = mass / MODEL.mass
    model = LongitudinalModel(mass, MODEL.friction * share)
    base = TunedPidParameters(force_limit=8000.0 * share, force_rate_limit=1000.0 * share)
    same, other = merits(TunedPidParameters(), MODEL), merits(base, model)
    assert (other.rise_time, other.settling_time) == (same.rise_time, same.settling_time)
    assert other.sensitivity == pytest.approx(same.sensitivity)
    assert other.overshoot == pytest.approx(same.overshoot, abs=1e-9)


def test_the_sensitivity_of_a_lone_gain():
    """Without integrator, friction and delay S = (z - 1)/(z - 1 + k): 2/(2 - k) at z = -1."""
    model = LongitudinalModel(friction=0.0)
    tiny = TunedPidParameters(bandwidth=1e-4, damping=5.0 / (2.0 * 1e-4))
    k = 5.0 * model.time_step
    expected = 2.0 / (2.0 - k)
    assert sensitivity(tiny, model, model.mass, delay=0) == pytest.approx(expected, rel=1e-4)


def test_an_unstable_loop_has_no_sensitivity():
    wild = TunedPidParameters(bandwidth=50.0)
    assert sensitivity(wild, MODEL, MODEL.mass) == math.inf


def test_times_of_a_first_order_step():
    t = np.arange(0.0, 20.0, 0.001)
    speed = 4.0 * (1.0 - np.exp(-t))
    assert rise_time(speed, 4.0, 0.001) == pytest.approx(math.log(9.0), abs=0.002)
    assert settling_time(speed, 4.0, 4.0, 0.001) == pytest.approx(math.log(50.0), abs=0.002)
    assert rise_time(speed[:100], 4.0, 0.001) == math.inf


def test_admissible_candidates_stand_first(found):
    worse = replace(found[0], load_error=1.0)
    broken = replace(found[0], load_error=0.0, overshoot=0.5)
    assert ranked([broken, worse, found[0]]) == [found[0], worse, broken]
    assert table([worse, broken]).splitlines()[-1].endswith("  -")
