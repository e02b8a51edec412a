"""What recorded people do near a car: known motions come out as they are, however smoothed."""

import importlib.util
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from giveway.recordings.dataset import CITR
from giveway.validation.clips import read_clips
from tests.support.clips import RATE

FILE = Path(__file__).parents[3] / "benchmarks" / "bounds" / "worst_motion.py"
SPEC = importlib.util.spec_from_file_location("worst_motion", FILE)
worst = importlib.util.module_from_spec(SPEC)
sys.modules["worst_motion"] = worst
SPEC.loader.exec_module(worst)

FRAMES = 120


@pytest.fixture
def clips(tmp_path, write_clip):
    """One person accelerates by 0.5 m/s^2 towards a cart that passes 3 m away, one far from it."""
    time = np.arange(FRAMES)[:, None] / RATE
    speed = np.array([[0.0, 0.5 * t] for t in time[:, 0]])
    near = np.array([0.0, -6.0]) + np.column_stack([0.0 * time[:, 0], 0.25 * time[:, 0] ** 2])
    far = near - (0.0, 40.0)
    cart = np.column_stack([-2.0 + time, 0.0 * time, 0.0 * time, np.ones(FRAMES)])
    position, velocity = np.stack([near, far], axis=1), np.stack([speed, speed], axis=1)
    write_clip(tmp_path, "made", position, velocity, cart)
    return read_clips(tmp_path, CITR)


@pytest.mark.parametrize("window", [0.0, 0.3, 0.5, 0.8])
def test_a_constant_acceleration_is_found_as_it_is(clips, window) -> None:
    found = list(worst.tracks(clips, window))
    assert [bool(track.near.any()) for track in found] == [True, False]
    near = found[0]
    assert near.acceleration[near.near] == pytest.approx(
        np.tile([0.0, 0.5], (near.near.sum(), 1)), abs=1e-6
    )
    assert np.einsum("ij,ij->i", near.towards, near.towards) == pytest.approx(1.0)
    assert (near.towards[:, 1] > 0.0).all()
    off = worst.departures(found, 0.5, 1.0 / RATE)
    assert len(off)
    assert off == pytest.approx(0.5, abs=1e-6)


def test_the_table_has_a_row_for_each_quantity_of_those_who_are_near(clips, capsys) -> None:
    measured = worst.quantities(clips, 0.5)
    worst.table({"MADE": measured, "AGAIN": measured})
    head, _, *rows = capsys.readouterr().out.splitlines()
    assert head.startswith("| | MADE 95 % |")
    assert head.count("AGAIN") == 4
    assert rows[0] == f"| acceleration [m/s²] |{' 0.50 |' * 8}"
    assert len(rows) == len(measured)


def test_a_data_set_in_which_nobody_is_near_is_one_line(clips) -> None:
    (clip,) = clips
    alone = replace(clip, poses=clip.poses[:, :0])
    with pytest.raises(SystemExit, match="CITR: nobody within 5 m of a moving vehicle"):
        worst.quantities((alone,), 0.5)


def test_needed_is_the_acceleration_less_what_the_margin_allows(clips) -> None:
    found = worst.needed(list(worst.tracks(clips, 0.5, 10.0)), 1.0 / RATE)
    # 2 s later, 1 m from the straight line; the margin of 5 cm is worth 0.025 m/s^2
    seen = found.acceleration > 0.47
    assert seen.sum() > 20
    assert found.acceleration[seen] == pytest.approx(0.475, abs=0.001)
    assert set(found.person.tolist()) == {0}
    assert (found.speed > 0.5).all()


def test_the_last_positions_give_a_velocity_that_is_late(clips) -> None:
    found = worst.needed(list(worst.tracks(clips, 0.0, 10.0)), 1.0 / RATE, late=True)
    # 7 frames: 0.117 s late, thus 0.117 m more within 2 s, and 0.05 m less by the margin
    assert np.median(found.acceleration) == pytest.approx(0.5334, abs=0.001)


def test_the_interval_of_a_quantile_is_that_of_its_clips() -> None:
    values, clip = np.repeat([1.0, 2.0, 3.0], 100), np.repeat([4, 5, 6], 100)
    assert worst.quantile(values, clip, 0.5) == (2.0, 1.0, 3.0)
    assert worst.quantile(values, np.zeros(300, dtype=int), 0.5) == (2.0, 2.0, 2.0)


def test_the_table_of_sites_says_who_keeps_to_the_bounds(clips, capsys) -> None:
    worst.sites(clips)
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(" | ")[1] for line in lines[2:]] == ["5", "10", "10", "10"]
    assert all(line.startswith("| CITR | ") for line in lines[2:])
    assert all(line.endswith(" | 100.0, 100.00 | 100.0, 100.00 |") for line in lines[2:])
