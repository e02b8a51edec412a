"""Every broken FMU and wrong value is refused by one clear line that names it."""

from __future__ import annotations

import math
import re

import pytest

import fmus
from fmus import FmuError, VehicleFmu, describe
from fmus.profile.bundled import BUNDLED_PROFILE

H = 0.05  # [s]


def test_all_errors_have_one_root():
    errors = [getattr(fmus, name) for name in fmus.__all__ if name.endswith("Error")]
    assert len(errors) > 5
    assert all(issubclass(error, FmuError) for error in errors)


# ---- files ----


@pytest.mark.parametrize("use", [lambda path: VehicleFmu(path, step_size=H), describe])
class TestFiles:
    def test_missing(self, use, tmp_path, refused):
        path = tmp_path / "nowhere.fmu"
        with refused(fmus.FmuFileError, path, "no such file"):
            use(path)

    def test_a_folder(self, use, tmp_path, refused):
        with refused(fmus.FmuFileError, tmp_path):
            use(tmp_path)

    def test_not_a_zip_archive(self, use, tmp_path, refused):
        path = tmp_path / "text.fmu"
        path.write_text("I am no FMU\n")
        with refused(fmus.FmuFileError, path, "zip"):
            use(path)

    def test_truncated(self, use, fmu, tmp_path, refused):
        path = tmp_path / "half.fmu"
        path.write_bytes(fmu.read_bytes()[:50_000])
        with refused(fmus.FmuFileError, path, "zip"):
            use(path)

    def test_without_a_model_description(self, use, remake, refused):
        path = remake(keep=lambda name: name != "modelDescription.xml")
        with refused(fmus.FmuFileError, path, "modelDescription.xml"):
            use(path)

    def test_with_a_broken_model_description(self, use, remake, refused):
        path = remake(edit=lambda xml: xml[: len(xml) // 2])
        with refused(fmus.FmuFileError, path, "modelDescription.xml"):
            use(path)


def test_damaged_inside(fmu, tmp_path, refused):
    data = bytearray(fmu.read_bytes())
    first = data.index(b"\x7fELF")
    data[first + 4000 : first + 4016] = b"damaged bytes..."
    path = tmp_path / "damaged.fmu"
    path.write_bytes(data)
    with refused(fmus.FmuFileError, path), VehicleFmu(path, step_size=H):
        pass


# ---- interface and platform ----


def test_a_kind_that_the_binary_does_not_have(remake, refused):
    path = remake(edit=lambda xml: re.sub("(</?)CoSimulation", r"\1ModelExchange", xml))
    with (
        refused(FmuError, path),
        VehicleFmu(path, step_size=H, profile=BUNDLED_PROFILE) as vehicle,
    ):
        vehicle.start()


def test_a_kind_that_the_description_does_not_have(fmu, refused):
    values = BUNDLED_PROFILE.model_dump(exclude_none=True) | {"fmu": {"kind": "model-exchange"}}
    profile = fmus.make_profile(values, "test")
    with refused(fmus.FmuInterfaceError, fmu, "kind = 'model-exchange'", "has co-simulation only"):
        VehicleFmu(fmu, step_size=H, profile=profile)


def test_no_binary_for_this_platform(remake, refused):
    path = remake(keep=lambda name: not name.startswith("binaries/"))
    with refused(fmus.FmuPlatformError, path, "binar"):
        VehicleFmu(path, step_size=H)


def test_a_binary_that_cannot_be_loaded(remake, refused):
    path = remake(replace=lambda name: b"no library" if name.startswith("binaries/") else None)
    with refused(fmus.FmuPlatformError, path):
        VehicleFmu(path, step_size=H)


# ---- variables ----


@pytest.mark.parametrize(
    ("role", "name", "named"),
    [
        ("speed", "sped", ("sped", "did you mean", "speed")),
        ("force", "Force", ("Force", "did you mean", "force")),
        ("position", "where_it_is", ("where_it_is",)),
        ("force", "speed", ("speed", "output", "input")),
        ("speed", "force", ("force", "input", "output")),
        ("speed", "exact", ("exact",)),
    ],
)
def test_a_variable_that_cannot_play_its_part(fmu, role, name, named, refused):
    values = BUNDLED_PROFILE.model_dump(exclude_none=True)
    table = values["inputs" if role == "force" else "outputs"]
    table[role]["variable"] = name
    profile = fmus.make_profile(values, "test")
    with refused(fmus.FmuVariableError, fmu, f".{role}]", *named):
        VehicleFmu(fmu, step_size=H, profile=profile)


@pytest.mark.parametrize(
    ("values", "named"),
    [
        ({"alhpa": 90.0}, ("alhpa", "did you mean", "alpha")),
        ({"speed": 3.0}, ("speed",)),
        ({"M": math.nan}, ("M", "nan")),
        ({"exact": 2.5}, ("exact", "2.5")),
        ({"M": True}, ("M", "True")),
        ({"alpha": -1.0}, ("alpha = -1", "expected at least 0 N.s/m")),
    ],
)
def test_a_start_value_that_cannot_be_set(fmu, values, named, refused):
    with refused(fmus.FmuVariableError, fmu, *named):
        VehicleFmu(fmu, step_size=H, start_values=values)


@pytest.mark.parametrize("step_size", [0.0, -0.05, math.nan, math.inf])
def test_a_step_size_without_meaning(fmu, step_size, refused):
    with refused(FmuError, fmu, "step size", f"{step_size:g}"):
        VehicleFmu(fmu, step_size=step_size)


# ---- what the FMU itself refuses, in its own words ----


@pytest.mark.parametrize(
    ("values", "named"), [({"M": -5.0}, ("M = -5 kg",)), ({"M": 0.0}, ("M = 0 kg",))]
)
def test_start_values_that_the_fmu_refuses(fmu, values, named, refused):
    with VehicleFmu(fmu, step_size=H, start_values=values) as vehicle:
        with refused(fmus.FmuStartError, fmu, *named):
            vehicle.start()
        with refused(fmus.FmuStateError, fmu):
            vehicle.step(0.0)


@pytest.mark.parametrize("force", [math.nan, math.inf, -math.inf])
def test_a_force_that_is_no_number(fmu, force, refused):
    with VehicleFmu(fmu, step_size=H) as vehicle:
        vehicle.start(speed=1.0)
        vehicle.step(0.0)
        with refused(fmus.FmuStepError, fmu, f"{force:g}", "0.05 s"):
            vehicle.step(force)


def test_a_motion_out_of_the_range_of_numbers(fmu, refused):
    with VehicleFmu(fmu, step_size=H, start_values={"M": 1e-300, "reverse": True}) as vehicle:
        vehicle.start()
        with refused(FmuError, fmu, "0 s"):
            vehicle.step(1e300)
            vehicle.step(1e300)


def test_a_vehicle_that_failed_can_start_again(fmu):
    with VehicleFmu(fmu, step_size=H) as vehicle:
        vehicle.start(speed=1.0)
        with pytest.raises(FmuError):
            vehicle.step(math.nan)
        vehicle.start(speed=2.0)
        vehicle.step(0.0)
        assert vehicle.position == H * 2.0
