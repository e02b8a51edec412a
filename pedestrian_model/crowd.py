"""The state of a crowd: arrays, one row per pedestrian."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from pedestrian_model._check import as_floats, check_not_negative, check_shape, check_values
from pedestrian_model._jit import kernel
from pedestrian_model.errors import CrowdError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True, eq=False)
class Crowd:
    """A structure of arrays; build it with ``Crowd.create`` or ``Crowd.empty``.

    The way-points of all pedestrians stand in one array; those of pedestrian i are
    ``waypoints[waypoint_start[i]:waypoint_start[i + 1]]``, the last one is the destination.

    Raises:
        CrowdError: if an array has a wrong shape, or a value is not finite or out of range.
    """

    position: NDArray[np.float64]  # (n, 2) [m] centres
    velocity: NDArray[np.float64]  # (n, 2) [m/s]
    desired_speed: NDArray[np.float64]  # (n,) [m/s]
    waypoints: NDArray[np.float64]  # (total, 2) [m]
    waypoint_start: NDArray[np.int64]  # (n + 1,) offsets into ``waypoints``
    waypoint_index: NDArray[np.int64]  # (n,) current target, counted from the pedestrian's first

    def __post_init__(self) -> None:
        n = self.position.shape[0]
        for name, shape in (
            ("position", (n, 2)),
            ("velocity", (n, 2)),
            ("desired_speed", (n,)),
            ("waypoints", (None, 2)),
        ):
            array = getattr(self, name)
            check_shape(array, shape, name, CrowdError)
            _check_memory(array, np.dtype(np.float64), name)
            check_values(array, name, CrowdError)
        check_not_negative(self.desired_speed, "desired_speed", CrowdError)
        for name, length in (("waypoint_start", n + 1), ("waypoint_index", n)):
            check_shape(getattr(self, name), (length,), name, CrowdError)
            _check_memory(getattr(self, name), np.dtype(np.int64), name)
        self._check_offsets()

    def _check_offsets(self) -> None:
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

    def __len__(self) -> int:
        return int(self.position.shape[0])

    @classmethod
    def create(
        cls,
        position: ArrayLike,
        velocity: ArrayLike,
        desired_speed: ArrayLike,
        waypoints: Sequence[ArrayLike],
    ) -> Crowd:
        """A new crowd, each pedestrian on the way to the first of its way-points.

        Args:
            position: (n, 2) centres [m].
            velocity: (n, 2) [m/s].
            desired_speed: (n,) or one number for all [m/s].
            waypoints: for each pedestrian (k_i, 2) [m] with k_i >= 1; the last is the destination.

        Raises:
            CrowdError: naming the array, the index and the value that is not as it should be.
        """
        x = as_floats(position, "position", CrowdError)
        x = x.reshape(0, 2) if x.size == 0 else x
        check_shape(x, (None, 2), "position", CrowdError)
        n = x.shape[0]
        v = as_floats(velocity, "velocity", CrowdError)
        v0 = as_floats(desired_speed, "desired_speed", CrowdError)
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
        return cls(
            position=x.copy(),
            velocity=v.reshape(0, 2) if v.size == 0 else v.copy(),
            desired_speed=np.full(n, v0) if v0.ndim == 0 or v0.size == 0 else v0.copy(),
            waypoints=np.concatenate(routes) if routes else np.empty((0, 2)),
            waypoint_start=_offsets(np.array([len(route) for route in routes], dtype=np.int64)),
            waypoint_index=np.zeros(n, dtype=np.int64),
        )

    @classmethod
    def empty(cls) -> Crowd:
        """A crowd of nobody."""
        return cls.create(np.empty((0, 2)), np.empty((0, 2)), np.empty(0), [])

    @property
    def target(self) -> NDArray[np.float64]:
        """(n, 2) [m] the current way-point of each pedestrian."""
        targets: NDArray[np.float64] = self.waypoints[
            self.waypoint_start[:-1] + self.waypoint_index
        ]
        return targets

    @property
    def destination(self) -> NDArray[np.float64]:
        """(n, 2) [m] the last way-point of each pedestrian."""
        last: NDArray[np.float64] = self.waypoints[self.waypoint_start[1:] - 1]
        return last

    def copy(self) -> Crowd:
        """An independent state; what a step never changes is shared."""
        return _unchecked(
            self.position.copy(), self.velocity.copy(), self.waypoint_index.copy(), self
        )

    def select(self, mask: NDArray[np.bool_]) -> Crowd:
        """The pedestrians where ``mask`` (n,) is true, in the same order.

        Raises:
            CrowdError: if ``mask`` is not a boolean array of length n.
        """
        mask = np.asarray(mask)
        if mask.dtype != np.bool_ or mask.shape != (len(self),):
            raise CrowdError(
                f"mask is {mask.dtype} of shape {mask.shape}, expected bool of ({len(self)},)"
            )
        count = np.diff(self.waypoint_start)
        return Crowd(
            position=self.position[mask],
            velocity=self.velocity[mask],
            desired_speed=self.desired_speed[mask],
            waypoints=self.waypoints[np.repeat(mask, count)],
            waypoint_start=_offsets(count[mask]),
            waypoint_index=self.waypoint_index[mask],
        )

    def concatenate(self, other: Crowd) -> Crowd:
        """This crowd followed by ``other``."""
        return Crowd(
            position=np.concatenate([self.position, other.position]),
            velocity=np.concatenate([self.velocity, other.velocity]),
            desired_speed=np.concatenate([self.desired_speed, other.desired_speed]),
            waypoints=np.concatenate([self.waypoints, other.waypoints]),
            waypoint_start=np.concatenate(
                [self.waypoint_start, self.waypoint_start[-1] + other.waypoint_start[1:]]
            ),
            waypoint_index=np.concatenate([self.waypoint_index, other.waypoint_index]),
        )


def arrived(crowd: Crowd, radius: float) -> NDArray[np.bool_]:
    """Mask (n,): on the way to the last way-point and within ``radius`` [m] of it."""
    mask = np.empty(len(crowd), dtype=np.bool_)
    _fill_arrived(
        crowd.position, crowd.waypoints, crowd.waypoint_start, crowd.waypoint_index, radius, mask
    )
    return mask


@kernel
def _fill_arrived(
    position: NDArray[np.float64],
    waypoints: NDArray[np.float64],
    waypoint_start: NDArray[np.int64],
    waypoint_index: NDArray[np.int64],
    radius: float,
    mask: NDArray[np.bool_],
) -> None:
    for i in range(len(mask)):
        last = waypoint_start[i + 1] - 1
        x = waypoints[last, 0] - position[i, 0]
        y = waypoints[last, 1] - position[i, 1]
        on_the_way = waypoint_start[i] + waypoint_index[i] == last
        mask[i] = on_the_way and x * x + y * y <= radius * radius


def _offsets(count: NDArray[np.int64]) -> NDArray[np.int64]:
    """(n + 1,) offsets of runs of these lengths."""
    return np.concatenate([np.zeros(1, dtype=np.int64), np.cumsum(count, dtype=np.int64)])


def _check_memory(array: NDArray[np.generic], dtype: np.dtype[np.generic], name: str) -> None:
    """The kernels take C-contiguous arrays of one type only."""
    if array.dtype != dtype or not array.flags.c_contiguous:
        raise CrowdError(f"{name} is {array.dtype}, expected C-contiguous {dtype}: Crowd.create")


def _unchecked(
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    waypoint_index: NDArray[np.int64],
    like: Crowd,
) -> Crowd:
    """A crowd ``like`` another in a new state, without the checks: the hot path."""
    crowd = object.__new__(Crowd)
    crowd.__dict__.update(like.__dict__)
    crowd.__dict__.update(position=position, velocity=velocity, waypoint_index=waypoint_index)
    return crowd
