"""The columns of every table that giveway writes: name, type, unit and meaning, once.

Recorder, CSV writer and data package all read from here. ``trajectories.csv`` keeps the names,
the reference point and the angle convention of SUMO's floating car data (FCD).
"""

from dataclasses import dataclass
from typing import Literal, get_args, get_type_hints

ColumnType = Literal["number", "integer", "string", "boolean"]
_TYPES: dict[type, ColumnType] = {
    bool: "boolean",
    int: "integer",
    float: "number",
    str: "string",
}


@dataclass(frozen=True)
class Column:
    """One column: Frictionless type, unit (None where there is none) and meaning."""

    name: str
    type: ColumnType
    unit: str | None
    description: str


@dataclass(frozen=True)
class Quantity:
    """Unit and meaning of a column, as the annotation of the attribute that holds its values."""

    unit: str | None
    meaning: str


def columns_of(table: type) -> tuple[Column, ...]:
    """The columns of a class whose every attribute is ``Annotated[type, Quantity(...)]``."""
    columns = []
    for name, hint in get_type_hints(table, include_extras=True).items():
        python_type, quantity = get_args(hint)
        columns.append(Column(name, _TYPES[python_type], quantity.unit, quantity.meaning))
    return tuple(columns)


_FRONT = "of the front bumper's centre (SUMO's reference point)"

EGO_COLUMNS = (
    Column("time", "number", "s", "simulation time t_k of the control instant"),
    Column("id", "string", None, "SUMO id of the ego"),
    Column("position", "number", "m", "distance driven along the path since departure, by the FMU"),
    Column("x", "number", "m", f"network x {_FRONT}"),
    Column("y", "number", "m", f"network y {_FRONT}"),
    Column("angle", "number", "deg", "navigational angle: 0 is north, clockwise"),
    Column("speed", "number", "m/s", "speed, by the FMU"),
    Column("acceleration", "number", "m/s^2", "acceleration over the step before t_k, by the FMU"),
    Column("force", "number", "N", "force command applied from t_k on; negative brakes"),
    Column(
        "controller",
        "string",
        None,
        "who acted: mpc, pid, plug-in (somebody else's), safety (the layer below)",
    ),
    Column("reason", "string", None, "why it acted; of the planning MPC: which manoeuvre"),
    Column("solver_status", "string", None, "the QP solver's status; empty where none ran"),
    Column("solver_iterations", "integer", None, "the QP solver's iterations"),
    Column("gap", "number", "m", "distance to the closest pedestrian in front now; empty: nobody"),
    Column("reference_speed", "number", "m/s", "the reference speed of the controller that acted"),
    Column("vehicle_gap", "number", "m", "distance to the closest vehicle in front; empty: none"),
    Column(
        "stop_gap",
        "number",
        "m",
        "front bumper's distance to where a light, a stop or a crossing halts it",
    ),
    Column(
        "waits_for",
        "string",
        None,
        "what it stands for: person, vehicle, light, stop, yield (at a crossing: to people, or "
        "since it is blocked; where lanes merge: to vehicles), plan (people expected in front), "
        "none; empty: it drives, or drives off",
    ),
)

SUMMARY_HEAD = (
    Column("scenario", "string", None, "the scenario's name"),
    Column("ego", "string", None, "SUMO id of the ego"),
    Column("controller", "string", None, "the controller that was asked for"),
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

SIGNAL_COLUMNS = (
    Column("time", "number", "s", "simulation time from which on it holds"),
    Column("system", "string", None, "SUMO id of the traffic light"),
    Column("state", "string", None, "one letter per movement, SUMO's"),
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
