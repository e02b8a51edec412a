"""The columns of every table that giveway writes: name, type, unit and meaning.

Recorder, CSV writer and data package all read them from here. ``trajectories.csv`` has the names,
the reference point and the angle convention of SUMO's floating car data (FCD).
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, TypeVar, get_args, get_type_hints

ColumnType = Literal["number", "integer", "string", "boolean"]
Direction = Literal["lower", "higher"]
Number = TypeVar("Number")
"""Type of a number in a class that describes one row or a whole table: float, or an array."""
Text = TypeVar("Text")
"""Type of a text in such a class: str, or an array."""
Count = TypeVar("Count")
"""Type of a whole number in such a class: int, or an array."""
_TYPES: dict[Any, ColumnType] = {
    bool: "boolean",
    int: "integer",
    float: "number",
    str: "string",
    Number: "number",
    Text: "string",
    Count: "integer",
}


@dataclass(frozen=True)
class Column:
    """One column of a table.

    Attributes:
        name: Name in the CSV file.
        type: Frictionless type.
        unit: Unit, or None.
        description: Meaning of the values.
        better: Direction that is better, or None if studies do not compare the column.
    """

    name: str
    type: ColumnType
    unit: str | None
    description: str
    better: Direction | None = None


def _unchanged(values: Any) -> Any:
    return values


@dataclass(frozen=True)
class Quantity:
    """The unit and meaning of a column; it annotates the attribute that holds the values.

    Attributes:
        unit: Unit in the CSV file, or None.
        meaning: Meaning of the values.
        column: Name in the CSV file, or an empty text if it is the attribute's name.
        written: Conversion of the attribute's array into what the CSV file holds.
        better: Direction that is better, for metrics of other packages that studies compare.
    """

    unit: str | None
    meaning: str
    column: str = ""
    written: Callable[[Any], Any] = _unchanged
    better: Direction | None = None


def quantities_of(table: type) -> dict[str, tuple[ColumnType, Quantity]]:
    """Return the type and quantity of each attribute of a class whose attributes are annotated."""
    found = {}
    for name, hint in get_type_hints(table, include_extras=True).items():
        python_type, quantity = get_args(hint)
        found[name] = _TYPES[python_type], quantity
    return found


def columns_of(table: type) -> tuple[Column, ...]:
    """Return the columns of a class whose every attribute is ``Annotated[type, Quantity(...)]``."""
    return tuple(
        Column(quantity.column or name, kind, quantity.unit, quantity.meaning, quantity.better)
        for name, (kind, quantity) in quantities_of(table).items()
    )


SUMMARY_HEAD = (
    Column("scenario", "string", None, "the scenario's name"),
    Column("ego", "string", None, "SUMO id of the ego"),
    Column(
        "controller",
        "string",
        None,
        "the controller that was asked for, and its options that are set",
    ),
    Column("pedestrians", "integer", "persons", "pedestrians that giveway moved"),
    Column("seed", "integer", None, "seed of the crowd that giveway adds"),
    Column(
        "ending",
        "string",
        None,
        "completed, time limit, scenario end, interrupted, failed or crashed",
    ),
)

TRAJECTORY_COLUMNS = (
    Column("time", "number", "s", "simulation time"),
    Column("id", "string", None, "SUMO id of the person or vehicle"),
    Column("type", "string", None, "pedestrian, ego, or the SUMO type of a background vehicle"),
    Column("x", "number", "m", "network x: a person's body centre, a vehicle's front bumper"),
    Column("y", "number", "m", "network y: a person's body centre, a vehicle's front bumper"),
    Column("angle", "number", "deg", "navigational angle: 0 is north, clockwise"),
    Column("speed", "number", "m/s", "speed"),
    Column("vx", "number", "m/s", "velocity's x component"),
    Column("vy", "number", "m/s", "velocity's y component"),
)

SEEN = Column("seen", "boolean", None, "of a person: whether an ego's sensor perceives it")

SIGNAL_COLUMNS = (
    Column("time", "number", "s", "simulation time from which on it holds"),
    Column("system", "string", None, "SUMO id of the traffic light"),
    Column("state", "string", None, "one letter per movement, SUMO's"),
)

SIGHT_COLUMNS = (
    Column("ego", "string", None, "SUMO id of the ego whose sensor it is"),
    Column("id", "string", None, "the pedestrian"),
    Column("time", "number", "s", "simulation time from which on the ego perceives the person"),
    Column("until", "number", "s", "simulation time from which on it does not; empty: to the end"),
    Column("distance", "number", "m", "from the front bumper to the person at `time`"),
)

PEOPLE_COLUMNS = (
    Column("time", "number", "s", "simulation time from which on it holds"),
    Column("id", "string", None, "the pedestrian"),
    Column("desired_speed", "number", "m/s", "speed at which it would walk if nobody was there"),
    Column("number", "integer", None, "0: where it is then; 1, 2, ...: its way-points"),
    Column("x", "number", "m", "network x of the place"),
    Column("y", "number", "m", "network y of the place"),
)

LEDGER_COLUMNS = (
    Column("time", "number", "s", "simulation time of the event, or of its begin"),
    Column("ego", "string", None, "SUMO id of the ego"),
    Column("kind", "string", None, "what happened"),
    Column("violation", "boolean", None, "whether the ego is answerable for it"),
    Column("other", "string", None, "the pedestrian, vehicle or traffic light concerned"),
    Column("place", "string", None, "SUMO id of the crossing or its number among the junctions"),
    Column("x", "number", "m", "network x of where it happened"),
    Column("y", "number", "m", "network y of where it happened"),
    Column("value", "number", None, "how bad it was"),
    Column("unit", "string", None, "of the value"),
    Column("words", "string", None, "the event in words"),
)

PREDICTION_COLUMNS = (
    Column("time", "number", "s", "control instant t_k at which the prediction was made"),
    Column("ego", "string", None, "SUMO id of the ego whose MPC made it"),
    Column("id", "string", None, "the pedestrian"),
    Column("look_ahead", "number", "s", "the prediction is for this long after t_k"),
    Column("x", "number", "m", "network x of the body's centre then"),
    Column("y", "number", "m", "network y of the body's centre then"),
)

TIMING_COLUMNS = (
    Column("time", "number", "s", "simulation time t_k of the control instant"),
    Column("prediction", "number", "us", "computing time of the crowd's prediction"),
    Column("control", "number", "us", "computing time of the controller, the QP included"),
    Column("vehicle", "number", "us", "computing time of the vehicle FMU's step"),
    Column("crowd", "number", "us", "computing time of the crowd's step"),
    Column("sumo", "number", "us", "computing time of SUMO: moves, step, comparison"),
    Column("total", "number", "us", "computing time of the whole control step"),
)
