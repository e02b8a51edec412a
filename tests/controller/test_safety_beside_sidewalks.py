"""People on sidewalks who want to be driven into, as suddenly as the layer assumes and no more so.

Towards the kerb they accelerate by a_k at most, along it and on the road as hard as anybody.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller import (
    LongitudinalModel,
    ParameterError,
    SafetyLayer,
    SafetyParameters,
)
from controller.safety.worst_motion import RECORDED

DT, R, HALF = 0.05, 0.27, 1.0
LOOKS = 5  # in between, at each step
WORST = RECORDED["recorded-99.9"]
EAST = np.array([[0.0, 0.0, 1.0, 0.0]])
PEOPLE = 4

relaxed = settings(max_examples=60)
seeds = st.integers(0, 2**32 - 1)


class Street:
    """East along y = 0, between kerbs that may come nearer to the way, or leave it.

    Args:
        kerb: [m] from the ego's side to the right kerb, at x = 0.
        angle: of the kerb's direction [rad].
    """

    def __init__(self, kerb, angle):
        self.to = np.array([-math.sin(angle), math.cos(angle)])  # from the sidewalk to the road
        self.at = np.array([0.0, -HALF - kerb])

    def depth(self, x):
        """(n,) [m] from places on the sidewalk to its kerb; negative on the road."""
        return (self.at - x) @ self.to

    def kerbs(self, x):
        depth = self.depth(x)
        on = depth > 0.0
        return np.column_stack([np.where(on[:, None], self.to, 0.0), np.where(on, depth, 0.0)])


def walk(x, v, a, limit):
    """One step of the crowd with its limits (pedestrian_model)."""
    size = np.maximum(np.hypot(*a.T), 1e-12)[:, None]
    after = v + DT * a * np.minimum(1.0, limit / size)
    fast = np.maximum(np.hypot(*after.T), 1e-12)[:, None]
    after *= np.minimum(1.0, WORST.speed / fast)
    return x + 0.5 * DT * (v + after), after


def set_out(street, x, a, hardest):
    """The accelerations of those on the sidewalk, cut to ``hardest`` towards the kerb."""
    towards = a @ street.to
    excess = np.where(street.depth(x) > 0.0, np.maximum(towards - hardest, 0.0), 0.0)
    return a - excess[:, None] * street.to


def drive(seed, *, hardest=WORST.setting_out, knows=True):
    """The reasons given while the ego drove; fails where its front got into somebody.

    ``hardest`` is the acceleration towards the kerb at most; ``knows``: the layer sees sidewalks.
    """
    rng = np.random.default_rng(seed)
    street = Street(rng.uniform(0.0, 1.5), rng.choice([0.0, rng.uniform(-0.2, 0.2)]))
    layer = SafetyLayer(LongitudinalModel(), SafetyParameters())
    back = rng.uniform(-0.2, 1.0, PEOPLE)
    x = street.at + np.outer(rng.uniform(2.0, 14.0, PEOPLE), (street.to[1], -street.to[0]))
    x -= back[:, None] * street.to
    pace, angle = rng.uniform(0.0, 1.6, PEOPLE), rng.choice([0.0, math.pi], PEOPLE)
    angle += rng.uniform(-0.3, 0.3, PEOPLE)
    v = np.column_stack([pace * np.cos(angle), pace * np.sin(angle)])
    mood = rng.integers(2, size=PEOPLE)
    travel, speed, reasons = 0.0, 0.0, []
    for _ in range(70):
        eager = rng.choice([8000.0, 8000.0, rng.uniform(-8000.0, 8000.0)])
        kerbs = street.kerbs(x) if knows else np.zeros((0, 3))
        way = np.array([[travel, 0.0, 1.0, 0.0]])
        safe = layer.filter(eager, speed, (way, 0.25), x, v, kerbs=kerbs)
        reasons.append(safe.reason)
        look = rng.choice([0.1, 0.3, 0.6])
        front = np.column_stack(
            [np.full(PEOPLE, travel + look * speed), np.clip(x[:, 1], -HALF, HALF)]
        )
        at_it = front - x - look * v
        waiting = (mood == 1) & (np.hypot(*at_it.T) > 3.0)
        a = np.where(waiting[:, None], -v, 10.0 * at_it)
        size = np.maximum(np.hypot(*a.T), 1e-12)[:, None]
        a *= np.minimum(1.0, WORST.acceleration / size)
        x_next, v_next = walk(x, v, set_out(street, x, a, hardest), WORST.acceleration)
        before, moving = travel, speed
        travel += speed * DT
        speed = max(0.0, speed + DT * (safe.force - 100.0 * speed) / 1000.0)
        if moving > 1e-9:
            assert not moved_into(before, travel, x, x_next, v), safe
        x, v = x_next, v_next
    return reasons


def moved_into(before, after, x, x_next, v):
    """Whether the front got into a body within the step, at any of some looks."""
    a = 2.0 * (x_next - x - DT * v) / DT**2
    for t in np.linspace(0.0, DT, LOOKS + 1):
        there = x + t * v + 0.5 * t**2 * a
        along = there[:, 0] - (before + (after - before) * t / DT)
        off = np.hypot(along, np.maximum(np.abs(there[:, 1]) - HALF, 0.0))
        if ((along >= 0.0) & (off < R)).any():
            return True
    return False


@relaxed
@given(seed=seeds)
def test_an_assumed_start_is_not_hit_and_a_stop_stays_possible(seed):
    assert "unavoidable" not in drive(seed)


def test_who_sets_out_more_suddenly_can_be_hit():
    """The bound is no formality: those who jump off the kerb reach the front."""

    def is_hit(seed):
        try:
            drive(seed, hardest=WORST.acceleration)
        except AssertionError:
            return True
        return False

    assert any(map(is_hit, range(300)))
    for seed in range(40):
        drive(seed, hardest=WORST.acceleration, knows=False)  # and without it nobody is


@relaxed
@given(
    seed=seeds,
    speed=st.floats(0.0, 14.0),
    force=st.floats(-8000.0, 8000.0),
)
def test_sidewalks_only_let_more_through(seed, speed, force):
    rng = np.random.default_rng(seed)
    x = np.column_stack([rng.uniform(0.0, 12.0, 3), rng.uniform(-4.0, 4.0, 3)])
    v = rng.uniform(-1.5, 1.5, (3, 2))
    kerbs = np.zeros((3, 3))
    kerbs[:, 1] = np.where(x[:, 1] < 0.0, 1.0, -1.0)
    kerbs[:, 2] = np.maximum(0.0, np.abs(x[:, 1]) - rng.uniform(1.0, 3.0))
    kerbs[kerbs[:, 2] == 0.0] = 0.0
    kept = SafetyLayer(LongitudinalModel(), SafetyParameters()).filter(
        force, speed, (EAST, 0.25), x, v
    )
    more = SafetyLayer(LongitudinalModel(), SafetyParameters()).filter(
        force, speed, (EAST, 0.25), x, v, kerbs=kerbs
    )
    assert more.force >= kept.force - 4.0
    assert more.acted <= kept.acted
    if not kerbs.any():
        assert more == kept


def test_a_walker_along_a_kerb_is_passed_at_thirty_km_per_hour():
    """0.5 m behind a kerb that is 0.75 m from the ego's side: a lane of 3.5 m."""
    x, v = np.array([[3.0, -2.25]]), np.array([[1.3, 0.0]])
    behind = np.array([[0.0, 1.0, 0.5]])

    def acts(kerbs, v=v):
        layer = SafetyLayer(LongitudinalModel(), SafetyParameters())
        return layer.filter(833.0, 8.33, (EAST, 0.25), x, v, kerbs=kerbs).acted

    assert acts(np.zeros((1, 3)))
    assert not acts(behind)
    assert acts(behind, np.array([[0.3, 1.2]]))  # who heads for the road is braked for


def test_a_bound_of_nothing_is_refused():
    with pytest.raises(ParameterError, match="setting_out"):
        SafetyParameters(setting_out=0.0)
