"""Which background vehicles have to wait at their line for an ego."""

from types import SimpleNamespace
from typing import Any

import pytest

from giveway.cosimulation.traffic.priority import rooms_before
from giveway.ego.rules.gap_acceptance import MINOR_STRAIGHT, PERMITTED
from giveway.ego.rules.junctions import Approach, Gaps, PathJunction
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.conflict import Conflict
from giveway.sumo.network.junction_links import Movement

OWN, OTHER = 0, 1


def movement(number: int, state: str, yields_to: set[int], light: int) -> Movement:
    lanes = f"{number}_0", f"{number}_out_0"
    system = "tls" if light >= 0 else ""
    first = frozenset(yields_to)
    inside = (f":j_{number}_0",)
    return Movement("j", number, *lanes, inside, state, "s", 10.0, system, light, first, first)


def ego(
    front: float,
    speed: float,
    *,
    stop: float = float("inf"),
    lights: bool = False,
    its: tuple[int, ...] = (OWN,),
) -> Any:
    """One on a road with priority, its line at 50 m, ways that cross at 55 to 60 m."""
    own = movement(OWN, "M", set(), 0 if lights else -1)
    other = movement(OTHER, "m", set(its), 1 if lights else -1)
    where = {OTHER: Conflict(55.0, 60.0, 4.0, 8.0)}
    gaps = Gaps(MINOR_STRAIGHT, PERMITTED)
    place = PathJunction(50.0, 65.0, (), own, {OWN: own, OTHER: other}, where, frozenset(), gaps)
    return SimpleNamespace(
        id="ego",
        front=front,
        shape=VehicleShape(5.0, 2.0),
        vehicle=SimpleNamespace(speed=speed),
        rules=SimpleNamespace(junctions=(place,), stop=stop),
    )


def other(distance: float = 6.0, speed: float = 3.0, standing: float = 0.0) -> Approach:
    return Approach("car", OTHER, distance, speed, 4.5, standing)


def rooms(which: Any, *others: Approach, lights: str = "") -> dict[str, float]:
    return rooms_before(which, {"tls": lights}, {"j": others})


def test_who_would_meet_it_waits() -> None:
    assert rooms(ego(40.0, 8.0), other()) == {"car": 6.0}


def test_who_is_in_the_junction_waits_before_their_ways_cross() -> None:
    assert rooms(ego(40.0, 8.0), other(-1.0)) == {"car": 2.0}


@pytest.mark.parametrize(
    ("which", "car"),
    [
        (ego(-20.0, 8.0), other()),  # it is far away
        (ego(66.0, 8.0), other()),  # it has passed
        (ego(40.0, 8.0, stop=49.0), other()),  # it waits itself
        (ego(40.0, 8.0, its=()), other()),  # the car need not let it go first
        (ego(40.0, 8.0), other(2.0, 6.0)),  # the car cannot stop any more
        (ego(40.0, 8.0), other(-3.5)),  # the car is in its way already
        (ego(40.0, 8.0), other(-1.0, 5.0)),  # or cannot stop before it is
        (ego(52.0, 0.5, stop=54.0), other()),  # it waits itself, inside the junction
        (ego(40.0, 8.0), other(40.0, 3.0)),  # the car comes long after it
        (ego(5.0, 3.0), other(3.0, 6.0)),  # the car is away long before it
    ],
)
def test_who_would_not_goes_on(which: Any, car: Approach) -> None:
    assert rooms(which, car) == {}


@pytest.mark.parametrize(
    ("lights", "waits"), [("Gg", True), ("gg", True), ("rg", False), ("Gr", False), ("gG", False)]
)
def test_at_lights_the_letters_decide(lights: str, waits: bool) -> None:
    assert bool(rooms(ego(40.0, 8.0, lights=True), other(), lights=lights)) == waits


def test_a_vehicle_inside_goes_first_though_its_light_is_red() -> None:
    assert rooms(ego(52.0, 3.0, lights=True), other(), lights="rg") == {"car": 6.0}


@pytest.mark.parametrize(
    ("front", "speed", "standing", "waits"),
    [
        (52.0, 3.0, 1.0, True),
        (52.0, 3.0, 0.0, False),  # the car drives, and has priority
        (52.0, 0.0, 1.0, False),  # the ego stands: the car goes first
        (49.0, 0.7, 1.0, True),  # the ego drives off from its line
        (49.0, 0.0, 1.0, False),  # it waits there
        (47.0, 3.0, 1.0, False),  # it is still before its line
        (66.0, 3.0, 1.0, False),  # the ego has left
    ],
)
def test_who_stands_does_not_start_into_the_ego_s_way(
    front: float, speed: float, standing: float, waits: bool
) -> None:
    which = ego(front, speed, its=())  # the car need not let it go first
    assert bool(rooms(which, other(-1.0, 0.0, standing))) == waits
