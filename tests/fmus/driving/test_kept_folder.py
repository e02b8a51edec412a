"""A process that makes many runs unpacks a shipped FMU once; only where it has said so."""

import os
import subprocess
import sys

SCRIPT = """
import os, sys, tempfile
from pathlib import Path
import fmus

def drive(path):
    with fmus.VehicleFmu(path, step_size=0.05) as a, fmus.VehicleFmu(path, step_size=0.05) as b:
        a.start(speed=1.0)
        b.start(speed=2.0)
        a.step(100.0)
        return a.position, a.speed, b.position, b.speed

place = Path(tempfile.gettempdir())
first = drive(fmus.bundled_fmu())
assert not list(place.iterdir())
fmus.keep_unpacked()
for version in ("2.0", "3.0"):
    for _ in range(3):
        assert drive(fmus.bundled_fmu(version)) == first
assert len(list(place.iterdir())) == 2
"""


def test_each_shipped_fmu_is_unpacked_once_for_all_vehicles(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT],
        env=os.environ | {"TMPDIR": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
