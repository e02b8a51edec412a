"""People who walk together: how many, and how they stand to each other at the start.

Sizes and formation: Moussaïd, Perozo, Garnier, Helbing & Theraulaz, "The walking behaviour of
pedestrian social groups and its impact on crowd dynamics", PLoS ONE 5(4), 2010: zero-truncated
Poisson, abreast where there is room.
"""

import math

import numpy as np

from giveway.geometry.kernel import Array

RATE = 1.11  # of the zero-truncated Poisson distribution of sizes (population B)
LARGEST = 5
_ABREAST = 3  # more walk in two rows
_BESIDE, _BEHIND = 0.75, 1.0  # [m] between neighbours in a row, and between rows
_SIZES = np.arange(2, LARGEST + 1)
_WEIGHTS = np.array([RATE**size / math.factorial(size) for size in _SIZES.tolist()])
_MEAN = float(_SIZES @ _WEIGHTS / _WEIGHTS.sum())  # of those who are not alone


def parties_per_person(share: float) -> float:
    """How many parties, groups and those who walk alone, a person is on average.

    Args:
        share: of the people who walk in groups.
    """
    return 1.0 - share + share / _MEAN


def party_size(share: float, random: np.random.Generator) -> int:
    """The size of the next party; without groups nothing is drawn.

    Args:
        share: of the people who walk in groups.
        random: of the draw.
    """
    if not share or random.random() >= share / _MEAN / parties_per_person(share):
        return 1
    return int(random.choice(_SIZES, p=_WEIGHTS / _WEIGHTS.sum()))


def party_sizes(people: int, share: float, random: np.random.Generator) -> list[int]:
    """Sizes of parties that come to ``people``; the last one is what is left."""
    sizes: list[int] = []
    left = people
    while left > 0:
        sizes.append(min(party_size(share, random), left))
        left -= sizes[-1]
    return sizes


def formation(size: int) -> Array:
    """(size, 2) [m] beside and ahead of the middle: abreast, the larger ones in two rows."""
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
    """(size, 2) [m] of each from the middle, in formation for a walk along ``way`` (2,)."""
    length = math.hypot(*way)
    ahead = np.asarray(way) / length if length > 0.0 else np.array([1.0, 0.0])
    return np.asarray(formation(size) @ np.array([[-ahead[1], ahead[0]], ahead]))


def of_parties(sizes: list[int], names: tuple[str, ...]) -> tuple[str, ...]:
    """For each of ``names`` its group, which is called as its first member; empty: alone."""
    groups: list[str] = []
    for size in sizes:
        groups += [names[len(groups)] if size > 1 else ""] * size
    return tuple(groups)


def slowest(speed: Array, sizes: list[int]) -> Array:
    """(n,) [m/s] at which everybody wants to walk: with the slowest of the own party."""
    first = np.cumsum([0, *sizes[:-1]])
    return np.repeat(np.minimum.reduceat(speed, first), sizes) if len(speed) else speed
