"""A real tool's FMU: OpenModelica's Mass_Damper, which gemseo-fmu ships.

A mass of 1 kg on a spring of 10,000 N/m: no car, but a Co-Simulation whose explicit Euler diverges
at 50 ms (it swings at 100 rad/s) and still returns OK. That must not be reported as a success.
gemseo-fmu's own requirements clash with ours; its files are all that is needed:
``pip install --no-deps gemseo-fmu``.
"""

from __future__ import annotations

import importlib.util
import platform
from pathlib import Path

import pytest

from fmus import FmuOutputError, open_vehicle
from fmus.description.reading import read_model
from fmus.profile.vehicle_profile import make_profile

STEP = 0.05  # [s]


@pytest.fixture
def mass_damper() -> Path:
    spec = importlib.util.find_spec("gemseo_fmu")
    if spec is None or spec.origin is None:
        pytest.skip("pip install --no-deps gemseo-fmu")
    if (platform.system(), platform.machine()) != ("Linux", "x86_64"):
        pytest.skip("its FMUs are for Linux on x86_64")
    return Path(spec.origin).parent / "problems" / "fmu_files" / "linux" / "Mass_Damper.fmu"


def profile(**fmu):
    return make_profile(
        {
            "fmu": fmu,
            "inputs": {"force": {"variable": "f"}},
            "limits": {"acceleration": 1e4},  # a mass of 1 kg on a spring
            "outputs": {"speed": {"variable": "mass.v"}, "position": {"variable": "mass.s"}},
        },
        "the test's profile",
    )


def drive(vehicle, force=100.0, steps=20):
    """[(position, speed)] under a force [N]."""
    vehicle.start()
    track = []
    for _ in range(steps):
        vehicle.step(force)
        track.append((vehicle.position, vehicle.speed))
    return track


def test_it_can_be_read(mass_damper):
    model = read_model(mass_damper)
    assert model.generation_tool.startswith("OpenModelica")
    assert set(model.interfaces) == {"co-simulation", "model-exchange"}
    assert model.variables["mass.v"].unit == "m/s"


def test_its_co_simulation_diverges_and_is_caught(mass_damper):
    with (
        open_vehicle(mass_damper, step_size=STEP, profile=profile(kind="co-simulation")) as vehicle,
        pytest.raises(FmuOutputError, match=r"mass\.[vs] = .* at \d.* s") as caught,
    ):
        drive(vehicle)
    assert str(caught.value).startswith(f"{mass_damper}: ")


def test_its_model_exchange_is_integrated_rightly(mass_damper):
    """The spring gives way by F / c; what swings around that dies away by the damper."""
    ends = []
    for force in (0.0, 100.0):
        made = profile(kind="model-exchange", tolerance=1e-8)
        with open_vehicle(mass_damper, step_size=0.02, profile=made) as vehicle:
            ends.append(drive(vehicle, force, steps=250)[-1])
    (free, at_rest), (pushed, also_at_rest) = ends
    assert at_rest == pytest.approx(0.0, abs=1e-6)
    assert also_at_rest == pytest.approx(0.0, abs=1e-6)
    assert abs(pushed - free) == pytest.approx(100.0 / 10_000.0, rel=1e-5)
