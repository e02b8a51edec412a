"""The ego's time beside that of SUMO's own driver, up to the same place."""

from math import inf, isnan, nan

import numpy as np
import pytest

from giveway.metrics.baseline import summarise_baseline, times
from giveway.results.metric_conformance import made_up_drive
from giveway.run_data.tracks import EgoTrack
from giveway.sumo.plain_drive import PlainDrive, PlainDrives

EGO = made_up_drive().track
LENGTH = float(EGO.position[-1])


def plain(speed: float, length: float, *, arrived: bool = True, begin: float = 0.0) -> PlainDrive:
    """Return a drive along +x at a constant speed [m/s] up to one step before ``length`` [m]."""
    time = begin + np.arange(0.0, (length - 1e-9) / speed, 1.0)
    driven = speed * (time - begin)
    gap = np.full(len(time), inf)
    return PlainDrive(
        time, driven, 0.0 * driven, np.full(len(time), speed), driven, gap, arrived, nan, 1.0
    )


def to_goal(ego: EgoTrack, goal: float) -> float:
    return float(np.interp(goal, ego.position, ego.time) - ego.time[0])


def test_both_are_timed_up_to_the_goal() -> None:
    ego, sumo = times(EGO, LENGTH, plain(4.0, LENGTH))
    assert ego == pytest.approx(EGO.time[-1] - EGO.time[0])
    assert sumo == pytest.approx(LENGTH / 4.0, abs=1e-6)


def test_the_time_counts_up_to_a_goal_that_sumo_passes() -> None:
    ego, sumo = times(EGO, LENGTH, plain(4.0, LENGTH + 100.0))
    assert ego == pytest.approx(EGO.time[-1] - EGO.time[0])
    assert sumo == pytest.approx(LENGTH / 4.0, abs=1e-6)


def test_the_time_counts_up_to_where_sumo_ends_before_the_goal() -> None:
    ego, sumo = times(EGO, LENGTH, plain(2.0, LENGTH / 2.0))
    place = 2.0 * sumo
    assert sumo == pytest.approx((LENGTH / 2.0) // 2.0, abs=1.0)
    assert ego == pytest.approx(to_goal(EGO, place), abs=1e-6)


def test_nothing_is_compared_without_an_arrival() -> None:
    teleported = plain(4.0, LENGTH)._replace(teleported=7.0)
    for drive in (None, teleported, plain(4.0, LENGTH / 2.0, arrived=False)):
        assert all(map(isnan, times(EGO, LENGTH, drive)))


def test_an_ego_that_is_taken_over_late_is_timed_from_there() -> None:
    _, sumo = times(EGO, LENGTH, plain(4.0, LENGTH, begin=EGO.time[0] - 3.0))
    assert sumo == pytest.approx(LENGTH / 4.0 - 3.0, abs=1e-6)


def test_a_drive_of_one_row_has_no_ratio() -> None:
    at_once = plain(4.0, LENGTH)._replace(
        **{name: getattr(plain(4.0, LENGTH), name)[-1:] for name in PlainDrive._fields[:6]}
    )
    found = times(EGO, LENGTH, at_once._replace(time=EGO.time[:1]))
    assert found.sumo <= 0.0
    assert isnan(found.ratio)


def test_the_summary_has_both_drivers() -> None:
    found = summarise_baseline(EGO, LENGTH, PlainDrives(plain(4.0, LENGTH), None))
    assert found.sumo_time == pytest.approx(LENGTH / 4.0, abs=1e-6)
    own = EGO.time[-1] - EGO.time[0]
    assert found.time_over_sumo == pytest.approx(own / found.sumo_time)
    assert isnan(found.sumo_time_at_limit)
    assert isnan(found.time_over_sumo_at_limit)
