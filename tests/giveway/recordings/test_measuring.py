"""Measures of recorded drives, by hand."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.errors import DatasetError
from giveway.recordings import dataset_of, read_recordings
from giveway.recordings.measuring import SHARES, measure


def read(recorded_crossing):
    folder, description = recorded_crossing
    return read_recordings(folder, dataset_of(str(description)))


def test_a_straight_drive_past_standing_people_by_hand(recorded_crossing) -> None:
    found = measure(read(recorded_crossing))
    assert found.drives["vehicle"].tolist() == ["car"], "a parked car is no drive"
    drive = found.drives.iloc[0]
    assert drive["duration"] == pytest.approx(9.9)
    assert drive["mean_speed"] == pytest.approx(4.0)
    assert drive["standing"] == 0.0
    assert drive["rms_jerk"] == pytest.approx(0.0, abs=1e-6)
    assert (drive["near"], drive["close"], drive["tight"]) == (4, 2, 1)
    assert drive["near_moving"] == 4
    people = found.people.set_index("person")
    assert people.index.tolist() == ["a", "b", "c", "d"]
    np.testing.assert_allclose(people["clearance"][:3], [0.73, 0.33, 0.23], atol=1e-6)
    np.testing.assert_allclose(people["clearance_above_3"][:3], [0.73, 0.33, 0.23], atol=1e-6)
    assert people["time_to_collision"].isna().all()


def test_who_crosses_before_the_vehicle_is_first_by_a_positive_pet(recorded_crossing) -> None:
    """They leave the strip of 0.9 m + 0.27 m after 3.78 s; the front is there after 4.45 s."""
    person = measure(read(recorded_crossing)).people.set_index("person").loc["d"]
    assert person["first"] == "person"
    assert person["post_encroachment_time"] == pytest.approx(0.665, abs=0.01)


def test_shares_are_of_the_people_near_close_passes_first(recorded_crossing) -> None:
    shares = {share.name: share for share in measure(read(recorded_crossing)).shares}
    assert tuple(shares) == SHARES
    assert [share.count for share in shares.values()] == [2, 1, 0, 1, 1]
    assert shares[SHARES[0]].share == 0.5
    assert np.isnan(shares[SHARES[0]].low), "one vehicle has no interval"


def test_who_passes_a_standing_vehicle_is_not_near_a_moving_one(recorded_crossing) -> None:
    """The car comes to b and stands from 6.25 s on; c then walks up to it."""
    folder, _ = recorded_crossing
    for name, place in (
        ("cars", lambda row: ("car", min(float(row[2]), 5.0), 0.0)),
        ("people", lambda row: ("c", 8.0, 14.0 - 1.4 * int(row[1]) / 10.0)),
    ):
        file = folder / f"street_{name}.csv"
        head, *lines = file.read_text().splitlines()
        rows = [line.split(",") for line in lines]
        for row in rows:
            who, x, y = place(row)
            if row[0] == who:
                row[2:] = [f"{x:.6f}", f"{y:.6f}"]
        file.write_text("\n".join([head, *(",".join(row) for row in rows)]) + "\n")
    found = measure(read(recorded_crossing))
    c = found.people.set_index("person").loc["c"]
    assert c["clearance"] == pytest.approx(0.53, abs=1e-6)
    assert c["clearance_moving"] > 4.0
    assert (found.drives["near"][0], found.drives["near_moving"][0]) == (4, 3)
    close = found.shares[0]
    assert (close.count, close.share, close.share_moving) == (1, 1 / 4, 1 / 3)


def test_a_vehicle_that_is_not_there_is_named(recorded_crossing) -> None:
    recordings = read(recorded_crossing)
    assert len(measure(recordings, "car").drives) == 1
    with pytest.raises(DatasetError, match="--vehicle ca: no such id; did you mean 'car'"):
        measure(recordings, "ca")
    with pytest.raises(DatasetError, match="--vehicle parked: no drive; expected a"):
        measure(recordings, "parked")
