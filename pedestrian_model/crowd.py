"""The state of a crowd: arrays, one row per pedestrian."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pedestrian_model._check import as_floats, check_not_negative, check_shape, check_values
from pedestrian_model.arrays import Arrays, extent, select_into
from pedestrian_model.errors import CrowdError
from pedestrian_model.routes import OFF_WALKWAYS, Routes, offsets, passage_rows, signal_rows

_UNIT = 1e-6  # tolerance of a direction's length of one


@dataclass(frozen=True, eq=False)
class Crowd:
    """The state of a crowd, a structure of arrays; made by ``Crowd.create`` or ``Crowd.empty``.

    The way-points of all pedestrians are in one array. Those of pedestrian i are
    ``waypoints[waypoint_start[i]:waypoint_start[i + 1]]``, and the last one is the destination.

    A way-point with a passage (direction_x, direction_y, half_width) is a line across this
    direction. It is passed beyond the line, within its half-width. With (0, 0, 0) it is only a
    point. A way-point with a signal is not passed while ``Surroundings.closed[signal]``. Without a
    signal it has -1, or ``OFF_WALKWAYS``: walls do not hold people on the way to it. This may be
    changed in place.

    Priority is the degree to which a person relies on vehicles to stop: 1 on a crossing with
    priority, 0 as in the paper. It may be changed in place. Copies share it, as they share all
    arrays that a step does not change.

    Raises:
        CrowdError: if an array has a wrong shape, or a value is not finite or out of range.
    """

    position: NDArray[np.float64]  # centres (n, 2) [m]
    velocity: NDArray[np.float64]  # velocities (n, 2) [m/s]
    desired_speed: NDArray[np.float64]  # desired speeds (n,) [m/s]
    waypoints: NDArray[np.float64]  # way-points (total, 2) [m]
    waypoint_start: NDArray[np.int64]  # offsets (n + 1,) into ``waypoints``
    waypoint_index: NDArray[np.int64]  # next way-point (n,), counted from the pedestrian's first
    waypoint_passage: NDArray[np.float64]  # passages (total, 3): unit direction, half-width [m]
    waypoint_signal: NDArray[np.int64]  # signals (total,) that must be open; -1, or -2, without
    priority: NDArray[np.float64]  # priorities (n,), 0 to 1

    def __post_init__(self) -> None:
        n = self.position.shape[0]
        for name, shape in (
            ("position", (n, 2)),
            ("velocity", (n, 2)),
            ("desired_speed", (n,)),
            ("waypoints", (None, 2)),
            ("waypoint_passage", (self.waypoints.shape[0], 3)),
            ("priority", (n,)),
        ):
            array = getattr(self, name)
            check_shape(array, shape, name, CrowdError)
            _check_memory(array, np.dtype(np.float64), name)
            check_values(array, name, CrowdError)
        check_not_negative(self.desired_speed, "desired_speed", CrowdError)
        self._check_priority()
        for name, length in (
            ("waypoint_start", n + 1),
            ("waypoint_index", n),
            ("waypoint_signal", self.waypoints.shape[0]),
        ):
            check_shape(getattr(self, name), (length,), name, CrowdError)
            _check_memory(getattr(self, name), np.dtype(np.int64), name)
        self._checkoffsets()
        self._check_passages()

    def _check_priority(self) -> None:
        bad = (self.priority < 0.0) | (self.priority > 1.0)
        if bad.any():
            i = int(np.argmax(bad))
            raise CrowdError(f"priority[{i}] = {self.priority[i]}, expected 0 to 1")

    def _checkoffsets(self) -> None:
        start, total = self.waypoint_start, self.waypoints.shape[0]
        if start[0] != 0 or start[-1] != total:
            raise CrowdError(
                f"waypoint_start runs from {start[0]} to {start[-1]}, expected 0 to {total}"
            )
        count = np.diff(start)
        for bad, message in (
            (count < 1, "has no way-point, expected at least its destination"),
            (self.waypoint_index < 0, "has a negative waypoint_index"),
            (self.waypoint_index >= count, "has a waypoint_index beyond its last way-point"),
        ):
            if bad.any():
                raise CrowdError(f"pedestrian {int(np.argmax(bad))} {message}")

    def _check_passages(self) -> None:
        direction, half = self.waypoint_passage[:, :2], self.waypoint_passage[:, 2]
        check_not_negative(half, "half-width of waypoint_passage", CrowdError)
        bad = (half > 0.0) & (np.abs((direction**2).sum(axis=1) - 1.0) > 2.0 * _UNIT)
        if bad.any():
            at = int(np.argmax(bad))
            raise CrowdError(
                f"waypoint_passage[{at}] has direction {direction[at].tolist()}, "
                "expected length 1: Crowd.create"
            )
        bad = self.waypoint_signal < OFF_WALKWAYS
        if bad.any():
            at = int(np.argmax(bad))
            raise CrowdError(
                f"waypoint_signal[{at}] = {self.waypoint_signal[at]}, expected an index >= 0, "
                "or -1 (-2 where walls hold nobody) for none"
            )

    def __len__(self) -> int:
        return int(self.position.shape[0])

    @classmethod
    def create(
        cls,
        position: ArrayLike,
        velocity: ArrayLike,
        desired_speed: ArrayLike,
        waypoints: Sequence[ArrayLike],
        *,
        passages: Sequence[ArrayLike] | None = None,
        signals: Sequence[ArrayLike] | None = None,
        priority: ArrayLike = 0.0,
    ) -> Crowd:
        """Return a new crowd, in which each pedestrian walks to the first of its way-points.

        Args:
            position: Centres (n, 2) [m].
            velocity: Velocities (n, 2) [m/s].
            desired_speed: Desired speeds (n,) [m/s], or one number for all.
            waypoints: Way-points (k_i, 2) [m] of each pedestrian, k_i >= 1; the last one is the
                destination.
            passages: Passages (k_i, 3) of each: direction_x, direction_y (of any length) and
                half_width [m]. (0, 0, anything) stands for a point. None if all are points.
            signals: Signals (k_i,) of each: index of a signal, or -1. None if there are none.
            priority: Priorities (n,), 0 to 1, or one number for all.

        Raises:
            CrowdError: a value is invalid; the message has the array, the index and the value.
        """
        x = as_floats(position, "position", CrowdError)
        x = x.reshape(0, 2) if x.size == 0 else x
        check_shape(x, (None, 2), "position", CrowdError)
        n = x.shape[0]
        v = as_floats(velocity, "velocity", CrowdError)
        v0 = as_floats(desired_speed, "desired_speed", CrowdError)
        relying = as_floats(priority, "priority", CrowdError)
        if len(waypoints) != n:
            raise CrowdError(
                f"waypoints has {len(waypoints)} entries, expected one for each of {n}"
            )
        routes = [
            as_floats(route, f"waypoints[{i}]", CrowdError) for i, route in enumerate(waypoints)
        ]
        for i, route in enumerate(routes):
            check_shape(route, (None, 2), f"waypoints[{i}]", CrowdError)
            check_values(route, f"waypoints[{i}]", CrowdError)
        total = sum(len(route) for route in routes)
        return cls(
            position=x.copy(),
            velocity=v.reshape(0, 2) if v.size == 0 else v.copy(),
            desired_speed=_for_each(v0, n),
            waypoints=np.concatenate(routes) if routes else np.empty((0, 2)),
            waypoint_start=offsets(np.array([len(route) for route in routes], dtype=np.int64)),
            waypoint_index=np.zeros(n, dtype=np.int64),
            waypoint_passage=(
                np.zeros((total, 3)) if passages is None else passage_rows(passages, routes)
            ),
            waypoint_signal=(
                np.full(total, -1, dtype=np.int64)
                if signals is None
                else signal_rows(signals, routes)
            ),
            priority=_for_each(relying, n),
        )

    @classmethod
    def empty(cls) -> Crowd:
        """Return a crowd without people."""
        return cls.create(np.empty((0, 2)), np.empty((0, 2)), np.empty(0), [])

    @cached_property
    def routes(self) -> Arrays:
        """The arrays of ``Routes``, which a step never changes."""
        return tuple(
            Routes(self.waypoints, self.waypoint_passage, self.waypoint_signal, self.waypoint_start)
        )

    @cached_property
    def fixed_arrays(self) -> Arrays:
        """The crowd's part of a ``Scene``: desired speeds, priority, and routes."""
        return (self.desired_speed, self.priority, *self.routes)

    @property
    def state(self) -> Arrays:
        """The arrays that a step changes: position, velocity, index of the next way-point."""
        return self.position, self.velocity, self.waypoint_index

    @cached_property
    def signals(self) -> int:
        """The number of signals needed: one more than the largest index of any way-point."""
        return int(self.waypoint_signal.max(initial=-1)) + 1

    def copy(self) -> Crowd:
        """Return a copy with its own state. Arrays that a step never changes are shared."""
        return _unchecked(
            self.__dict__
            | {
                "position": self.position.copy(),
                "velocity": self.velocity.copy(),
                "waypoint_index": self.waypoint_index.copy(),
            }
        )

    def select(self, mask: NDArray[np.bool_], room: Crowd | None = None) -> Crowd:
        """The pedestrians where ``mask`` (n,) is true, in the same order.

        Args:
            mask: Marks (n,) of the people who are selected.
            room: Earlier selection that is no longer needed, or None. It is reused if it fits.

        Raises:
            CrowdError: if ``mask`` is not a boolean array of length n.
        """
        mask = np.asarray(mask)
        if mask.dtype != np.bool_ or mask.shape != (len(self),):
            raise CrowdError(
                f"mask is {mask.dtype} of shape {mask.shape}, expected bool of ({len(self)},)"
            )
        n, total = extent(mask, self.waypoint_start)
        if room is None or (len(room.position), len(room.waypoints)) != (n, total):
            room = _unfilled(n, total)
        signals = select_into(
            (*self.state, *self.fixed_arrays), mask, (*room.state, *room.fixed_arrays)
        )
        room.__dict__["signals"] = signals
        return room

    def concatenate(self, other: Crowd) -> Crowd:
        """Return this crowd followed by ``other``."""
        joined: dict[str, Any] = {
            name: np.concatenate([getattr(self, name), getattr(other, name)]) for name in _JOINED
        }
        joined["waypoint_start"] = np.concatenate(
            [self.waypoint_start, self.waypoint_start[-1] + other.waypoint_start[1:]]
        )
        return _unchecked(joined)


#: All fields but ``waypoint_start``, whose offsets are shifted.
_JOINED = tuple(field.name for field in fields(Crowd) if field.name != "waypoint_start")


def _check_memory(array: NDArray[np.generic], dtype: np.dtype[np.generic], name: str) -> None:
    """Raise an error unless an array is C-contiguous and of the type that the kernels take."""
    if array.dtype != dtype or not array.flags.c_contiguous:
        raise CrowdError(f"{name} is {array.dtype}, expected C-contiguous {dtype}: Crowd.create")


def _unfilled(n: int, total: int) -> Crowd:
    """Return a crowd with uninitialised arrays for n pedestrians and ``total`` way-points."""
    state = np.empty((n, 2)), np.empty((n, 2)), np.empty(n, dtype=np.int64)
    signal, start = np.empty(total, dtype=np.int64), np.empty(n + 1, dtype=np.int64)
    routes = np.empty((total, 2)), np.empty((total, 3)), signal, start
    fixed = np.empty(n), np.empty(n), *routes
    return _unchecked(
        {
            "position": state[0],
            "velocity": state[1],
            "desired_speed": fixed[0],
            "waypoints": routes[0],
            "waypoint_start": start,
            "waypoint_index": state[2],
            "waypoint_passage": routes[1],
            "waypoint_signal": signal,
            "priority": fixed[1],
            "routes": routes,
            "fixed_arrays": fixed,
        }
    )


def _unchecked(state: dict[str, Any]) -> Crowd:
    """Return a crowd of these fields, which are known to be valid, without checks."""
    crowd = object.__new__(Crowd)
    crowd.__dict__.update(state)
    return crowd


def _for_each(values: NDArray[np.float64], n: int) -> NDArray[np.float64]:
    """Return one value for each of n pedestrians, from one value for all or one for each."""
    return np.full(n, values) if values.ndim == 0 or values.size == 0 else values.copy()
