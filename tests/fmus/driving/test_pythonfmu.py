"""Cars written in Python and packed by PythonFMU (FMI 2.0) and PythonFMU3 (FMI 3.0).

Their binary starts Python code in the process that loads it; both tell that they need a tool, and
FMI 2.0's has no units.
"""

from __future__ import annotations

import importlib.util

import pytest

from fmus import FmuProfileError, VehicleFmu, open_vehicle
from fmus.description.reading import read_model
from fmus.errors import FmuStepError
from fmus.profile.vehicle_profile import make_profile

H = 0.05  # [s]
PACKERS = {"2.0": "pythonfmu", "3.0": "pythonfmu3"}
UNITS = {"2.0": {"force": "N", "speed": "m/s", "position": "m"}, "3.0": {}}


@pytest.fixture(params=PACKERS)
def version(request):
    if importlib.util.find_spec(PACKERS[request.param]) is None:
        pytest.skip(f"pip install {PACKERS[request.param]}")
    return request.param


def profile(version, **parameters):
    def axis(name):
        unit = UNITS[version].get(name)
        return {"variable": name} if unit is None else {"variable": name, "unit": unit}

    return make_profile(
        {
            "inputs": {"force": axis("force")},
            "outputs": {"speed": axis("speed"), "position": axis("position")},
            "initial": {"speed": {"variable": "v0", **({"unit": "m/s"} if UNITS[version] else {})}},
            "parameters": parameters,
        },
        "the test's profile",
    )


@pytest.mark.parametrize("isolated", [True, False])
def test_it_drives_as_its_python_says(zoo, version, isolated):
    parameters = {"mass": 500.0, "friction": 50.0}
    path = zoo.python_car(version)
    with open_vehicle(
        path, step_size=H, profile=profile(version, **parameters), isolated=isolated
    ) as vehicle:
        vehicle.start(speed=3.0)
        position, speed = 0.0, 3.0
        for k in range(60):
            force = 1000.0 if k < 20 else -800.0
            vehicle.step(force)
            position, speed = position + H * speed, speed + H * (force - 50.0 * speed) / 500.0
            assert vehicle.speed == pytest.approx(speed, rel=1e-12)
            assert vehicle.position == pytest.approx(position, rel=1e-12)


def test_two_of_them_at_once(zoo, version):
    path = zoo.python_car(version)
    made = profile(version)
    with (
        open_vehicle(path, step_size=H, profile=made) as one,
        open_vehicle(path, step_size=H, profile=made) as other,
    ):
        one.start(speed=1.0)
        other.start(speed=2.0)
        for _ in range(5):
            one.step(100.0)
            other.step(200.0)
        assert one.speed == pytest.approx(1.0, abs=1e-12)
        assert other.speed == pytest.approx(2.0, abs=1e-12)


def test_what_it_is(zoo, version):
    model = read_model(zoo.python_car(version))
    assert model.fmi_version == version
    assert model.generation_tool.startswith("PythonFMU")
    (interface,) = model.interfaces.values()
    assert interface.needs_execution_tool  # a tool to have, no reason to refuse it


def test_without_units_a_profile_has_to_say_them(zoo):
    if importlib.util.find_spec("pythonfmu") is None:
        pytest.skip("pip install pythonfmu")
    path = zoo.python_car("2.0")
    with pytest.raises(FmuProfileError, match="unit") as caught:
        VehicleFmu(path, step_size=H)
    assert str(caught.value).startswith(f"{path}: ")


def test_an_exception_in_its_python_is_a_failed_step(zoo):
    if importlib.util.find_spec("pythonfmu") is None:
        pytest.skip("pip install pythonfmu")
    path = zoo.python_car("2.0")
    made = profile("2.0", broken=True)
    with open_vehicle(path, step_size=H, profile=made) as vehicle:
        vehicle.start()
        for _ in range(4):
            vehicle.step(0.0)
        with pytest.raises(FmuStepError, match=r"0\.2 s to 0\.25 s") as caught:
            vehicle.step(0.0)
    assert "the gearbox is missing" in str(caught.value)
