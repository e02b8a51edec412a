"""One row per pedestrian: their walk, and their proximity to the ego."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.bodies import VehicleShape
from giveway.metrics.close_passes import clearances
from giveway.metrics.conflicts import proximity
from giveway.metrics.contacts import contacts
from giveway.metrics.encroachment import encroachment
from giveway.metrics.groups import PedestrianGroups
from giveway.metrics.serious_conflicts import serious_conflicts
from giveway.run_data.columns import Quantity, columns_of
from giveway.run_data.tracks import CrowdTrack, EgoTrack

if TYPE_CHECKING:
    import pandas as pd

SLOW = 0.2
"""Speed [m/s] below which a person stands, as for the ego (Yang & Özgüner 2019, section 2.1)."""


class PedestrianRow:
    """The columns of the table; nan (an empty cell) if the event never occurred."""

    id: Annotated[str, Quantity(None, "the pedestrian")]
    kind: Annotated[
        str, Quantity(None, "adult, child, elderly, distracted, hurried; empty: not told apart")
    ]
    group: Annotated[
        str, Quantity(None, "id of the first in the group it walks in; empty: it walks alone")
    ]
    first_seen: Annotated[float, Quantity("s", "time of its first record")]
    last_seen: Annotated[float, Quantity("s", "time of its last record")]
    path_length: Annotated[float, Quantity("m", "length of the path it walked")]
    mean_speed: Annotated[float, Quantity("m/s", "path length over time seen")]
    minimum_clearance: Annotated[
        float, Quantity("m", "smallest distance of its circle to the ego's rectangle, < 0: overlap")
    ]
    time_of_minimum_clearance: Annotated[float, Quantity("s", "when that was, the first time")]
    overlap_time: Annotated[
        float, Quantity("s", "for how long its circle overlapped the ego's rectangle")
    ]
    contact: Annotated[
        str,
        Quantity(
            None,
            "frontal: the ego moved into it; side: any other overlap; recorded: any overlap while "
            "it walked as recorded; empty: none",
        ),
    ]
    minimum_ttc: Annotated[
        float, Quantity("s", "smallest time to collision; empty: never on a collision course")
    ]
    time_of_minimum_ttc: Annotated[float, Quantity("s", "when that was, the first time")]
    post_encroachment_time: Annotated[
        float, Quantity("s", "smallest time between its and the ego's presence at one place")
    ]
    maximum_drac: Annotated[
        float, Quantity("m/s^2", "largest deceleration that the ego needed to spare it")
    ]
    slow_time: Annotated[
        float,
        Quantity("s", "for how long it was slower than 0.2 m/s, near the ego"),
    ]
    peak_acceleration: Annotated[
        float, Quantity("m/s^2", "largest change of its velocity in a control step, over the step")
    ]
    passed_first: Annotated[
        str,
        Quantity(None, "who was first where both came: person, ego, contact; empty: nowhere"),
    ]
    clearance_moving: Annotated[
        float, Quantity("m", "smallest clearance while the ego was faster than 0.5 m/s; or empty")
    ]
    clearance_above_1: Annotated[
        float, Quantity("m", "smallest clearance while the ego was faster than 1 m/s; or empty")
    ]
    clearance_above_2: Annotated[
        float, Quantity("m", "smallest clearance while the ego was faster than 2 m/s; or empty")
    ]
    clearance_above_3: Annotated[
        float, Quantity("m", "smallest clearance while the ego was faster than 3 m/s; or empty")
    ]
    time_to_accident: Annotated[
        float,
        Quantity("s", "TTC when its conflict was most severe, before the ego evaded; empty: none"),
    ]
    conflicting_speed: Annotated[
        float, Quantity("m/s", "speed then of the ego, or of a pedestrian who came from beside")
    ]


PEDESTRIAN_FIELDS = columns_of(PedestrianRow)


def pedestrian_metrics(
    ego: EgoTrack, crowd: CrowdTrack, shape: VehicleShape, body_radius: float
) -> "pd.DataFrame":
    """Return proximity and walk of every pedestrian, in the columns ``PEDESTRIAN_FIELDS``.

    Args:
        ego: Track of the ego, T instants.
        crowd: Track of the crowd, R records of n pedestrians in time order.
        shape: Rectangle of the ego.
        body_radius: Radius of a pedestrian [m].

    Returns:
        Table with n rows in the order of ``crowd.ids``. A pedestrian who was never seen has nan in
        all columns, and no contact.

    Raises:
        ValueError: a record points outside the ego's track.
    """
    return table_of(pedestrian_columns(ego, crowd, shape, body_radius))


def table_of(columns: Mapping[str, Any]) -> "pd.DataFrame":
    """Return the table of the columns of :func:`pedestrian_columns`."""
    import pandas as pd

    return pd.DataFrame(columns, columns=[column.name for column in PEDESTRIAN_FIELDS])


def pedestrian_columns(
    ego: EgoTrack, crowd: CrowdTrack, shape: VehicleShape, body_radius: float
) -> dict[str, Any]:
    """Return the columns (n,) of the table of :func:`pedestrian_metrics`, which is slower to make.

    Args:
        ego: Track of the ego, T instants.
        crowd: Track of the crowd, R records of n pedestrians in time order.
        shape: Rectangle of the ego.
        body_radius: Radius of a pedestrian [m].

    Raises:
        ValueError: a record points outside the ego's track.
    """
    return _joined(_columns(ego, part, shape, body_radius) for part in crowd.by_people())


def _joined(parts: Iterable[dict[str, Any]]) -> dict[str, Any]:
    """Return the columns of all people from those of some at a time."""
    first, *more = parts
    return {
        name: np.concatenate([column, *(part[name] for part in more)]) if more else column
        for name, column in first.items()
    }


def _columns(
    ego: EgoTrack, crowd: CrowdTrack, shape: VehicleShape, body_radius: float
) -> dict[str, Any]:
    """Return the columns of :func:`pedestrian_columns` of people whose records are in memory."""
    near = clear, ttc, drac = proximity(ego, crowd, shape, body_radius)
    groups = PedestrianGroups(crowd)
    time = ego.time[crowd.step]
    missed = encroachment(ego, crowd, shape, body_radius)
    closest, soonest = groups.first_minimum(clear), groups.first_minimum(ttc)
    minimum_ttc = groups.at(ttc, soonest)
    on_course = np.isfinite(minimum_ttc)
    passed = clearances(crowd.pedestrian, ego.speed[crowd.step], clear, len(crowd.ids))
    conflict = serious_conflicts(ego, crowd, groups, near)
    return {
        **_walks(crowd, groups, time),
        "minimum_clearance": groups.at(clear, closest),
        "time_of_minimum_clearance": groups.at(time, closest),
        "overlap_time": groups.total(np.where(clear < 0.0, durations(ego)[crowd.step], 0.0)),
        "contact": contacts(ego, crowd, shape, body_radius, clear),
        "minimum_ttc": np.where(on_course, minimum_ttc, np.nan),
        "time_of_minimum_ttc": np.where(on_course, groups.at(time, soonest), np.nan),
        "post_encroachment_time": missed.time,
        "maximum_drac": -groups.at(-drac, groups.first_minimum(-drac)),
        "passed_first": missed.first,
        "clearance_moving": passed.moving,
        "clearance_above_1": passed.above_1,
        "clearance_above_2": passed.above_2,
        "clearance_above_3": passed.above_3,
        "time_to_accident": conflict.time_to_accident,
        "conflicting_speed": conflict.conflicting_speed,
    }


def walks_without_ego(
    time: NDArray[np.float64], crowd: CrowdTrack, every: int = 1
) -> "pd.DataFrame":
    """Return the walk of every pedestrian in a run without an ego.

    Args:
        time: Control instants (T,) [s].
        crowd: Track of the crowd.
        every: Control steps from one record of a pedestrian to the next; their peak acceleration
            is known only if it is 1.
    """
    import pandas as pd

    columns = _joined(
        _walks(part, PedestrianGroups(part), time[part.step], every) for part in crowd.by_people()
    )
    return pd.DataFrame(columns)


@dataclass(frozen=True)
class WalkSummary:
    """The summary of people's walks in a run without an ego; nan if there were no people."""

    mean_walking_speed: Annotated[float, Quantity("m/s", "mean of these people's mean speeds")]
    mean_slow_time: Annotated[
        float, Quantity("s", "mean time for which one of them was slower than 0.2 m/s")
    ]
    mean_walk: Annotated[float, Quantity("m", "mean length of these people's paths")]


WALK_SUMMARY_FIELDS = columns_of(WalkSummary)


def summarise_walks(table: "pd.DataFrame") -> WalkSummary:
    """Summarise the rows of :func:`walks_without_ego` in one row."""
    seen = table[table["first_seen"].notna()]
    return WalkSummary(
        mean_walking_speed=float(seen["mean_speed"].mean()),
        mean_slow_time=float(seen["slow_time"].mean()),
        mean_walk=float(seen["path_length"].mean()),
    )


def _walks(
    crowd: CrowdTrack, groups: PedestrianGroups, time: NDArray[np.float64], every: int = 1
) -> dict[str, Any]:
    """Return the columns about walks; ``time`` (R,) [s] is the time of each record."""
    first_seen, last_seen = groups.at(time, groups.first), groups.at(time, groups.last)
    path = groups.total(groups.walked(crowd))
    lasting, change = _changes(crowd, groups, time, every)
    peak = -groups.at(-change, groups.first_minimum(-change))
    with np.errstate(invalid="ignore", divide="ignore"):
        mean_speed = np.where(last_seen > first_seen, path / (last_seen - first_seen), np.nan)
    return {
        "id": list(crowd.ids),
        "kind": list(crowd.kinds) or [""] * len(crowd.ids),
        "group": list(crowd.groups) or [""] * len(crowd.ids),
        "first_seen": first_seen,
        "last_seen": last_seen,
        "path_length": path,
        "mean_speed": mean_speed,
        "slow_time": groups.total(np.where(np.hypot(crowd.vx, crowd.vy) < SLOW, lasting, 0.0)),
        "peak_acceleration": peak if every == 1 else np.full(len(peak), np.nan),
    }


def _changes(
    crowd: CrowdTrack, groups: PedestrianGroups, time: NDArray[np.float64], every: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return each record's duration (R,) [s], and the acceleration (R,) [m/s^2] before it.

    A duration lasts until the same pedestrian's record ``every`` control steps later. Duration and
    acceleration are 0 if there is no record so much later or earlier, respectively.
    """
    order = groups.order
    step = crowd.step[order]
    follows = (np.diff(groups.pedestrian) == 0) & (np.diff(step) == every)
    period = np.where(follows, np.diff(time[order]), 0.0)
    speeding = np.hypot(np.diff(crowd.vx[order]), np.diff(crowd.vy[order]))
    lasting, change = np.zeros(step.size), np.zeros(step.size)
    lasting[order[:-1]] = period
    change[order[1:]] = np.where(follows, speeding / np.where(follows, period, 1.0), 0.0)
    return lasting, change


def durations(ego: EgoTrack) -> NDArray[np.float64]:
    """Return the time (T,) [s] from each instant to the next one; 0 for the last."""
    return np.append(np.diff(ego.time), 0.0)
