"""Every way to drive an FMU: the ego moves as the FMU's physics says, from start to goal.

The recorded force is played through the analytic solution of the zoo's car; each row of the ego's
record must follow from the one before it. The crowd makes it brake by all it has, and stand.
"""

from __future__ import annotations

from math import exp, log

import pandas as pd
import pytest

import giveway as library

H = 0.05  # [s]
M, ALPHA = 1000.0, 100.0  # [kg], [N.s/m] of the zoo's car
RESPONSE = 0.5  # [s] of its speed controller
KMH, KN, MPH = ("km/h", 1 / 3.6, 0.0), ("kN", 1000.0, 0.0), ("mph", 0.44704, 0.0)
KM, PER_CENT = ("km", 1000.0, 0.0), ("%", 0.01, 0.0)
SEED = 4  # the MPC brakes by all it has


def decay(speed: float, end: float, rate: float, time: float = H) -> tuple[float, float]:
    """Speed and distance after v' = rate (end - v) for some time."""
    after = end + (speed - end) * exp(-rate * time)
    return after, end * time + (speed - after) / rate


def by_force(speed: float, force: float) -> tuple[float, float]:
    """A standing car is not braked: a bare mass would be driven backwards."""
    return decay(speed, 0.0 if speed <= 0.0 > force else force / ALPHA, ALPHA / M)


def by_held_force(speed: float, force: float) -> tuple[float, float]:
    """The brake takes hold when the car comes to stand."""
    end, rate = force / ALPHA, ALPHA / M
    after, distance = decay(speed, end, rate)
    if after >= 0.0:
        return after, distance
    stop = log((speed - end) / -end) / rate
    return 0.0, decay(speed, end, rate, stop)[1]


def by_acceleration(speed: float, force: float) -> tuple[float, float]:
    """The inverse map asks for (u - alpha v) / M, and the car keeps it over the step."""
    rate = (force - ALPHA * speed) / M
    if speed <= 0.0 > rate:
        rate = 0.0
    return speed + rate * H, speed * H + rate * H * H / 2


def by_set_point(speed: float, force: float) -> tuple[float, float]:
    """The inverse map asks for v + lead (u - alpha v) / M; the car follows in first order."""
    wanted = max(speed + RESPONSE * (force - ALPHA * speed) / M, 0.0)
    return decay(speed, wanted, 1 / RESPONSE)


PHYSICS = {
    "force": by_force,
    "drive_brake": by_held_force,
    "throttle_brake": by_held_force,
    "acceleration": by_acceleration,
    "speed_setpoint": by_set_point,
}
PEDALS = {"role": "throttle_brake", "values": {"full_drive": 9000.0, "full_brake": 9000.0}}
CARS = {
    "force, FMI 1": {"role": "force", "fmi": "1.0"},
    "force, FMI 2 Model Exchange": {"role": "force", "kind": "model-exchange"},
    "force, FMI 3 Float32": {"role": "force", "fmi": "3.0", "float32": True},
    "force in kN, speed in km/h, position in km": {
        "role": "force",
        "units": {"force": KN, "speed": KMH, "initial_speed": KMH, "position": KM},
    },
    "force, speed in mph only": {
        "role": "force",
        "outputs": ("speed",),
        "units": {"speed": MPH, "initial_speed": MPH},
    },
    "drive and brake force, FMI 2": {"role": "drive_brake"},
    "drive and brake force, FMI 3 Model Exchange": {
        "role": "drive_brake",
        "fmi": "3.0",
        "kind": "model-exchange",
    },
    "acceleration, FMI 3": {"role": "acceleration", "fmi": "3.0"},
    "pedals, FMI 3": {**PEDALS, "fmi": "3.0"},
    "pedals in per cent, FMI 1": {
        **PEDALS,
        "fmi": "1.0",
        "units": {"throttle": PER_CENT, "brake": PER_CENT},
    },
    "set-point, FMI 2 Model Exchange": {"role": "speed_setpoint", "kind": "model-exchange"},
    "set-point in km/h, FMI 3": {
        "role": "speed_setpoint",
        "fmi": "3.0",
        "units": {"speed_setpoint": KMH, "speed": KMH},
    },
}


def require_physics(rows: pd.DataFrame, options: dict, tolerance: float) -> None:
    assert len(rows) > 200
    physics = PHYSICS[options["role"]]
    for now, after in zip(rows.itertuples(), rows[1:].itertuples(), strict=False):
        speed, distance = physics(now.speed, now.force)
        if "outputs" in options:  # without a position: the trapezoid of the speed
            distance = H * (now.speed + after.speed) / 2
        assert after.speed == pytest.approx(speed, rel=0, abs=tolerance), now
        moved = after.position - now.position
        assert moved == pytest.approx(distance, rel=0, abs=tolerance), now


@pytest.mark.parametrize("name", CARS)
def test_the_ego_moves_as_the_fmus_physics_says(zoo, own_temp, name):
    car = zoo.car(**CARS[name])
    vehicle = {"fmu": str(car), "profile": str(car.with_suffix(".toml")), "isolation": "none"}
    result = library.run(
        {"controller": "mpc-paper", "seed": SEED, "ego": {"initial_speed": 2.0}, "vehicle": vehicle}
    )
    assert result.ego["force"].min() == pytest.approx(-8000.0, abs=1e-3)
    tolerance = 1e-4 if "Exchange" in name else 1e-5 if "Float32" in name else 1e-9
    require_physics(result.ego, CARS[name], tolerance)
    assert not list(own_temp.iterdir())


def test_units_make_no_difference(zoo):
    """The same car in SI and in kN, km/h and km: the same run, but for rounding."""
    si, other = (
        library.run(
            {
                "seed": SEED,
                "time_limit": 6.0,
                "vehicle": {"fmu": str(car), "profile": str(car.with_suffix(".toml"))},
            }
        ).ego
        for car in (zoo.car(), zoo.car(**CARS["force in kN, speed in km/h, position in km"]))
    )
    assert len(si) == len(other)
    for column in ("speed", "position"):
        assert (si[column] - other[column]).abs().max() < 1e-6


@pytest.mark.parametrize("array", [True, "structural"])
def test_elements_of_arrays_play_the_parts(zoo, profiled, array):
    """An array has one unit at most: the profile says those of its elements."""
    car = zoo.car(role="force", fmi="3.0", array=array)
    profile = profiled(
        car,
        inputs={"force": {"unit": "N"}},
        outputs={
            "speed": {"unit": "m/s"},
            "position": {"unit": "m"},
            "acceleration": {"unit": "m/s2"},
        },
    )
    vehicle = {"fmu": str(car), "profile": str(profile)}
    result = library.run(
        {"controller": "mpc-paper", "seed": SEED, "ego": {"initial_speed": 2.0}, "vehicle": vehicle}
    )
    require_physics(result.ego, {"role": "force"}, 1e-9)


@pytest.mark.parametrize("role", PHYSICS)
def test_each_role_from_the_command_line(zoo, giveway, tmp_path, role):
    options = PEDALS if role == "throttle_brake" else {"role": role}
    car = zoo.car(**options)
    words = ["run", "shared_space", "--seed", SEED, "--ego-initial-speed", 2, "--out", "r"]
    words += ["--no-pictures", "--controller", "mpc-paper"]
    done = giveway(*words, "--vehicle", car, "--profile", car.with_suffix(".toml"))
    assert done.returncode == 0, done.stderr
    require_physics(pd.read_csv(tmp_path / "r" / "ego.csv"), options, 1e-5)


@pytest.mark.parametrize("fmi", ["2.0", "3.0"])
def test_names_and_units_without_doubt_need_no_profile(zoo, fmi):
    car = zoo.car(role="force", fmi=fmi, units={"speed": KMH, "initial_speed": KMH})
    result = library.run(
        {"seed": SEED, "ego": {"initial_speed": 2.0}, "vehicle": {"fmu": str(car)}}
    )
    require_physics(result.ego, {"role": "force"}, 1e-9)
