"""The vehicles, routes and places of a scenario that meet people, counted while SUMO runs it."""

from collections import defaultdict
from collections.abc import Mapping
from typing import Any

import numpy as np

from giveway.sumo.types import ROAD_CLASSES

_MEETING = 10.0  # Largest distance [m] between a moving vehicle's front and a pedestrian it meets
_MOVING = 0.5  # Speed [m/s] above which a vehicle moves
_PERIOD = 1.0  # Time [s] between two counts
_CELL = 100.0  # Side [m] of the squares of the ranking
_SHOWN = 3
_EDGES = 12  # Largest number of edges shown of a route


class Encounters:
    """Counts, once a second, the pedestrians within 10 m of a moving road vehicle.

    Args:
        sumo: The libsumo module, while a simulation runs.
    """

    def __init__(self, sumo: Any) -> None:
        self._sumo = sumo
        self._looked = -np.inf
        self._met: defaultdict[str, set[str]] = defaultdict(set)  # people that each vehicle met
        self._places: defaultdict[tuple[int, int], set[tuple[str, str]]] = defaultdict(set)
        self._departures: dict[str, tuple[float, tuple[str, ...]]] = {}

    def departed(self, name: str, kind: str, route: tuple[str, ...]) -> None:
        """Note a vehicle of SUMO's class ``kind`` that departs."""
        if kind in ROAD_CLASSES:
            self._departures[name] = float(self._sumo.simulation.getTime()), route

    def look(self) -> None:
        """Count the present encounters, if a second has passed since the last count."""
        now = float(self._sumo.simulation.getTime())
        people = self._sumo.person.getIDList()
        if now < self._looked + _PERIOD or not people:
            return
        self._looked = now
        vehicle, person = self._sumo.vehicle, self._sumo.person
        moving = [
            name
            for name in vehicle.getIDList()
            if name in self._departures and vehicle.getSpeed(name) > _MOVING
        ]
        places = np.array([person.getPosition(name) for name in people])
        for name in moving:
            x, y = vehicle.getPosition(name)
            near = np.flatnonzero(np.hypot(places[:, 0] - x, places[:, 1] - y) <= _MEETING)
            for i in near:
                if not person.getVehicle(people[i]):
                    self._met[name].add(people[i])
                    cell = int(x // _CELL), int(y // _CELL)
                    self._places[cell].add((name, people[i]))

    @property
    def ranking(self) -> Mapping[str, Any]:
        """Return the vehicles, routes and squares with most encounters, as JSON values.

        ``egos``: id, departure [s], people. ``routes``: edges, departure [s] of the route's vehicle
        that meets most people, people per vehicle. ``zones``: x_min, y_min, x_max, y_max [m],
        encounters, and the vehicle that meets most people in the square.
        """
        egos = sorted(self._met, key=lambda name: (-len(self._met[name]), name))
        of_route: defaultdict[tuple[str, ...], list[str]] = defaultdict(list)
        for name, (_, route) in self._departures.items():
            of_route[route].append(name)
        mean = {
            route: sum(len(self._met[name]) for name in names if name in self._met) / len(names)
            for route, names in of_route.items()
        }
        routes = sorted((route for route in mean if mean[route] > 0.0), key=lambda r: (-mean[r], r))
        cells = sorted(self._places, key=lambda cell: (-len(self._places[cell]), cell))
        return {
            "egos": [
                [name, self._departures[name][0], len(self._met[name])] for name in egos[:_SHOWN]
            ],
            "routes": [
                [
                    list(route[:_EDGES]),
                    self._departures[self._best(of_route[route])][0],
                    mean[route],
                ]
                for route in routes[:_SHOWN]
            ],
            "zones": [
                [*_corners(cell), len(self._places[cell]), self._best_in(cell)]
                for cell in cells[:_SHOWN]
            ],
        }

    def _best(self, names: list[str]) -> str:
        return max(sorted(names), key=lambda name: len(self._met.get(name, ())))

    def _best_in(self, cell: tuple[int, int]) -> str:
        names = [vehicle for vehicle, _ in self._places[cell]]
        return max(sorted(set(names)), key=names.count)


def _corners(cell: tuple[int, int]) -> tuple[float, float, float, float]:
    x, y = cell[0] * _CELL, cell[1] * _CELL
    return x, y, x + _CELL, y + _CELL
