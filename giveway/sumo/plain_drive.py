"""The drive of plain SUMO: the ego's vehicle with SUMO's own driver, in a process of its own.

A crash or a hang of that process costs its numbers only. The scenario runs as its author left it,
and its outputs go to a scratch folder. A drive is kept in the user's cache under a digest of all
that it depends on: the scenario's files, SUMO's command and version, the vehicle and its trip. The
newest thousand are kept. The child runs :func:`main`.
"""

import hashlib
import json
import math
import os
import subprocess
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway._cache_folder import cache_folder, forget_oldest
from giveway.processes import interpreter
from giveway.processes.child import die_with
from giveway.scenario_files import ScenarioFiles, StartOptions, prepare_start
from giveway.sumo.first_reading import digest_of
from giveway.sumo.library import import_bare_libsumo
from giveway.sumo.scratch import scratch

AT_LIMIT: Final = 1.0
"""SUMO's speed factor of a driver who drives at the lanes' limits."""

LONGEST: Final = 3600.0
"""Longest drive [s] that is waited for."""

Array = NDArray[np.float64]

_CHILD: Final = "from giveway.sumo.plain_drive import main; main(arguments)"
_FILES: Final = ("as_is.npz", "at_limit.npz")
_VERSION: Final = "1"  # Version of what is kept
_SIGHT: Final = 100.0  # Distance [m] within which a leader is noted


@dataclass(frozen=True)
class Trip:
    """A vehicle, and its trip.

    Attributes:
        vehicle: SUMO's id of the vehicle.
        serves: Vehicle classes of SUMO that halt at their scheduled stops.
        route: Edges of a vehicle that is to be inserted; empty if the scenario has the vehicle.
        kind: Type of a vehicle that is to be inserted.
        lane: Index of its departure lane, or "first" for the first one that it may use.
        depart: Time [s] of its departure on SUMO's clock.
        position: Position [m] on the first edge at its departure.
        speed: Speed [m/s] at its departure, reduced to the lane's limit.
    """

    vehicle: str
    serves: tuple[str, ...] = ()
    route: tuple[str, ...] = ()
    kind: str = ""
    lane: str = "first"
    depart: float = 0.0
    position: float = 0.0
    speed: float = 0.0


class PlainDrive(NamedTuple):
    """A drive of plain SUMO, from the vehicle's departure on; each column has the shape (n,)."""

    time: Array  # [s] SUMO's clock after each step
    x: Array  # [m] middle of the front bumper
    y: Array  # [m]
    speed: Array  # [m/s]
    position: Array  # [m] distance driven since the departure
    vehicle_gap: Array  # [m] gap to the leader; inf without one
    arrived: bool  # True if it reached the end of its route in the step after the last row
    teleported: float  # [s] time at which SUMO teleported it; nan: never
    speed_factor: float  # speed factor of its driver

    @property
    def step(self) -> float:
        """SUMO's step [s]."""
        return float(self.time[1] - self.time[0]) if len(self.time) > 1 else 0.0


class PlainDrives(NamedTuple):
    """The drives of plain SUMO for one trip; None where there is none."""

    as_is: PlainDrive | None  # with the driver's own speed factor
    at_limit: PlainDrive | None  # with a speed factor of 1 from the departure on


def plain_drives(
    scenario: ScenarioFiles,
    options: StartOptions,
    trip: Trip,
    types: str,
    *,
    patience: float = 600.0,
) -> PlainDrives:
    """Return the drives of plain SUMO.

    Args:
        scenario: Files of the scenario.
        options: Settings for SUMO, of which seed, step and further options count.
        trip: Vehicle and trip.
        types: Text of an additional file with the vehicle's type.
        patience: Wall-clock limit [s] of the process.
    """
    options = replace(options, interact=False, outputs=None, written=())
    folder = scratch()
    try:
        place = Path(folder.name)
        start = prepare_start(scenario, options, place, types=types)
        asked = json.dumps([start.command, asdict(trip)])
        depends = asked.replace(str(place), "") + types + _VERSION
        key = hashlib.sha256(depends.encode())
        key.update(digest_of(scenario.config_file, start.read).encode())
        kept = cache_folder() / "plain_drives" / key.hexdigest()
        found = _read(kept)
        if found is None:
            _let_drive([asked, str(place), os.getpid()], patience)
            found = _read(place)
            if found is not None:
                _keep(place, kept)
        return found or PlainDrives(None, None)
    finally:
        with suppress(OSError):
            folder.cleanup()


def _keep(made: Path, kept: Path) -> None:
    """Copy the drives into the cache; without it SUMO drives again, which is slow but not wrong."""
    beside = kept.with_name(f"{kept.name}.{os.getpid()}")
    with suppress(OSError):
        beside.mkdir(parents=True)
        for name in _FILES:
            (beside / name).write_bytes((made / name).read_bytes())
        beside.replace(kept)
    forget_oldest(kept.parent)


def _let_drive(arguments: Sequence[str | float], patience: float) -> None:
    """Run the child; nothing is reported if it fails, since its files are then missing."""
    with suppress(OSError, subprocess.TimeoutExpired):
        subprocess.run(
            interpreter.command(_CHILD, arguments),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            check=False,
            timeout=patience,
        )


def _read(folder: Path) -> PlainDrives | None:
    """Return the drives in a folder, or None if the first one is missing."""
    as_is, at_limit = (_read_one(folder / name) for name in _FILES)
    return None if as_is is None else PlainDrives(as_is, at_limit)


def _read_one(file: Path) -> PlainDrive | None:
    try:
        with np.load(file, allow_pickle=False) as kept:
            arrived, teleported, factor = kept["end"].tolist()
            time, x, y, speed, position, gap = kept["rows"].T
            end = bool(arrived), teleported, factor
            return PlainDrive(time, x, y, speed, position, gap, *end)
    except (OSError, ValueError, KeyError, EOFError):
        return None


def main(arguments: Sequence[Any]) -> None:
    """Let SUMO drive, and write the drives into files.

    Args:
        arguments: Command and trip as JSON, the folder for the files, and the parent's process id.
    """
    asked, folder, parent = arguments
    die_with(parent)
    command, fields = json.loads(asked)
    sumo = import_bare_libsumo()
    for name, factor in zip(_FILES, (None, AT_LIMIT), strict=True):
        sumo.start(command)
        rows, end = _driven(sumo, Trip(**fields), factor)
        if not rows:
            break
        np.savez_compressed(Path(folder) / name, rows=np.array(rows), end=np.array(end))
        if end[-1] == AT_LIMIT:  # the second drive would be the same
            (Path(folder) / _FILES[1]).write_bytes((Path(folder) / name).read_bytes())
            break
        sumo.close()
    os._exit(0)  # skips the destructors of native code


def _driven(
    sumo: Any, trip: Trip, speed_factor: float | None
) -> tuple[list[tuple[float, ...]], tuple[float, ...]]:
    """Return the rows of the drive, and how it ended."""
    simulation, vehicle, name = sumo.simulation, sumo.vehicle, trip.vehicle
    end = simulation.getEndTime()
    end = math.inf if end < 0.0 else end
    waiting = bool(trip.route)
    while name not in simulation.getDepartedIDList():
        now = simulation.getTime()
        if waiting and now >= trip.depart - 1e-9:
            _insert(sumo, trip)
            waiting = False
        if now >= end or not (waiting or simulation.getMinExpectedNumber()):
            return [], ()
        simulation.step()
    if speed_factor is not None:
        vehicle.setSpeedFactor(name, speed_factor)
    if vehicle.getVehicleClass(name) not in trip.serves:
        for _ in vehicle.getStops(name):
            vehicle.replaceStop(name, 0, "")
    factor, least = vehicle.getSpeedFactor(name), vehicle.getMinGap(name)
    begin, end = vehicle.getDistance(name), min(end, simulation.getTime() + LONGEST)
    rows: list[tuple[float, ...]] = []
    while True:
        leader = vehicle.getLeader(name, _SIGHT)
        gap = leader[1] + least if leader and leader[0] else math.inf
        driven = vehicle.getDistance(name) - begin
        place = vehicle.getPosition(name)
        rows.append((simulation.getTime(), *place, vehicle.getSpeed(name), driven, gap))
        if simulation.getTime() >= end:
            return rows, (False, math.nan, factor)
        simulation.step()
        if name in simulation.getStartingTeleportIDList():
            return rows, (False, simulation.getTime(), factor)
        if name not in vehicle.getIDList():
            arrived = name in simulation.getArrivedIDList()
            return rows, (arrived, math.nan, factor)


def _insert(sumo: Any, trip: Trip) -> None:
    """Let the vehicle depart with the next step, or as soon as SUMO finds room for it."""
    number = trip.lane if trip.lane.isdigit() else "0"
    lane = f"{trip.route[0]}_{number}"  # all lanes of an edge are equally long
    sumo.route.add(f"giveway_route_{trip.vehicle}", list(trip.route))
    sumo.vehicle.add(
        trip.vehicle,
        f"giveway_route_{trip.vehicle}",
        typeID=trip.kind,
        depart="now",
        departLane=trip.lane,
        departPos=f"{min(trip.position, sumo.lane.getLength(lane)):.3f}",
        departSpeed=f"{min(trip.speed, sumo.lane.getMaxSpeed(lane)):.3f}",
    )
