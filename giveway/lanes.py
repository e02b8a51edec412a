"""The lanes of the loaded network: the polyline of a route, and what there is to draw."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from giveway.errors import ScenarioError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray


class Lanes:
    """What libsumo knows of lanes while a simulation runs.

    Args:
        sumo: the libsumo module, as ``SumoSession`` owns it.
        config_file: the scenario, for messages.
    """

    def __init__(self, sumo: Any, config_file: Path) -> None:
        self._sumo = sumo
        self._config_file = config_file

    def along(self, edges: Sequence[str], lane: int) -> list[tuple[float, float]]:
        """The polyline of the lanes along ``edges``, junctions included.

        Raises:
            ScenarioError: an edge or lane does not exist, or the lanes do not connect.
        """
        known = set(self._sumo.edge.getIDList())
        for edge in edges:
            if edge not in known:
                msg = f"{self._config_file}: ego route: no edge '{edge}' in the network"
                raise ScenarioError(msg)
        lanes = int(self._sumo.edge.getLaneNumber(edges[0]))
        if lane >= lanes:
            msg = (
                f"{self._config_file}: ego lane {lane}: edge '{edges[0]}' has {lanes} lane(s); "
                f"expected 0 to {lanes - 1}"
            )
            raise ScenarioError(msg)
        current = f"{edges[0]}_{lane}"
        drivable = [i for i in range(lanes) if self._admits_cars(f"{edges[0]}_{i}")]
        if lane not in drivable:
            msg = (
                f"{self._config_file}: ego lane {lane}: lane '{current}' is not for cars; "
                f"expected one of {drivable or 'no lane of this edge'}, name it with --ego-lane"
            )
            raise ScenarioError(msg)
        points = list(self._sumo.lane.getShape(current))
        for following in edges[1:]:
            current, via = self._next_lane(current, following)
            for lane_id in (*via, current):
                points.extend(self._sumo.lane.getShape(lane_id))
        return points

    def _admits_cars(self, lane: str) -> bool:
        allowed = self._sumo.lane.getAllowed(lane)
        disallowed = self._sumo.lane.getDisallowed(lane)
        return (not allowed or "passenger" in allowed) and "passenger" not in disallowed

    def _next_lane(self, lane: str, edge: str) -> tuple[str, list[str]]:
        """The lane of ``edge`` that ``lane`` leads to, and the junction's lanes between them."""
        for link in self._sumo.lane.getLinks(lane):
            target, inside = link[0], link[4]
            if self._sumo.lane.getEdgeID(target) != edge:
                continue
            via = []
            while inside:
                via.append(inside)
                onwards = self._sumo.lane.getLinks(inside)
                inside = onwards[0][4] if onwards else ""
            return target, via
        msg = (
            f"{self._config_file}: ego route: lane '{lane}' has no connection to edge '{edge}'; "
            "choose another lane or route"
        )
        raise ScenarioError(msg)

    def areas(self) -> list[tuple[NDArray[np.float64], float]]:
        """Centre line (k, 2) [m] and width [m] of every lane outside of junctions."""
        lane = self._sumo.lane
        names = [name for name in lane.getIDList() if not name.startswith(":")]
        return [(np.array(lane.getShape(name)), float(lane.getWidth(name))) for name in names]
