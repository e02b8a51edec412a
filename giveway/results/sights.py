"""The table of who was in sight of an ego, when and from what distance on."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from giveway.run_data.columns import SIGHT_COLUMNS
from giveway.run_data.tracks import SightTrack, names_of

if TYPE_CHECKING:
    import pandas as pd


def sight_table(track: SightTrack, ids: tuple[str, ...]) -> "pd.DataFrame":
    """Return ``sights.csv``: one row per ego, person and stretch of time in sight.

    Args:
        track: Changes in time order.
        ids: Ids of the pedestrians.
    """
    import pandas as pd

    rows: list[list[object]] = []
    open_rows: dict[tuple[str, str], int] = {}
    names = names_of(track.pedestrian, ids)
    changes = zip(track.time, track.ego, names, track.seen, track.distance, strict=True)
    for time, ego, name, seen, distance in changes:
        whom = str(ego), name
        if seen:
            open_rows[whom] = len(rows)
            rows.append([ego, name, time, np.nan, distance])
        elif whom in open_rows:
            rows[open_rows.pop(whom)][3] = time
    return pd.DataFrame(rows, columns=[column.name for column in SIGHT_COLUMNS])


def perceived(track: SightTrack, pedestrian: NDArray[np.int64], time: Array) -> NDArray[np.bool_]:
    """Return which rows (n,) are of somebody whom an ego's sensor perceives then.

    Args:
        track: Changes in time order.
        pedestrian: Index of each row's pedestrian.
        time: Time [s] of each row.
    """
    changes, rows = track.time - _HALF_A_MILLISECOND, time
    span = 1.0 + max(changes.max(initial=0.0), rows.max(initial=0.0))
    order = np.lexsort((changes, track.pedestrian))
    keys = (track.pedestrian * span + changes)[order]
    among = np.concatenate([[0], np.cumsum(np.where(track.seen, 1, -1)[order])])
    before = np.searchsorted(keys, pedestrian * span - 0.5)
    count = among[np.searchsorted(keys, pedestrian * span + rows)] - among[before]
    found: NDArray[np.bool_] = count > 0
    return found


_HALF_A_MILLISECOND = 5e-4
