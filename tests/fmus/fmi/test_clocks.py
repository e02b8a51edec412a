"""Input clocks of FMI 3: the car's force counts as its clock ticks."""

from __future__ import annotations

import pytest
from support.fmus.analytic import moved

from fmus import FmuError, FmuInterfaceError, FmuProfileError, FmuStartError

H = 0.05  # [s]
EVENTS = {"hasEventMode": "true"}
KINDS = ["co-simulation", "model-exchange"]


def clock(variability="constant", **times):
    names = {"interval": "intervalDecimal", "shift": "shiftDecimal"}
    return {"intervalVariability": variability} | {
        names.get(name, name): str(value) for name, value in times.items()
    }


@pytest.fixture
def drive(zoo, open_car):
    """Drive a car with 100 N more at each step; returns the times of the ticks and the speed."""

    def drive(count=8, *, fmu=None, flags=EVENTS, **options):
        key = " ".join(map(str, options.values())).translate(str.maketrans("/{}':", "-    "))
        path = zoo.car(fmi="3.0", flags=flags, calls=True, file=f"clock{key}"[:120], **options)
        told = path.with_suffix(".calls")
        told.unlink(missing_ok=True)
        car = open_car(path, fmu=fmu or {})
        car.start(speed=4.0)
        for k in range(count):
            car.step(100.0 * (k + 1))
        calls = told.read_text().splitlines()
        ticks = [float(line.split()[1]) for line in calls if line.startswith("tick ")]
        return ticks, car

    return drive


def after(parts):
    """The speed after forces [N] that are held for some times [s], from 4 m/s."""
    speed = 4.0
    for force, time in parts:
        _, speed = moved(force, time, speed)
    return speed


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("clocked", [True, False])
def test_a_periodic_clock_ticks_by_its_interval(drive, kind, clocked):
    ticks, car = drive(clock=clock(interval=0.1), kind=kind, clocked=clocked)
    assert ticks == pytest.approx([0.0, 0.1, 0.2, 0.3])
    held = [(100.0, 0.1), (300.0, 0.1), (500.0, 0.1), (700.0, 0.1)]
    assert car.speed == pytest.approx(after(held), rel=1e-5)
    assert not car.warnings


@pytest.mark.parametrize("kind", KINDS)
def test_a_clock_ticks_within_a_step_too(drive, kind):
    times = {"intervalCounter": 3, "shiftCounter": 2, "resolution": 100}  # 0.03 s, from 0.02 s on
    ticks, car = drive(2, clock=clock("fixed", **times), kind=kind)
    assert ticks == pytest.approx([0.02, 0.05, 0.08])
    assert car.speed == pytest.approx(after([(0.0, 0.02), (100.0, 0.03), (200.0, 0.05)]), rel=1e-5)


@pytest.mark.parametrize(
    ("variability", "expected"),
    [("calculated", [0.0, 0.1, 0.2, 0.3]), ("changing", [0.1, 0.2, 0.3]),
     ("countdown", [0.1, 0.2, 0.3])],
)  # fmt: skip
def test_an_interval_is_asked_of_the_fmu(drive, variability, expected):
    if variability == "countdown":  # each event sets the countdown anew: it never ends
        expected = []
    ticks, _car = drive(clock=clock(variability), interval=0.1)
    assert ticks == pytest.approx(expected)
    if variability == "countdown":
        assert drive(1, clock=clock(variability), interval=0.03)[0] == pytest.approx([0.03])


def test_the_profile_gives_a_clock_its_period(drive):
    ticks, _car = drive(clock=clock("triggered"), fmu={"clocks": {"tick": 0.2}})
    assert ticks == pytest.approx([0.0, 0.2])
    ticks, car = drive(clock=clock(interval=0.1), clocked=True, fmu={"clocks": {"tick": 0}})
    assert not ticks
    assert not car.warnings


def test_what_cannot_tick_is_refused_or_told_before_the_run(drive):
    for kind, flags, options, said in (
        (FmuInterfaceError, EVENTS, {"clock": clock("triggered")}, "'tick' is triggered by other"),
        (FmuInterfaceError, {}, {"clock": clock(interval=0.1)}, "needs event mode"),
        (FmuInterfaceError, EVENTS, {"clock": clock(interval=0.07), "constant_step": True},
         "between the FMU's steps of 0.05 s"),
        (FmuStartError, EVENTS, {"clock": clock(interval=0.1), "refuses_ticks": True},
         "fmi3SetClock returned 'error'"),
    ):  # fmt: skip
        with pytest.raises(kind, match=said):
            drive(0, flags=flags, clocked=True, **options)
        _, car = drive(2, flags=flags, **options)  # nothing belongs to the clock
        (warning,) = car.warnings
        assert "tick" in warning
    with pytest.raises(FmuProfileError, match="no input clock 'tock'; it has tick"):
        drive(clock=clock(interval=0.1), fmu={"clocks": {"tock": 0.1}})
    with pytest.raises(FmuError, match="intervalDecimal of Clock tick"):
        drive(clock=clock(interval=0.0))


def test_event_mode_is_used_where_no_other_instance_is_made(drive):
    _, car = drive(only_event_mode=True)
    _, plain = drive(flags={})
    assert car.speed == plain.speed
    with pytest.raises(FmuStartError, match="fmi3InstantiateCoSimulation returned no instance"):
        drive(only_event_mode=True, flags={})
