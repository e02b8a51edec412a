"""A run that goes wrong on the way: what was computed is kept, SUMO is free again."""

from pathlib import Path

import pytest

import giveway
from giveway.errors import SumoError
from giveway.run_data.progress import Ending


def test_rows_up_to_a_failure_are_written(tmp_path: Path) -> None:
    # A watcher of the user's that fails stands for anything that fails on the way.
    def fail_at_one_second(progress: object) -> None:
        if progress.time > 1.0:  # type: ignore[attr-defined]
            raise SumoError("the disk under SUMO burns")

    with pytest.raises(SumoError, match="burns") as caught:
        giveway.run({}, results=tmp_path / "r", watcher=fail_at_one_second)
    assert caught.value.result is not None
    assert caught.value.result.ending is Ending.FAILED
    rows = (tmp_path / "r" / "ego.csv").read_text().splitlines()
    assert len(rows) == 1 + 22  # the header, and 0 ... 1.05 s


def test_a_watcher_that_fails_costs_no_rows(tmp_path: Path) -> None:
    def fail(progress: object) -> None:
        raise ZeroDivisionError("the user's own")

    with pytest.raises(ZeroDivisionError, match="own"):
        giveway.run({}, results=tmp_path / "r", watcher=fail)
    assert len((tmp_path / "r" / "ego.csv").read_text().splitlines()) == 2
