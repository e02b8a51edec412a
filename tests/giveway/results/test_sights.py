"""The table of who was in sight of an ego."""

import numpy as np
import pytest

from giveway.results.sights import perceived, sight_table
from giveway.run_data.tracks import SightTrack


def track(*rows: tuple[float, str, int, bool, float]) -> SightTrack:
    time, ego, pedestrian, seen, distance = zip(*rows, strict=True) if rows else ((),) * 5
    return SightTrack(
        np.array(time, dtype=np.float64),
        np.array(ego, dtype=np.str_),
        np.array(pedestrian, dtype=np.int64),
        np.array(seen, dtype=np.bool_),
        np.array(distance, dtype=np.float64),
    )


def test_a_row_is_a_stretch_of_time_in_sight() -> None:
    table = sight_table(
        track(
            (1.0, "ego", 0, True, 9.0),
            (1.5, "ego", 1, True, 20.0),
            (2.0, "ego", 0, False, np.nan),
            (3.0, "ego", 0, True, 4.0),
        ),
        ("anna", "bob"),
    )
    assert table["id"].tolist() == ["anna", "bob", "anna"]
    assert table["time"].tolist() == [1.0, 1.5, 3.0]
    assert table["until"].tolist() == pytest.approx([2.0, np.nan, np.nan], nan_ok=True)
    assert table["distance"].tolist() == [9.0, 20.0, 4.0]


def test_false_detections_have_names_of_their_own() -> None:
    changes = track(
        (1.0, "ego", -1, True, 9.0), (1.5, "ego", 0, True, 9.0), (2.0, "ego", -12, True, 1)
    )
    assert sight_table(changes, ("anna",))["id"].tolist() == ["false:1", "anna", "false:12"]
    assert perceived(changes, np.array([0, 0]), np.array([1.2, 1.6])).tolist() == [False, True]


def test_nobody_in_sight_is_a_table_without_rows() -> None:
    table = sight_table(track(), ())
    assert list(table) == ["ego", "id", "time", "until", "distance"]
    assert not len(table)


def test_a_person_is_perceived_while_a_stretch_in_sight_lasts() -> None:
    changes = track(
        (1.0, "ego", 0, True, 9.0),
        (1.5, "other", 0, True, 20.0),
        (1.5, "ego", 1, True, 20.0),
        (2.0, "ego", 0, False, np.nan),
        (2.5, "other", 0, False, np.nan),
    )
    time = np.array([0.95, 1.0, 2.0, 2.5, 1.4, 1.5, 9.0, 2.0])
    who = np.array([0, 0, 0, 0, 1, 1, 1, 2])
    seen = [False, True, True, False, False, True, True, False]
    assert perceived(changes, who, time).tolist() == seen
    assert not perceived(track(), who, time).any()
