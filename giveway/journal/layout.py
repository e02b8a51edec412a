"""The tables of a run's journal and their columns, by name; the order is that in a row."""

from dataclasses import fields

from giveway.run_data.columns import quantities_of
from giveway.run_data.rows import LEDGER
from giveway.run_data.tracks import (
    BackgroundTrack,
    EgoRow,
    PeopleTrack,
    SightTrack,
    SignalTrack,
    Timings,
)

_EGO = quantities_of(EgoRow)
EGO_TEXTS = tuple(name for name, (kind, _) in _EGO.items() if kind == "string")
"""Columns of an ego's row that are texts: a row holds their indices in the table of words."""
EGO_NUMBERS = tuple(name for name, (kind, _) in _EGO.items() if kind != "string")
"""All other columns of an ego's row."""
EGO_COUNTS = frozenset(name for name, (kind, _) in _EGO.items() if kind == "integer")
"""The columns among them that are whole numbers."""


def _names(track: type) -> tuple[str, ...]:
    return tuple(field.name for field in fields(track))


ROWS: dict[str, tuple[str, ...]] = {
    "clock": ("time",),
    "ego": ("step", "ego", *EGO_NUMBERS, *EGO_TEXTS),
    "crowd": ("step", "pedestrian", "x", "y", "vx", "vy"),
    "background": _names(BackgroundTrack),
    "timing": Timings.NAMES,
    "drives": ("ego", "length", "width", "goal"),
    "ledger": LEDGER,
    "predictions": ("step", "ego", "pedestrian", "look_ahead", "x", "y"),
    "signals": _names(SignalTrack),
    "people": _names(PeopleTrack),
    "sights": _names(SightTrack),
    "hasty": ("ego", "pedestrian"),
    "reacting": ("step", "pedestrian", "reacts"),
    "outputs": ("step", "output", "value"),
}
"""Columns of each table of rows; a text is given by its index in a table of names."""
STORED = "crowd"
"""The longest table, whose rows leave the memory."""
NAMES = ("ways", "outputs", "words", "egos", "pedestrians", "traits", "vehicles")
"""The tables of names. Ways, outputs and traits are JSON texts."""
