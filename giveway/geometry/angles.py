"""SUMO's navigational angles (degrees, 0 is north, clockwise) and our headings.

A heading is in radians, counter-clockwise from +x.
"""

from __future__ import annotations

import math

import numpy as np

from giveway.geometry.kernel import Array, kernel


def heading_to_angle(heading: float) -> float:
    """The navigational angle [deg] of a heading [rad]."""
    return (90.0 - math.degrees(heading)) % 360.0


def angle_to_heading(angle: float) -> float:
    """The heading [rad] of a navigational angle [deg]."""
    return math.radians(90.0 - angle)


def angles_to_headings(angles: Array) -> Array:
    """The headings (n,) [rad] of navigational angles (n,) [deg]."""
    headings: Array = np.radians(90.0 - angles)
    return headings


def headings_to_angles(headings: Array) -> Array:
    """The navigational angles (n,) [deg] of headings (n,) [rad], as tables keep them: rounded."""
    return np.mod(np.round(90.0 - np.degrees(headings), 6), 360.0)


@kernel
def angle_of_velocity(v_x: float, v_y: float) -> float:
    """The navigational angle [deg] into which a velocity points."""
    return float((90.0 - np.degrees(np.arctan2(v_y, v_x))) % 360.0)
