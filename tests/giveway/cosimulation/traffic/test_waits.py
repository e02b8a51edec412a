"""How long background vehicles wait inside a junction for people who stand there as well."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from controller.driving_constants import PATIENCE
from giveway.cosimulation.traffic.waits import Waits
from giveway.sumo.background import BackgroundVehicles
from pedestrian_model import Crowd

STEP = 0.5  # [s]
AHEAD = np.array([0])


def car(speed: float = 0.0) -> BackgroundVehicles:
    one = np.ones(1)
    return BackgroundVehicles(
        ("car",), ("car",), 0.0 * one, 0.0 * one, 0.0 * one, speed * one, 5 * one, one
    )


def on(lane: str) -> Any:
    return SimpleNamespace(whereabouts=lambda _: (lane, "", 1.0))


def people(*speeds: float) -> Crowd:
    rows = range(len(speeds))
    return Crowd.create(
        [(1.5 + row, 0.5) for row in rows],
        [(0.0, speed) for speed in speeds],
        1.4,
        [[(0.0, 9.0)] for _ in rows],
    )


def stuck(
    seconds: float, lane: str = ":j_1_0", crowd: Crowd | None = None, waits: Waits | None = None
) -> bool:
    """Return whether a car that has stood for ``seconds`` [s] is stuck."""
    waits = Waits(STEP) if waits is None else waits
    crowd = people(0.1, 0.0) if crowd is None else crowd
    found: Any = ()
    for _ in range(round(seconds / STEP)):
        found = waits.stuck(car(), AHEAD, crowd, on(lane))
    return "car" in found


def test_a_car_in_a_junction_is_stuck_after_the_wait() -> None:
    assert not stuck(PATIENCE)
    assert stuck(PATIENCE + STEP)


def test_a_car_at_its_line_waits_without_bound() -> None:
    assert not stuck(10 * PATIENCE, lane="street_0")


def test_a_car_waits_for_people_who_walk() -> None:
    assert not stuck(10 * PATIENCE, crowd=people(0.1, 1.2))
    far = people(0.1, *[0.0] * 5, 1.2)  # the one who walks is 7.5 m away
    assert stuck(PATIENCE + STEP, crowd=far)


def test_a_creeping_car_is_stuck_until_it_drives() -> None:
    waits = Waits(STEP)
    assert stuck(PATIENCE + STEP, waits=waits)
    assert waits.stuck(car(0.8), AHEAD, people(0.0), on(":j_1_0")) == {"car"}
    assert waits.stuck(car(2.0), AHEAD, people(0.0), on(":j_1_0")) == set()
    assert waits.stuck(car(0.0), AHEAD, people(0.0), on(":j_1_0")) == set()


def test_a_car_whose_way_was_free_begins_to_wait_anew() -> None:
    waits = Waits(STEP)
    assert stuck(PATIENCE + STEP, waits=waits)
    waits.stuck(car(), np.array([], dtype=int), people(0.0), on(":j_1_0"))
    assert not stuck(STEP, waits=waits)
