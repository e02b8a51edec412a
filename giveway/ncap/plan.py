"""The runs of a table: for each cell the car, the dummy and its script, as a study."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from giveway.config.files.layers import Layer, merge
from giveway.geometry.bodies import BODY
from giveway.metrics.dummies import DUMMY
from giveway.ncap.course import DRIVE, GATE, LINE
from giveway.ncap.protocol import KMH, Cell, Protocol
from giveway.ncap.turning import BEGIN, meeting, path_of
from giveway.studies.definition import StudyDefinition, make_definition

HOLDER = "speed-holder"
"""The driver of the tests: holds the speed, so that only the safety layer brakes."""
OPEN, OBSTRUCTED = "open road", "parked cars"
"""Names of the two roads."""
FACTOR = "test"
OF_CONTROLLER = ("controller_options", "controller_profile")
"""Settings of the controller of the second table."""

_LEAD = 4.0  # Time [s] of driving before the person sets out
_BEYOND = 10.0  # Distance [m] that the car drives on behind the dummy's line
_ALONE = 2.0  # Time [s] before the line, besides, of a run without a person
_WALKS_ON = 12.0  # Distance [m] that the person walks on behind the meeting
_DEPARTS = 1.0  # Time [s] of the departure, when the parked cars are there
_LATENCY = 0.3  # Latency [s] of the sensor, as in docs/sight.md
_FASTEST = 27.0  # Highest speed [m/s] of the car; the tests go up to 80 km/h


@dataclass(frozen=True)
class Planned:
    """One run of a table.

    Attributes:
        label: Name of the run's cell in the study.
        driver: Controller that drives.
        road: Name of the road.
        speed: Speed [km/h].
        cell: Cell of the table, or None for a run without a person.
    """

    label: str
    driver: str
    road: str
    speed: int
    cell: Cell | None


def runs_of(cells: tuple[Cell, ...], drivers: tuple[str, ...]) -> list[Planned]:
    """Return all runs: driver by driver the cells, and each road and speed without a person."""
    found: list[Planned] = []
    for number, driver in enumerate(drivers):
        own = "" if number == 0 else f" {driver}"
        found += [
            Planned(f"{cell.label}{own}", driver, road_of(cell), cell.speed, cell) for cell in cells
        ]
        alone = {(road_of(cell), cell.speed) for cell in cells}
        found += [
            Planned(f"nobody, {road}, {speed} km/h{own}", driver, road, speed, None)
            for road, speed in sorted(alone)
        ]
    return found


def course_name(road: str, speed: int) -> str:
    """Return the name of the scenario of a road; a turn has another one at each speed [km/h]."""
    return road if road in {OPEN, OBSTRUCTED} else f"{road} {speed}"


def road_of(cell: Cell) -> str:
    """Return the road of a cell."""
    if cell.test.turn is not None:
        return f"{cell.test.turn.side} turn"
    return OBSTRUCTED if cell.test.parked else OPEN


def study_of(
    name: str,
    protocol: Protocol,
    runs: list[Planned],
    car: Mapping[str, Any],
    courses: Mapping[str, Path],
    out: Path,
    seed: int,
) -> StudyDefinition:
    """Return the study whose cells are the runs of a table.

    Args:
        name: Name of the study.
        protocol: Protocol.
        runs: Runs.
        car: Settings of the car, as in a run's TOML file.
        courses: Scenario of each road, by its name, relative to the study's folder.
        out: Folder of the study.
        seed: Seed of the runs.
    """
    width = width_of(car)
    length = float(car.get("vehicle", {}).get("length") or BODY.length)
    own = {key: car[key] for key in OF_CONTROLLER if key in car}
    shared = {key: value for key, value in car.items() if key not in own}
    levels = {}
    for run in runs:
        layers = [Layer("cell", _settings(protocol, run, width, length, courses))]
        if run.driver != HOLDER:
            layers.append(Layer("config", own))
        elif "hidden_speed" not in car.get("safety", {}):
            layers.append(Layer("holder", {"safety": {"hidden_speed": 0.0}}))
        levels[run.label] = merge(layers)
    common = Layer("ncap", _common())
    values = {
        "name": name,
        "description": f"{protocol.title}: pedestrians by day",
        "folder": str(out.absolute()),
        "replications": 1,
        "first_seed": seed,
        "run": merge([common, Layer("car", shared)]),
        "factors": {FACTOR: levels},
    }
    return make_definition(values, "giveway ncap")


def width_of(car: Mapping[str, Any]) -> float:
    """Return the width [m] of a car by its settings."""
    return float(car.get("vehicle", {}).get("width") or BODY.width)


def _common() -> dict[str, Any]:
    """Return the settings that all runs share, and that the user may change."""
    return {
        "time_limit": 30.0,
        "vehicle": {"speed_max": _FASTEST},
        "ego": {"route": [DRIVE], "depart_time": _DEPARTS},
        "crowd": {"host_edge": GATE, "zone": "none"},
        "perception": {"sensor": "sight"},
        "sensor_options": {"latency": _LATENCY},
        "metrics": {DUMMY: [1.0, 1.0]},
    }


def _settings(
    protocol: Protocol, run: Planned, width: float, length: float, courses: Mapping[str, Path]
) -> dict[str, Any]:
    """Return the settings of one run of a car of some width and length [m]."""
    speed, before = run.speed / KMH, _ALONE
    if run.road not in {OPEN, OBSTRUCTED}:  # before the turn
        before += (LINE - BEGIN) * KMH / run.speed
    values: dict[str, Any] = {
        "scenario": str(courses[course_name(run.road, run.speed)]),
        "controller": run.driver,
        "regulation": {"reference_speed": round(speed, 6)},
    }
    met = LINE
    if run.cell is not None:
        dummy = protocol.dummy(run.cell.test)
        person, before = script_of(protocol, run.cell, width, length)
        met = LINE if run.cell.test.turn is None else person["meet_x"]
        values["crowd"] = {"model": "recorded", "scripted": [person]}
        values["metrics"] = {DUMMY: [dummy.length, dummy.width]}
    start = met - speed * (before + _LEAD)
    values["ego"] = {
        "depart_position": round(start, 3),
        "initial_speed": round(speed, 6),
        "travel_distance": round(met + _BEYOND - start, 3),
    }
    return values


def script_of(
    protocol: Protocol, cell: Cell, width: float, length: float = BODY.length
) -> tuple[dict[str, Any], float]:
    """Return the script of a cell's dummy, and the time [s] of its walk to the meeting.

    The dummy's box is met by the front when its reference point is at the hit point.

    Args:
        protocol: Protocol.
        cell: Cell.
        width: Width [m] of the car.
        length: Length [m] of the car.
    """
    test, walking_speed = cell.test, cell.test.walking_speed / KMH
    place, walked, front = _walk_of(protocol, cell, width, length)
    person = {
        "name": "dummy",
        **{key: round(value, 6) for key, value in place.items()},
        "speed": round(walking_speed, 6),
        "acceleration_distance": test.acceleration,
        "distance": round(walked + _WALKS_ON, 6),
        "meet_after": round(walked, 6),
        "meet_x": round(front, 6),
        "kind": protocol.dummy(test).kind,
    }
    return person, (walked + test.acceleration) / walking_speed


def _walk_of(
    protocol: Protocol, cell: Cell, width: float, length: float
) -> tuple[dict[str, float], float, float]:
    """Return the dummy's first place and direction, its walk [m], and the front's station [m].

    Walk and station are those of the meeting.
    """
    test, dummy = cell.test, protocol.dummy(cell.test)
    offset = width * (cell.hit / 100.0 - 0.5)
    if test.turn is not None:
        direction = 1.0 if test.walks == "with the car" else -1.0
        path = path_of(test.turn, cell.speed)
        front, middle, crossed = meeting(test.turn, path, dummy, direction, length)
        first = crossed - direction * cell.start
        walked = direction * (middle - first)
        place = {"x": first, "y": test.turn.line, "heading": 90.0 - 90.0 * direction}
    elif test.walks == "along":  # the hit point counts from the right
        walked = test.acceleration + cell.start
        place = {"x": LINE - walked, "y": offset, "heading": 0.0}
        front = LINE - dummy.length / 2.0
    else:
        walked = cell.start + offset + dummy.reference
        side = test.comes_from
        place = {"x": LINE, "y": side * cell.start, "heading": -90.0 * side}
        front = LINE - dummy.width / 2.0
    return place, walked, front
