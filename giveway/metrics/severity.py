"""The severity, the time and the place of each pedestrian's encounter with the ego.

The time to a collision ranks encounters, while the speed ranks collisions. No single number does
both (Laureshyn, Svensson & Hydén 2010). Therefore class and speed have columns of their own.
"""

from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.bodies import VehicleShape
from giveway.metrics.conflicts import CRITICAL_TTC, proximity
from giveway.metrics.contacts import FRONTAL
from giveway.metrics.groups import PedestrianGroups
from giveway.run_data.columns import Quantity, columns_of
from giveway.run_data.tracks import CrowdTrack, EgoTrack

if TYPE_CHECKING:
    import pandas as pd

SERIOUS_TTC = 1.0
"""Time to collision [s] below which an encounter is serious: the highest of the three classes of
Sayed, Brown & Navin (1994) and Sayed & Zein (1999). From here to ``CRITICAL_TTC`` it is in their
middle class."""

CRITICAL_PET = 1.0
"""Largest post-encroachment time [s] that is critical at any TTC, from DOCTOR, the Dutch technique
of observing conflicts (Kraay, van der Horst & Oppe 1986)."""

SEVERITIES = ("slight", "serious", "collision")
"""The classes from the mildest to the worst: TTC of 1.0 to 1.5 s or PET of at most 1.0 s; TTC below
1.0 s; the ego moved into the pedestrian."""


class SeverityRow:
    """The columns of a pedestrian's encounter; empty cells without one."""

    severity: Annotated[
        str,
        Quantity(
            None,
            "of its encounter with the moving ego. slight: TTC below 1.5 s or PET up to 1 s; "
            "serious: TTC below 1 s; collision: frontal contact; empty: none",
        ),
    ]
    conflict_time: Annotated[float, Quantity("s", "when this encounter was closest to a collision")]
    conflict_ttc: Annotated[
        float, Quantity("s", "smallest time to collision while the ego moved; empty: PET alone")
    ]
    conflict_speed: Annotated[
        float, Quantity("m/s", "speed of ego and pedestrian relative to each other then")
    ]
    conflict_x: Annotated[float, Quantity("m", "network x of the pedestrian then")]
    conflict_y: Annotated[float, Quantity("m", "network y of the pedestrian then")]


SEVERITY_FIELDS = columns_of(SeverityRow)


def severities(
    ego: EgoTrack,
    crowd: CrowdTrack,
    shape: VehicleShape,
    body_radius: float,
    stop_speed: float,
    per_pedestrian: "pd.DataFrame",
) -> "pd.DataFrame":
    """Return class, instant, relative speed and place of each pedestrian's encounter.

    The instant of an encounter is the one with the smallest time to collision with the moving ego.
    For an encounter by PET alone, it is the one with the smallest clearance.

    Args:
        ego: Track of the ego, T instants.
        crowd: Track of the crowd, R records of n pedestrians.
        shape: Rectangle of the ego.
        body_radius: Radius of a pedestrian [m].
        stop_speed: Speed [m/s] above which the ego moves.
        per_pedestrian: Table of ``pedestrian_metrics``.

    Returns:
        n rows in the order of ``crowd.ids``, columns as in ``SEVERITY_FIELDS``.
    """
    import pandas as pd

    tables, first = [], 0
    for part in crowd.by_people():
        some = per_pedestrian.iloc[first : first + len(part.ids)]
        tables.append(pd.DataFrame(_columns(ego, part, shape, body_radius, stop_speed, some)))
        first += len(part.ids)
    table = tables[0] if len(tables) == 1 else pd.concat(tables, ignore_index=True)
    return table[[column.name for column in SEVERITY_FIELDS]]


def _columns(
    ego: EgoTrack,
    crowd: CrowdTrack,
    shape: VehicleShape,
    body_radius: float,
    stop_speed: float,
    per_pedestrian: "pd.DataFrame",
) -> dict[str, NDArray[Any]]:
    """Return the columns of :func:`severities` of people whose records are in memory."""
    clear, ttc, _ = proximity(ego, crowd, shape, body_radius)
    groups = PedestrianGroups(crowd)
    moving = np.where(ego.speed[crowd.step] > stop_speed, ttc, np.inf)
    soonest = groups.first_minimum(moving)
    smallest = groups.at(moving, soonest)
    by_time = smallest < CRITICAL_TTC
    present = np.flatnonzero(groups.present)
    place = np.where(by_time[present], soonest, groups.first_minimum(clear))
    classes = _classes(smallest, per_pedestrian)
    some = classes != ""

    def then(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.where(some, groups.at(values, place), np.nan)

    step = crowd.step
    away_x = ego.speed[step] * np.cos(ego.heading[step]) - crowd.vx
    away_y = ego.speed[step] * np.sin(ego.heading[step]) - crowd.vy
    return {
        "severity": classes,
        "conflict_time": then(ego.time[step]),
        "conflict_ttc": np.where(some & by_time, smallest, np.nan),
        "conflict_speed": then(np.hypot(away_x, away_y)),
        "conflict_x": then(crowd.x),
        "conflict_y": then(crowd.y),
    }


def _classes(ttc: NDArray[np.float64], per_pedestrian: "pd.DataFrame") -> NDArray[np.object_]:
    """Return the class (n,) of each pedestrian's encounter, or an empty text without one."""
    pet = per_pedestrian["post_encroachment_time"].to_numpy(dtype=np.float64)
    frontal = (per_pedestrian["contact"] == FRONTAL).to_numpy(dtype=np.bool_)
    slight, serious, collision = SEVERITIES
    found = np.full(len(pet), "", dtype=object)
    found[(ttc < CRITICAL_TTC) | ((pet > 0.0) & (pet <= CRITICAL_PET))] = slight
    found[ttc < SERIOUS_TTC] = serious
    found[frontal] = collision
    return found
