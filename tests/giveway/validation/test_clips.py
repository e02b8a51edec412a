"""Reading the dataset: our frame, and one clear line for what cannot be used."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from giveway.errors import DatasetError
from giveway.validation import CITR, read_clip, read_clips, validate
from pedestrian_model import SIM

if TYPE_CHECKING:
    from pathlib import Path

HEAD = "id,frame,label,x_est,y_est,vx_est,vy_est\n"


def test_image_axes_are_mirrored_into_a_right_handed_frame(tmp_path: Path) -> None:
    """A walker going up the image walks towards +y; a cart turned to it turns counter-clockwise."""
    file = tmp_path / "a_01_traj_ped_filtered.csv"
    file.write_text(HEAD + "7,10,ped,3.0,-2.0,0.5,-1.0\n7,11,ped,3.0,-2.1,0.5,-1.0\n")
    beside = tmp_path / "a_01_traj_veh_filtered.csv"
    beside.write_text("id,frame,label,x_est,y_est,psi_est,vel_est\n1,11,veh,5.0,4.0,-0.5,2.0\n")
    clip = read_clip(file, CITR)
    assert (clip.name, clip.first_frame, clip.frames) == ("a_01", 10, 2)
    assert clip.ids.tolist() == [7]
    np.testing.assert_array_equal(clip.position[0, 0], [3.0, 2.0])
    np.testing.assert_array_equal(clip.velocity[0, 0], [0.5, 1.0])
    assert np.isnan(clip.poses[0]).all(), "the cart is not seen in the first frame"
    np.testing.assert_array_equal(clip.poses[1, 0], [5.0, -4.0, 0.5, 2.0])


def test_clips_are_found_in_any_folder_with_and_without_vehicles(
    tmp_path, write_clip, straight_walks
) -> None:
    x, v = straight_walks(60, [[0, 0], [0, 3]], [[1, 0], [1, 0]])
    write_clip(tmp_path / "trajectories_filtered" / "p2p_uni", "walk_01", x, v)
    cart = np.tile([9.0, 9.0, 0.0, 1.0], (60, 1))
    write_clip(tmp_path / "trajectories_filtered" / "vci_front", "drive_01", x, v, cart)
    clips = read_clips(tmp_path, CITR)
    assert [(c.name, c.poses.shape[1]) for c in clips] == [("walk_01", 0), ("drive_01", 1)]


def test_who_comes_late_or_leaves_early_is_not_seen_then(
    tmp_path, write_clip, straight_walks
) -> None:
    x, v = straight_walks(60, [[0, 0], [0, 3]], [[1, 0], [1, 0]])
    x[40:, 1] = np.nan
    clip = read_clip(write_clip(tmp_path, "walk_01", x, v), CITR)
    assert clip.seen.sum(axis=0).tolist() == [60, 40]
    np.testing.assert_allclose(clip.destination[1], x[39, 1])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "cannot be read as CSV"),
        (HEAD, "no rows"),
        (HEAD.replace(",vy_est", ""), "column 'vy_est' is missing"),
        (HEAD + "1,1,ped,0,0,0,nan\n", "line 2: vy_est = 'nan': expected a finite number"),
        (HEAD + "1,1,ped,0,0,0,0\n1,2,ped,0,,0,0\n", "line 3: y_est = ''"),
        (HEAD + "1,1.5,ped,0,0,0,0\n", "line 2: frame = '1.5': expected a whole number"),
        (HEAD + "1,1,ped,0,0,0,inf\n", "vy_est = 'inf'"),
        (HEAD + "1,1,ped,0,0,0,0\n1,1,ped,1,0,0,0\n", "line 3: id 1 is in frame 1 twice"),
        (HEAD + "1,1,ped,0,0,0,0\n1,900000000,ped,1,0,0,0\n", "expected at most 200000"),
        (HEAD + "1,1,ped,0,0,0,0,1,2,3\n2,\n3,1,2,3,4,5,6,7,8,9,9,9,9\n", "cannot be read as CSV"),
    ],
)
def test_a_broken_file_is_named_with_its_line(tmp_path: Path, text: str, said: str) -> None:
    file = tmp_path / "a_01_traj_ped_filtered.csv"
    file.write_text(text)
    with pytest.raises(DatasetError) as error:
        read_clips(tmp_path, CITR)
    assert str(file) in str(error.value)
    assert said in str(error.value)
    assert "\n" not in str(error.value)


def test_a_wrong_folder_says_what_was_expected(tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match="no such folder"):
        read_clips(tmp_path / "nowhere", CITR)
    with pytest.raises(DatasetError, match=r"no recording found; expected files \*_traj_ped"):
        read_clips(tmp_path, CITR)


def test_a_vehicle_without_pedestrians_is_refused(tmp_path, write_clip, straight_walks) -> None:
    x, v = straight_walks(60, [[0, 0]], [[1, 0]])
    cart = np.tile([9.0, 9.0, 0.0, 1.0], (60, 1))
    write_clip(tmp_path, "drive_01", x, v, cart).unlink()
    with pytest.raises(DatasetError, match="no pedestrians beside it"):
        read_clips(tmp_path, CITR)


def test_two_clips_of_one_name_are_refused(tmp_path, write_clip, straight_walks) -> None:
    x, v = straight_walks(60, [[0, 0]], [[1, 0]])
    write_clip(tmp_path / "a", "walk_01", x, v)
    write_clip(tmp_path / "b", "walk_01", x, v)
    with pytest.raises(DatasetError, match="a clip of this name is in"):
        read_clips(tmp_path, CITR)


def test_a_clip_too_short_says_how_long_it_must_be(tmp_path, write_clip, straight_walks) -> None:
    x, v = straight_walks(37, [[0, 0]], [[1, 0]])
    write_clip(tmp_path, "walk_01", x, v)
    with pytest.raises(DatasetError, match="has 37 frames: expected at least 38"):
        validate(read_clips(tmp_path, CITR), SIM)
    x, v = straight_walks(38, [[0, 0]], [[1, 0]])
    write_clip(tmp_path, "walk_01", x, v)
    assert len(validate(read_clips(tmp_path, CITR), SIM).cut) == 1
