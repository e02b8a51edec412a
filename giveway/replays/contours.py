"""The vehicle's influence as lines of equal force, for a range of its speeds."""

from typing import Any, cast

import numpy as np
from contourpy import contour_generator

from giveway.figures.influence_figure import (
    DRAWN,
    FRONT_MARGIN,
    FRONT_MARGIN_PER_SPEED,
    REAR_MARGIN,
    SIDE_MARGIN,
)
from giveway.geometry.kernel import Array
from giveway.replays.packed_tracks import MILLIMETRES, packed
from pedestrian_model import VciParameters, Vehicles, vehicle_influence

_RESOLUTION = 0.15  # Grid width [m]
# Speeds [m/s] at low speed; below 0.2 a vehicle is an obstacle like a wall
_SLOW = (0.0, 0.1, 0.3, 0.5)
_STEP = 0.25  # Step [m/s] between the other speeds
_MOST_SPEEDS = 40


def influence_contours(
    shape: tuple[float, float], fastest: float, parameters: VciParameters
) -> dict[str, Any]:
    """Return the lines of 10, 100 and 1000 N around a vehicle, in its own frame.

    The force is that on a standing pedestrian, as ``giveway plot influence`` draws it.

    Args:
        shape: Length and width [m].
        fastest: Highest speed [m/s] that is needed.
        parameters: Parameters of the pedestrian model.

    Returns:
        ``speeds`` [m/s] and ``levels`` [N]; the points ``x``, ``y`` [mm] from the body's centre,
        heading along +x; ``lines``: for each speed and level, the points at which its pieces begin,
        and the last one's end.
    """
    step = max(_STEP, fastest / _MOST_SPEEDS)
    speeds = np.append(_SLOW, np.arange(0.75, fastest + step, step))
    points: list[Array] = []
    lines: list[list[list[int]]] = []
    begun = 0
    for speed in speeds:
        of_speed = []
        for pieces in _contours(shape, float(speed), parameters):
            starts = [begun]
            for piece in pieces:
                points.append(piece)
                begun += len(piece)
                starts.append(begun)
            of_speed.append(starts)
        lines.append(of_speed)
    x, y = np.concatenate([np.empty((0, 2)), *points]).T * MILLIMETRES
    return {
        "speeds": [round(float(speed), 3) for speed in speeds],
        "levels": list(DRAWN),
        "lines": lines,
        "x": packed(np.round(x), np.int32),
        "y": packed(np.round(y), np.int32),
    }


def _contours(
    shape: tuple[float, float], speed: float, parameters: VciParameters
) -> list[list[Array]]:
    """Return for each level the pieces of its contour, each with k points (k, 2) [m]."""
    length, width = shape
    ahead = length / 2 + FRONT_MARGIN + FRONT_MARGIN_PER_SPEED * speed
    half_height = width / 2 + SIDE_MARGIN
    x = np.arange(-length / 2 - REAR_MARGIN, ahead + _RESOLUTION, _RESOLUTION)
    y = np.linspace(-half_height, half_height, 2 * round(half_height / _RESOLUTION) + 1)
    across, up = np.meshgrid(x, y)
    places = np.column_stack((across.ravel(), up.ravel()))
    vehicle = Vehicles.create(0.0, 0.0, 0.0, speed, length / 2, length / 2, width)
    force, *_ = vehicle_influence(places, np.zeros_like(places), vehicle, parameters)
    # Forces fall exponentially, so their logarithm is nearly linear between the grid's points.
    magnitude = np.log(np.maximum(np.hypot(*force.T), 1e-6)).reshape(across.shape)
    # the contour algorithm that matplotlib uses
    generator = contour_generator(x, y, magnitude, name="mpl2014", line_type="SeparateCode")
    pieces = [cast("list[Array]", generator.lines(level)[0]) for level in np.log(DRAWN)]
    return [[piece for piece in of_level if len(piece) > 2] for of_level in pieces]
