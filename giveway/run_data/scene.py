"""The static scene of a run: the road's outlines and the vehicles' bodies.

A results folder keeps it in ``scene.json``, so that a replay needs neither SUMO nor the scenario,
which may have been deleted by then.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from giveway.gate import finite, read_json
from giveway.geometry.kernel import Array
from giveway.run_data.road_marks import UNMARKED, RoadMarks
from giveway.run_data.way import EgoWay

SCENE_FILE = "scene.json"

Outline = tuple[tuple[float, float], ...]
Body = tuple[float, float]


@dataclass(frozen=True)
class Opaque:
    """The things that hide people from cameras.

    Attributes:
        walls: Sides (k, 5) of opaque polygons: x0, y0, x1, y1, height [m].
        heights: Heights [m] of vehicles, by their ids.
    """

    walls: Array = field(default_factory=lambda: np.empty((0, 5)))
    heights: dict[str, float] = field(default_factory=dict)

    @property
    def hides_nobody(self) -> bool:
        """True if nothing is opaque, from a single ego's place."""
        return not len(self.walls) and len(self.heights) < 2


@dataclass(frozen=True)
class Scene:
    """The road and the bodies on it.

    Attributes:
        road: Closed outlines [m] of lanes, crossings and walkingareas.
        bodies: Length and width [m] of vehicles, by their ids.
        ways: Paths of the egos on which rules of the road apply.
        marks: Crossings and stop lines.
        opaque: Things that hide people, or None if no ego has cameras.
    """

    road: tuple[Outline, ...] = ()
    bodies: dict[str, Body] | None = None
    ways: tuple[EgoWay, ...] = ()
    marks: RoadMarks = UNMARKED
    opaque: Opaque | None = None

    def body(self, vehicle: str, otherwise: Body) -> Body:
        """Return length and width [m] of a vehicle, or ``otherwise`` if they are not known."""
        return (self.bodies or {}).get(vehicle, otherwise)

    def to_json(self) -> str:
        """Return the scene as one line of JSON."""
        kept: dict[str, Any] = {"road": self.road, "bodies": self.bodies}
        kept |= self.marks.as_dict()
        if self.ways:
            kept |= {"ways": [way.as_dict() for way in self.ways]}
        if self.opaque is not None:
            walls = (np.round(self.opaque.walls, 3) + 0.0).tolist()
            kept |= {"walls": walls, "heights": self.opaque.heights}
        return json.dumps(kept, separators=(",", ":"), ensure_ascii=False) + "\n"

    @classmethod
    def read(cls, folder: Path) -> Scene:
        """Read the scene in a results folder; it is empty if the folder has none.

        Raises:
            RefusedFileError: the file is a link, too large, or not JSON.
        """
        try:
            kept = read_json(folder / SCENE_FILE)
            road = tuple(tuple((finite(x), finite(y)) for x, y in line) for line in kept["road"])
            bodies = {
                str(name): (finite(length), finite(width))
                for name, (length, width) in (kept["bodies"] or {}).items()
            }
            ways = tuple(map(EgoWay.from_dict, kept.get("ways", ())))
            marks = RoadMarks.from_dict(kept)
            opaque = _opaque(kept) if "walls" in kept else None
        except (OSError, ValueError, TypeError, KeyError, AttributeError, OverflowError):
            return cls()
        return cls(road, bodies, ways, marks, opaque)


def _opaque(kept: dict[str, Any]) -> Opaque:
    walls = np.array([[finite(value) for value in side] for side in kept["walls"]]).reshape(-1, 5)
    return Opaque(walls, {str(name): finite(top) for name, top in kept["heights"].items()})
