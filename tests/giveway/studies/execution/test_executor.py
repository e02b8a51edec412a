"""What executors have in common: numbers that cannot be used are refused."""

from __future__ import annotations

import pytest

from giveway.studies.execution import WorkerError, local_executor


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"jobs": 0}, "jobs = 0"),
        ({"jobs": 1, "hang_limit": 0.0}, "hang_limit = 0.0"),
        ({"jobs": 1, "run_limit": float("nan")}, "run_limit = nan"),
    ],
)
def test_numbers_that_cannot_be_used(options, named, refused):
    with refused(WorkerError, named, "expected"):
        local_executor(**options)
