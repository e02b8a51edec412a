"""People alone in periodic corridors: how fast they walk at a density, and whether lanes form.

The speeds are compared with those of Weidmann, "Transporttechnik der Fussgänger", Schriftenreihe
des IVT 90 (1993): v = v_0 (1 - exp(-gamma (1/D - 1/D_max))), with v_0 = 1.34 m/s,
gamma = 1.913 /m^2 and D_max = 5.4 /m^2. Lanes are measured by the order parameter of Rex & Löwen,
Phys. Rev. E 75, 051402 (2007): 1 if every strip has people of one direction only, near 0 if mixed.
"""

from typing import Final, NamedTuple

import numpy as np

from giveway.crowd.motion.sway import Sway
from giveway.geometry.kernel import Array
from pedestrian_model import Crowd, PedestrianModel, Surroundings, Vehicles, Walls

DENSITIES: Final = (0.5, 1.0, 1.5, 2.0)
"""Densities [/m^2] of the corridors."""
FREE_SPEEDS: Final = (1.34, 0.26)
"""Mean and standard deviation [m/s] of desired speeds, from Weidmann 1993."""
_SHARPNESS, _DENSEST = 1.913, 5.4  # gamma and D_max [/m^2] of Weidmann 1993
_LENGTH = 16.0  # Length [m] of a corridor's period: people see at most half of it
_WIDTH = 2.5  # Width [m] of a corridor
_APART = 40.0  # Distance [m] between corridors
_SETTLED = 0.5  # Share of the time after which speeds count
_STRIP = 0.5  # Width [m] of the strips of the order parameter
_NONE = Vehicles.empty()


class Walked(NamedTuple):
    """The result of a walk in the corridors.

    Attributes:
        speed: Mean speed (D,) [m/s] at each of ``DENSITIES``.
        lanes: Order parameter (D,) of lanes at the end, from 0 to 1.
    """

    speed: Array
    lanes: Array


def weidmann() -> Array:
    """Return the speed (D,) [m/s] at each of ``DENSITIES`` by Weidmann 1993."""
    gap = 1.0 / np.array(DENSITIES) - 1.0 / _DENSEST
    speed: Array = FREE_SPEEDS[0] * (1.0 - np.exp(-_SHARPNESS * gap))
    return speed


def walk(
    model: PedestrianModel, duration: float, *, both_ways: bool = False, seed: int = 0
) -> Walked:
    """Let people walk in periodic corridors, one for each density.

    Everybody has one image, a period ahead or behind, whom the others see.

    Args:
        model: Model that moves people; its time step is that of the corridors.
        duration: Time [s]; speeds count in its second half.
        both_ways: Whether every second person walks the other way.
        seed: Seed of places, desired speeds and sway.
    """
    random = np.random.default_rng(seed)
    place, corridor = _places(random)
    people = len(place)
    pace = random.normal(*FREE_SPEEDS, people).clip(0.5, 2.2)
    for number in range(len(DENSITIES)):
        pace[corridor == number] += FREE_SPEEDS[0] - pace[corridor == number].mean()
    way = np.where(np.arange(people) % 2 == 1, -1.0, 1.0) if both_ways else np.ones(people)
    far = np.column_stack([1e5 * way, place[:, 1]])
    crowd = Crowd.create(
        np.concatenate([place, _images(place)]),
        np.tile(np.column_stack([pace * way, 0.0 * pace]), (2, 1)),
        np.tile(pace, 2),
        list(np.tile(far, (2, 1))[:, None]),
    )
    sway = Sway(model, seed) if model.parameters.sway else None
    twice = np.tile(np.arange(people), 2)
    steps = round(duration / model.time_step)
    ahead = np.zeros(people)
    walls = Surroundings(_walls())
    for step in range(steps):
        if sway is None:
            model.advance(crowd, _NONE, walls)
        else:
            sway.advance(crowd, _NONE, walls, twice, people)
        crowd.position[:people, 0] %= _LENGTH
        crowd.position[people:] = _images(crowd.position[:people])
        crowd.velocity[people:] = crowd.velocity[:people]
        if step >= _SETTLED * steps:
            ahead += crowd.velocity[:people, 0] * way
    speed = np.bincount(corridor, ahead) / np.bincount(corridor) / (steps * (1.0 - _SETTLED))
    return Walked(speed, _order(crowd.position[:people, 1], corridor, way))


def _places(random: np.random.Generator) -> tuple[Array, np.ndarray]:
    """Return a place (n, 2) [m] of each person, and the number (n,) of the corridor."""
    places, corridors = [], []
    for number, density in enumerate(DENSITIES):
        people = round(density * _LENGTH * _WIDTH)
        rows = max(1, round((people * _WIDTH / _LENGTH) ** 0.5))
        columns = -(-people // rows)
        x = (np.arange(columns) + 0.5) * _LENGTH / columns
        y = (np.arange(rows) + 0.5) * (_WIDTH - 0.6) / rows + 0.3 + number * _APART
        grid = np.array([(one, other) for one in x for other in y])
        places.append(grid[random.permutation(len(grid))[:people]])
        corridors.append(np.full(people, number))
    place = np.concatenate(places)
    return place + random.uniform(-0.05, 0.05, place.shape), np.concatenate(corridors)


def _images(place: Array) -> Array:
    """Return the image (n, 2) [m] of each person, in the nearer neighbouring period."""
    image: Array = place + np.where(place[:, :1] < 0.5 * _LENGTH, _LENGTH, -_LENGTH) * (1.0, 0.0)
    return image


def _walls() -> Walls:
    ends = -_LENGTH, 2.0 * _LENGTH
    sides = [number * _APART for number in range(len(DENSITIES))]
    low = [(ends[0], y, ends[1], y) for y in sides]
    high = [(ends[1], y + _WIDTH, ends[0], y + _WIDTH) for y in sides]
    return Walls.create(low + high)


def _order(y: Array, corridor: np.ndarray, way: Array) -> Array:
    """Return the order parameter (D,) of lanes in strips along each corridor."""
    strip = ((y - corridor * _APART) / _STRIP).astype(int) + 100 * corridor
    _, which, count = np.unique(strip, return_inverse=True, return_counts=True)
    order = (np.bincount(which, way) / count) ** 2
    found: Array = np.bincount(corridor, order[which]) / np.bincount(corridor)
    return found
