"""Measures of crowds whose density, speed and flow are known by hand."""

import numpy as np
import pytest
from support.steady_crowd import STEP, steady_crowd

from giveway.config.tables.measures import MeasureConfig, read_measures
from giveway.measures import measure_table
from giveway.run_data.tracks import CrowdTrack


def _measure(**settings: object) -> MeasureConfig:
    return read_measures([{"name": "here", **settings}])[0]


def test_flow_of_a_file_through_a_line() -> None:
    """One every 1.25 m at 1.25 m/s is one a second; the line is 2 m wide."""
    time = STEP * np.arange(401)
    starts = np.column_stack([0.6 - 1.25 * np.arange(40), np.zeros(40)])
    line = _measure(line=[[1.0, -1.0], [1.0, 1.0]], interval=10)
    table = measure_table([line], time, steady_crowd(starts, (1.25, 0.0), time))
    assert table["crossings"].to_list() == [10, 10]
    assert table["crossed"].to_list() == [10, 20]
    assert table["flow"].to_list() == pytest.approx([1.0, 1.0])
    assert table["specific_flow"].to_list() == pytest.approx([0.5, 0.5])
    assert table["speed"].to_list() == pytest.approx([1.25, 1.25])
    assert table["service_fruin"].to_list() == ["B", "B"]  # 30 persons per minute and metre
    assert table["service_hcm"].to_list() == ["C", "C"]


def test_density_of_a_standing_grid() -> None:
    """One person per 0.8 m by 0.8 m."""
    time = STEP * np.arange(41)
    along = 0.8 * np.arange(11)
    starts = np.array([(x, y) for x in along for y in along])
    area = _measure(area=[[2.0, 2.0], [6.0, 2.0], [6.0, 6.0], [2.0, 6.0]], interval=1)
    table = measure_table([area], time, steady_crowd(starts, (0.0, 0.0), time))
    assert len(table) == 2
    assert table["density"].to_list() == pytest.approx([1 / 0.64] * 2, rel=1e-6)
    assert table["peak_density"].to_list() == pytest.approx([1 / 0.64] * 2, rel=1e-6)
    assert table["classic_density"].to_list() == pytest.approx([25 / 16] * 2)  # x, y: 2.4 to 5.6
    assert table["people"].to_list() == pytest.approx([25.0] * 2)
    assert table["speed"].to_list() == pytest.approx([0.0] * 2)
    assert set(table["service_fruin"]) == {"E"}  # 0.64 m^2 each
    assert set(table["service_hcm"]) == {"F"}


def test_speed_in_an_area() -> None:
    time = STEP * np.arange(101)
    starts = np.array([(0.0, 0.0), (1.0, 2.0), (2.0, 1.0)])
    area = _measure(area=[[-1, -1], [9, -1], [9, 9], [-1, 9]])
    table = measure_table([area], time, steady_crowd(starts, (0.6, 0.8), time))
    assert table["speed"].to_list() == pytest.approx([1.0])
    assert table["classic_density"].to_list() == pytest.approx([0.03])


def test_nobody_is_a_density_of_zero() -> None:
    time = STEP * np.arange(21)
    nobody = CrowdTrack(*[np.empty(0, dtype=int)] * 2, *[np.empty(0)] * 4, ids=())
    measures = read_measures(
        [
            {"name": "line", "line": [[0, 0], [1, 0]]},
            {"name": "area", "area": [[0, 0], [1, 0], [1, 1]]},
        ]
    )
    table = measure_table(measures, time, nobody)
    assert table["flow"].to_list()[0] == 0.0
    assert table["density"].to_list()[1] == 0.0
    assert table["service_hcm"].to_list() == ["A", "A"]


def test_who_was_away_does_not_jump_over_the_line() -> None:
    """Recorded on both sides of the line, but out of our hands between."""
    time = STEP * np.arange(100)
    step = np.r_[0:20, 60:80]
    x = np.where(step < 50, 0.0, 5.0) + 0.01 * np.arange(40)
    zeros = np.zeros(40)
    crowd = CrowdTrack(step, np.zeros(40, dtype=int), x, zeros, zeros, zeros, ("ped0",))
    line = _measure(line=[[3.0, -1.0], [3.0, 1.0]])
    assert measure_table([line], time, crowd)["crossings"].to_list() == [0]
