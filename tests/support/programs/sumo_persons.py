"""Look at SUMO's people through real libsumo: ``python sumo_persons.py LOOK JSON``, prints JSON."""

from __future__ import annotations

import json
import math
import random
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import libsumo

from giveway.sumo.persons.scenario_persons import Arrival, Person, ScenarioPersons

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

FLAGS = ["--pedestrian.model", "striping", "--no-step-log", "true", "--no-warnings", "true"]
PERSON = libsumo.person


@contextmanager
def simulation(command: list[str], ours: Sequence[str] = ()) -> Iterator[ScenarioPersons]:
    libsumo.start(["sumo", *command, *FLAGS, "--duration-log.disable", "true"])
    try:
        yield ScenarioPersons(libsumo, ours)
    finally:
        libsumo.simulationStep()  # a move that is still pending at close() is a crash
        libsumo.close()


def step(walkers: ScenarioPersons, places: dict[str, tuple[float, float]] | None = None) -> None:
    """One SUMO step with the held persons at their ``places``."""
    for name, (x, y) in (places or {}).items():
        PERSON.moveToXY(name, "", x, y, 0.0, keepRoute=2, matchThreshold=-1)
    libsumo.simulationStep()
    walkers.positions()


def wait_until(walkers: ScenarioPersons, time: float) -> None:
    while libsumo.simulation.getTime() < time:
        step(walkers)


def hold(walkers: ScenarioPersons, walker: Person, steps: int = 5) -> None:
    for _ in range(steps):
        step(walkers, {walker.id: (walker.x, walker.y)})


def take(command: list[str], time: float, name: str = "a") -> Any:
    """What take() tells of a person at a time; None if it does not walk."""
    with simulation(command) as walkers:
        wait_until(walkers, time)
        return described(walkers.take([name]))


def described(taken: list[Person]) -> dict[str, Any] | None:
    if not taken:
        return None
    walker = taken[0]
    return {name: getattr(walker, name) for name in Person.__slots__}


def hand_back(
    command: list[str], place: tuple[str, float], time: float = 0.0, lane: str = ""
) -> Any:
    """Take `a` at a time, or when it is on a lane; hand it back at a place; see it walk on."""
    with simulation(command) as walkers:
        wait_until(walkers, time)
        while lane and PERSON.getLaneID("a") != lane:
            step(walkers)
        walker = walkers.take(["a"])[0]
        hold(walkers, walker)
        x, y = libsumo.simulation.convert2D(place[0], place[1], 0)
        handed_back = walkers.hand_back("a", x, y, place[0])
        there = PERSON.getPosition("a")
        seen = {
            "handed_back": handed_back,
            "jump": math.dist(there, (x, y)),
            "type": PERSON.getTypeID("a"),
            "color": PERSON.getColor("a"),
            "home": PERSON.getParameter("a", "home"),
            "stages": [
                [s.type, s.edges[-1], s.arrivalPos, s.description, s.destStop]
                for s in (PERSON.getStage("a", i) for i in range(PERSON.getRemainingStages("a")))
            ],
            "held": sorted(walkers.held),
            "counts": walkers.counts,
        }
        speeds, last = [], there
        before = PERSON.getRemainingStages("a")
        while "a" in PERSON.getIDList() and PERSON.getRemainingStages("a") == before:
            last = PERSON.getPosition("a")
            step(walkers)
            if "a" in PERSON.getIDList():
                speeds.append(PERSON.getSpeed("a"))
        while PERSON.getIDCount():
            step(walkers)
        return seen | {"fastest": max(speeds[1:-1]), "end": last}


def refuse(command: list[str], places: list[tuple[float, float, str]]) -> Any:
    """Try to hand `a` back at impossible places, then go on holding it."""
    with simulation(command) as walkers:
        wait_until(walkers, 5.0)
        walker = walkers.take(["a"])[0]
        hold(walkers, walker)
        answers = [walkers.hand_back("a", x, y, edge) for x, y, edge in places]
        hold(walkers, walker)
        return {
            "answers": answers,
            "held": sorted(walkers.held),
            "there": PERSON.getPosition("a") == (walker.x, walker.y),
        }


def arrive(command: list[str], time: float, seconds: float) -> Any:
    """Take `a`, let it arrive at its walk's end at once, and see what it does then."""
    with simulation(command) as walkers:
        wait_until(walkers, time)
        hold(walkers, walkers.take(["a"])[0])
        arrival = walkers.arrive("a")
        stages = []
        begin = libsumo.simulation.getTime()
        while libsumo.simulation.getTime() < begin + seconds:
            step(walkers)
            there = "a" in PERSON.getIDList()
            stages.append(PERSON.getStage("a").type if there else None)
        return {
            "arrived": arrival is Arrival.ARRIVED,
            "stages": stages,
            "again": described(walkers.take(["a"])),
            "counts": walkers.counts,
        }


def cars_past(command: list[str], lane: str, seconds: float) -> Any:
    """How many cars arrive while `a`, taken over on ``lane``, is held far away."""
    with simulation(command) as walkers:
        cars = 0
        while PERSON.getLaneID("a") != lane:
            step(walkers)
        walkers.take(["a"])
        while libsumo.simulation.getTime() < seconds:
            step(walkers, {"a": (500.0, 500.0)})
            cars += libsumo.simulation.getArrivedNumber()
        return {"cars": cars}


def followers(command: list[str], taken: bool) -> Any:
    """Where SUMO's own people walk past the spot where `a` was taken over."""
    with simulation(command) as walkers:
        wait_until(walkers, 10.0)
        if taken:
            walkers.take(["a"])
        lateral = []
        while libsumo.simulation.getTime() < 100.0:
            step(walkers, {"a": (500.0, 500.0)} if taken else None)
            if not taken and libsumo.simulation.getTime() == 10.5:
                PERSON.removeStages("a")  # as if it had never been there
            for name in set(PERSON.getIDList()) - {"a"}:
                lateral.append(round(PERSON.getPosition(name)[1], 2))
        return sorted(set(lateral))


def untouched(command: list[str], asked: bool, seconds: float, fcd: str) -> Any:
    """Write SUMO's FCD output, asking for positions in every step or not at all."""
    with simulation([*command, "--fcd-output", fcd]) as walkers:
        most = 0
        while libsumo.simulation.getTime() < seconds:
            libsumo.simulationStep()
            if asked:
                ids, places = walkers.positions()
                assert places.shape == (len(ids), 2)
                assert set(ids) == set(PERSON.getIDList())
                most = max(most, len(ids))
        return {"most": most}


def vehicles(command: list[str], holding: bool, seconds: float) -> Any:
    """Where the cars are, while people are taken over and handed back at random, or not."""
    chance, seen = random.Random(3), []
    with simulation(command) as walkers:
        while libsumo.simulation.getTime() < seconds:
            if holding:
                ids, _ = walkers.positions()
                walkers.take([name for name in ids if chance.random() < 0.05])
                for name in sorted(walkers.held):
                    if chance.random() < 0.05:
                        edge = PERSON.getEdges(name)[0]
                        walkers.hand_back(name, *libsumo.simulation.convert2D(edge, 5.0), edge)
            step(walkers, dict.fromkeys(sorted(walkers.held), (50.0, 50.0)))
            seen.append({v: libsumo.vehicle.getPosition(v) for v in libsumo.vehicle.getIDList()})
        return {"cars": seen, "counts": walkers.counts}


def roam(command: list[str], radius: float, seconds: float) -> Any:
    """A zone that moves about the city: who is in it is ours, who leaves it is SUMO's.

    Each held person goes straight from edge to edge of its walk.
    """
    at: dict[str, tuple[float, float]] = {}
    goals: dict[str, list[tuple[float, float]]] = {}
    plans: dict[str, Person] = {}
    arrived: list[str] = []
    wrong, worst, farthest = 0, 0.0, 0.0
    with simulation(command) as walkers:
        time_step = libsumo.simulation.getDeltaT()
        while (time := libsumo.simulation.getTime()) < seconds or PERSON.getIDCount():
            roaming = time < seconds
            centre = 150 + 150 * math.sin(time / 23), 150 + 150 * math.sin(time / 31 + 1)
            ids, places = walkers.positions()
            wrong += len(set(ids) & walkers.held) + len(ids) - len(set(ids))
            near = [i for i, p in zip(ids, places, strict=True) if math.dist(p, centre) < radius]
            for walker in walkers.take(near if roaming else []):
                at[walker.id], plans[walker.id] = (walker.x, walker.y), walker
                goals[walker.id] = [middle(edge) for edge in walker.edges[1:-1]]
                last = walker.edges[-1], walker.arrival_position
                goals[walker.id].append(libsumo.simulation.convert2D(*last, 0))
            for name in sorted(walkers.held):
                at[name] = towards(at[name], goals[name], plans[name].desired_speed * time_step)
                if not goals[name]:
                    walkers.arrive(name)
                elif not roaming or math.dist(at[name], centre) > radius:
                    edge, *_ = libsumo.simulation.convertRoad(*at[name], False, "pedestrian")
                    if walkers.hand_back(name, *at[name], edge):  # else it is not near enough
                        farthest = max(farthest, math.dist(PERSON.getPosition(name), at[name]))
            held = {name: at[name] for name in sorted(walkers.held)}
            step(walkers, held)
            worst = max([worst, *(math.dist(PERSON.getPosition(n), p) for n, p in held.items())])
            arrived += libsumo.simulation.getArrivedPersonIDList()
            assert time < seconds + 2000.0, f"frozen: {PERSON.getIDList()}"
        return {
            "counts": walkers.counts,
            "held": len(walkers.held),
            "arrived": arrived,
            "wrong": wrong,
            "off": worst,
            "jump": farthest,
        }


def middle(edge: str) -> tuple[float, float]:
    x, y = libsumo.simulation.convert2D(edge, libsumo.lane.getLength(f"{edge}_0") / 2, 0)
    return x, y


def towards(
    place: tuple[float, float], goals: list[tuple[float, float]], distance: float
) -> tuple[float, float]:
    """``distance`` [m] on towards the first of ``goals``, which is dropped when it is reached."""
    (x, y), (goal_x, goal_y) = place, goals[0]
    left = math.dist(place, goals[0])
    if left <= distance:
        return goals.pop(0)
    return x + (goal_x - x) / left * distance, y + (goal_y - y) / left * distance


def ours(command: list[str]) -> Any:
    """Persons that giveway added are nobody's business here."""
    with simulation(command, ours=["a"]) as walkers:
        wait_until(walkers, 5.0)
        return {"ids": walkers.positions()[0], "taken": described(walkers.take(["a"]))}


LOOKS = (take, hand_back, refuse, arrive, cars_past, followers, untouched, vehicles, roam, ours)

if __name__ == "__main__":
    look = {function.__name__: function for function in LOOKS}[sys.argv[1]]
    sys.stdout.write(json.dumps(look(**json.loads(sys.argv[2]))))
