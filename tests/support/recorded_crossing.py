"""A small recording made here: a car that passes four people, and a parked car with one inside."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

RATE = 10.0
DESCRIPTION = """
name = "MADE"
site = "a straight street"
citation = "Nobody 2026"
frame_rate = 10.0
y_axis = "up"
[vehicle]
front = 2.2
rear = 2.2
width = 1.8
[[tables]]
files = "{name}_people.csv"
holds = "people"
columns = { id = "id", frame = "frame", x = "x", y = "y" }
[[tables]]
files = "{name}_cars.csv"
holds = "vehicles"
columns = { id = "id", frame = "frame", x = "x", y = "y" }
"""


@pytest.fixture
def recorded_crossing(tmp_path: Path) -> tuple[Path, Path]:
    """A folder with one recording of 10 s at 10 Hz, and its description.

    The car drives along y = 0 at 4 m/s, and reaches x = 0 after 5 s. ``a``, ``b`` and ``c`` stand
    beside it, at 0.73, 0.33 and 0.23 m; ``d`` crosses x = 0 at 1.5 m/s, and is on the car's axis
    after 3 s. ``e`` is inside the parked car.
    """
    folder = tmp_path / "made"
    folder.mkdir()
    description = tmp_path / "made.toml"
    description.write_text(DESCRIPTION)
    people: dict[str, Callable[[float], tuple[float, float]]] = {
        "a": lambda _t: (-4.0, 1.9),
        "b": lambda _t: (5.0, 1.5),
        "c": lambda _t: (8.0, 1.4),
        "d": lambda t: (0.0, 1.5 * (t - 3.0)),
        "e": lambda _t: (0.0, 40.0),
    }
    cars: dict[str, Callable[[float], tuple[float, float]]] = {
        "car": lambda t: (-20.0 + 4.0 * t, 0.0),
        "parked": lambda _t: (0.5, 40.0),
    }
    for name, tracks in (("people", people), ("cars", cars)):
        lines = ["id,frame,x,y"]
        for who, place in tracks.items():
            for k in range(100):
                x, y = place(k / RATE)
                lines.append(f"{who},{k},{x:.6f},{y:.6f}")
        (folder / f"street_{name}.csv").write_text("\n".join(lines) + "\n")
    return folder, description
