"""The run's tables as pandas frames, columns as in :mod:`giveway.run_data.columns`."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from giveway.geometry.kernel import Array
from giveway.geometry.path import directions, headings_to_angles
from giveway.results.sights import perceived
from giveway.run_data.columns import (
    PREDICTION_COLUMNS,
    SEEN,
    TIMING_COLUMNS,
    TRAJECTORY_COLUMNS,
    quantities_of,
)
from giveway.run_data.outputs import Output
from giveway.run_data.tracks import (
    EGO_COLUMNS,
    BackgroundTrack,
    CrowdTrack,
    EgoTrack,
    PredictionTrack,
    SightTrack,
    Timings,
    names_of,
)

if TYPE_CHECKING:
    import pandas as pd

_STANDING = 1e-6  # Speed [m/s] below which a pedestrian keeps the last angle


def ego_table(track: EgoTrack, ego_id: str, outputs: Sequence[Output] = ()) -> "pd.DataFrame":
    """Return ``ego.csv``: one row per control instant."""
    import pandas as pd

    columns = {"id": ego_id} | {
        quantity.column or name: quantity.written(getattr(track, name))
        for name, (_, quantity) in quantities_of(EgoTrack).items()
    }
    own = {output.name: output.values for output in outputs}
    names = [column.name for column in EGO_COLUMNS]
    return pd.DataFrame(columns | own, index=range(len(track.time)))[[*names, *own]]


def prediction_table(track: PredictionTrack, ego_id: str, ids: Sequence[str]) -> "pd.DataFrame":
    """Return ``predictions.csv``: one row per control instant, pedestrian and look-ahead."""
    import pandas as pd

    columns = {
        "time": track.time,
        "ego": ego_id,
        "id": names_of(track.pedestrian, ids),
        "look_ahead": track.look_ahead,
        "x": track.x,
        "y": track.y,
    }
    names = [column.name for column in PREDICTION_COLUMNS]
    return pd.DataFrame(columns, index=range(len(track.time)))[names]


def trajectory_pieces(
    time: Array,
    egos: Sequence[tuple[str, EgoTrack]],
    crowd: CrowdTrack,
    background: BackgroundTrack,
    sights: SightTrack | None = None,
) -> "Iterator[pd.DataFrame]":
    """Yield ``trajectories.csv``: all egos, SUMO's vehicles and pedestrians by instant.

    The rows come at once, or in the crowd's pieces if it is too long for the memory.
    """
    import pandas as pd

    waiting = [
        _moving(ego.time, name, "ego", ego.front_x, ego.front_y, ego.heading, ego.speed)
        for name, ego in egos
    ]
    waiting.append(
        _moving(
            background.time,
            background.id,
            background.type,
            background.x,
            background.y,
            background.heading,
            background.speed,
        )
    )
    names = [column.name for column in TRAJECTORY_COLUMNS]
    names += [] if sights is None else [SEEN.name]
    angles = np.zeros(len(crowd.ids))  # the latest ones
    parts = crowd.pieces()
    part: CrowdTrack | None = next(parts)
    while part is not None:
        following = next(parts, None)
        walking = _walking(time, part, angles)
        if sights is not None:
            seen = perceived(sights, part.pedestrian, time[part.step])
            walking[SEEN.name] = seen.astype(object)
        frames = [*waiting, walking]
        if following is not None:
            until = _rounded(time[following.step[0]])
            waiting = [frame[frame["time"] >= until] for frame in waiting]
            frames = [frame[frame["time"] < until] for frame in frames]
        frames = [frame for frame in frames if len(frame)]
        if frames:
            table = pd.concat(frames, ignore_index=True)
            ordered = table.sort_values("time", kind="stable", ignore_index=True)
            yield ordered.reindex(columns=names)
        elif following is None:
            yield pd.DataFrame(columns=names)
        part = following


def _rounded(time: Any) -> Any:
    """Return times without the last digits, in which SUMO's clock and giveway's differ."""
    return np.round(time, 6)


def _moving(
    time: Array,
    name: object,
    kind: object,
    x: Array,
    y: Array,
    heading: Array,
    speed: Array,
) -> "pd.DataFrame":
    import pandas as pd

    velocity = {"vx": speed * np.cos(heading), "vy": speed * np.sin(heading)}
    placed = {"time": _rounded(time), "id": name, "type": kind, "x": x, "y": y}
    angle = headings_to_angles(heading)
    return pd.DataFrame({**placed, "angle": angle, "speed": speed, **velocity})


def _walking(time: Array, crowd: CrowdTrack, angles: Array) -> "pd.DataFrame":
    """Return the rows of people; ``angles`` (n,) has the latest angle of each [deg]."""
    import pandas as pd

    speed = np.hypot(crowd.vx, crowd.vy)
    angle = headings_to_angles(directions(np.column_stack([crowd.vx, crowd.vy])))
    walked = pd.Series(np.where(speed < _STANDING, np.nan, angle))
    last = walked.groupby(crowd.pedestrian).ffill().to_numpy()
    known: Array = np.where(np.isnan(last), angles[crowd.pedestrian], last)
    angles[crowd.pedestrian] = known
    ids = np.array(crowd.ids, dtype=object)[crowd.pedestrian]
    placed = {"time": _rounded(time[crowd.step]), "id": ids, "type": "pedestrian"}
    moving = {"angle": known, "speed": speed, "vx": crowd.vx, "vy": crowd.vy}
    return pd.DataFrame({**placed, "x": crowd.x, "y": crowd.y, **moving})


def timing_table(time: Array, timings: Timings) -> "pd.DataFrame":
    """Return ``timing.csv``: computing times [us], which differ between equal runs."""
    import pandas as pd

    microseconds = pd.DataFrame(np.round(timings.seconds * 1e6, 1), columns=list(Timings.NAMES))
    microseconds["time"] = time[: len(microseconds)]
    return microseconds[[column.name for column in TIMING_COLUMNS]]
