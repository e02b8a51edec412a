"""Parts that the pictures of a study share: colours of levels, rows with headings."""

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes

from giveway.figures.style import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SKY_BLUE,
    VERMILION,
    quiet_grid,
)

LEVEL_COLOURS = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY_BLUE)
PUBLISHED = PURPLE
ROW_HEIGHT = 0.27  # Height of a row [in]
LABEL_WIDTH = 30  # Number of characters after which a label is broken


@dataclass(frozen=True)
class Row:
    """A row of a picture: its own label, and the heading that it shares with its neighbours."""

    label: str
    heading: str = ""


def level_colours(levels: Sequence[str], baseline: str) -> dict[str, str]:
    """Return a colour per level of the compared factor, grey for the baseline."""
    others = [level for level in levels if level != baseline]
    colours = {
        level: LEVEL_COLOURS[place % len(LEVEL_COLOURS)] for place, level in enumerate(others)
    }
    return {level: colours.get(level, GREY) for level in levels}


def wrapped(label: str, width: int = LABEL_WIDTH) -> str:
    """Return a label, broken into as many lines as it needs.

    A dollar sign is escaped, since it would start a formula.
    """
    return "\n".join(textwrap.wrap(label, width)).replace("$", r"\$")


def row_places(rows: Sequence[Row]) -> tuple[list[float], list[tuple[float, str]], float]:
    """Return the positions of rows and headings, from the top (0) downwards.

    If all headings differ, rows have no headings: their names hold them.

    Returns:
        The place of each row, the places and texts of headings, and the whole height.
    """
    places: list[float] = []
    headings: list[tuple[float, str]] = []
    if not _grouped(rows):
        return [float(k) for k in range(len(rows))], [], float(len(rows))
    y, last = 0.0, None
    for row in rows:
        if row.heading != last:
            y += 0.35 if places else 0.0
            if row.heading:
                headings.append((y, row.heading))
                y += 1.0
            last = row.heading
        places.append(y)
        y += 1.0
    return places, headings, y


def _grouped(rows: Sequence[Row]) -> bool:
    headings = [row.heading for row in rows]
    return len(set(headings)) < len(headings) and any(headings)


def _names(rows: Sequence[Row]) -> list[str]:
    """Return the name of each row: its label under a heading, or the heading itself.

    If no two rows share a heading but their labels differ, the name has both.
    """
    if _grouped(rows):
        return [row.label for row in rows]
    if len({row.label for row in rows}) > 1:
        return [f"{row.heading}: {row.label}" if row.heading else row.label for row in rows]
    return [row.heading or row.label for row in rows]


def label_rows(axes: Axes, rows: Sequence[Row]) -> list[float]:
    """Name the rows at the axis, headings in bold, and return the rows' positions."""
    places, headings, height = row_places(rows)
    names = _names(rows)
    ticks = sorted(
        [(y, name, False) for y, name in zip(places, names, strict=True)]
        + [(y, heading, True) for y, heading in headings]
    )
    axes.set_yticks([y for y, _, _ in ticks], [wrapped(name) for _, name, _ in ticks])
    for label, (_, _, bold) in zip(axes.get_yticklabels(), ticks, strict=True):
        label.set_fontweight("bold" if bold else "normal")
    axes.set_ylim(height - 0.4, -0.6)
    axes.tick_params(axis="y", length=0)
    return places


def rows_height(rows: Sequence[Row]) -> float:
    """Return the height [in] that rows and their broken labels need."""
    _, _, height = row_places(rows)
    names = _names(rows)
    tallest = max((wrapped(name).count("\n") + 1 for name in names), default=1)
    return height * max(ROW_HEIGHT, 0.05 + 0.14 * tallest)


def horizontal_grid(axes: Axes) -> None:
    """Draw a grid of vertical lines only, for pictures made of rows."""
    quiet_grid(axes)
    axes.grid(visible=False, axis="y")
    axes.spines["left"].set_visible(False)
