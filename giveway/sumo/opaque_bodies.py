"""Heights of vehicles and persons in SUMO, and walls of its polygons: all that hides people."""

from collections.abc import Iterable, Mapping
from functools import cache
from math import inf, nan
from typing import Any

import numpy as np

from giveway.errors import ScenarioError
from giveway.geometry.kernel import Array
from giveway.sumo.library import direct

NOTHING_OPAQUE = (
    "sensor 'sight': nothing hides anybody: no polygon of a type in [perception] opaque, and no "
    "other vehicle"
)
_HEIGHT = "height"  # parameter of a polygon that is taller or lower than others of its type


class OpaqueBodies:
    """Reads the heights of bodies, and the walls that polygons stand for.

    Args:
        sumo: The libsumo module, with a simulation running.
    """

    def __init__(self, sumo: Any) -> None:
        self._polygon = sumo.polygon
        self._of_vehicle = cache(direct(sumo, "vehicle", "getHeight"))
        self._of_person = cache(direct(sumo, "person", "getHeight"))

    def vehicle_heights(self, names: Iterable[str]) -> Array:
        """The heights (m,) [m] of vehicles on the road."""
        return np.array([self._of_vehicle(name) for name in names], dtype=np.float64)

    def person_heights(self, names: Iterable[str]) -> Array:
        """The heights (n,) [m] of persons in SUMO."""
        return np.array([self._of_person(name) for name in names], dtype=np.float64)

    def walls(self, heights: Mapping[str, float]) -> Array:
        """The sides (k, 5) of opaque polygons: x0, y0, x1, y1, height [m].

        Args:
            heights: Height [m] of each type of polygon that hides people. A type stands for its
                kinds, too: ``building`` for ``building.house``. A polygon's own parameter
                ``height`` [m] comes before it.

        Raises:
            ScenarioError: a polygon's height is not one.
        """
        sides = [np.empty((0, 5))]
        for name in sorted(self._polygon.getIDList()):
            height = height_of(self._polygon.getType(name), heights)
            if height is None:
                continue
            own = self._polygon.getParameter(name, _HEIGHT)
            height = _own_height(name, own) if own else height
            shape = np.array([point[:2] for point in self._polygon.getShape(name)]).reshape(-1, 2)
            tops = np.full((max(len(shape) - 1, 0), 1), height)
            sides.append(np.hstack([shape[:-1], shape[1:], tops]))
        return np.concatenate(sides)


def _own_height(name: str, text: str) -> float:
    """Return the height [m] that a polygon's parameter gives.

    Raises:
        ScenarioError: it is no height.
    """
    try:
        height = float(text)
    except ValueError:
        height = nan
    if not 0.0 < height < inf:
        raise ScenarioError(
            f"polygon '{name}': parameter {_HEIGHT} = '{text}': expected a number above 0 [m]; "
            "correct it in the additional file"
        )
    return height


def height_of(kind: str, heights: Mapping[str, float]) -> float | None:
    """The height [m] of a type of polygon, or None if it hides nobody.

    Args:
        kind: Type; it may be a kind of a known one, like ``building.house``.
        heights: Height [m] of each known type.
    """
    while kind:
        if kind in heights:
            return heights[kind]
        kind = kind.rpartition(".")[0]
    return None
