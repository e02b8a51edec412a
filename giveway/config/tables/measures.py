"""``[[measure]]``: lines and areas on which density, speed and flow of the people are measured."""

import math
from collections.abc import Sequence
from typing import Any

import shapely
from pydantic import Field

from giveway.config.option import Section, is_number, problem_of_name, read_tables

_KEYS = ("name", "line", "area", "interval")
_FARTHEST = 1e7  # Largest coordinate [m]; beyond it a millimetre is lost in rounding
Place = tuple[float, float]


class MeasureConfig(Section):
    """One measurement line or area, in network coordinates."""

    name: str = Field(description="Name of the measure in the table")
    line: tuple[Place, ...] = Field((), description="The two ends of the line, x and y [m]")
    area: tuple[Place, ...] = Field((), description="Corners of a convex area, x and y [m]")
    interval: float = Field(10.0, description="Interval [s] of each row of the table")

    @property
    def places(self) -> tuple[Place, ...]:
        """The ends of the line or the corners of the area [m]."""
        return self.line or self.area

    def settings(self) -> dict[str, Any]:
        """Return the entries for a table of a TOML file."""
        kind = "line" if self.line else "area"
        places = [list(place) for place in self.places]
        return {"name": self.name, kind: places, "interval": self.interval}


def read_measures(value: Any) -> tuple[MeasureConfig, ...]:
    """Read the measures in a TOML file or a dictionary.

    Raises:
        ValueError: a measure is not valid; the message names it.
    """
    return read_tables(value, MeasureConfig, "measure", "[[measure]]", _read)


def _read(entry: dict[str, Any], number: int) -> MeasureConfig:
    name = entry.get("name")
    if not isinstance(name, str) or not name:
        raise ValueError(f"measure[{number}]: name = {name!r}: expected a text; name it")
    if problem := problem_of_name(name):
        raise ValueError(f"measure[{number}]: name = {name!r}: {problem}")
    called = f"measure '{name}'"
    unknown = sorted(set(entry) - set(_KEYS))
    if unknown:
        raise ValueError(f"{called}: unknown key '{unknown[0]}'; expected {', '.join(_KEYS)}")
    kinds = [kind for kind in ("line", "area") if entry.get(kind)]
    if len(kinds) != 1:
        raise ValueError(f"{called}: expected either line or area, a list of points [x, y] in m")
    interval = entry.get("interval", 10.0)
    if not is_number(interval) or not 0.5 <= interval <= _FARTHEST:
        raise ValueError(f"{called}: interval = {interval!r}: expected at least 0.5 [s]")
    kind = kinds[0]
    places = _places(entry[kind], f"{called}: {kind}")
    (_require_line if kind == "line" else _require_area)(places, called)
    return MeasureConfig.model_validate({"name": name, kind: places, "interval": float(interval)})


def _places(value: Any, called: str) -> tuple[Place, ...]:
    points = value if isinstance(value, list | tuple) else [value]
    for point in points:
        is_pair = isinstance(point, list | tuple) and len(point) == 2
        if not is_pair or not all(is_number(c) and abs(c) <= _FARTHEST for c in point):
            raise ValueError(f"{called}: {point!r}: expected a point [x, y] in m")
    return tuple((float(x), float(y)) for x, y in points)


def _require_line(places: Sequence[Place], called: str) -> None:
    if len(places) != 2:
        raise ValueError(f"{called}: line has {len(places)} point(s); expected its two ends")
    if math.dist(*places) < 0.01:
        raise ValueError(f"{called}: line starts and ends at {places[0]}; expected two places")


def _require_area(places: Sequence[Place], called: str) -> None:
    if len(places) < 3:
        raise ValueError(
            f"{called}: area has {len(places)} point(s); expected three corners or more"
        )
    polygon = shapely.Polygon(places)
    if not polygon.is_valid or polygon.area < 0.01:
        reason = shapely.is_valid_reason(polygon) if not polygon.is_valid else "no extent"
        raise ValueError(f"{called}: the area has no inside ({reason}); list the corners in order")
    if polygon.convex_hull.area - polygon.area > 1e-6 * polygon.area:
        raise ValueError(
            f"{called}: area has a corner that turns inwards; expected a convex one, "
            "split it in two"
        )
