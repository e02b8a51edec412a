"""Recorded people in the network of a run: places, times, speeds and destinations."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from giveway.config.tables.recorded import RecordedConfig
from giveway.errors import ConfigError
from giveway.recordings import CITR, read_recording
from giveway.recordings.placing import people_of_run, require_inside

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from giveway.recordings import Recording


def entry(**settings: Any) -> RecordedConfig:
    return RecordedConfig(name="yard", path="a", dataset="citr", **settings)


@pytest.fixture
def recording(tmp_path: Path, write_clip: Callable, straight_walks: Callable) -> Recording:
    """Two people: one along x at 1.2 m/s, one who hardly moves, for 91 frames, some 3 s."""
    walks = straight_walks(91, [(1, 2), (5, 5)], [(1.2, 0), (0, 0.01)])
    return read_recording(write_clip(tmp_path, "one", *walks), CITR)


def test_places_turn_about_the_origin_and_move(recording: Recording) -> None:
    first, _ = people_of_run(entry(x=10.0, y=-5.0, heading=90.0), recording, "yard.")
    assert first.name == "yard.1"
    assert first.position[0] == pytest.approx([10.0 - 2.0, -5.0 + 1.0])
    assert first.velocity[0] == pytest.approx([0.0, 1.2], abs=1e-9)
    assert first.destination == pytest.approx(first.position[-1])


def test_times_are_those_of_the_run(recording: Recording) -> None:
    first, _ = people_of_run(entry(begin=-1.0), recording, "")
    assert first.time[[0, -1]] == pytest.approx([-1.0, 90 / 29.97 - 1.0])


def test_speeds_and_destinations_are_as_recorded(recording: Recording) -> None:
    walker, stander = people_of_run(entry(walk_on=4.0), recording, "")
    assert walker.desired_speed == pytest.approx(1.2)
    assert walker.destination == pytest.approx(walker.position[-1] + [4.0, 0.0])
    assert stander.desired_speed == 0.5  # the slowest that the models know
    assert stander.destination == pytest.approx(stander.position[-1])


def test_ids_are_such_that_sumo_takes_them(recording: Recording) -> None:
    object.__setattr__(recording.people, "ids", ("a b", "a<b"))
    names = [person.name for person in people_of_run(entry(), recording, "yard.")]
    assert names == ["yard.a_b_0", "yard.a_b_1"]


def test_people_far_from_the_network_are_refused(recording: Recording) -> None:
    network = (-20.0, -35.0, 100.0, 0.0)
    for settings, said in (
        ({"x": 5000.0}, "x = 5000, y = 0: its people walk from 5001,2 to 5005,5 m, outside"),
        ({"begin": -60.0}, "begin = -60: nobody is left when the run starts"),
    ):
        wanted = entry(**settings)
        with pytest.raises(ConfigError) as error:
            require_inside(wanted, people_of_run(wanted, recording, ""), network)
        assert f"[[crowd.recorded]] 'yard': {said}" in str(error.value)
    require_inside(entry(), people_of_run(entry(), recording, ""), network)


def test_a_person_of_one_instant_is_left_out(recording: Recording) -> None:
    people = recording.people
    rows = np.arange(len(people.track)) <= people.rows(0).stop
    for name in ("track", "frame", "position", "velocity", "heading", "speed"):
        object.__setattr__(people, name, getattr(people, name)[rows])
    assert len(people_of_run(entry(), recording, "")) == 1
