"""FMUs for Co-Simulation that are set back to an earlier state, or need event mode."""

from __future__ import annotations

import pytest
from support.fmus.analytic import moved, saving

from fmus.fmi.status import ERROR

H = 0.05  # [s]


# ---- whether the state may be set back (noSetFMUStatePriorToCurrentPoint) ----


def steps_told(path):
    """Begin, length and what was told of each step."""
    lines = path.with_suffix(".calls").read_text().splitlines()
    return [tuple(map(float, line.split()[1:])) for line in lines if line.startswith("step ")]


@pytest.mark.parametrize("able", [True, False], ids=["saves", "does-not-save"])
@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_an_fmu_that_keeps_final_steps_only_moves_as_any_other(zoo, version, run, able):
    path = zoo.car(fmi=version, keeps_final_only=True, flags=saving(version, able))
    car = run(path, {"force": 700.0}, 100)
    assert list(car.outputs) == pytest.approx(moved(700.0, 5.0), rel=1e-12)


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_a_step_is_final_unless_an_earlier_state_may_be_restored(zoo, version, run):
    path = zoo.car(
        fmi=version, behaviour="discard_spoiled", at=0.05, calls=True, file=f"final{version[0]}"
    )
    car = run(path, {"force": 700.0}, 3)
    assert car.status <= 1
    quarter = H / 4
    whole, halved, *rest = (told for told in steps_told(path) if told[0] >= H)
    assert whole == pytest.approx((H, H, 1))
    assert halved == pytest.approx((H, H / 2, 1))
    for number, told in enumerate(rest[:4]):
        assert told == pytest.approx((H + number * quarter, quarter, float(number == 0)))
    assert rest[4] == pytest.approx((2 * H, H, 1))


def test_without_a_saved_state_what_is_left_of_a_step_is_final(zoo, run):
    path = zoo.car(
        fmi="2.0", behaviour="discard_once", flags=saving("2.0", False), calls=True, file="rest"
    )
    run(path, {"force": 700.0}, 6)
    told = steps_told(path)
    assert len(told) == 7
    assert all(final == 1 for _, _, final in told)


# ---- event mode (FMI 3) ----

WITH_EVENTS = {"hasEventMode": "true"}


@pytest.mark.parametrize("able", [True, False], ids=["saves", "does-not-save"])
def test_event_mode_is_tried_when_a_step_without_it_fails(zoo, run, able):
    path = zoo.car(
        fmi="3.0", needs_event_mode=True, flags=WITH_EVENTS | saving("3.0", able), calls=True,
        file=f"events{able}",
    )  # fmt: skip
    car = run(path, {"force": 700.0}, 100, values={"initial_speed": 5.0, "mass": 900.0})
    assert list(car.outputs) == pytest.approx(moved(700.0, 5.0, 5.0, mass=900.0), rel=1e-12)
    car.stop()
    calls = path.with_suffix(".calls").read_text().splitlines()
    assert calls.count("instantiate") == calls.count("free") == 2
    again = run(path, {"force": 700.0}, 1)
    again.stop()
    assert path.with_suffix(".calls").read_text().splitlines()[-1] == "free"


def test_what_fails_later_is_done_again_from_the_start(zoo, load, start):
    """Each step had its own input; with event mode the FMU gets the same ones."""
    path = zoo.car(fmi="3.0", behaviour="error_without_events", at=0.2, flags=WITH_EVENTS)
    same = zoo.car(fmi="3.0")
    ends = []
    for one in (path, same):
        car = start(load(one))
        for k in range(8):
            car.inputs[0] = 100.0 * k
            assert car.tick(k * H, H) <= 1
        ends.append(list(car.outputs))
        assert car.inputs[0] == 700.0
    assert ends[0] == ends[1]


def test_the_next_start_uses_event_mode_at_once(zoo, load, start):
    path = zoo.car(
        fmi="3.0", needs_event_mode=True, flags=WITH_EVENTS, calls=True, file="events_again"
    )
    car = start(load(path))
    assert car.tick(0.0, H) <= 1
    start(car)
    assert car.tick(0.0, H) <= 1
    assert path.with_suffix(".calls").read_text().splitlines().count("instantiate") == 3


@pytest.mark.parametrize("flags", [{}, WITH_EVENTS])
def test_an_error_that_event_mode_does_not_mend_stays(zoo, run, flags):
    car = run(zoo.car(fmi="3.0", behaviour="error", flags=flags), {"force": 700.0}, 10)
    assert car.status == ERROR
    assert "the axle broke" in car.messages.take()


def test_without_the_capability_event_mode_is_not_used(zoo, run):
    car = run(zoo.car(fmi="3.0", needs_event_mode=True), {"force": 700.0}, 1)
    assert car.status == ERROR
