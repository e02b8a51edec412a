"""The places of people for whom background vehicles stop: where they are and will soon be."""

import numpy as np

from controller.driving_constants import CREEPING
from giveway.cosimulation.traffic.lane_paths import Indices
from giveway.crowd.gap_acceptance import Waiting
from giveway.geometry.kernel import Array
from giveway.sumo.background import BackgroundVehicles
from pedestrian_model import Crowd, targets

BESIDE = 0.3
"""Distance [m] from a vehicle's side to the middle of a person who waits for a gap, from which on
the vehicle passes: half of the shoulder breadth and 0.03 m."""

_LOOK_AHEAD = 1.0  # Time [s] for which pedestrians are expected to keep their velocity
# Times [s] ahead at which people with priority are expected on their route
_WALKING_ON = (1.0, 2.0)
_FRONT = 1.0  # Length [m] of a body from its front on, beside which a person keeps it from starting


def expected(crowd: Crowd, waiting: Waiting | None = None) -> Array:
    """Return the present and expected places (k, 2) [m] of people who do not wait for a gap."""
    places = [crowd.position, crowd.position + _LOOK_AHEAD * crowd.velocity]
    if waiting is not None and waiting.held.any():
        places = [place[~waiting.held] for place in places]
    relying = np.flatnonzero(crowd.priority)
    if len(relying):
        place = crowd.position[relying]
        way = targets(crowd, relying) - place
        pace = crowd.desired_speed[relying] / np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-9)
        places += [place + (time * pace)[:, None] * way for time in _WALKING_ON]
    return np.concatenate(places)


def still(crowd: Crowd, waiting: Waiting) -> Array:
    """Return the places (k, 2) [m] of people who wait, and where those off the sidewalk drift."""
    drifts = waiting.held & ~waiting.stays
    there, way = crowd.position[drifts], _LOOK_AHEAD * crowd.velocity[drifts]
    return np.concatenate([crowd.position[waiting.held], there + 0.5 * way, there + way])


def touched_in_front(background: BackgroundVehicles, people: Array) -> Indices:
    """Return the rows of slow vehicles with a person beside the first metre of their bodies.

    Such a person is not ahead on the vehicle's way, and it would turn into the person as it starts.
    """
    slow = np.flatnonzero(background.speed <= CREEPING)
    cos, sin = np.cos(background.heading[slow]), np.sin(background.heading[slow])
    x = people[:, None, 0] - background.x[slow]
    y = people[:, None, 1] - background.y[slow]
    along, aside = x * cos + y * sin, np.abs(y * cos - x * sin)
    touched = (along <= 0.0) & (along >= -_FRONT) & (aside <= background.width[slow] / 2 + BESIDE)
    return slow[touched.any(axis=0)]
