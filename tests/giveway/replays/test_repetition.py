"""The repetition of a run for its predictions, and what its end by the user leaves."""

import os
import signal
import subprocess
import sys
import time

import pytest

import giveway

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")


def test_a_replay_that_sigterm_ends_leaves_no_journal(tmp_path):
    settings = {"crowd": {"pedestrians": 2}, "time_limit": 0.5}
    giveway.run(settings, results=tmp_path / "run", pictures=False)
    place = tmp_path / "temporary"
    place.mkdir()
    with subprocess.Popen(
        [sys.executable, "-m", "giveway", "replay", str(tmp_path / "run")],
        env=os.environ | {"TMPDIR": str(place)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    ) as replay:
        deadline = time.monotonic() + 60.0
        while not list(place.glob("giveway-journal-*/heartbeat")):
            assert time.monotonic() < deadline
            time.sleep(0.01)
        time.sleep(0.3)
        replay.send_signal(signal.SIGTERM)
        _, errors = replay.communicate(timeout=60)
    assert replay.returncode == 143
    assert errors.endswith("error: ended by SIGTERM\n")  # a slow start adds a note
    assert list(place.iterdir()) == []
    assert not (tmp_path / "run" / "replay.html").exists()
