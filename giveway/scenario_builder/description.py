"""The description of a street (TOML): lanes, crossings, pavements, people and vehicles."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any, Final, Literal

from pydantic import BaseModel, ValidationError, model_validator

from giveway.config.files.toml import read_toml_file
from giveway.config.option import Section, expectation, option
from giveway.errors import ConfigError, suggestion

KMH: Final = 3.6
"""Kilometres per hour in a metre per second."""
_CLEARING: Final = 1.2  # Walking speed [m/s] of the clearance time, as in the German RiLSA
_YELLOW: Final = 3.0  # [s] of vehicles
_ALL_RED: Final = 2.0  # Time [s] between the yellow of vehicles and people's green
_LEAST_GREEN: Final = 5.0  # [s] of vehicles
_APART: Final = 30.0  # Least distance [m] of a crossing from the next one and from an end

EXAMPLE: Final = """\
# A straight street for `giveway new`. Every key may be left out: it then has the value shown here.

length = 220.0      # m, from the western end (x = 0) to the eastern one
traffic = "right"   # the side on which vehicles drive: "right" or "left"
lanes = 1           # lanes in each direction
lane_width = 3.5    # m
speed = 30.0        # km/h, the speed limit
pavement = 3.0      # m, width of the pavement on each side; 0: there is none

# One table for each crossing. Without any, people cross half-way, where nothing is marked.
[[crossing]]
position = 120.0    # m, from the western end
kind = "zebra"      # "zebra": people have priority; "signals": traffic lights
width = 4.0         # m

[signals]           # of the crossings with traffic lights
cycle = 60.0        # s
walk = 10.0         # s, people's green; a clearance time for the width of the road follows

[demand]
people = 600.0      # persons per hour over each crossing, or over the street without any
vehicles = 360.0    # vehicles per hour in each direction
duration = 300.0    # s, of the whole scenario
"""
"""A description with all keys and their defaults, besides the crossing."""


class Crossing(Section):
    """A crossing of the street."""

    position: float = option(..., "m", "distance of its middle from the western end", ge=0.0)
    kind: Literal["zebra", "signals"] = option("zebra", None, "zebra or signals")
    width: float = option(4.0, "m", "width, along the street", ge=2.0, le=20.0)


class Signals(Section):
    """The programme of the crossings with traffic lights."""

    cycle: float = option(60.0, "s", "length of a cycle", ge=30.0, le=240.0)
    walk: float = option(10.0, "s", "people's green", ge=4.0, le=60.0)


class StreetDemand(Section):
    """The people and vehicles of the street."""

    people: float = option(600.0, "persons/h", "people over each crossing", ge=0.0, le=20_000.0)
    vehicles: float = option(360.0, "1/h", "vehicles in each direction", ge=0.0, le=4_000.0)
    duration: float = option(300.0, "s", "length of the scenario", ge=120.0, le=86_400.0)


class Street(Section):
    """A straight street, from west to east."""

    length: float = option(220.0, "m", "length of the street", ge=100.0, le=10_000.0)
    traffic: Literal["right", "left"] = option("right", None, "side of vehicles: right or left")
    lanes: int = option(1, None, "lanes in each direction", ge=1, le=4)
    lane_width: float = option(3.5, "m", "width of a lane", ge=2.5, le=6.0)
    speed: float = option(30.0, "km/h", "speed limit", ge=5.0, le=72.0)
    pavement: float = option(3.0, "m", "width of each pavement", ge=0.0, le=20.0, least=1.0)
    crossing: tuple[Crossing, ...] = option((), None, "tables, each headed [[crossing]]")
    signals: Signals = Signals()
    demand: StreetDemand = StreetDemand()

    @model_validator(mode="after")
    def _crossings_fit(self) -> Street:
        """Refuse crossings that no pavement leads to, or that are too close to each other."""
        positions = sorted(each.position for each in self.crossing)
        if positions and not self.pavement:
            raise ValueError(
                "pavement = 0: a crossing needs a pavement on each side; give it a width, or leave "
                "[[crossing]] out"
            )
        for west, east in pairwise([0.0, *positions, self.length]):
            if east - west < _APART and positions:
                raise ValueError(
                    f"[[crossing]] position: {west:g} m and {east:g} m are {east - west:g} m "
                    f"apart; expected crossings {_APART:g} m or more from each other and from the "
                    f"ends, 0 and {self.length:g} m"
                )
        if self.phases[0][2] < _LEAST_GREEN:
            least = self.signals.cycle - self.phases[0][2] + _LEAST_GREEN
            raise ValueError(
                f"signals.cycle = {self.signals.cycle:g}: leaves {self.phases[0][2]:g} s of green "
                f"for vehicles; expected a cycle of {least:g} s or more, or a shorter walk"
            )
        return self

    @property
    def phases(self) -> tuple[tuple[str, str, float], ...]:
        """The phases of a programme: signal of vehicles, signal of people, duration [s]."""
        clearance = float(math.ceil(2.0 * self.half_width / _CLEARING))
        walk = self.signals.walk
        green = self.signals.cycle - _YELLOW - _ALL_RED - walk - clearance
        return (
            ("G", "r", green),
            ("y", "r", _YELLOW),
            ("r", "r", _ALL_RED),
            ("r", "G", walk),
            ("r", "r", clearance),
        )

    @property
    def crossings(self) -> tuple[Crossing, ...]:
        """The crossings from west to east."""
        return tuple(sorted(self.crossing, key=lambda each: each.position))

    @property
    def sides(self) -> dict[str, str]:
        """The side of the street on which the lanes lie, by the way they lead: east or west."""
        sides = ("south", "north") if self.traffic == "right" else ("north", "south")
        return dict(zip(("east", "west"), sides, strict=True))

    @property
    def half_width(self) -> float:
        """Width [m] of the lanes in one direction."""
        return self.lanes * self.lane_width


def read_street(path: Path) -> Street:
    """Read the description of a street.

    Raises:
        ConfigError: the file is missing, not TOML, or holds what no street has.
    """
    values = read_toml_file(path, "a street; `giveway new` writes an example")
    try:
        return Street.model_validate(values)
    except ValidationError as error:
        raise ConfigError(f"{path}: {_explained(error.errors(include_url=False)[0])}") from None


def _explained(error: Any) -> str:
    """Return one line on pydantic's error."""
    key = ".".join(str(part) for part in error["loc"])
    if not key or error["type"] == "value_error":
        return str(error["ctx"]["error"])
    model: type[BaseModel] = Street
    field = None
    for name in (part for part in error["loc"] if isinstance(part, str)):
        field = model.model_fields.get(name)
        if field is None:
            return f"{key}: unknown key; {suggestion(name, model.model_fields)}"
        model = _TABLES.get(name, model)
    assert field is not None
    if error["type"] == "missing":
        return f"{key}: missing ({field.description})"
    return f"{key} = {error['input']!r}: {expectation(error, field)}"


_TABLES: Final[dict[str, type[BaseModel]]] = {
    "crossing": Crossing,
    "signals": Signals,
    "demand": StreetDemand,
}
