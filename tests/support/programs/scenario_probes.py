"""Look at a scenario through real libsumo: ``python scenario_probes.py PROBE JSON`` prints JSON.

A process of its own per look: libsumo holds one simulation per process, and a test must not
inherit another's.
"""

from __future__ import annotations

import itertools
import json
import math
import sys
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import libsumo

if TYPE_CHECKING:
    from collections.abc import Iterator

EGO_TYPE = '<vType id="ego" vClass="passenger" length="5" width="2" timeToTeleport="-1" {speed}/>'
PERSON_TYPE = '<vType id="walker" vClass="ignoring" speedDev="0"/>'
FLAGS = [
    *("--pedestrian.model", "striping", "--gui-settings-file", ""),
    *("--collision.action", "warn", "--collision.check-junctions", "true"),
    *("--random", "false"),
    *("--no-step-log", "true", "--duration-log.disable", "true"),
]
NOW = -3  # "depart now" of person.add


@contextmanager
def simulation(
    config: str, step_length: float | None, ego_speed: float | None = None, seed: int = 1
) -> Iterator[None]:
    """A running simulation, with the flags that giveway uses."""
    speed = (
        ""
        if ego_speed is None
        else f'maxSpeed="{ego_speed}" speedFactor="1" speedDev="0" sigma="0"'
    )
    types = Path("types.add.xml").absolute()
    types.write_text(f"<additional>{EGO_TYPE.format(speed=speed)}{PERSON_TYPE}</additional>")
    step = [] if step_length is None else ["--step-length", str(step_length)]
    own = map(str, sorted(Path(config).parent.glob("*.add.xml")))  # ours replace them otherwise
    command = ["sumo", "-c", config, *step, "--additional-files", ",".join([str(types), *own])]
    libsumo.start([*command, "--seed", str(seed), *FLAGS])
    try:
        yield
    finally:
        libsumo.simulationStep()  # a move that is still pending at close() is a crash
        libsumo.close()


def step_until(time: float) -> None:
    while libsumo.simulation.getTime() < time - 1e-9:
        libsumo.simulationStep()


def add_ego(ego: dict[str, Any]) -> None:
    """Have the ego on the road when this returns: SUMO inserts it in a step of its own."""
    depart = ego["depart_time"]
    libsumo.route.add("ego", ego["route"])
    libsumo.vehicle.add(
        "ego",
        "ego",
        typeID="ego",
        depart=str(depart[0] if isinstance(depart, list) else depart),
        departLane=str(ego["lane"]),
        departPos=str(ego["depart_position"]),
        departSpeed=str(ego["initial_speed"]),
    )
    while "ego" not in libsumo.vehicle.getIDList():
        libsumo.simulationStep()


def load(config: str, step_length: float | None) -> dict[str, Any]:
    with simulation(config, step_length):
        return {
            "step_length": libsumo.simulation.getDeltaT(),
            "end": libsumo.simulation.getEndTime(),
            "lanes": {
                lane: {
                    "shape": libsumo.lane.getShape(lane),
                    "width": libsumo.lane.getWidth(lane),
                    "length": libsumo.lane.getLength(lane),
                    "max_speed": libsumo.lane.getMaxSpeed(lane),
                    "pedestrians_only": libsumo.lane.getAllowed(lane) == ("pedestrian",),
                    "bans_pedestrians": "pedestrian" in libsumo.lane.getDisallowed(lane),
                }
                for lane in libsumo.lane.getIDList()
            },
        }


def drive(config: str, step_length: float | None, ego: dict[str, Any]) -> dict[str, Any]:
    """SUMO itself drives the ego at its initial speed for its travel distance."""
    with simulation(config, step_length, ego_speed=ego["initial_speed"]):
        add_ego(ego)
        start, begun = libsumo.vehicle.getDistance("ego"), libsumo.simulation.getTime()
        first = libsumo.vehicle.getPosition("ego")
        step_until(begun + ego["travel_distance"] / ego["initial_speed"])
        return {
            "first_position": first,
            "departed_at": libsumo.vehicle.getDeparture("ego"),
            "distance": libsumo.vehicle.getDistance("ego") - start,
            "position": libsumo.vehicle.getPosition("ego"),
            "speed": libsumo.vehicle.getSpeed("ego"),
            "collisions": len(libsumo.simulation.getCollisions()),
        }


def mirror_ego(config: str, step_length: float | None, ego: dict[str, Any]) -> dict[str, Any]:
    """Put the ego on points along its lane, as giveway does, and read back where SUMO has it."""
    with simulation(config, step_length):
        add_ego(ego)
        lane = f"{ego['route'][0]}_{ego['lane']}"
        spacing = ego["initial_speed"] * libsumo.simulation.getDeltaT()
        last = ego["depart_position"] + ego["travel_distance"]
        points = along(libsumo.lane.getShape(lane), ego["depart_position"], last, spacing)
        off_position, off_angle, collisions = 0.0, 0.0, 0
        for x, y, angle in points:
            libsumo.vehicle.moveToXY("ego", "", -1, x, y, angle, keepRoute=3)
            libsumo.simulationStep()
            off_position = max(off_position, math.dist((x, y), libsumo.vehicle.getPosition("ego")))
            difference = libsumo.vehicle.getAngle("ego") - angle
            off_angle = max(off_angle, abs((difference + 180.0) % 360.0 - 180.0))
            collisions += len(libsumo.simulation.getCollisions())
        return {
            "points": len(points),
            "off_position": off_position,
            "off_angle": off_angle,
            "collisions": collisions,
        }


def along(
    shape: list[tuple[float, float]], start: float, last: float, spacing: float
) -> list[tuple[float, float, float]]:
    """Points on a polyline from `start` to `last`: x, y [m], SUMO's angle [deg, 0 = north]."""
    points, passed, s = [], 0.0, start
    for (x0, y0), (x1, y1) in itertools.pairwise(shape):
        length = math.dist((x0, y0), (x1, y1))
        angle = math.degrees(math.atan2(x1 - x0, y1 - y0)) % 360.0
        while s <= min(passed + length, last):
            share = (s - passed) / length
            points.append((x0 + share * (x1 - x0), y0 + share * (y1 - y0), angle))
            s += spacing
        passed += length
    return points


def move_ghosts(config: str, step_length: float | None, crowd: dict[str, Any]) -> dict[str, Any]:
    """Spawn persons at the corners of the spawn area and walk them to their destinations."""
    x_min, y_min, x_max, y_max = crowd["spawn_area"]
    corners = [(x, y) for x in (x_min, x_max) for y in (y_min, y_max)]
    ids = [f"person.{i}" for i in range(len(corners))]
    dx, dy = crowd["walk"]
    angle = math.degrees(math.atan2(dx, dy)) % 360.0
    steps, errors = 100, []
    with simulation(config, step_length):
        libsumo.simulationStep()
        for person in ids:
            libsumo.person.add(person, crowd["host_edge"], 0.0, depart=NOW, typeID="walker")
            libsumo.person.appendWalkingStage(person, [crowd["host_edge"]], -1.0)
        for k in range(steps + 1):
            places = [(x + dx * k / steps, y + dy * k / steps) for x, y in corners]
            for person, (x, y) in zip(ids, places, strict=True):
                libsumo.person.moveToXY(person, "", x, y, angle, keepRoute=2, matchThreshold=-1)
            libsumo.simulationStep()
            seen = [libsumo.person.getPosition(person) for person in ids]
            errors.append(max(map(math.dist, seen, places)))
        for person in ids:
            libsumo.person.remove(person)
        libsumo.simulationStep()
        left = len(set(ids).intersection(libsumo.person.getIDList()))
    return {"first_error": errors[0], "largest_error": max(errors), "left": left}


def watch_traffic(config: str, step_length: float | None, seconds: float) -> dict[str, Any]:
    """Let the background traffic run alone."""
    seen: dict[str, set[str]] = {"eastbound": set(), "westbound": set()}
    arrived, teleports, collisions, slowest, most = 0, 0, 0, math.inf, 0
    trace: list[tuple[str, float]] = []
    with simulation(config, step_length):
        while libsumo.simulation.getTime() < seconds:
            libsumo.simulationStep()
            arrived += libsumo.simulation.getArrivedNumber()
            teleports += libsumo.simulation.getStartingTeleportNumber()
            collisions += len(libsumo.simulation.getCollisions())
            vehicles = libsumo.vehicle.getIDList()
            most = max(most, len(vehicles))
            for vehicle in vehicles:
                seen[libsumo.vehicle.getRoadID(vehicle)].add(vehicle)
                slowest = min(slowest, libsumo.vehicle.getSpeed(vehicle))
                trace.append((vehicle, libsumo.vehicle.getLanePosition(vehicle)))
    return {
        "departed": {edge: len(vehicles) for edge, vehicles in seen.items()},
        "arrived": arrived,
        "teleports": teleports,
        "collisions": collisions,
        "slowest": slowest,
        "most_at_once": most,
        "trace": trace,
    }


def watch_junction(config: str, step_length: float | None, seed: int) -> dict[str, Any]:
    """Let cars and people meet for two minutes: who used which crossing, under which light."""
    used: dict[str, set[str]] = {}
    cars: set[str] = set()
    on_red, departed, driven = [], [], []
    with simulation(config, step_length, seed=seed):
        signals = {
            after: index
            for index, links in enumerate(libsumo.trafficlight.getControlledLinks("centre"))
            for _, after, _ in links
            if after.startswith(":")  # people's links lead to a crossing, cars' out of the junction
        }
        crossings = [e for e in libsumo.edge.getIDList() if e.rpartition("_")[2][0] == "c"]
        where: dict[str, str] = {}
        teleports = collisions = 0
        while libsumo.simulation.getTime() < 120.0:
            libsumo.simulationStep()
            now = libsumo.simulation.getTime()
            departed += [(name, now) for name in libsumo.simulation.getDepartedPersonIDList()]
            driven += [(name, now) for name in libsumo.simulation.getDepartedIDList()]
            teleports += libsumo.simulation.getStartingTeleportNumber()
            collisions += len(libsumo.simulation.getCollisions())
            state = libsumo.trafficlight.getRedYellowGreenState("centre")  # as it was in the step
            cars |= {name.partition(".")[0] for name in libsumo.vehicle.getIDList()}
            for person in libsumo.person.getIDList():
                lane = libsumo.person.getLaneID(person)
                if lane != where.get(person) and lane.startswith(":") and "_c" in lane:
                    used.setdefault(lane[1:].rpartition("_")[0], set()).add(person)
                    if lane in signals and state[signals[lane]] == "r":
                        on_red.append(person)
                where[person] = lane
    return {
        "crossings": sorted(name[1:] for name in crossings),
        "signalised": sorted(lane[1:].rpartition("_")[0] for lane in signals),
        "used": {crossing: len(people) for crossing, people in used.items()},
        "on_red": on_red,
        "departed": departed,
        "driven": driven,
        "teleports": teleports,
        "collisions": collisions,
        "cars": sorted(cars),
    }


PROBES = {
    probe.__name__: probe
    for probe in (load, drive, mirror_ego, move_ghosts, watch_traffic, watch_junction)
}

if __name__ == "__main__":
    sys.stdout.write(json.dumps(PROBES[sys.argv[1]](**json.loads(sys.argv[2]))))
