"""The rating of impact speeds: colours, points, and the verification of predicted colours.

The rules are those of Euro NCAP's calculator, euroncap-rating-2026. Its answers to 200 tables are
kept in the tests (benchmarks/ncap/official_points.py).
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_HALF_UP, Decimal
from math import inf, isnan
from typing import Final, Literal

from giveway.ncap.protocol import Cell, Colour, Protocol, Test

GREEN: Final = "green"
RED: Final = "red"
Verdict = Literal["correct", "in tolerance", "better", "incorrect"]

_HALF, _THREE_QUARTERS = 0.5, 0.75  # shares of the extended range that score
_GUARD, _DIGITS, _SPEED_DIGITS = 9, 3, 2


@dataclass(frozen=True)
class Points:
    """The points of a test.

    Attributes:
        standard: Points of the standard range.
        extended: Points of the extended range.
        most: Largest possible sum of both.
    """

    standard: float
    extended: float
    most: float


@dataclass(frozen=True)
class Rating:
    """The points of a whole table by day.

    Attributes:
        tests: Points of each test by its name.
        zeroed: True if the cell is not green that all points need.
    """

    tests: dict[str, Points]
    zeroed: bool

    @property
    def total(self) -> float:
        """The sum of all points, by day, without robustness layers."""
        return rounded(sum(each.standard + each.extended for each in self.tests.values()), _DIGITS)

    @property
    def most(self) -> float:
        """The largest possible sum."""
        return rounded(sum(each.most for each in self.tests.values()), _DIGITS)


def rounded(value: float, digits: int) -> float:
    """Return a number rounded half up, as spreadsheets do."""
    exact = Decimal(value).quantize(Decimal(1).scaleb(-_GUARD), rounding=ROUND_HALF_UP)
    return float(exact.quantize(Decimal(1).scaleb(-digits), rounding=ROUND_HALF_UP))


def bands_of(protocol: Protocol, cell: Cell) -> tuple[tuple[Colour, float, float], ...]:
    """Return the colours of a cell, each from one impact speed [km/h] to below another.

    Green is 0 alone, or reaches up to the allowed speed.
    """
    colours = protocol.colours
    allowed = dict(colours.allowed).get(cell.speed, 0.0)
    below = {}
    if not cell.avoid:
        below = [band.below for band in colours.bands if band.speed <= cell.speed][-1]
    edges = [allowed, *below.values(), inf]
    names: list[Colour] = [*below, RED]
    between = zip(names, edges[:-1], edges[1:], strict=True)
    return ((GREEN, -inf, allowed), *between)


def colour_of(protocol: Protocol, cell: Cell, impact: float) -> Colour:
    """Return the colour of an impact speed [km/h]; nan stands for no impact."""
    value = 0.0 if isnan(impact) else rounded(impact, _SPEED_DIGITS)
    (_, _, green), *others = bands_of(protocol, cell)
    if value <= green:
        return GREEN
    return next(colour for colour, _, below in others if value < below)


def verified(
    protocol: Protocol, cell: Cell, predicted: Colour, impact: float
) -> tuple[Verdict, Colour]:
    """Return whether a measured impact speed confirms a predicted colour, and what is applied.

    Args:
        protocol: Protocol.
        cell: Cell.
        predicted: Predicted colour.
        impact: Measured impact speed [km/h]; nan stands for no impact.
    """
    value = 0.0 if isnan(impact) else rounded(impact, _SPEED_DIGITS)
    measured = colour_of(protocol, cell, impact)
    if measured == predicted:
        return "correct", measured
    bands = {colour: (low, high) for colour, low, high in bands_of(protocol, cell)}
    tolerance = 0.0 if cell.avoid else protocol.colours.tolerance
    if predicted in bands and tolerance:
        low, high = bands[predicted]
        low -= 0.0 if predicted == RED else tolerance
        above = value >= low if low > 0.0 else value > 0.0 or predicted == GREEN
        if above and value < high + tolerance:
            return "in tolerance", predicted
    points = protocol.colours.points
    return ("better" if points[measured] > points[predicted] else "incorrect"), measured


Key = tuple[str, int, int]


def rate(
    protocol: Protocol,
    colours: Mapping[Key, Colour],
    checks: Sequence[tuple[Key, Verdict]] = (),
    *,
    zeroes: bool = True,
) -> Rating:
    """Return the points of a table of predicted colours.

    Args:
        protocol: Protocol.
        colours: Colour of each cell by its key. Cells without one count as red.
        checks: Verified cells with their verdicts. Points of a range are given in proportion to
            the cells that are confirmed, or better.
        zeroes: False to leave out the rule that one cell which is not green costs all points.
    """
    zero = protocol.zero
    missed = zero is not None and colours.get((zero.test, zero.hit, zero.speed), RED) != GREEN
    zeroed = zeroes and missed
    tests = {}
    for test in protocol.tests:
        cells = [cell for cell in protocol.cells if cell.test is test]
        given = protocol.colours.points
        standard = _share(given[colours.get(cell.key, RED)] for cell in cells if not cell.extended)
        extended = _stepped(
            _share(float(colours.get(cell.key, RED) != RED) for cell in cells if cell.extended)
        )
        standard *= _confirmed(protocol, test, checks, extended=False)
        extended *= _confirmed(protocol, test, checks, extended=True)
        most = test.standard_points + test.extended_points
        tests[test.name] = Points(
            0.0 if zeroed else standard * test.standard_points,
            0.0 if zeroed else extended * test.extended_points,
            most,
        )
    return Rating(tests, zeroed)


def _confirmed(
    protocol: Protocol, test: Test, checks: Sequence[tuple[Key, Verdict]], *, extended: bool
) -> float:
    """Return the share of a range's verified cells that are confirmed, in whole percent."""
    cells = {cell.key for cell in protocol.cells if cell.test is test and cell.extended == extended}
    verdicts = [verdict for key, verdict in checks if key in cells]
    if not verdicts:
        return 1.0
    confirmed = sum(verdict != "incorrect" for verdict in verdicts)
    return rounded(100.0 * confirmed / len(verdicts), 0) / 100.0


def _share(scores: Iterable[float]) -> float:
    """Return the mean of some scores; 0 without any."""
    all_ = list(scores)
    return sum(all_) / len(all_) if all_ else 0.0


def _stepped(share: float) -> float:
    """Return the share of the extended range's points for a share of its cells."""
    share = rounded(share, 6)
    steps = [step for step in (_HALF, _THREE_QUARTERS, 1.0) if share >= step]
    return steps[-1] if steps else 0.0
