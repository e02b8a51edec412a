"""The protocols of consumer tests, as data: tests, dummies, parked cars, colours and points."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from importlib.resources import files
from typing import Final, Literal

from giveway.config.files.toml import parse_toml
from giveway.config.option import Section

PROTOCOLS: Final = ("euroncap-2026", "euroncap-2023", "r152")
"""Names of the bundled protocols."""
KMH: Final = 3.6
"""Kilometres per hour in a metre per second."""

Colour = Literal["green", "yellow", "orange", "brown", "red"]


class Dummy(Section):
    """A dummy: its box, and the point that is to be hit.

    Attributes:
        length: Length [m] in the direction of the walk.
        width: Width [m] across it.
        reference: Distance [m] from the middle of the box back to the point to be hit.
        kind: Kind of person, on which the height depends.
    """

    length: float
    width: float
    reference: float
    kind: str


class ParkedCars(Section):
    """The parked cars in front of an obstructed dummy.

    Attributes:
        gap: Distance [m] to the side of the car, to the dummy's box, and to each other.
        lengths: Lengths [m], that of the car nearest to the dummy first.
        width: Width [m].
        height: Height [m].
    """

    gap: float
    lengths: tuple[float, ...]
    width: float
    height: float


class Band(Section):
    """The colours of a test's speeds from ``speed`` on.

    Attributes:
        speed: Smallest test speed [km/h].
        below: Impact speed [km/h] below which a colour is given, best colour first.
    """

    speed: float
    below: dict[Colour, float]


class Colours(Section):
    """The colours of impact speeds, and their points.

    Attributes:
        points: Points of a standard cell of each colour, of 1.
        bands: Colours by the speed of the test.
        allowed: Test speeds and the impact speeds [km/h] up to which a cell is green; empty if
            only 0 is.
        tolerance: Tolerance [km/h] of a verification.
    """

    points: dict[Colour, float]
    bands: tuple[Band, ...]
    allowed: tuple[tuple[float, float], ...] = ()
    tolerance: float = 0.0


class CellName(Section):
    """The place of one cell: its test, hit point [%] and speed [km/h]."""

    test: str
    hit: int
    speed: int


class Row(Section):
    """The cells of some speeds of a test.

    Attributes:
        speeds: Speeds [km/h] of the car.
        standard: Hit points [%] of the standard range.
        extended: Hit points of the extended range.
        start: Start of the person, if it is not the test's.
        avoid: True if only an avoided impact scores.
    """

    speeds: tuple[int, ...]
    standard: tuple[int, ...]
    extended: tuple[int, ...] = ()
    start: float | None = None
    avoid: bool = False


class Bend(Section):
    """The curve of a turning test at one speed.

    Attributes:
        speed: Speed [km/h] of the car.
        radius: Radius [m] of the arc.
        clothoid: Angle [degree] of each clothoid.
        arc: Angle [degree] of the arc.
    """

    speed: int
    radius: float
    clothoid: float
    arc: float


class Turn(Section):
    """The turn of the car in a test.

    Attributes:
        side: Side to which it turns.
        beside: Distance [m] of the dummy's line from the middle of the road that the car leaves.
        lane: Width [m] of a lane, of which the car drives on the right one.
        bends: Curves by speed.
    """

    side: Literal["left", "right"]
    beside: float
    lane: float
    bends: tuple[Bend, ...]

    @property
    def line(self) -> float:
        """The y [m] of the dummy's line, counted from the middle of the car's lane."""
        if self.side == "left":
            return self.beside + self.lane / 2.0
        return self.lane / 2.0 - self.beside


class Test(Section):
    """One test.

    Attributes:
        name: Short name.
        title: Title.
        walks: Direction from which, or in which, the person walks.
        dummy: Name of the dummy.
        walking_speed: Speed [km/h] of the person.
        start: Distance [m] of the first place from the car's middle, or, along the road, of the
            walk at full speed before the impact, or, at a turn, from the car's path.
        acceleration: Distance [m] of the acceleration.
        parked: True if parked cars hide the person.
        turn: Turn of the car, or None if it drives straight on.
        standard_points: Points of the standard range.
        extended_points: Points of the extended range.
        rows: Cells.
    """

    name: str
    title: str
    walks: Literal["from the right", "from the left", "along", "with the car", "against the car"]
    dummy: str
    walking_speed: float
    start: float
    acceleration: float
    parked: bool = False
    turn: Turn | None = None
    standard_points: float = 0.0
    extended_points: float = 0.0
    rows: tuple[Row, ...]

    @property
    def comes_from(self) -> int:
        """The side from which the person comes to the car: 1 for the left, -1 for the right."""
        if self.turn is None:
            return 1 if self.walks == "from the left" else -1
        return 1 if (self.walks == "with the car") == (self.turn.side == "left") else -1

    __test__ = False  # it is no test of pytest


@dataclass(frozen=True)
class Cell:
    """One cell of the table.

    Attributes:
        test: Its test.
        hit: Hit point [%] of the width of the car, from the side from which the person comes.
        speed: Speed [km/h] of the car.
        extended: True if it belongs to the extended range.
        start: Start of the person, as of the test.
        avoid: True if only an avoided impact scores.
    """

    test: Test
    hit: int
    speed: int
    extended: bool
    start: float
    avoid: bool

    @property
    def key(self) -> tuple[str, int, int]:
        """The test's name, hit point [%] and speed [km/h]."""
        return self.test.name, self.hit, self.speed

    @property
    def label(self) -> str:
        """The cell's name, as "CPNA 50 % 30 km/h"."""
        return f"{self.test.name} {self.hit} % {self.speed} km/h"


class Protocol(Section):
    """A protocol.

    Attributes:
        title: Title.
        rates: True if it has points.
        coloured_by: Quantity by which a cell is coloured.
        untested: Names and reasons of what is not tested.
        dummies: Dummies by name.
        parked: Parked cars, or None without any.
        colours: Colours and their points.
        zero: Cell without whose green there are no points at all, or None.
        tests: Tests.
    """

    title: str
    rates: bool
    coloured_by: str
    untested: tuple[tuple[str, str], ...]
    dummies: dict[str, Dummy]
    parked: ParkedCars | None = None
    colours: Colours
    zero: CellName | None = None
    tests: tuple[Test, ...]

    @cached_property
    def cells(self) -> tuple[Cell, ...]:
        """All cells, test by test, hit point by hit point, speed by speed."""
        found = [
            Cell(test, hit, speed, hit in row.extended, row.start or test.start, row.avoid)
            for test in self.tests
            for row in test.rows
            for speed in row.speeds
            for hit in (*row.standard, *row.extended)
        ]
        order = {test.name: number for number, test in enumerate(self.tests)}
        return tuple(sorted(found, key=lambda cell: (order[cell.test.name], *cell.key[1:])))

    def dummy(self, test: Test) -> Dummy:
        """Return the dummy of a test."""
        return self.dummies[test.dummy]


def read_protocol(name: str) -> Protocol:
    """Return one of the bundled protocols."""
    file = files("giveway.ncap") / "protocols" / f"{name}.toml"
    return Protocol.model_validate(parse_toml(file.read_text(encoding="utf-8"), file.name))
