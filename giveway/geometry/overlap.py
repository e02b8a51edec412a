"""The overlap of vehicles' rectangles."""

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array

TOUCH = 0.01
"""Depth [m] up to which rectangles that reach into each other only touch."""


def rectangles_overlap(one: Array, other: Array, deeper_than: float = TOUCH) -> NDArray[np.bool_]:
    """Return whether rectangles overlap, pair by pair: no axis of either separates the two.

    Args:
        one: Rectangles (..., 5): x and y [m] of the front's middle, heading [rad], length and width
            [m].
        other: Rectangles in the same form; the leading axes of both are broadcast.
        deeper_than: Depth [m] by which they have to reach into each other.
    """
    x, y, psi, length, width = np.moveaxis(one, -1, 0)
    x_2, y_2, psi_2, length_2, width_2 = np.moveaxis(other, -1, 0)
    c, s, c_2, s_2 = np.cos(psi), np.sin(psi), np.cos(psi_2), np.sin(psi_2)
    d_x = x_2 - length_2 / 2 * c_2 - x + length / 2 * c  # vector from centre to centre
    d_y = y_2 - length_2 / 2 * s_2 - y + length / 2 * s
    along, across = np.abs(np.cos(psi_2 - psi)), np.abs(np.sin(psi_2 - psi))

    def apart(cos: Array, sin: Array, own: Array, reach: Array, its: Array) -> NDArray[np.bool_]:
        distance = np.abs(d_x * cos + d_y * sin)
        separate: NDArray[np.bool_] = (
            distance >= (own + along * reach + across * its) / 2 - deeper_than
        )
        return separate

    return ~(
        apart(c, s, length, length_2, width_2)
        | apart(-s, c, width, width_2, length_2)
        | apart(c_2, s_2, length_2, length, width)
        | apart(-s_2, c_2, width_2, width, length)
    )
