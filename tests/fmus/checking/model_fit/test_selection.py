"""The structure that explains a vehicle is chosen, and no other."""

import numpy as np
import pytest

from fmus.checking.manoeuvres import Trace
from fmus.checking.model_fit.estimation import half_widths
from fmus.checking.model_fit.measurements import Measurements
from fmus.checking.model_fit.selection import identify_sides
from fmus.checking.model_fit.side_models import poverty, side_model
from fmus.checking.model_fit.side_response import SideResponse

STEP, MASS = 0.05, 1500.0
PHASES = (40, 30, 36, 30, 20)  # numbers of steps: roll, drive, roll, brake, roll


def driven(drive, brake, *, gap=None):
    """Traces of a car of 1,500 kg, 80 N.s/m and 150 N with these responses."""
    traces = []
    for force in (600.0, 3000.0, 6000.0, 12_000.0):
        for start in (6.0, 16.0):
            command = np.repeat([0.0, force, 0.0, -force, 0.0], PHASES)
            speed = np.full(command.size + 1, start)
            for _ in range(3):  # the power's limit depends on the speed
                mean = 0.5 * (speed[1:] + speed[:-1])[None]
                acting = drive.force(np.maximum(command, 0.0)[None], mean, STEP)[0]
                acting -= brake.force(np.maximum(-command, 0.0)[None], mean, STEP)[0]
                speed = np.full(command.size + 1, start)
                open_until = -1
                for k, force_now in enumerate(acting):
                    v = speed[k]
                    pull = 0.0 if k < open_until else force_now
                    z = 80.0 * STEP / MASS
                    speed[k + 1] = (v * (1.0 - z / 2) + STEP / MASS * (pull - 150.0)) / (1 + z / 2)
                    if gap and v < gap <= speed[k + 1] and force_now > 0.0:
                        open_until = k + 9
            zero = np.zeros(speed.size)
            end = int(np.argmax(speed < 0.5)) or speed.size - 1
            traces.append(
                Trace(STEP, command[:end], zero[: end + 1], speed[: end + 1], zero[: end + 1],
                      zero[:end], ())
            )  # fmt: skip
    return Measurements.of(traces)


@pytest.mark.parametrize(
    ("drive", "names"),
    [
        (SideResponse(), set()),
        (SideResponse(lag=0.3, delay=0.12), {"lag", "delay"}),
        (SideResponse(rate=4000.0), {"rate"}),
        (SideResponse(lag=0.4, limit=5000.0, power=50_000.0), {"lag", "limit", "power"}),
        (SideResponse(lag=0.024, second=0.0063), {"lag", "second"}),
    ],
)
def test_the_structure_that_made_the_drives_is_found(drive, names):
    found = identify_sides(driven(drive, SideResponse(lag=0.1)))
    assert set(found.names[0]) == names
    assert set(found.names[1]) == {"lag"}
    halves = half_widths(found)
    for side, response in enumerate((drive, SideResponse(lag=0.1))):
        assert abs(found.mass(side) - MASS) <= halves[side] < 0.01 * MASS
        for name in found.names[side]:
            exact = getattr(response, name)
            assert getattr(found.responses[side], name) == pytest.approx(exact, rel=0.02)
    assert poverty(found) == []


def test_gears_that_shift_are_no_limit():
    found = identify_sides(driven(SideResponse(lag=0.1), SideResponse(lag=0.1), gap=12.0))
    assert found.mass(0) == pytest.approx(MASS, rel=0.002)
    model = side_model(found, 0)
    assert model.lag + model.delay == pytest.approx(0.1, abs=0.01)
    assert model.limit is model.power_from is model.rate is None
    assert poverty(found) == []


def test_two_lags_are_a_lag_and_a_dead_time_without_the_sensors():
    found = identify_sides(driven(SideResponse(lag=0.9, second=0.14), SideResponse(lag=0.4)))
    drive, brake = side_model(found, 0), side_model(found, 1, 0.4)
    assert (drive.lag, drive.delay) == pytest.approx((0.7, 0.2), abs=0.02)
    assert brake.lag + brake.delay < 0.01


def test_what_follows_no_model_is_poor():
    measured = driven(SideResponse(lag=0.1), SideResponse(lag=0.1))
    noise = np.random.default_rng(2).normal(0.0, 5.0, measured.acceleration.size)
    strange = Measurements(measured.step, measured.commands, measured.speed, measured.used,
                           measured.acceleration + noise, measured.drive)  # fmt: skip
    assert any("follow" in reason for reason in poverty(identify_sides(strange, coarse=True)))
