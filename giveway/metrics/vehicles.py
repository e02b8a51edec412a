"""The background vehicles that had contact with the ego."""

from typing import NamedTuple

import numpy as np

from giveway.geometry.bodies import VehicleShape
from giveway.geometry.overlap import rectangles_overlap
from giveway.run_data.tracks import BackgroundTrack, EgoTrack

_SAME_INSTANT = 1e-6  # Difference [s] up to which two instants are one


class VehicleContact(NamedTuple):
    """A background vehicle whose rectangle overlapped the ego's."""

    id: str
    first: float  # [s] first instant of contact, in simulation time
    duration: float  # [s] duration of all contacts together


def vehicle_contacts(
    ego: EgoTrack, background: BackgroundTrack, shape: VehicleShape
) -> tuple[VehicleContact, ...]:
    """Return the background vehicles that overlapped the ego, in order of their first contact.

    Background vehicles are at the instants and places that SUMO gives. An instant stands for the
    time until the same vehicle's next one.

    Args:
        ego: Track of the ego, T instants.
        background: The background vehicles.
        shape: Rectangle of the ego.
    """
    if not len(background.time) or not len(ego.time):
        return ()
    at = np.minimum(np.searchsorted(ego.time, background.time - _SAME_INSTANT), len(ego.time) - 1)
    x, y = ego.front_x[at], ego.front_y[at]
    apart = np.hypot(background.x - x, background.y - y)
    reach = shape.length + shape.width + background.length + background.width
    together = np.abs(ego.time[at] - background.time) <= _SAME_INSTANT
    near = np.flatnonzero(together & (apart <= reach))
    own = np.empty((len(near), 5))
    own[:, 0], own[:, 1], own[:, 2] = x[near], y[near], ego.heading[at[near]]
    own[:, 3:] = shape.length, shape.width
    others = np.column_stack(
        [background.x, background.y, background.heading, background.length, background.width]
    )[near]
    touching = near[rectangles_overlap(own, others)]
    contacts = []
    for name in dict.fromkeys(background.id[touching].tolist()):
        seen = np.flatnonzero(background.id == name)
        lasting = np.diff(background.time[seen], append=background.time[seen[-1]])
        in_contact = np.isin(seen, touching)
        first = float(background.time[seen[in_contact][0]])
        contacts.append(VehicleContact(name, first, float(lasting[in_contact].sum())))
    return tuple(contacts)
