"""What stands still in a run, or never changes: the road's outlines and the vehicles' bodies.

A results folder keeps it in ``scene.json``, so that a replay needs neither SUMO nor the scenario,
which may be gone by then.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from giveway.run_result import RunResult

    Array = NDArray[np.float64]

SCENE_FILE = "scene.json"
_AROUND = 60.0  # [m] of road kept beyond the places where somebody was
_DECIMALS = 2  # centimetres

Outline = tuple[tuple[float, float], ...]
Body = tuple[float, float]


@dataclass(frozen=True)
class Scene:
    """The road and the bodies on it.

    Attributes:
        road: closed outlines [m] of lanes, crossings and walkingareas.
        bodies: length and width [m] of vehicles, by their ids.
    """

    road: tuple[Outline, ...] = ()
    bodies: dict[str, Body] | None = None

    def body(self, vehicle: str, otherwise: Body) -> Body:
        """Length and width [m] of a vehicle, as far as they are known."""
        return (self.bodies or {}).get(vehicle, otherwise)

    def to_json(self) -> str:
        """The scene as one line of JSON."""
        return json.dumps(asdict(self), separators=(",", ":"), ensure_ascii=False) + "\n"

    @classmethod
    def read(cls, folder: Path) -> Scene:
        """The scene that a results folder keeps; an empty one where there is none."""
        try:
            kept = json.loads((folder / SCENE_FILE).read_text(encoding="utf-8"))
            road = tuple(tuple((float(x), float(y)) for x, y in line) for line in kept["road"])
            bodies = {
                str(name): (float(length), float(width))
                for name, (length, width) in (kept["bodies"] or {}).items()
            }
        except (OSError, ValueError, TypeError, KeyError, AttributeError):
            return cls()
        return cls(road, bodies)


def scene_of(result: RunResult) -> Scene:
    """What of a run's surroundings a replay shows."""
    background = result.background_track
    _, first = np.unique(background.id, return_index=True)
    bodies = {
        str(background.id[i]): (float(background.length[i]), float(background.width[i]))
        for i in first
    }
    bodies |= {ego.id: (ego.shape.length, ego.shape.width) for ego in result.egos}
    low, high = _extent(result)
    near = [
        outline
        for outline in result.road
        if (outline.max(axis=0) >= low).all() and (outline.min(axis=0) <= high).all()
    ]
    return Scene(tuple(tuple((x, y) for x, y in _rounded(outline)) for outline in near), bodies)


def _rounded(outline: Array) -> list[list[float]]:
    points: list[list[float]] = (np.round(outline, _DECIMALS) + 0.0).tolist()
    return points


def _extent(result: RunResult) -> tuple[Array, Array]:
    """The corners of where anybody was, and some room around."""
    tracks = [(result.crowd_track.x, result.crowd_track.y)]
    tracks += [(result.background_track.x, result.background_track.y)]
    tracks += [(ego.track.front_x, ego.track.front_y) for ego in result.egos]
    x = np.concatenate([x for x, _ in tracks])
    y = np.concatenate([y for _, y in tracks])
    if not x.size:
        return np.full(2, -np.inf), np.full(2, np.inf)
    return np.array((x.min(), y.min())) - _AROUND, np.array((x.max(), y.max())) + _AROUND
