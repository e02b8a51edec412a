"""A small recording made here: pairs of people who walk through a corridor, a second apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

RATE = 16.0
PAIRS = 30
SPEED = 1.25
DENSITY = 2.0 / (SPEED * 2.0)
FLOW = (2 * PAIRS - 1) / (PAIRS - 1.0)
DESCRIPTION = """
name = "MADE"
citation = "Nobody 2026"
frame_rate = 16.0
y_axis = "up"
[units]
length = "cm"
[vehicle]
front = 2.0
rear = 2.0
width = 1.8
[corridor]
right = [0.0, 0.0, 8.0, 0.0]
names = "walk-{width}-{exit}"
[[tables]]
files = "{name}.txt"
format = "text"
holds = "people"
header = ["id", "frame", "x", "y"]
columns = { id = "id", frame = "frame", x = "x", y = "y" }
"""


@pytest.fixture
def recorded_corridor(tmp_path: Path) -> Callable[[str], tuple[Path, Path]]:
    """Write a recording of this name, and its description, and return folder and description.

    Of 30 pairs one enters each second 4 m before the corridor of 8 m by 2 m, and leaves 2 m behind
    it. Everybody walks at 1.25 m/s, 0.5 or 1.5 m from the wall on the right.
    """

    def write(name: str) -> tuple[Path, Path]:
        folder = tmp_path / "made"
        folder.mkdir(exist_ok=True)
        description = tmp_path / "made.toml"
        description.write_text(DESCRIPTION)
        lines = []
        for person in range(2 * PAIRS):
            entered = round(RATE * (person // 2))
            for k in range(round(14.0 / SPEED * RATE)):
                x, y = -4.0 + SPEED * k / RATE, 0.5 + person % 2
                lines.append(f"{person} {entered + k} {100.0 * x:.4f} {100.0 * y:.4f}")
        (folder / f"{name}.txt").write_text("\n".join(lines) + "\n")
        return folder, description

    return write
