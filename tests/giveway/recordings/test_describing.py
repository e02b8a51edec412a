"""The description of recordings: counts, speeds, gaps and defects."""

from __future__ import annotations

import pytest

from giveway.recordings import dataset_of, read_recordings
from giveway.recordings.describing import describe


def test_people_vehicles_encounters_and_defects_are_counted(recorded_crossing) -> None:
    folder, description = recorded_crossing
    found = describe(read_recordings(folder, dataset_of(str(description))))
    row, total = (found.table.iloc[k] for k in range(2))
    assert (row["recording"], total["recording"]) == ("street", "total")
    assert (row["people"], row["moving"], row["parked"], row["encounters"]) == (5, 1, 1, 4)
    assert row["duration"] == pytest.approx(9.9)
    assert row["walking_speed"] == pytest.approx(0.0, abs=1e-9)
    assert row["walking_speed_95"] == pytest.approx(1.2)  # of four who stand, and one at 1.5 m/s
    assert row["smallest_gap"] == pytest.approx(-0.9 - 0.27)
    assert found.defects.values.tolist() == [
        ["street", "person in a vehicle", 1, "e is 1.17 m inside vehicle parked"]
    ]
    assert total.drop("recording").tolist() == row.drop("recording").tolist()
