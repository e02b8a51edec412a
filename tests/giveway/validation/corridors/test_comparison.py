"""Speed per density and flow, of a recording whose speed, density and flow are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.recorded_corridor import DENSITY, FLOW, SPEED

from giveway.config import RunConfig
from giveway.errors import DatasetError
from giveway.recordings import dataset_of, read_recordings
from giveway.validation.behaviour.replaying import settled
from giveway.validation.corridors.comparison import Walked, compare_in_corridors, measured
from giveway.validation.corridors.geometry import corridor_of


def crowd(speed: float) -> RunConfig:
    values = {"desired_speed_mean": speed, "desired_speed_sd": 0.0}
    return RunConfig.model_validate({"crowd": {"model": "constant-velocity", **values}})


@pytest.fixture
def recordings(recorded_corridor):
    recorded_corridor("walk-200-200")
    folder, description = recorded_corridor("yard")
    return read_recordings(folder, dataset_of(str(description)))


def test_density_speed_and_flow_are_those_of_the_recording(recordings) -> None:
    here = settled(recordings[0])
    found = measured(corridor_of(here), here, here.frames)
    steady = found.density[10:-5]
    assert steady == pytest.approx(DENSITY, rel=0.02)
    assert found.speed == pytest.approx(SPEED, rel=1e-3)
    assert found.flow == pytest.approx([FLOW], rel=0.01)


def test_people_of_the_recorded_speed_are_within_the_bar(recordings) -> None:
    found = compare_in_corridors(recordings, crowd(SPEED), draws=2)
    assert (found.names, found.left_out, found.people) == (("walk-200-200",), 1, 60)
    assert found.free == pytest.approx([SPEED, SPEED])
    table = found.table.set_index("of")
    assert list(table.index) == ["0.5 to 1 /m^2", "walk-200-200"]
    assert table["recorded"].tolist() == pytest.approx([SPEED, FLOW], rel=0.01)
    assert table["difference"].tolist() == pytest.approx([0.0, 0.0], abs=0.01)
    assert table["within_bar"].all()


def test_slower_people_are_outside_of_the_bar(recordings) -> None:
    table = compare_in_corridors(recordings, crowd(0.8), draws=1).table
    speed, flow = table["difference"]
    assert np.isnan(speed)  # they are denser than any recorded second
    assert flow < -0.15
    assert not table["within_bar"].any()


def test_flow_counts_until_the_end_if_not_all_get_out(recordings) -> None:
    here = settled(recordings[0])
    people = here.people
    stuck = people.position.copy()
    stuck[people.track >= 30] = 0.5
    jam = replace(here, people=replace(people, position=stuck))
    whole = measured(corridor_of(here), jam, 1000).flow
    assert whole == pytest.approx([29 / (1000 / 16.0 - 12.0 / SPEED)], rel=0.02)


def test_a_bin_with_few_seconds_has_no_speed() -> None:
    found = Walked(np.array([0.1] * 5 + [0.7] * 4), np.arange(9.0), np.array([1.0]))
    assert found.speeds(2)[0] == 2.0
    assert np.isnan(found.speeds(2)[1])


def test_recordings_of_no_corridor_are_refused(recordings) -> None:
    with pytest.raises(DatasetError, match="none of 1 has a name of a corridor"):
        compare_in_corridors(recordings[1:], crowd(SPEED))


def test_vehicles_in_a_corridor_are_refused(recordings) -> None:
    here = replace(recordings[0], vehicles=recordings[0].people)
    with pytest.raises(DatasetError, match="60 vehicles; expected people alone in a corridor"):
        compare_in_corridors([here], crowd(SPEED))


def test_a_handful_of_people_is_refused(recordings) -> None:
    few = recordings[0].people.only(np.arange(60) < 6)
    with pytest.raises(DatasetError, match="6 people in corridors; expected at least 10"):
        compare_in_corridors([replace(recordings[0], people=few)], crowd(SPEED))
