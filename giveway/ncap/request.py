"""The table that a command line asks for: its protocol, car, cells and drivers."""

from __future__ import annotations

import re
import shutil
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from giveway.config.files.layers import Layer, merge, read_toml
from giveway.config.files.loading import load
from giveway.errors import ConfigError
from giveway.gate import MANIFEST
from giveway.ncap.course import write_course
from giveway.ncap.measured import read_measured
from giveway.ncap.plan import (
    HOLDER,
    OBSTRUCTED,
    OPEN,
    Planned,
    course_name,
    road_of,
    runs_of,
    study_of,
    width_of,
)
from giveway.ncap.protocol import Cell, Protocol, read_protocol
from giveway.ncap.rating import Key
from giveway.ncap.turning import path_of
from giveway.studies.definition import StudyDefinition
from giveway.studies.folder.lock import COURSE

YEARS = ("2026", "2023")
_LONGEST = 80  # Largest number of characters of the study's name


@dataclass(frozen=True)
class NcapRequest:
    """The table that the user wants.

    Attributes:
        car: Vehicle FMU, or the name of a bundled one.
        profile: Vehicle profile, or None to draft it.
        protocol: Name of the protocol: euroncap or r152.
        year: Year of Euro NCAP's protocol.
        controller: Controller of a second table, or None without one.
        config: TOML file with other settings of every run, or None.
        tests: Names of the only tests; empty for all.
        speeds: The only speeds [km/h]; empty for all.
        seed: Seed of all runs.
        measured: CSV file with measured impact speeds, or None without one.
        out: Folder of the table, or None for results/ncap_CAR_PROTOCOL.
    """

    car: str
    profile: Path | None
    protocol: str
    year: str
    controller: str | None
    config: Path | None
    tests: Sequence[str] = ()
    speeds: Sequence[int] = ()
    seed: int = 1
    measured: Path | None = None
    out: Path | None = None


@dataclass(frozen=True)
class NcapPlan:
    """The runs of a table and their study.

    Attributes:
        protocol: Protocol.
        runs: Runs, in the order of the study's cells.
        definition: Study that makes them.
        width: Width [m] of the car.
        out: Folder of the table.
        measured: Measured impact speeds [km/h] by cell.
    """

    protocol: Protocol
    runs: list[Planned]
    definition: StudyDefinition
    width: float
    out: Path
    measured: dict[Key, float]


def requested_ncap(request: NcapRequest) -> NcapPlan:
    """Return the plan of a table, and write the roads of its tests.

    Raises:
        GivewayError: a name is not known, or a file cannot be read or written.
    """
    protocol = read_protocol(_protocol_name(request))
    cells = _chosen(protocol, request)
    measured = {} if request.measured is None else read_measured(request.measured, protocol)
    if request.controller is not None:
        load([Layer("--controller", {"controller": request.controller})])
    drivers = dict.fromkeys((HOLDER, *filter(None, [request.controller])))
    runs = runs_of(cells, tuple(drivers))
    car = _car(request)
    width = width_of(car)
    slug = re.sub(r"[^\w.-]+", "-", f"ncap_{Path(request.car).stem}_{_protocol_name(request)}")
    out = request.out or Path("results") / slug[:_LONGEST]
    courses = courses_of(out, protocol, width)
    definition = study_of(slug[:_LONGEST], protocol, runs, car, courses, out, request.seed)
    return NcapPlan(protocol, runs, definition, width, out, measured)


def _protocol_name(request: NcapRequest) -> str:
    if request.protocol == "r152":
        return "r152"
    if request.protocol != "euroncap":
        raise ConfigError(f"--protocol {request.protocol}: expected euroncap or r152")
    if request.year not in YEARS:
        raise ConfigError(
            f"--year {request.year}: no protocol of that year is bundled; expected "
            f"{' or '.join(YEARS)}"
        )
    return f"euroncap-{request.year}"


def _chosen(protocol: Protocol, request: NcapRequest) -> tuple[Cell, ...]:
    names = [test.name for test in protocol.tests]
    for name in request.tests:
        if name not in names:
            raise ConfigError(
                f"--only {name}: not simulated in {protocol.title}; expected one of "
                f"{', '.join(names)}"
            )
    cells = [cell for cell in protocol.cells if cell.test.name in (request.tests or names)]
    speeds = sorted({cell.speed for cell in cells})
    for speed in request.speeds:
        if speed not in speeds:
            raise ConfigError(
                f"--speed {speed}: no speed of these tests; expected some of "
                f"{', '.join(map(str, speeds))} [km/h]"
            )
    return tuple(cell for cell in cells if cell.speed in (request.speeds or speeds))


_FIXED = ("scenario", "controller", "seed", "ego", "crowd", "metrics")
"""Settings that the protocol fixes."""


def _car(request: NcapRequest) -> dict[str, Any]:
    """Return the settings of the car, with absolute paths."""
    given: dict[str, Any] = {}
    if request.config is not None:
        given = dict(read_toml(request.config).values)
        for key in _FIXED:
            if key in given:
                raise ConfigError(
                    f"{request.config}: {key} = {given[key]!r}: the protocol fixes it; leave it out"
                )
    vehicle: dict[str, Any] = {"fmu": _placed(request.car)}
    if request.profile is not None:
        vehicle["profile"] = str(request.profile.absolute())
    return merge([Layer("config", given), Layer("car", {"vehicle": vehicle})])


def _placed(car: str) -> str:
    """Return the absolute path of an FMU, or the name of a bundled one."""
    return str(Path(car).absolute()) if Path(car).suffix else car


def courses_of(out: Path, protocol: Protocol, width: float) -> dict[str, Path]:
    """Write the roads of a protocol's tests into a study's folder.

    Returns:
        The scenario of each road, relative to the folder.

    Args:
        out: Folder of the study.
        protocol: Protocol.
        width: Width [m] of the car.
    """
    folder = out / COURSE
    found = {OPEN: write_course(folder / "open", "open", width)}
    hidden = [test for test in protocol.tests if test.parked]
    if hidden:
        half = protocol.dummy(hidden[0]).width / 2.0
        name = f"parked-{width:g}"
        found[OBSTRUCTED] = write_course(folder / name, name, width, protocol.parked, half)
    for cell in protocol.cells:
        course, turn = course_name(road_of(cell), cell.speed), cell.test.turn
        if turn is not None and course not in found:
            path, name = path_of(turn, cell.speed), course.replace(" ", "-")
            found[course] = write_course(folder / name, name, width, path=path)
    return {road: scenario.relative_to(out) for road, scenario in found.items()}


def forget_course(request: NcapRequest, out: Path) -> None:
    """Remove the roads again, and the folder, if no study has begun there."""
    if (out / MANIFEST).exists():
        return
    shutil.rmtree(out / COURSE, ignore_errors=True)
    for folder in (out, out.parent) if request.out is None else (out,):
        with suppress(OSError):  # it holds other files
            folder.rmdir()
