"""A run in which nobody drives: the baseline of the people."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

import giveway

NOBODY = {"ego.none": True, "time_limit": 25.0}


@pytest.fixture(scope="module")
def alone():
    measures = [
        {"name": "across", "line": [[20.0, 0.0], [36.0, 0.0]], "interval": 5},
        {"name": "middle", "area": [[22, -3], [34, -3], [34, 3], [22, 3]], "interval": 5},
    ]
    return giveway.run({"crowd.pedestrians": 12, "measure": measures, **NOBODY})


def test_everybody_is_recorded_at_every_instant(alone):
    rows = alone.trajectories
    assert rows.groupby("time")["id"].nunique().iloc[:200].eq(12).all()


def test_people_are_recorded_as_often_as_wanted():
    thinned = {"crowd.pedestrians": 3, "record.far_period": 0.5, **NOBODY, "time_limit": 2.0}
    rows = giveway.run(thinned).trajectories
    assert rows.groupby("time")["id"].nunique().to_dict() == dict.fromkeys((0, 0.5, 1, 1.5, 2), 3)


def test_measures_need_people_at_every_step():
    line = [{"name": "a", "line": [[20.0, 0.0], [36.0, 0.0]]}]
    with pytest.raises(giveway.GivewayError, match=r"far_period = 0\.5: .* at every control step"):
        giveway.run({"measure": line, "record.far_period": 0.5, **NOBODY})


def test_the_tables_tell_how_people_walked(alone):
    table = alone.pedestrians
    assert (table["peak_acceleration"] > 0.0).all()
    (row,) = alone.summary_table.to_dict("records")
    assert row["controller"] == ""
    assert row["pedestrians"] == 12
    assert row["mean_walking_speed"] == pytest.approx(table["mean_speed"].mean())
    assert row["mean_walk"] == pytest.approx(table["path_length"].mean())


def test_slow_time_is_that_of_the_trajectories(alone):
    rows = alone.trajectories.sort_values(["id", "time"])
    lasting = -rows.groupby("id")["time"].diff(-1)
    slow = lasting.where(rows["speed"] < 0.2, 0.0).groupby(rows["id"]).sum()
    told = alone.pedestrians.set_index("id")["slow_time"]
    pd.testing.assert_series_equal(told.sort_index(), slow.sort_index(), check_names=False)


def test_measures_agree_with_pedpy_on_the_exported_trajectories(alone):
    """What a user of PedPy would find in trajectories.csv."""
    import pedpy

    rows = alone.trajectories
    rows = rows.assign(frame=(rows["time"] / 0.05).round().astype(int))
    rows["id"] = rows["id"].str.removeprefix("ped").astype(int)
    data = pedpy.TrajectoryData(rows[["id", "frame", "x", "y"]], frame_rate=20.0)
    line = pedpy.MeasurementLine([(20.0, 0.0), (36.0, 0.0)])
    _, crossing = pedpy.compute_n_t(traj_data=data, measurement_line=line)
    area = pedpy.MeasurementArea([(22, -3), (34, -3), (34, 3), (22, 3)])
    density = pedpy.compute_classic_density(traj_data=data, measurement_area=area)["density"]
    ours = alone.measures
    across, middle = (ours[ours["measure"] == name] for name in ("across", "middle"))
    assert int(across["crossings"].sum()) == len(crossing) > 5
    looked_at = density.reindex(range(0, 500, 5))
    by_hand = np.nan_to_num(looked_at.to_numpy()).reshape(5, 20).mean(axis=1)
    assert middle["classic_density"].to_numpy() == pytest.approx(by_hand)
    assert by_hand.max() > 0.0


def test_a_two_sided_crowd_is_the_same_with_and_without_an_ego():
    settings = {"crowd.pedestrians": 10, "crowd.two_sided": True, "seed": 3, "time_limit": 0.1}
    driven, alone = giveway.run(settings), giveway.run(settings | NOBODY | {"time_limit": 0.1})
    places = [
        rows[(rows["type"] == "pedestrian") & (rows["time"] == 0.0)][["id", "x", "y"]]
        for rows in (driven.trajectories, alone.trajectories)
    ]
    pd.testing.assert_frame_equal(*(table.reset_index(drop=True) for table in places))


def test_a_zone_in_metres_is_round_the_path_an_ego_would_have():
    result = giveway.run({"scenario": "junction", **NOBODY, "crowd.zone": "15"})
    assert result.config.ego.route
    rows = result.trajectories
    people = rows[rows["type"] == "pedestrian"]
    assert len(people["id"].unique()) > 5
    assert people["y"].abs().max() < 15.0 + 5.0 + 3.0  # the way is along y = 0; margin, and a lane
    nowhere = giveway.run({"scenario": "junction", **NOBODY, "crowd.zone": "none"})
    assert not len(nowhere.crowd_track.ids)
