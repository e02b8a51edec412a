"""The processes behind an isolated vehicle: they start anywhere, and none is ever left."""

from __future__ import annotations

import gc
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from fmus import FmuCrashError, FmuError, FmuProfileError, bundled_fmu
from fmus.isolation import IsolatedVehicle, process_host
from fmus.isolation.portable_host import PortableHost

STEP = 0.05  # [s]
SCRIPT = """
import sys
from fmus import IsolatedVehicle, bundled_fmu

vehicle = IsolatedVehicle(bundled_fmu(), step_size=0.05)
vehicle.start(speed=1.0)
vehicle.step(100.0)
print(vehicle.time, vehicle.position, flush=True)
{end}
"""


def run(code, folder):
    """Start a script that has no guard around its main part, in a folder of its own."""
    temporary = folder / "temporary"
    temporary.mkdir(exist_ok=True)
    (folder / "json.py").write_text("raise SystemExit('imported from the working folder')")
    script = folder / "scripts" / "drive.py"
    script.parent.mkdir(exist_ok=True)
    script.write_text(code)
    return subprocess.Popen(
        [sys.executable, str(script)],
        cwd=folder,
        env=os.environ | {"TMPDIR": str(temporary), "PYTHONPATH": os.pathsep.join(sys.path)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def drive_on(vehicle):
    for _ in range(100_000):
        vehicle.step(0.0)


def eventually(condition):
    end = time.monotonic() + 10.0
    while not condition() and time.monotonic() < end:
        time.sleep(0.01)
    return condition()


@pytest.mark.parametrize("end", ["vehicle.close()", "", "raise SystemExit(3)"])
def test_a_plain_script_leaves_nothing_however_it_ends(tmp_path, end):
    process = run(SCRIPT.format(end=end), tmp_path)
    said, complaint = process.communicate(timeout=180)
    assert said.split() == ["0.05", "0.05"]
    assert not complaint
    assert process.returncode == (3 if "raise" in end else 0)
    assert not list((tmp_path / "temporary").iterdir())


def test_nothing_outlives_a_process_that_is_killed(tmp_path):
    process = run(SCRIPT.format(end="import time; time.sleep(60)"), tmp_path)
    assert process.stdout.readline().startswith("0.05")
    (folder,) = (tmp_path / "temporary").iterdir()
    workers = [
        entry.parent
        for entry in Path("/proc").glob("[0-9]*/cmdline")
        if str(folder).encode() in entry.read_bytes()
    ]
    assert len(workers) == 2  # a watchdog and the FMU's
    process.kill()
    process.communicate(timeout=180)
    assert eventually(lambda: not folder.exists())
    assert eventually(lambda: not any(worker.exists() for worker in workers))


def test_a_vehicle_that_is_forgotten_is_closed(nothing_left):
    vehicle = IsolatedVehicle(bundled_fmu(), step_size=STEP)
    vehicle.start()
    assert list(nothing_left.iterdir())
    del vehicle
    gc.collect()
    assert not list(nothing_left.iterdir())


def test_a_fork_of_this_process_leaves_the_vehicle_alone(nothing_left):
    with IsolatedVehicle(bundled_fmu(), step_size=STEP) as vehicle:
        vehicle.start(speed=1.0)
        child = os.fork()
        if child == 0:
            vehicle.close()
            os._exit(0)
        os.waitpid(child, 0)
        vehicle.step(100.0)
        assert vehicle.time == STEP


def test_the_process_works_in_its_own_folder(isolated, nothing_left):
    vehicle = isolated(behaviour="litter", at=0.0)
    vehicle.start()
    vehicle.step(0.0)
    (litter,) = nothing_left.rglob("litter.txt")
    assert litter.parent.name == "scratch"
    assert not Path("litter.txt").exists()


def test_a_watchdog_that_was_killed_is_replaced(isolated, nothing_left):
    vehicle = isolated()
    vehicle.start()
    children = Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()
    os.kill(int(children[-1]), signal.SIGKILL)
    with pytest.raises(FmuCrashError, match="killed the process that watches over it"):
        drive_on(vehicle)
    vehicle.start()
    vehicle.step(0.0)


def test_without_an_interpreter_the_reason_is_said(monkeypatch):
    monkeypatch.setattr(sys, "executable", "/nowhere/python")
    with pytest.raises(FmuCrashError, match=r"no process of its own can be started.*/nowhere"):
        IsolatedVehicle(bundled_fmu(), step_size=STEP)


def test_what_is_wrong_with_a_profile_needs_no_process(zoo):
    path = zoo.car(names={"force": "x", "speed": "y"}, units={"force": None, "speed": None})
    with pytest.raises(FmuProfileError):
        IsolatedVehicle(path, step_size=STEP)


class TestWithoutAWatchdog:
    """As on other systems than Linux."""

    @pytest.fixture(autouse=True)
    def _portable(self, monkeypatch):
        monkeypatch.setattr(process_host, "LinuxHost", PortableHost)

    def test_it_drives(self, isolated):
        vehicle = isolated()
        for _ in range(2):
            vehicle.start(speed=1.0)
            vehicle.step(100.0)
            assert (vehicle.time, vehicle.speed) == (STEP, 1.0)

    @pytest.mark.parametrize(
        ("behaviour", "line"),
        [("last_words", "SIGABRT.*after printing"), ("exit_0", "exit"), ("hang", "no answer")],
    )
    def test_crashes_and_hangs_have_their_line(self, isolated, behaviour, line):
        vehicle = isolated(behaviour=behaviour, at=0.0, step_timeout=0.5)
        vehicle.start()
        with pytest.raises(FmuError, match=line):
            vehicle.step(0.0)
