"""FMUs that fail on the road: the vehicle says which, where and when, and can go on afterwards.

Each is the shipped FMU with one line of its C source replaced, compiled for this platform.
"""

from __future__ import annotations

import importlib.util
import shutil
import zipfile

import fmpy
import pytest

from fmus import (
    FmuOutputError,
    FmuPlatformError,
    FmuStartError,
    FmuStateError,
    FmuStepError,
    VehicleFmu,
)
from fmus.archive.packing import write_archive
from fmus.profile.bundled import MODEL
from fmus.sources.compiler import TARGETS, compile_library
from fmus.sources.fmu_files import FRONT_ENDS, SOURCE

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("ziglang") is None,
    reason="ziglang is not installed: pip install giveway[build]",
)
H = 0.05  # [s]
HERE = next(target for target in TARGETS if target.folder == fmpy.platform_tuple)


@pytest.fixture
def operate(fmu, fmi_version, tmp_path):
    """The shipped FMU after replacing a piece of a C source by another."""

    def operation(file, old, new):
        folder, path = tmp_path / "source", tmp_path / "operated.fmu"
        shutil.copytree(SOURCE, folder)
        with zipfile.ZipFile(fmu) as archive:
            members = {
                name: archive.read(name)
                for name in archive.namelist()
                if not name.startswith("binaries/")
            }
        (folder / "token.h").write_bytes(members["sources/token.h"])
        text = (folder / file).read_text(encoding="utf-8")
        assert text.count(old) == 1
        (folder / file).write_text(text.replace(old, new), encoding="utf-8")
        sources = ("plant.c", "instance.c", FRONT_ENDS[fmi_version])
        library = compile_library(folder, sources, HERE, MODEL)
        members[f"binaries/{HERE.folder}/{MODEL}{HERE.suffix}"] = library
        write_archive(path, members)
        return path

    return operation


def test_an_output_that_is_no_number_is_named_with_its_time(operate):
    path = operate(
        "instance.c",
        "    self->now.state = next;",
        "    self->now.state = next; if (time > 0.12) self->now.state.speed = NAN;",
    )
    with VehicleFmu(path, step_size=H) as vehicle:
        vehicle.start(speed=1.0)
        for _ in range(3):
            vehicle.step(0.0)
        with pytest.raises(FmuOutputError, match=r"operated\.fmu: speed = nan at 0\.2 s; "):
            vehicle.step(0.0)
        with pytest.raises(FmuStateError, match=r"failed at 0\.2 s"):
            vehicle.step(0.0)
        vehicle.start(speed=1.0)
        vehicle.step(0.0)
        assert (vehicle.time, vehicle.position) == (H, H)


@pytest.mark.parametrize("quantity", ["position", "speed"])
def test_a_motion_that_no_car_has_is_named_with_its_time(operate, quantity):
    path = operate(
        "instance.c",
        "    self->now.state = next;",
        f"    self->now.state = next; if (time > 0.12) self->now.state.{quantity} = 1e300;",
    )
    with VehicleFmu(path, step_size=H) as vehicle:
        vehicle.start(speed=1.0)
        for _ in range(3):
            vehicle.step(0.0)
        with pytest.raises(FmuOutputError, match=rf"{quantity} = 1e\+300 m.* at 0\.2 s"):
            vehicle.step(0.0)


@pytest.mark.parametrize("status", ["DISCARD", "ERROR", "FATAL"])
def test_a_step_that_is_not_done_is_reported_with_the_fmus_own_words(operate, status):
    path = operate(
        "instance.c",
        "    self->now.state = next;",
        '    if (time > 0.09) { instance_error(self, "the %s broke, 100%% sure", "axle");'
        f" return STATUS_{status}; }}\n    self->now.state = next;",
    )
    with VehicleFmu(path, step_size=H) as vehicle:
        vehicle.start(speed=1.0)
        vehicle.step(0.0)
        vehicle.step(0.0)
        with pytest.raises(FmuStepError) as caught:
            vehicle.step(250.0)
    assert str(caught.value).startswith(
        f"{path}: no step from 0.1 s to 0.15 s under 250 N: the FMU returned '{status.lower()}', "
        "the axle broke, 100% sure"
    )


def test_a_warning_does_not_stop_the_vehicle(operate):
    path = operate("instance.c", "    self->now.time = time + dt;\n    return STATUS_OK;",
                   "    self->now.time = time + dt;\n    return STATUS_WARNING;")  # fmt: skip
    with VehicleFmu(path, step_size=H) as vehicle:
        vehicle.start(speed=1.0)
        vehicle.step(0.0)
        assert vehicle.position == H


def test_a_start_that_gives_no_number_is_refused(operate):
    path = operate("plant.c", ".acceleration = 0.0}", ".acceleration = 0.0 / p->s0}")
    with VehicleFmu(path, step_size=H) as vehicle:
        with pytest.raises(FmuOutputError, match=r"acceleration = -?nan at 0 s"):
            vehicle.start()
        vehicle.start(position=1.0)
        vehicle.step(0.0)


def test_an_fmu_that_cannot_be_instantiated_is_refused_without_a_word_of_its_own(operate):
    path = operate("instance.c", "    if (self->name == NULL) return false;", "    return false;")
    with (
        VehicleFmu(path, step_size=H) as vehicle,
        pytest.raises(FmuStartError, match="does not start"),
    ):
        vehicle.start()


def test_a_binary_without_the_standards_functions_is_refused(operate, fmi_version):
    name = f"fmi{fmi_version[0]}Terminate"
    path = operate(FRONT_ENDS[fmi_version], f"Status {name}(", f"Status not_{name}(")
    with pytest.raises(FmuPlatformError, match=f"no function {name}"):
        VehicleFmu(path, step_size=H)


def test_the_time_given_to_the_fmu_is_exact_too(operate):
    """An FMU that insists on k h to the last bit: a running sum fails it within a few steps."""
    path = operate(
        "instance.c",
        "    self->now.state = next;",
        "    self->now.state = next; self->now.state.acceleration = time;",
    )
    with VehicleFmu(path, step_size=H) as vehicle:
        vehicle.start(speed=1.0)
        for k in range(25_000):
            vehicle.step(0.0)
            assert vehicle.acceleration == k * H
