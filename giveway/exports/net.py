"""The parts of a SUMO network for exports: the lanes of normal edges, and the projection."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely

from giveway.errors import ResultsError, ScenarioError
from giveway.geometry.kernel import Array
from giveway.replays.run_folder import RunFolder
from giveway.scenario_files import read_scenario
from giveway.scenario_files.network import read_network
from sumo_scenarios import ScenarioError as MissingScenarioError
from sumo_scenarios import find

_INTERNAL = ":"  # beginning of SUMO's ids inside junctions


@dataclass(frozen=True)
class Place:
    """A position on a lane."""

    edge: str
    lane: str
    position: float  # [m] distance from the lane's beginning
    distance: float  # [m] distance from its middle


class Net:
    """The normal lanes of a network, and its projection.

    Attributes:
        file: File of the network.
        offset: Offset (2,) [m] that netconvert has added to projected coordinates.
        projection: Parameters of PROJ, or "!" without a projection.
    """

    def __init__(self, file: Path) -> None:
        self.file = file
        self.offset: Array = np.zeros(2)
        self.projection = "!"
        self._edge = ""
        self._lanes: list[tuple[str, str, float, shapely.LineString]] = []
        handlers = {"location": self._location, "edge": self._begin, "lane": self._lane}
        read_network(file, handlers)
        self._tree = shapely.STRtree([line for *_, line in self._lanes])

    @classmethod
    def of(cls, run: RunFolder) -> Net:
        """Return the network of a run's scenario.

        Raises:
            GivewayError: the scenario no longer exists, or its network cannot be read.
        """
        try:
            scenario = find(run.config.scenario)
        except MissingScenarioError as error:
            raise ScenarioError(
                f"{run.path}: its network is needed, but {error}; put the scenario back"
            ) from error
        return cls(read_scenario(scenario.config_file).net_file)

    def _location(self, attributes: dict[str, str]) -> None:
        x, y = attributes["netOffset"].split(",")
        self.offset = np.array([float(x), float(y)])
        self.projection = attributes.get("projParameter", "!")

    def _begin(self, attributes: dict[str, str]) -> None:
        self._edge = attributes["id"]

    def _lane(self, attributes: dict[str, str]) -> None:
        if self._edge.startswith(_INTERNAL):
            return
        points = [tuple(map(float, point.split(",")[:2])) for point in attributes["shape"].split()]
        line = shapely.LineString(points)
        self._lanes.append((self._edge, attributes["id"], float(attributes["length"]), line))

    def nearest(self, x: Array, y: Array) -> list[Place]:
        """Return the nearest lane of a normal edge for each point [m].

        Raises:
            ResultsError: the network has no such lane.
        """
        if not self._lanes:
            raise ResultsError(f"{self.file}: no edge in it but those of junctions")
        points = shapely.points(x, y)
        _, found = self._tree.query_nearest(points, all_matches=False)
        return [self.place(int(k), point) for k, point in zip(found, points, strict=True)]

    def place(self, k: int, point: shapely.Point) -> Place:
        """Return the position on the k-th lane that is nearest to a point [m]."""
        edge, lane, length, line = self._lanes[k]
        along = min(line.project(point) * length / max(line.length, 1e-9), length)
        return Place(edge, lane, along, line.distance(point))
