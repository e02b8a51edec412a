"""The vehicles that a crowd reacts to: moving rectangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pedestrian_model._check import as_floats, check_shape, check_values
from pedestrian_model.arrays import FRONT, HEADING, REAR, SPEED, WIDTH, X, Y
from pedestrian_model.errors import VehicleError

COLUMNS = ("x", "y", "heading", "speed", "front", "rear", "width")


@dataclass(frozen=True, eq=False)
class Vehicles:
    """The poses of m rectangles, one row each: x, y, heading, speed, front, rear, width.

    x, y [m] is the reference point. heading [rad] is counter-clockwise from +x. speed [m/s] is
    longitudinal, negative in reverse. front and rear [m] are the distances from the reference
    point to the bumpers. width is in [m]. It is made by ``Vehicles.create`` or ``Vehicles.empty``.
    ``array`` may be changed in place.

    Raises:
        VehicleError: if the array has a wrong shape, or a value is not finite or out of range.
    """

    array: NDArray[np.float64]  # (m, 7)

    def __post_init__(self) -> None:
        check_shape(self.array, (None, 7), "vehicles", VehicleError)
        if self.array.dtype != np.float64 or not self.array.flags.c_contiguous:
            raise VehicleError(
                f"vehicles is {self.array.dtype}, expected C-contiguous float64: Vehicles.create"
            )
        check_values(self.array, "vehicles", VehicleError)
        for column, sense in ((WIDTH, "> 0"), (FRONT, ">= 0"), (REAR, ">= 0")):
            values = self.array[:, column]
            bad = values <= 0.0 if sense == "> 0" else values < 0.0
            if bad.any():
                i = int(np.argmax(bad))
                raise VehicleError(
                    f"{COLUMNS[column]} of vehicle {i} = {values[i]} m, expected {sense} m"
                )

    def __len__(self) -> int:
        return int(self.array.shape[0])

    @classmethod
    def create(
        cls,
        x: ArrayLike,
        y: ArrayLike,
        heading: ArrayLike,
        speed: ArrayLike,
        front: ArrayLike = 2.5,
        rear: ArrayLike = 2.5,
        width: ArrayLike = 2.0,
    ) -> Vehicles:
        """Return vehicles from one number or (m,) numbers per quantity, by default the paper's car.

        Raises:
            VehicleError: a value is invalid; the message has the column, the vehicle and the value.
        """
        columns = [
            as_floats(values, name, VehicleError)
            for name, values in zip(
                COLUMNS, (x, y, heading, speed, front, rear, width), strict=True
            )
        ]
        try:
            rows = np.broadcast_arrays(*(np.atleast_1d(column) for column in columns))
        except ValueError:
            sizes = ", ".join(f"{n}: {c.size}" for n, c in zip(COLUMNS, columns, strict=True))
            raise VehicleError(f"lengths differ ({sizes}), expected one or m values") from None
        return cls(np.ascontiguousarray(np.stack(rows, axis=-1)))

    @classmethod
    def empty(cls) -> Vehicles:
        """Return an array without vehicles."""
        return cls(np.empty((0, 7)))

    @property
    def x(self) -> NDArray[np.float64]:
        """The x coordinates (m,) [m] of the reference points."""
        return self.array[:, X]

    @property
    def y(self) -> NDArray[np.float64]:
        """The y coordinates (m,) [m] of the reference points."""
        return self.array[:, Y]

    @property
    def heading(self) -> NDArray[np.float64]:
        """The headings (m,) [rad], counter-clockwise from +x."""
        return self.array[:, HEADING]

    @property
    def speed(self) -> NDArray[np.float64]:
        """The speeds (m,) [m/s] along the heading."""
        return self.array[:, SPEED]
