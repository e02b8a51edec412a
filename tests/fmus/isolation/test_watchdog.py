"""FMUs that attack the watchdog: nothing of them is left nevertheless."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from fmus import FmuCrashError, bundled_fmu, processes_reused
from fmus.isolation import IsolatedVehicle
from fmus.isolation.cleanup import remove
from fmus.profile.bundled import BUNDLED_PROFILE
from fmus.sources.compiler import LINUX_X86

SOURCE = Path(__file__).parent / "escape.c"
BINARY = "binaries/linux64/LongitudinalVehicle.so"
pytestmark = pytest.mark.skipif(
    sys.platform != "linux" or importlib.util.find_spec("ziglang") is None,
    reason="what Linux allows; ziglang compiles it",
)


@pytest.fixture
def crash(tmp_path):
    """The error of a start of our FMU with a library that escapes in its own way."""

    def start(way, start_timeout):
        library = tmp_path / "escape.so"
        compiler = [sys.executable, "-m", "ziglang", "cc", "-target", LINUX_X86.zig]
        compiler += ["-shared", "-fPIC", "-O1"]
        subprocess.run([*compiler, f"-D{way}", "-o", library, SOURCE], check=True)
        path = tmp_path / "car.fmu"
        with zipfile.ZipFile(bundled_fmu()) as ours, zipfile.ZipFile(path, "w") as made:
            made.writestr("modelDescription.xml", ours.read("modelDescription.xml"))
            made.write(library, BINARY)
        fmu = BUNDLED_PROFILE.fmu.model_copy(update={"start_timeout": start_timeout})
        profile = BUNDLED_PROFILE.model_copy(update={"fmu": fmu})
        with IsolatedVehicle(path, step_size=0.05, profile=profile) as vehicle:
            with pytest.raises(FmuCrashError) as caught:
                vehicle.start()
            return str(caught.value)

    return start


def test_processes_that_no_watchdog_can_end_any_more(crash):
    assert "no answer within 1 s while it was loaded" in crash("ORPHANS", 1.0)


def test_such_processes_are_told_after_another_vehicle_as_well(crash):
    with processes_reused():
        with IsolatedVehicle(bundled_fmu(), step_size=0.05) as vehicle:
            vehicle.start()
        assert "no answer within 1 s while it was loaded" in crash("ORPHANS", 1.0)


def test_a_watchdog_that_was_stopped_goes_on(crash):
    assert "exit(3) was called while it was loaded" in crash("STOPS_THE_WATCHDOG", 60.0)


def test_who_asks_to_be_traced_dies_as_without(crash):
    assert "died of SIGUSR1 while it was loaded" in crash("TRACED", 60.0)


def test_folders_deeper_than_any_path(crash):
    assert "exit(5) was called" in crash("DEEP_FOLDERS", 60.0)


def test_a_link_in_a_folders_place_is_removed_and_not_followed(tmp_path):
    precious = tmp_path / "precious" / "file"
    precious.parent.mkdir()
    precious.touch()
    link = tmp_path / "link"
    link.symlink_to(precious.parent)
    remove(link)
    assert not link.is_symlink()
    assert precious.exists()
