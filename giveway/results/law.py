"""The rows of a run that show how each ego kept the law of the road, and remarks on them."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from giveway.geometry.kernel import Array
from giveway.journal.recorded import RecordedEgo
from giveway.metrics.law import Event, count
from giveway.run_data.columns import LEDGER_COLUMNS, PEOPLE_COLUMNS, SIGNAL_COLUMNS
from giveway.run_data.tracks import BackgroundTrack, PeopleTrack, SignalTrack
from giveway.run_data.way import EgoWay

if TYPE_CHECKING:
    import pandas as pd


class LawRows(NamedTuple):
    """The rows from which a drive is judged, besides the tracks of the ego and of the crowd."""

    way: EgoWay
    signals: SignalTrack
    people: PeopleTrack  # counted from the ego's first instant
    vehicles: BackgroundTrack  # all other vehicles, egos among them


def people_from(people: PeopleTrack, first: int) -> PeopleTrack:
    """Return the records, counted from the control instant ``first`` on."""
    return PeopleTrack(
        people.step - first, people.pedestrian, people.desired_speed, people.x, people.y
    )


def others_of(
    ego: RecordedEgo, egos: Sequence[RecordedEgo], background: BackgroundTrack
) -> BackgroundTrack:
    """Return all vehicles except one ego, in order of time."""
    more = [_as_background(other) for other in egos if other.id != ego.id]
    if not more:
        return background
    parts = [background, *more]
    columns = {
        name: np.concatenate([getattr(part, name) for part in parts])
        for name in BackgroundTrack.__dataclass_fields__
    }
    order = np.argsort(columns["time"], kind="stable")
    return BackgroundTrack(**{name: column[order] for name, column in columns.items()})


def _as_background(ego: RecordedEgo) -> BackgroundTrack:
    track, count_ = ego.track, len(ego.track.time)
    return BackgroundTrack(
        time=track.time,
        id=np.full(count_, ego.id),
        type=np.full(count_, "ego"),
        x=track.front_x,
        y=track.front_y,
        heading=track.heading,
        speed=track.speed,
        length=np.full(count_, ego.shape.length),
        width=np.full(count_, ego.shape.width),
    )


def ledger_table(events: Sequence[tuple[str, Event]]) -> "pd.DataFrame":
    """Return ``ledger.csv``: one row per event.

    Args:
        events: Events, each with the id of its ego.
    """
    import pandas as pd

    rows = [{"ego": ego} | asdict(event) for ego, event in events]
    table = pd.DataFrame(rows, columns=[column.name for column in LEDGER_COLUMNS])
    return table.sort_values("time", kind="stable", ignore_index=True)


def signal_table(track: SignalTrack) -> "pd.DataFrame":
    """Return ``signals.csv``: the changes of traffic lights."""
    import pandas as pd

    names = [column.name for column in SIGNAL_COLUMNS]
    columns = {"time": track.time, "system": track.system, "state": track.state}
    return pd.DataFrame(columns)[names]


def people_table(time: Array, track: PeopleTrack, ids: Sequence[str]) -> "pd.DataFrame":
    """Return ``people.csv``: the planned routes and desired speeds of people."""
    import pandas as pd

    names = [column.name for column in PEOPLE_COLUMNS]
    another = np.diff(track.pedestrian, prepend=-1) != 0
    another[1:] |= np.diff(track.step) != 0
    begins = np.flatnonzero(another)
    number = np.arange(len(track.step)) - np.repeat(begins, np.diff(begins, append=len(track.step)))
    who = np.array(ids, dtype=object)[track.pedestrian]
    when = {"time": time[track.step], "id": who, "number": number}
    columns = when | {"desired_speed": track.desired_speed, "x": track.x, "y": track.y}
    return pd.DataFrame(columns)[names]


def remark(ego_id: str, violations: Sequence[Event]) -> str:
    """Return the remark on an ego that broke the law of the road, or "" if it did not."""
    if not violations:
        return ""
    kinds = [f"{number} x {kind}" for kind, number in count(violations).items()]
    first = violations[0]
    return (
        f"ego '{ego_id}': against the law of the road: {', '.join(kinds)}; the first at "
        f"{first.time:.2f} s ({first.words}); see ledger.csv"
    )
