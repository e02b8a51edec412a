"""The crowd's step and what is noted of it: delays that can be worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.config import RunConfig
from giveway.cosimulation.counterfactual.crowd_alone import CrowdAlone
from giveway.crowd.roster import Roster, Walking
from giveway.journal.walk_log import WalkLog
from giveway.metrics import delays
from giveway.processes.heartbeat import Heartbeat
from pedestrian_model import OPEN_GROUND, SIM, Crowd, CrowdModel, Vehicles

STEP = 0.05  # [s]
LONGEST = 4000  # control steps


def walker(speed: float = 1.2) -> Roster:
    crowd = Crowd.create([(0.0, -20.0)], [(0.0, speed)], speed, [[(0.0, 20.0)]])
    return Roster(["somebody"], crowd)


def begin(roster: Roster, detour: bool = True) -> tuple[Walking, WalkLog]:
    log = WalkLog(STEP, lambda _: True)
    model = CrowdModel(SIM, STEP, detour=detour, creep=False)
    return Walking(RunConfig(), model, roster, log), log


def go_on(roster: Roster, walking: Walking, log: WalkLog, step: int = 0) -> None:
    alone = CrowdAlone(roster, walking, log, step)
    alone.go_on(LONGEST, frozenset({"somebody"}), Heartbeat(None))


def test_a_delay_behind_a_standing_car_is_as_worked_out_by_hand():
    """The car stands across the way for 40 s, and is gone.

    Unhindered the place where he waits is reached at t_there. From there he starts at 40 s, takes
    up his pace v_0 with at most a_max and then as m/k_des has it, and walks on as he would have.
    """
    speed, gone = 1.2, round(40.0 / STEP)
    car = Vehicles.create(0.0, 0.0, 0.0, 0.0, front=40.0, rear=40.0, width=2.0)
    roster = walker(speed)
    walking, log = begin(roster, detour=False)
    for step in range(gone):
        walking.note(step)
        walking.advance(step, car, OPEN_GROUND)
    (_, place), held = roster.crowd.position[0], roster.crowd.velocity[0]
    assert np.abs(held).max() < 0.2  # he stands: the model lets him sway by a centimetre
    go_on(roster, walking, log, gone)
    free = walker(speed)
    unhindered, of_twin = begin(free)
    go_on(free, unhindered, of_twin)

    pace_time, a_max = SIM.mass / SIM.destination_gain, SIM.max_acceleration
    limited = max(0.0, speed - a_max * pace_time)  # the speed up to which a_max holds
    lost = limited / a_max - limited**2 / (2 * a_max * speed)
    lost += (speed - limited) * pace_time / speed
    by_hand = 40.0 - (place + 20.0) / speed + lost
    found = delays(log.track, of_twin.track)
    assert found.basis.tolist() == ["arrival"]
    assert found.delay[0] == pytest.approx(by_hand, abs=STEP)
    assert found.detour[0] == pytest.approx(0.0, abs=0.1)


def test_a_crowd_that_goes_on_in_two_parts_is_the_same_as_in_one():
    whole, parts = walker(), walker()
    (walking, log), (again, other) = begin(whole), begin(parts)
    go_on(whole, walking, log)
    alone = CrowdAlone(parts, again, other)
    alone.go_on(100, frozenset({"somebody"}), Heartbeat(None))
    assert other.track.last == 100
    alone.go_on(LONGEST, frozenset({"somebody"}), Heartbeat(None))
    for name in ("step", "x", "y", "remaining", "walked", "arrival_step"):
        assert np.array_equal(getattr(log.track, name), getattr(other.track, name)), name


def test_who_does_not_count_is_not_waited_for():
    roster = walker()
    walking, log = begin(roster)
    CrowdAlone(roster, walking, log).go_on(LONGEST, frozenset({"nobody"}), Heartbeat(None))
    assert log.track.last == 0


def test_what_is_left_and_what_is_walked_make_the_way():
    roster = walker()
    walking, log = begin(roster)
    go_on(roster, walking, log)
    track = log.track
    np.testing.assert_allclose(track.remaining + track.walked, 40.0, atol=1e-9)
    assert track.arrival_pedestrian.tolist() == [0]
    assert track.arrival_step[0] * STEP == pytest.approx(39.5 / 1.2, abs=1.0)  # slower at the end


def test_a_track_can_be_cut():
    roster = walker()
    walking, log = begin(roster)
    go_on(roster, walking, log)
    cut = log.track.until(200)
    assert cut.last == cut.step[-1] == 200
    assert not len(cut.arrival_step)
    assert log.track.until(LONGEST).last == log.track.last
