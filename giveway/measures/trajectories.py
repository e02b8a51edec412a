"""A crowd's records in PedPy's form."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from giveway.metrics.groups import PedestrianGroups
from giveway.run_data.tracks import CrowdTrack

if TYPE_CHECKING:
    import pandas as pd


def walks(crowd: CrowdTrack) -> "pd.DataFrame":
    """Return one row per record: id, frame (control instant), x, y [m].

    A person whom SUMO moved for a while gets another id then, so that nobody jumps over a line.
    """
    import pandas as pd

    groups = PedestrianGroups(crowd)
    order = groups.order
    frame = crowd.step[order]
    new = (np.diff(groups.pedestrian) != 0) | (np.diff(frame) != 1)
    number = np.concatenate([[0], np.cumsum(new)]) if len(order) else np.empty(0, dtype=np.int64)
    data = {"id": number, "frame": frame, "x": crowd.x[order], "y": crowd.y[order]}
    table = pd.DataFrame(data)
    lasting = table.groupby("id")["frame"].transform("size") > 1  # a single record has no speed
    return table[lasting].reset_index(drop=True)


def trajectory_data(table: "pd.DataFrame", time_step: float) -> Any:
    """Return PedPy's trajectories of ``walks``."""
    from pedpy import TrajectoryData

    return TrajectoryData(data=table, frame_rate=1.0 / time_step)


def surroundings(table: "pd.DataFrame", places: NDArray[np.float64], beyond: float) -> Any:
    """Return a walkable area that holds all of ``table`` and ``places`` (k, 2) [m]."""
    from pedpy import WalkableArea

    points = np.concatenate([table[["x", "y"]].to_numpy(), places])
    (x_0, y_0), (x_1, y_1) = points.min(axis=0) - beyond, points.max(axis=0) + beyond
    return WalkableArea([(x_0, y_0), (x_1, y_0), (x_1, y_1), (x_0, y_1)])
