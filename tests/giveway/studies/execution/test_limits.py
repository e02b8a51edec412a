"""Limits of a run: how long nothing may happen."""

import math

import pytest

from giveway.processes.heartbeat import LOOP, Phase
from giveway.studies.execution.executor import WorkerError
from giveway.studies.execution.limits import HANG_LIMIT, Limits


def test_without_a_limit_a_run_may_take_any_time() -> None:
    assert Limits.checked(HANG_LIMIT, None).run == math.inf


@pytest.mark.parametrize(("hang", "run"), [(0.0, None), (-1.0, None), (60.0, 0.0), (math.nan, 1.0)])
def test_a_limit_not_above_zero_is_refused(hang: float, run: float | None) -> None:
    with pytest.raises(WorkerError, match="expected seconds above 0"):
        Limits.checked(hang, run)


def test_before_the_loop_five_times_as_long_is_quiet() -> None:
    limits = Limits(hang=10.0)
    assert {limits.quiet(phase) for phase in LOOP} == {10.0}
    assert {limits.quiet(phase) for phase in set(Phase) - LOOP - {Phase.STARTING}} == {50.0}


def test_who_is_stopped_or_does_not_begin_is_quiet_once() -> None:
    limits = Limits(hang=10.0)
    assert {limits.quiet(phase, stopped=True) for phase in Phase} == {10.0}
    assert limits.quiet(Phase.STARTING) == 10.0
