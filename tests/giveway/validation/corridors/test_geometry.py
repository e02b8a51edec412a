"""Corridors: their walls, the way through them, and what their descriptions must say."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.errors import ConfigError
from giveway.recordings import dataset_of, read_recordings
from giveway.validation.corridors.geometry import StraightCorridor, corridor_of

HERMES = StraightCorridor((0.0, 4.0), (0.0, -1.0), 8.0, 1.8, 1.2, 0.3)


def read(recorded_corridor, name, old="", new=""):
    folder, description = recorded_corridor(name)
    description.write_text(description.read_text().replace(old, new))
    found = {each.name: each for each in read_recordings(folder, dataset_of(str(description)))}
    return found[name]


def test_widths_are_in_the_name_in_the_unit_of_length(recorded_corridor) -> None:
    found = corridor_of(read(recorded_corridor, "walk-180-120"))
    assert found is not None
    assert (found.length, found.width, found.exit) == pytest.approx((8.0, 1.8, 1.2))
    assert found.exit_from == pytest.approx(0.3)
    assert corridor_of(read(recorded_corridor, "walk-180")) is None


def test_the_description_may_give_width_and_exit(recorded_corridor) -> None:
    sizes = "width = 2.0\nexit = 0.8\nexit_from = 0.1"
    found = corridor_of(read(recorded_corridor, "any", 'names = "walk-{width}-{exit}"', sizes))
    assert found is not None
    assert (found.width, found.exit, found.exit_from) == (2.0, 0.8, 0.1)


def test_a_corridor_without_width_is_refused(recorded_corridor) -> None:
    with pytest.raises(ConfigError, match=r"corridor.width is missing; give it, or \{width\}"):
        read(recorded_corridor, "walk-180-120", "walk-{width}", "walk-*")


def test_an_exit_wider_than_the_corridor_is_refused(recorded_corridor) -> None:
    recording = read(recorded_corridor, "walk-120-180")
    with pytest.raises(ConfigError, match=r"by 1\.2 m, exit from -0\.3 to 1\.5 m from the wall"):
        corridor_of(recording)


def test_along_and_across_are_measured_from_the_entrance() -> None:
    places = np.array([HERMES.place(3.0, 0.4), HERMES.place(-1.0, 2.0)])
    assert places == pytest.approx(np.array([[0.4, 1.0], [2.0, 5.0]]))
    assert HERMES.along(places) == pytest.approx([3.0, -1.0])
    assert HERMES.across(places) == pytest.approx([0.4, 2.0])


@pytest.mark.parametrize(
    ("along", "across", "distance", "normal"),
    [
        (3.0, 0.2, 0.2, (1, 0)),  # sides
        (3.0, 1.6, 0.2, (-1, 0)),
        (-0.2, -1.0, 0.2, (0, 1)),  # beside the entrance
        (-0.2, 3.0, 0.2, (0, 1)),
        (7.9, 0.15, 0.1, (0, 1)),  # before, in and behind the plates that hold the exit
        (8.1, 0.4, 0.1, (1, 0)),
        (8.1, 1.4, 0.1, (-1, 0)),
        (8.3, 0.1, 0.1, (0, -1)),
        (8.3, 1.7, 0.1, (0, -1)),
    ],
)
def test_people_are_on_the_walkable_side(along, across, distance, normal) -> None:
    walls = HERMES.surroundings().walls
    assert walls is not None
    found, away = walls.nearest([HERMES.place(along, across)])
    assert found == pytest.approx([distance])
    assert away[0] == pytest.approx(normal)


def test_the_way_leads_through_entrance_and_exit() -> None:
    places, passages = HERMES.route()
    assert places[:2] == pytest.approx(np.array([[0.9, 4.0], [0.9, -4.0]]))
    assert passages[:, 2] == pytest.approx([0.9, 0.6, 0.0])
    assert passages[:2, :2] == pytest.approx(np.array([[0.0, -1.0]] * 2))
