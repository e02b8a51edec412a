"""Pictures are the same for everybody: no user setting, no date, no display."""

from __future__ import annotations

import subprocess
import sys

import matplotlib as mpl
import pytest

from giveway.figures import save_figure, state_figure, top_view_figure
from giveway.geometry.bodies import VehicleShape


def draw(run, kind):
    ego, crowd = run(10, 2, "mpc")
    if kind == "state":
        return state_figure(ego, safe_distance=8.0, buffer_distance=10.0, title="t")
    return top_view_figure(ego, crowd, VehicleShape(), 0.27, title="t")


@pytest.mark.parametrize(
    ("kind", "suffix"),
    [
        ("state", ".png"),
        ("state", ".svg"),
        ("state", ".pdf"),
        ("top_view", ".png"),
        ("top_view", ".pdf"),
    ],
)
def test_the_same_run_gives_the_same_bytes(run, kind, suffix, tmp_path, monkeypatch):
    first, second = tmp_path / f"1{suffix}", tmp_path / f"2{suffix}"
    save_figure(draw(run, kind), first)
    with mpl.rc_context({"font.size": 20, "axes.facecolor": "red", "savefig.facecolor": "blue"}):
        save_figure(draw(run, kind), second)
    assert first.read_bytes() == second.read_bytes()
    assert not any(date in first.read_bytes() for date in (b"CreationDate", b"<dc:date>"))


def test_a_users_settings_are_left_alone(run):
    before = dict(mpl.rcParams)
    draw(run, "state")
    assert dict(mpl.rcParams) == before


def test_no_window_system_is_touched():
    code = "import sys, giveway.figures; print('matplotlib.pyplot' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


def test_a_folder_that_is_missing_is_an_os_error(run, tmp_path):
    with pytest.raises(OSError, match="missing"):
        save_figure(draw(run, "state"), tmp_path / "missing" / "state.png")
