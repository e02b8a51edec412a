"""The zone in which giveway moves the scenario's own pedestrians."""

import math

import numpy as np
import shapely
from numpy.typing import NDArray

from giveway.errors import ConfigError
from giveway.geometry.kernel import Array

_EXPECTED = (
    "expected metres round each ego (like 50), 'everywhere', 'none', or a polygon of at least "
    "three corners 'x,y x,y x,y' [m] in network coordinates"
)

_SMALLEST, _LARGEST = 0.1, 1e6  # bounds of the radius [m]
_FARTHEST = 1e7  # largest coordinate [m]; beyond it rounding errors exceed a millimetre


_MARGIN = 5.0  # hysteresis [m] at the zone's edge


class Zone:
    """The zone in which giveway moves pedestrians: around egos, a polygon, everywhere or nowhere.

    Args:
        text: Text of the setting ``zone`` in the configuration.
        margin: Distance [m] outside the zone at which people are handed back to SUMO.

    Raises:
        ConfigError: the text is none of these.
    """

    def __init__(self, text: str, margin: float = _MARGIN) -> None:
        self._text = text
        self._margin = margin
        self._radius: float | None = None
        self._inner: shapely.Polygon | None = None
        self._outer: shapely.Polygon | None = None
        word = text.strip().lower()
        self.everywhere = word == "everywhere"
        self.nowhere = word in {"none", ""}
        if self.everywhere or self.nowhere:
            return
        try:
            numbers = [float(part) for part in word.replace(",", " ").split()]
        except ValueError:
            numbers = []
        if len(numbers) == 1 and 0.0 < numbers[0] < math.inf:
            self._radius = _radius(text, numbers[0])
        elif len(numbers) >= 6 and len(numbers) % 2 == 0 and np.abs(numbers).max() <= _FARTHEST:
            self._inner = _polygon(text, numbers)
            # The union, because rounding may make the buffer smaller than the polygon.
            self._outer = self._inner.union(self._inner.buffer(margin))
            shapely.prepare((self._inner, self._outer))
        else:
            raise ConfigError(f"--zone '{text}': {_EXPECTED}")

    def along(self, way: Array) -> "Zone":
        """Return the zone of a run without an ego, around the path that an ego would drive.

        Args:
            way: Path (k, 2) [m] that an ego would drive.
        """
        if self._radius is None:
            return self
        line, zone = shapely.LineString(way), Zone("none", self._margin)
        zone._text, zone.nowhere = self._text, False
        zone._inner = line.buffer(self._radius)
        zone._outer = line.buffer(self._radius + self._margin)
        shapely.prepare((zone._inner, zone._outer))
        return zone

    @property
    def follows_egos(self) -> bool:
        """True if the zone is around the egos; without an ego there is no such zone."""
        return self._radius is not None

    def require_overlap(self, boundary: tuple[float, float, float, float]) -> None:
        """Make sure that the zone lies in the network.

        Args:
            boundary: Bounds x_min, y_min, x_max, y_max of the network [m].

        Raises:
            ConfigError: it lies outside.
        """
        if self._inner is None or self._inner.intersects(shapely.box(*boundary)):
            return
        x_min, y_min, x_max, y_max = boundary
        raise ConfigError(
            f"--zone '{self._text}': lies outside of the network, which reaches from "
            f"{x_min:.0f},{y_min:.0f} to {x_max:.0f},{y_max:.0f} m; name a place inside"
        )

    def enters(self, points: Array, egos: Array) -> NDArray[np.bool_]:
        """Return whether each point (n,) is in the zone.

        Args:
            points: Points (n, 2) [m].
            egos: Positions (e, 2) [m] of the egos' front bumpers.
        """
        return self._inside(points, egos, self._radius or 0.0, self._inner)

    def keeps(self, points: Array, egos: Array) -> NDArray[np.bool_]:
        """Return whether each point (n,) is in the zone, or at most its margin outside.

        Arguments are as for :meth:`enters`.
        """
        return self._inside(points, egos, (self._radius or 0.0) + self._margin, self._outer)

    def _inside(
        self, points: Array, egos: Array, radius: float, polygon: shapely.Polygon | None
    ) -> NDArray[np.bool_]:
        if self.everywhere or self.nowhere or not len(points):
            return np.full(len(points), self.everywhere)
        if polygon is not None:
            return np.asarray(shapely.contains_xy(polygon, points[:, 0], points[:, 1]))
        inside = np.zeros(len(points), dtype=np.bool_)
        for x, y in egos:
            d_x, d_y = points[:, 0] - x, points[:, 1] - y
            inside |= d_x * d_x + d_y * d_y <= radius * radius
        return inside


def _radius(text: str, radius: float) -> float:
    if not _SMALLEST <= radius <= _LARGEST:
        raise ConfigError(
            f"--zone '{text}': expected {_SMALLEST:g} to {_LARGEST:g} m: less holds no person, and "
            "no network is larger; nobody is 'none', everybody 'everywhere'"
        )
    return radius


def _polygon(text: str, numbers: list[float]) -> shapely.Polygon:
    polygon = shapely.Polygon(np.reshape(numbers, (-1, 2)))
    if not polygon.is_valid or polygon.area <= 0.0:
        reason = shapely.is_valid_reason(polygon)
        raise ConfigError(
            f"--zone '{text}': not a polygon that encloses an area ({reason}); {_EXPECTED}"
        )
    return polygon
