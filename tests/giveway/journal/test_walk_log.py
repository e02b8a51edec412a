"""Who counts: people who come within 30 m of an ego's way."""

import numpy as np

from giveway.journal.walk_log import REACH, WalkLog
from pedestrian_model import Crowd

IDS = ["near", "far", "comes"]


def crowd(*y: float) -> Crowd:
    places = [(5.0, each) for each in y]
    return Crowd.create(places, np.zeros((len(y), 2)), 1.0, [[(5.0, 100.0)]] * len(y))


def test_those_who_come_close_to_the_way_count_from_then_on():
    log = WalkLog(0.5)
    present = np.arange(3)
    log.note(0, IDS, present, crowd(0.0, 50.0, 50.0))
    assert log.near == frozenset()  # no ego has departed
    log.add_way(np.array([(0.0, 0.0), (10.0, 0.0)]))
    log.note(1, IDS, present, crowd(1.0, 51.0, REACH + 0.1))
    assert log.near == {"near"}
    log.note(2, IDS, present, crowd(2.0, 52.0, REACH - 0.1))
    assert log.near == {"near", "comes"}
    log.stop_looking()
    log.note(3, IDS, present, crowd(3.0, 0.0, 60.0))
    assert log.near == {"near", "comes"}
    track = log.track
    assert list(zip(track.step.tolist(), track.pedestrian.tolist(), strict=True)) == [
        (1, 0), (2, 0), (2, 2), (3, 0), (3, 2),
    ]  # fmt: skip
    np.testing.assert_allclose(track.walked[-2:], [3.0, (50 - 30.1) + 0.2 + (60 - 29.9)])
    assert log.awaits(np.array([2]))
    assert not log.awaits(np.array([1]))


def test_an_instant_is_noted_once():
    log = WalkLog(0.5, lambda _: True)
    for _ in range(2):
        log.note(0, IDS[:1], np.arange(1), crowd(0.0))
    assert len(log.track.step) == 1


def test_those_named_count_from_the_beginning():
    log = WalkLog(0.5, {"far"}.__contains__)
    log.note(0, IDS, np.arange(3), crowd(0.0, 500.0, 1.0))
    assert log.track.pedestrian.tolist() == [1]
    assert log.track.remaining.tolist() == [400.0]
