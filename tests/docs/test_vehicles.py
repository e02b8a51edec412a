"""The profiles of docs/vehicles.md fit the cars that they describe, and drive them."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path

import pytest

from fmus import VehicleFmu, make_profile, open_vehicle, read_profile

PAGE = Path(__file__).parents[2] / "docs" / "vehicles.md"
SECTIONS = dict(re.findall(r"^### (.+?)\n(.*?)(?=^##)", PAGE.read_text("utf-8"), re.M | re.S))
H = 0.05  # [s]
PER_CENT = (0.01, 0.0)
CARS = {  # by the beginning of the section: the zoo's car, its M [kg] and alpha [N.s/m]
    "A force": (
        {
            "names": {"force": "F", "speed": "v"},
            "units": {"force": ("kN", 1e3, 0.0), "speed": ("km/h", 1 / 3.6, 0.0)},
            "outputs": ("speed",),
            "initial": (),
        },
        (1000.0, 100.0),
    ),
    "Drive and brake force": (
        {
            "role": "drive_brake",
            "names": {"drive_force": "F_drive", "brake_force": "F_brake", "initial_speed": "v0"},
        },
        (1000.0, 100.0),
    ),
    "An acceleration": (
        {
            "role": "acceleration",
            "names": {"wanted_acceleration": "a_ref", "speed": "v_x"},
            "initial": (),
        },
        (1400.0, 80.0),  # of the inverse map, which the car obeys
    ),
    "Throttle and brake": (
        {
            "role": "throttle_brake",
            "names": {"throttle": "accelerator", "brake": "brake_pedal"},
            "units": {"throttle": None, "brake": None},
            "spoken": {"throttle": PER_CENT, "brake": PER_CENT},
            "values": {"full_drive": 4000.0, "full_brake": 9000.0},
            "initial": (),
        },
        (1000.0, 100.0),
    ),
    "A speed set-point": (
        {
            "role": "speed_setpoint",
            "names": {"speed_setpoint": "v_set", "speed": "v"},
            "values": {"response": 0.8},
            "initial": (),
        },
        (1000.0, 100.0),
    ),
    "FMI 3 arrays": (
        {"fmi": "3.0", "array": True, "float32": True, "outputs": ("position", "speed")},
        (1000.0, 100.0),
    ),
}


def section(beginning):
    """The profile that stands under this heading."""
    text = next(text for title, text in SECTIONS.items() if title.startswith(beginning))
    return re.search(r"```toml\n(.*?)```", text, re.S)[1]


@pytest.mark.parametrize("beginning", CARS)
def test_a_worked_example_drives_its_car(zoo, tmp_path, beginning):
    options, (mass, friction) = CARS[beginning]
    file = tmp_path / "car.toml"
    file.write_text(section(beginning), "utf-8")
    with VehicleFmu(zoo.car(**options), step_size=H, profile=read_profile(file)) as car:
        car.start(speed=4.0)
        expected = car.speed
        assert expected == pytest.approx(4.0, abs=0.02)
        for force in [1500.0] * 20 + [-2000.0] * 20:
            car.step(force)
            expected += H / mass * (force - friction * expected)
        assert car.speed == pytest.approx(expected, abs=0.05)
        assert car.position > 5.0


def test_parts_that_are_zipped_as_shown_are_one_vehicle(zoo, tmp_path):
    """Powertrain and brakes are lags of 0.5 and 0.1 s: the zoo's car of so many kg, 1 N.s/m."""
    system = re.search(r"```xml\n(.*?)```", PAGE.read_text("utf-8"), re.S)[1]
    lags = {"powertrain": 0.5, "brakes": 0.1}
    parts = {
        name: zoo.car(
            names={"force": "demand", "speed": "output"},
            units={"speed": ("N", 1.0, 0.0)},
            outputs=("speed",),
            values={"mass": lag, "friction": 1.0},
            file=f"{name}_of_the_page",
        )
        for name, lag in lags.items()
    }
    parts["chassis"] = zoo.car(role="drive_brake", outputs=("speed",))
    with zipfile.ZipFile(tmp_path / "car.ssp", "w") as archive:
        archive.writestr("SystemStructure.ssd", system)
        for name, file in parts.items():
            archive.write(file, f"resources/{name}.fmu")
    roles = {
        "inputs": {
            "drive_force": {"variable": "powertrain.demand"},
            "brake_force": {"variable": "brakes.demand"},
        },
        "outputs": {"speed": {"variable": "chassis.speed"}},
    }
    profile = make_profile(roles, "test")
    with open_vehicle(tmp_path / "car.ssp", step_size=H, profile=profile) as car:
        car.start()
        for _ in range(60):
            car.step(2000.0)
        assert car.speed == pytest.approx(4.5, abs=0.3)
        for _ in range(20):
            car.step(-3000.0)
        assert car.speed < 2.5


def test_the_examples_are_all_there():
    assert sum(any(title.startswith(name) for name in CARS) for title in SECTIONS) == len(CARS)
