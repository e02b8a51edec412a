"""The recording that a configuration names, and what is said if there is none."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import pytest

from giveway.config.tables.recorded import RecordedConfig
from giveway.errors import ConfigError, DatasetError, GivewayError
from giveway.recordings.clips import clip_files, read_clip

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


def entry(path: Path, **settings: Any) -> RecordedConfig:
    return RecordedConfig(name="yard", path=str(path), **{"dataset": "citr", **settings})


@pytest.fixture
def folder(tmp_path: Path, write_clip: Callable, straight_walks: Callable) -> Path:
    """Two clips; the second has two people."""
    write_clip(tmp_path / "clips", "one", *straight_walks(40, [(0, 0)], [(1, 0)]))
    two = straight_walks(40, [(0, 0), (5, 5)], [(1, 0), (0, -1)])
    write_clip(tmp_path / "clips", "two", *two)
    return tmp_path / "clips"


def test_a_clip_is_found_by_its_name_or_by_its_file(folder: Path) -> None:
    by_name = read_clip(entry(folder, clip="two"))
    assert by_name.people.ids == ("1", "2")
    file = folder / "two_traj_ped_filtered.csv"
    assert read_clip(entry(file)) is by_name  # it is read once
    assert clip_files(entry(file)) == (file,)


def test_a_changed_file_is_read_again(folder: Path) -> None:
    wanted = entry(folder, clip="one")
    before = read_clip(wanted)
    file = folder / "one_traj_ped_filtered.csv"
    file.write_text(file.read_text().replace("\n1,", "\n7,"))
    os.utime(file, (1, 1))
    assert read_clip(wanted).people.ids == ("7",) != before.people.ids


def test_a_description_is_among_the_files(folder: Path, tmp_path: Path) -> None:
    own = tmp_path / "own.toml"
    own.write_text('name = "O"\nframe_rate = 5\n[vehicle]\nfront = 1\nrear = 1\nwidth = 1\n')
    wanted = entry(folder, clip="one", dataset=str(own))
    assert clip_files(wanted)[-1] == own
    assert read_clip(wanted).frame_rate == 5.0


@pytest.mark.parametrize(
    ("settings", "said", "kind"),
    [
        ({"clip": "three"}, "clip = 'three': not in ", ConfigError),
        ({}, "has 2 recordings; name one as clip: one, two", ConfigError),
        ({"dataset": "citrus"}, "dataset citrus: expected one of citr, ", ConfigError),
        ({"dataset": "ind"}, "no recording found; expected files *_tracks.csv", DatasetError),
        ({"dataset": "mine.toml"}, "dataset mine.toml: ", ConfigError),
    ],
)
def test_a_wrong_entry_is_named(
    folder: Path, settings: dict[str, str], said: str, kind: type[GivewayError]
) -> None:
    with pytest.raises(kind) as error:
        read_clip(entry(folder, **settings))
    assert str(error.value).startswith("[[crowd.recorded]] 'yard': ")
    assert said in str(error.value)
    assert "\n" not in str(error.value)


def test_a_missing_path_and_a_file_of_something_else_are_named(folder: Path) -> None:
    with pytest.raises(DatasetError, match="no such file or folder; expected a recording"):
        read_clip(entry(folder / "nowhere"))
    (folder / "notes.txt").write_text("")
    with pytest.raises(DatasetError, match=r"no file of tracks of CITR; expected \{name\}_traj"):
        read_clip(entry(folder / "notes.txt"))


def test_a_clip_without_people_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "empty_traj_veh_filtered.csv"
    file.write_text("id,frame,label,x_est,y_est,psi_est,vel_est\n1,1,veh,0,0,0,1\n")
    with pytest.raises(ConfigError, match="clip 'empty' of CITR has no people on foot"):
        read_clip(entry(file))


def test_a_broken_file_is_named(folder: Path) -> None:
    file = folder / "one_traj_ped_filtered.csv"
    file.write_text(file.read_text().replace("x_est", "easting"))
    with pytest.raises(DatasetError, match=r"'yard': .*column 'x_est' is missing"):
        read_clip(entry(folder, clip="one"))
