"""Large files are announced before the run."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from giveway.api.expected_size import size_note
from giveway.config.files.loading import as_layer, load
from giveway.cosimulation.preflight import CheckedRun, preflight
from giveway.errors import ResultsError

if TYPE_CHECKING:
    from pathlib import Path

HOUR = {"ego.none": True, "crowd.pedestrians": 1000, "crowd.walk": [0.0, 9000.0]}
FLOW = {"from": [0, 0, 4, 4], "to": [0, 5000], "rate": 3600.0}


def checked(settings: dict[str, Any], minutes: float = 60.0) -> CheckedRun:
    run = preflight(*load([as_layer(settings)]))
    config = run.config.model_copy(update={"time_limit": 60.0 * minutes})
    return replace(run, files=replace(run.files, end=None), config=config)


def test_an_hour_of_a_thousand_is_announced(tmp_path: Path) -> None:
    note = size_note(checked(HOUR), "csv", tmp_path)
    assert note.startswith("some 72 million rows of people: trajectories.csv of 5.9 GB, ")
    assert f"a journal of 3.5 GB in {tmp_path.parent}; --trajectories parquet has 1.3 GB" in note
    assert note.endswith("; --record-far-period 1 keeps one row in 20")


@pytest.mark.parametrize(
    ("settings", "minutes"),
    [
        (HOUR, 10.0),
        ({**HOUR, "record.far_period": 1.0}, 60.0),
        ({**HOUR, "ego.none": False}, 60.0),  # people far from an ego are recorded once a second
        ({**HOUR, "crowd.walk": [0.0, 30.0]}, 60.0),  # they leave after some 20 s
    ],
)
def test_smaller_tables_are_not(settings: dict[str, Any], minutes: float) -> None:
    assert size_note(checked(settings, minutes), "csv", None) == ""


def test_people_of_flows_count_while_they_walk() -> None:
    settings = {"ego.none": True, "crowd.pedestrians": 0, "crowd.flow": [FLOW]}
    assert "some 72 million rows" not in size_note(checked(settings), "csv", None)
    assert size_note(checked(settings), "csv", None).startswith("some 2")


def test_a_journal_that_does_not_fit_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("shutil.disk_usage", lambda _: type("Usage", (), {"free": 2e9}))
    with pytest.raises(ResultsError, match=r"needs 3\.5 GB, 2 GB are free .* set TMPDIR"):
        size_note(checked(HOUR), "parquet", tmp_path)
