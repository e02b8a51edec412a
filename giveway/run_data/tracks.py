"""The tracks of egos, crowd and background vehicles, as arrays.

The recorder fills them; metrics, tables and figures read them. All values have SI units, angles are
mathematical (radians, counter-clockwise from +x), and x, y are coordinates of the network.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar, Generic

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.path import headings_to_angles
from giveway.run_data.columns import (
    TIMING_COLUMNS,
    Column,
    Count,
    Number,
    Quantity,
    Text,
    columns_of,
)


def _empty_if_infinite(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.where(np.isfinite(values), values, np.nan)


_FRONT = "of the front bumper's centre (SUMO's reference point)"


@dataclass(kw_only=True)
class EgoColumns(Generic[Number, Text, Count]):
    """The columns of ``ego.csv``: :class:`EgoRow` is one row, :class:`EgoTrack` are all rows.

    Recorder, journal, table, data package and docs/results.md follow from this class. Here angles
    are mathematical [rad], and a distance to something that is not there is infinite. ``written``
    converts the values for the file.
    """

    time: Annotated[Number, Quantity("s", "simulation time t_k of the control instant")]
    position: Annotated[
        Number, Quantity("m", "distance driven along the path since departure, by the FMU")
    ]
    front_x: Annotated[Number, Quantity("m", f"network x {_FRONT}", column="x")]
    front_y: Annotated[Number, Quantity("m", f"network y {_FRONT}", column="y")]
    heading: Annotated[
        Number,
        Quantity(
            "deg",
            "navigational angle: 0 is north, clockwise",
            column="angle",
            written=headings_to_angles,
        ),
    ]
    speed: Annotated[Number, Quantity("m/s", "speed, by the FMU")]
    acceleration: Annotated[
        Number, Quantity("m/s^2", "acceleration over the step before t_k, by the FMU")
    ]
    force: Annotated[Number, Quantity("N", "force command applied from t_k on; negative brakes")]
    controller: Annotated[
        Text,
        Quantity(None, "who acted: mpc, pid, plug-in (somebody else's), safety (the layer below)"),
    ]
    reason: Annotated[Text, Quantity(None, "why it acted; of the planning MPC: which manoeuvre")]
    solver_status: Annotated[Text, Quantity(None, "the QP solver's status; empty where none ran")]
    solver_iterations: Annotated[Count, Quantity(None, "the QP solver's iterations")]
    gap: Annotated[
        Number,
        Quantity(
            "m",
            "distance to the closest pedestrian in front now; empty: nobody",
            written=_empty_if_infinite,
        ),
    ]
    reference_speed: Annotated[
        Number, Quantity("m/s", "the reference speed of the controller that acted")
    ]
    vehicle_gap: Annotated[
        Number,
        Quantity(
            "m",
            "distance to the closest vehicle in front; empty: none",
            written=_empty_if_infinite,
        ),
    ]
    stop_gap: Annotated[
        Number,
        Quantity(
            "m",
            "front bumper's distance to where it has to stop: for a light, a stop, a crossing, "
            "right of way or a merge; empty: nowhere",
            written=_empty_if_infinite,
        ),
    ]
    waits_for: Annotated[
        Text,
        Quantity(
            None,
            "what it stands for: person, vehicle, light, stop, yield (at a crossing: to people, or "
            "since it is blocked; where lanes merge: to vehicles), plan (people expected in front),"
            " none; empty: it drives, or drives off",
        ),
    ]


class EgoRow(EgoColumns[float, str, int]):
    """The values of an ego at one control instant."""


class EgoTrack(EgoColumns[NDArray[np.float64], NDArray[np.str_], NDArray[np.int64]]):
    """The values of an ego at its T control instants t_k; each column has the shape (T,)."""


_TIME, *_OWN = columns_of(EgoTrack)
EGO_COLUMNS = (_TIME, Column("id", "string", None, "SUMO id of the ego"), *_OWN)
"""Columns of ``ego.csv``, in order; the id is the same in all rows of a track."""


NEVER = 2**53
"""Index of a control instant that no run reaches."""

COORDINATES = ("x", "y", "vx", "vy")
_RECORDS = ("step", "pedestrian", *COORDINATES)
_MOST = 2.0**53  # Largest number whose float64 is an exact integer


def as_indices(numbers: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return numbers as indices or counts.

    Raises:
        ValueError: a number is no index or count, since a broken journal may hold anything.
    """
    if not (np.abs(numbers) < _MOST).all():  # false for nan, too
        raise ValueError("no index")
    return numbers.astype(np.int64)


@dataclass(frozen=True)
class CrowdTrack:
    """The crowd as flat records in time order, one per pedestrian and recorded instant."""

    step: NDArray[np.int64]  # (R,) index into the control instants
    pedestrian: NDArray[np.int64]  # (R,) index into ``ids``
    x: NDArray[np.float64]  # (R,) [m] body centre
    y: NDArray[np.float64]  # (R,) [m]
    vx: NDArray[np.float64]  # (R,) [m/s]
    vy: NDArray[np.float64]  # (R,) [m/s]
    ids: tuple[str, ...]  # id of each pedestrian
    # kind of each pedestrian, for example "elderly"; empty if kinds are not used
    kinds: tuple[str, ...] = ()
    groups: tuple[str, ...] = ()  # first member of each one's group; empty if there are no groups
    # instant (n,) from which each pedestrian reacts to vehicles; None if all of them always do
    reacts_from: NDArray[np.int64] | None = None
    is_long: ClassVar[bool] = False  # True if the records do not fit into the memory

    def pieces(self) -> Iterator[CrowdTrack]:
        """Yield the records in order of time; all at once if they are in memory."""
        yield self

    def by_people(self) -> Iterator[CrowdTrack]:
        """Yield the records of some people at a time, in the order of ``ids``; or of all."""
        yield self

    def of_people(self, begin: int, end: int) -> CrowdTrack:
        """Return the records of the people from ``begin`` to before ``end``, who count from 0."""
        part = self.where((self.pedestrian >= begin) & (self.pedestrian < end))
        reacts = self.reacts_from
        return replace(
            part,
            pedestrian=part.pedestrian - begin,
            ids=self.ids[begin:end],
            kinds=self.kinds[begin:end],
            groups=self.groups[begin:end],
            reacts_from=None if reacts is None else reacts[begin:end],
        )

    def where(self, rows: NDArray[np.bool_]) -> CrowdTrack:
        """Return the records at which ``rows`` (R,) is true."""
        columns: dict[str, Any] = {name: getattr(self, name)[rows] for name in _RECORDS}
        return replace(self, **columns)

    @classmethod
    def joined(cls, parts: Sequence[CrowdTrack]) -> CrowdTrack:
        """Return the records of at least one track, of the same people, behind one another."""
        columns: dict[str, Any] = {
            name: np.concatenate([getattr(part, name) for part in parts]) for name in _RECORDS
        }
        return replace(parts[0], **columns)

    def during(self, first: int, instants: int) -> CrowdTrack:
        """Return the records of ``instants`` control instants from ``first`` on, as step 0."""
        a, b = np.searchsorted(self.step, (first, first + instants))
        if first == 0 and b == len(self.step):
            return self
        return CrowdTrack(
            step=self.step[a:b] - first,
            pedestrian=self.pedestrian[a:b],
            x=self.x[a:b],
            y=self.y[a:b],
            vx=self.vx[a:b],
            vy=self.vy[a:b],
            ids=self.ids,
            kinds=self.kinds,
            groups=self.groups,
            reacts_from=None if self.reacts_from is None else self.reacts_from - first,
        )


@dataclass(frozen=True)
class PredictionTrack:
    """The positions of pedestrians that an ego's controller expected, in time order."""

    time: NDArray[np.float64]  # (P,) [s] control instant of the prediction
    pedestrian: NDArray[np.int64]  # (P,) index into the crowd's ``ids``
    look_ahead: NDArray[np.float64]  # (P,) [s] time ahead of that instant
    x: NDArray[np.float64]  # (P,) [m] body centre
    y: NDArray[np.float64]  # (P,) [m]


@dataclass(frozen=True)
class BackgroundTrack:
    """SUMO's own vehicles as flat records, at SUMO's instants, in time order."""

    time: NDArray[np.float64]  # (B,) [s]
    id: NDArray[np.str_]  # (B,)
    type: NDArray[np.str_]  # (B,) vehicle type in SUMO
    x: NDArray[np.float64]  # (B,) [m] front-bumper centre
    y: NDArray[np.float64]  # (B,) [m]
    heading: NDArray[np.float64]  # (B,) [rad]
    speed: NDArray[np.float64]  # (B,) [m/s]
    length: NDArray[np.float64]  # (B,) [m]
    width: NDArray[np.float64]  # (B,) [m]


@dataclass(frozen=True)
class SignalTrack:
    """The states of traffic lights, as changes in time order."""

    time: NDArray[np.float64]  # (S,) [s] time of the change
    system: NDArray[np.str_]  # (S,) SUMO's id of the light
    state: NDArray[np.str_]  # (S,) one letter per movement


@dataclass(frozen=True)
class SightTrack:
    """The changes of who is in sight of an ego, in time order."""

    time: NDArray[np.float64]  # (S,) [s] time of the change
    ego: NDArray[np.str_]  # (S,) id of the ego
    pedestrian: NDArray[np.int64]  # (S,) index into the crowd's ``ids``; negative: nobody is there
    seen: NDArray[np.bool_]  # (S,) whether the person is in sight from then on
    distance: NDArray[np.float64]  # (S,) [m] from the front bumper; NaN for who is lost


FALSE = "false:"
"""The beginning of the names of false detections, which have the indices -1, -2, ..."""


def names_of(pedestrian: NDArray[np.int64], ids: Sequence[str]) -> NDArray[np.object_]:
    """Return the names (n,) of pedestrians, and of false detections.

    Args:
        pedestrian: Indices (n,) into ``ids``.
        ids: Ids of the pedestrians.
    """
    names, false = np.array([*ids, ""], dtype=object)[np.maximum(pedestrian, -1)], pedestrian < 0
    names[false] = [f"{FALSE}{-number}" for number in pedestrian[false].tolist()]
    return names


NO_SIGHTS = SightTrack(
    np.empty(0), np.empty(0, np.str_), np.empty(0, np.int64), np.empty(0, np.bool_), np.empty(0)
)
"""The track of a run whose egos perceive everybody."""


@dataclass(frozen=True)
class PeopleTrack:
    """The planned routes and desired speeds of pedestrians, as flat records in time order.

    The records of one step are a pedestrian's route: the position then, and each later way-point.
    """

    step: NDArray[np.int64]  # (P,) index of the control instant from which on the route holds
    pedestrian: NDArray[np.int64]  # (P,) index into the crowd's ``ids``
    desired_speed: NDArray[np.float64]  # (P,) [m/s]
    x: NDArray[np.float64]  # (P,) [m]
    y: NDArray[np.float64]  # (P,) [m]


@dataclass(frozen=True)
class Timings:
    """The computing times of each control step; all other tables are equal in equal runs."""

    NAMES: ClassVar[tuple[str, ...]] = tuple(
        column.name for column in TIMING_COLUMNS if column.name != "time"
    )

    seconds: NDArray[np.float64]  # (T, 6) [s], columns in the order of NAMES

    def total(self, name: str) -> float:
        """Return the time [s] of one part, summed over all steps."""
        return float(self.seconds[:, self.NAMES.index(name)].sum())


def counted(people: int) -> str:
    """Return a number of people in words: "1 pedestrian", "24 pedestrians"."""
    return "1 pedestrian" if people == 1 else f"{people} pedestrians"
