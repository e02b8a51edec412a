"""Speed per density and flow, of a recording whose speed, density and flow are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from support.recorded_corridor import DENSITY, FLOW, SPEED

from giveway.config import RunConfig
from giveway.errors import DatasetError
from giveway.recordings import dataset_of, read_recordings
from giveway.validation.behaviour.replaying import settled
from giveway.validation.corridors.comparison import InCorridors, compare_in_corridors, measured
from giveway.validation.corridors.geometry import corridor_of

STRAIGHT = RunConfig.model_validate({"crowd": {"model": "constant-velocity"}})


@pytest.fixture
def recordings(recorded_corridor):
    recorded_corridor("walk-200-200")
    folder, description = recorded_corridor("yard")
    return read_recordings(folder, dataset_of(str(description)))


def test_density_speed_and_flow_are_those_of_the_recording(recordings) -> None:
    here = settled(recordings[0])
    windows, flow = measured(corridor_of(here), here, here.frames)
    assert windows["density"].to_numpy()[10:-5] == pytest.approx(DENSITY, rel=0.02)
    assert windows["speed"].to_numpy() == pytest.approx(SPEED, rel=1e-3)
    assert flow == pytest.approx(FLOW, rel=0.01)


def test_people_of_the_recorded_speed_are_within_the_bar(recordings) -> None:
    found = compare_in_corridors(recordings, STRAIGHT, draws=2, speeds=(SPEED, 0.0))
    assert (found.read, len(found.free)) == (2, 60)
    assert found.free[~np.isnan(found.free)] == pytest.approx([SPEED, SPEED])
    table = found.table.set_index("of")
    assert list(table.index) == ["0.5 to 1 /m^2", "walk-200-200"]
    assert table["recorded"].tolist() == pytest.approx([SPEED, FLOW], rel=0.01)
    assert table["difference"].tolist() == pytest.approx([0.0, 0.0], abs=0.01)
    assert table["within_bar"].all()


def test_slower_people_are_outside_of_the_bar(recordings) -> None:
    table = compare_in_corridors(recordings, STRAIGHT, draws=1, speeds=(0.8, 0.0)).table
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
    _, flow = measured(corridor_of(here), jam, 1000)
    assert flow == pytest.approx(29 / (1000 / 16.0 - 12.0 / SPEED), rel=0.02)


def test_flow_is_unknown_if_nobody_gets_out(recordings) -> None:
    here = settled(recordings[0])
    stuck = replace(here.people, position=0.5 + 0.0 * here.people.position)
    assert np.isnan(measured(corridor_of(here), replace(here, people=stuck), 1000)[1])


def test_a_bin_with_few_seconds_has_no_speed() -> None:
    windows = pd.DataFrame({"density": [0.1] * 5 + [0.7] * 4, "speed": np.arange(9.0)})
    flows = pd.DataFrame({"recorded": [2.0], "simulated": [2.1]}, index=["one"])
    found = InCorridors(1, np.ones(12), windows.assign(who="recorded"), flows)
    assert found.speeds["recorded"].dropna().to_dict() == {0: 2.0}
    table = found.table
    assert table["of"].tolist() == ["0 to 0.5 /m^2", "one"]
    assert table["within_bar"].tolist() == [False, True]


@pytest.mark.parametrize("people", ["none", "few", "beside vehicles"])
def test_recordings_without_people_in_corridors_are_refused(recordings, people) -> None:
    corridor, yard = recordings
    few = corridor.people.only(np.arange(60) < 6)
    here, said = {
        "none": (yard, "0 people in 0 corridors"),
        "few": (replace(corridor, people=few), "6 people in 1 corridors"),
        "beside vehicles": (replace(corridor, vehicles=few), "0 people in 0 corridors"),
    }[people]
    with pytest.raises(DatasetError, match=f"{said} without vehicles, of 1 recordings; expected"):
        compare_in_corridors([here], STRAIGHT)
