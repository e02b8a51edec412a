"""Draws groups of people who walk together: their sizes, and their formation at the start.

Sizes and formation are those of Moussaïd, Perozo, Garnier, Helbing & Theraulaz, "The walking
behaviour of pedestrian social groups and its impact on crowd dynamics", PLoS ONE 5(4), 2010: sizes
have a zero-truncated Poisson distribution, and people walk abreast if there is room.
"""

import math

import numpy as np

from giveway.geometry.kernel import Array

RATE = 1.11  # rate of the zero-truncated Poisson distribution of sizes (population B)
LARGEST = 5  # largest size of a group
_ABREAST = 3  # largest number of people in one row; larger groups walk in two
_BESIDE, _BEHIND = 0.75, 1.0  # distance [m] of neighbours in a row, and of rows
_SIZES = np.arange(2, LARGEST + 1)
_WEIGHTS = np.array([RATE**size / math.factorial(size) for size in _SIZES.tolist()])
_MEAN = float((_SIZES * _WEIGHTS).sum() / _WEIGHTS.sum())  # mean size of groups of at least two


def parties_per_person(share: float) -> float:
    """Return the mean number of parties (groups and single people) per person.

    Args:
        share: Share of the people who walk in groups.
    """
    return 1.0 - share + share / _MEAN


def party_size(share: float, random: np.random.Generator) -> int:
    """Draw the size of the next group or single person.

    Without groups it is 1, and no random number is drawn.

    Args:
        share: Share of the people who walk in groups.
        random: Generator of the draw.
    """
    if not share or random.random() >= share / _MEAN / parties_per_person(share):
        return 1
    return int(random.choice(_SIZES, p=_WEIGHTS / _WEIGHTS.sum()))


def party_sizes(people: int, share: float, random: np.random.Generator) -> list[int]:
    """Draw sizes of groups and single people up to the sum ``people``; the last one is cut."""
    sizes: list[int] = []
    left = people
    while left > 0:
        sizes.append(min(party_size(share, random), left))
        left -= sizes[-1]
    return sizes


def formation(size: int) -> Array:
    """Return offsets (size, 2) [m] to the side and ahead: abreast, large groups in two rows."""
    front = size if size <= _ABREAST else (size + 1) // 2
    rows = [front, size - front]
    return np.array(
        [
            ((i - (row - 1) / 2.0) * _BESIDE, -number * _BEHIND)
            for number, row in enumerate(rows)
            for i in range(row)
        ]
    )


def facing(size: int, way: Array) -> Array:
    """Return offsets (size, 2) [m] of a formation that walks along ``way`` (2,)."""
    length = math.hypot(*way)
    ahead = np.asarray(way) / length if length > 0.0 else np.array([1.0, 0.0])
    axes = np.array([[-ahead[1], ahead[0]], ahead])
    return np.asarray(np.einsum("ij,jk", formation(size), axes))


def of_parties(sizes: list[int], names: tuple[str, ...]) -> tuple[str, ...]:
    """Return the group of each of ``names``: its first member's name, empty for single people."""
    groups: list[str] = []
    for size in sizes:
        groups += [names[len(groups)] if size > 1 else ""] * size
    return tuple(groups)


def slowest(speed: Array, sizes: list[int]) -> Array:
    """Return desired speeds (n,) [m/s], each that of the slowest member of the group."""
    first = np.cumsum([0, *sizes[:-1]])
    return np.repeat(np.minimum.reduceat(speed, first), sizes) if len(speed) else speed
