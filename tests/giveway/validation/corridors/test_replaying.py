"""Replays in corridors: who enters when, how fast people want to walk, and what holds them."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.config import RunConfig
from giveway.recordings import dataset_of, read_recordings
from giveway.validation.behaviour.replaying import settled
from giveway.validation.corridors.geometry import corridor_of
from giveway.validation.corridors.replaying import free_speeds, replayed_in

MIXED = RunConfig.model_validate({"crowd": {"model": "vci", "preset": "MIXED"}})


@pytest.fixture
def walk(recorded_corridor):
    """Return the corridor of 2 m with an exit of 1.2 m, and its recording."""
    folder, description = recorded_corridor("walk-200-120")
    (recording,) = read_recordings(folder, dataset_of(str(description)))
    return corridor_of(recording), settled(recording)


def test_only_people_with_nobody_ahead_show_a_free_speed(walk) -> None:
    corridor, recording = walk
    found = free_speeds(corridor, recording)
    assert found[:2] == pytest.approx([1.25, 1.25])
    assert np.isnan(found[2:]).all()


def test_people_enter_as_recorded_and_pass_the_exit(walk) -> None:
    corridor, recording = walk
    people = replayed_in(corridor, recording, MIXED).people
    first = people.bounds[:-1]
    recorded = recording.people.frame[recording.people.bounds[:-1]]
    assert people.frame[first].tolist() == recorded.tolist()
    assert people.position[first] == pytest.approx(
        recording.people.position[recording.people.bounds[:-1]]
    )
    last = people.bounds[1:] - 1
    assert (corridor.along(people.position[last]) > 10.0).all()
    along, across = corridor.along(people.position), corridor.across(people.position)
    inside = (along > 0.0) & (along < 8.0)
    assert (across[inside] > 0.1).all()
    assert (across[inside] < 1.9).all()
    mouth = (along > 7.95) & (along < 8.15)
    assert (np.abs(across[mouth] - 1.0) < 0.6).all()


def test_another_draw_has_other_desired_speeds(walk) -> None:
    one, two = (replayed_in(*walk, MIXED, draw).people for draw in (0, 1))
    assert one.position.tobytes() != two.position.tobytes()
    assert one.position.tobytes() == replayed_in(*walk, MIXED).people.position.tobytes()
