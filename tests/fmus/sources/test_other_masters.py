"""Our vehicle and our controller in masters of another make, and together."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from fmpy import simulate_fmu

from fmus import VehicleFmu, bundled_fmu
from fmus.sources.export import bundled_controller
from fmus.sources.parameters import ControllerParameters

if TYPE_CHECKING:
    from collections.abc import Callable

    from controller import Observation, SpeedController

    Seen = Callable[..., Observation]

H = 0.05  # [s]
STANDING = 40.0  # [m] where somebody stands still
# Value references of the two FMUs in FMI 2
FORCE_IN, POSITION_OUT, SPEED_OUT, ALPHA, S0, V0, EXACT = 1, 2, 3, 6, 7, 8, 9
SPEED, POSITION, GAP, FORCE, D_SAFE = 1, 2, 3, 5, 14
OBSTACLES = list(range(100, 115))


@pytest.mark.parametrize("exact", [False, True])
def test_the_vehicle_in_libcosim_has_our_numbers(exact: bool, cosim: Callable[..., Any]) -> None:
    master = cosim(H)
    car = master.add(str(bundled_fmu("2.0")), "car")
    execution = master.execution
    assert execution.real_initial_value(car, S0, -7.0)
    assert execution.real_initial_value(car, V0, 6.0)
    assert execution.real_initial_value(car, ALPHA, 80.0)
    assert execution.boolean_initial_value(car, EXACT, exact)
    with VehicleFmu(
        bundled_fmu(), step_size=H, start_values={"alpha": 80.0, "exact": exact}
    ) as ours:
        ours.start(position=-7.0, speed=6.0)
        for force in np.random.default_rng(0).uniform(-4000, 3000, 400):
            theirs = master.step(car, [FORCE_IN], [force], [POSITION_OUT, SPEED_OUT, 4])
            ours.step(float(force))
            own = [ours.position, ours.speed, ours.acceleration]
            assert theirs == pytest.approx(own, abs=1e-9)


def test_libcosims_reader_has_no_findings_in_the_controller(
    cosim: Callable[..., Any], capfd: pytest.CaptureFixture[str]
) -> None:
    cosim(H).add(str(bundled_controller("2.0")), "controller")
    captured = capfd.readouterr()
    assert captured.out + captured.err == ""


def drive(
    decide: Callable[[float, float], float], steps: int, *, lag: bool = False
) -> list[tuple[float, float, float]]:
    """Positions, speeds and forces of the vehicle FMU under a feedback law."""
    rows: list[tuple[float, float, float]] = []
    with VehicleFmu(bundled_fmu(), step_size=H) as car:
        car.start(speed=4.0)
        for _ in range(steps):
            force = decide(car.position, car.speed)
            rows.append((car.position, car.speed, force))
            car.step(rows[max(len(rows) - 2, 0)][2] if lag else force)
    return rows


def test_controller_and_vehicle_in_fmpy_are_the_loop_without_lag(
    fmi_version: str,
    new_host: Callable[..., Any],
    regulator_of: Callable[[ControllerParameters], SpeedController],
    seen: Seen,
) -> None:
    host, regulator = new_host(fmi_version), regulator_of(ControllerParameters())
    steps = iter(range(1000))

    def by_fmu(position: float, speed: float) -> float:
        host.see(seen(position, speed, STANDING))
        force = host.get("force")
        host.step(next(steps) * H, H)
        return float(force)

    def by_regulator(position: float, speed: float) -> float:
        return regulator.control(seen(position, speed, STANDING)).force

    loop = drive(by_fmu, 400)
    assert np.abs(np.array(loop) - drive(by_regulator, 400)).max() < 1e-6
    position, speed, _ = loop[-1]
    assert speed < 1e-3
    assert STANDING - 8.3 < position <= STANDING - 8.0


def test_connected_in_libcosim_the_loop_lags_one_step(
    cosim: Callable[..., Any],
    regulator_of: Callable[[ControllerParameters], SpeedController],
    seen: Seen,
) -> None:
    # libcosim steps all FMUs, then passes their outputs on: the force that the vehicle gets is
    # that of the step before. This is the master's doing; the numbers are those of such a loop.
    master = cosim(H)
    car = master.add(str(bundled_fmu("2.0")), "car")
    controller = master.add(str(bundled_controller("2.0")), "controller")
    execution = master.execution
    assert execution.real_initial_value(car, V0, 4.0)
    assert execution.real_initial_value(controller, SPEED, 4.0)
    for reference in (GAP, *OBSTACLES):
        assert execution.real_initial_value(controller, reference, STANDING)
    for source, target in ((POSITION_OUT, POSITION), (SPEED_OUT, SPEED)):
        assert execution.connect_real_variables(car, source, controller, target) == 0
    assert execution.connect_real_variables(controller, FORCE, car, FORCE_IN) == 0

    regulator = regulator_of(ControllerParameters())
    gaps = [STANDING]  # the gap is no output of the vehicle: a host computes it

    def by_regulator(position: float, speed: float) -> float:
        now = seen(position, speed, STANDING).replaced(gap=gaps[-1])
        return regulator.control(now).force

    for position, speed, _ in drive(by_regulator, 200, lag=True)[1:]:
        assert execution.step()
        assert master.read(car, [POSITION_OUT, SPEED_OUT]) == pytest.approx(
            [position, speed], abs=1e-9
        )


def test_fmpys_own_simulation_reads_the_force_of_each_step(
    fmi_version: str,
    regulator_of: Callable[[ControllerParameters], SpeedController],
    seen: Seen,
) -> None:
    h = 0.0625  # a power of two: FMPy's grid of times is exact
    speeds = 4.0 + np.sin(np.arange(41))
    times = h * np.arange(41)
    rows = np.array(list(zip(times, speeds, strict=True)), dtype=[("time", "f8"), ("speed", "f8")])
    result = simulate_fmu(
        str(bundled_controller(fmi_version)),
        stop_time=40 * h,
        step_size=h,
        output_interval=h,
        input=rows,
        start_values={"dt": h},
        output=["force", "acting"],
    )
    regulator = regulator_of(ControllerParameters(time_step=h))
    own = [regulator.control(seen(speed=float(speed))).force for speed in speeds[:-1]]
    assert result["force"][1:] == pytest.approx(own, abs=1e-7)
    assert set(result["acting"][1:]) == {1}
