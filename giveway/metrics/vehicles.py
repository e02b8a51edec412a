"""Which background vehicles came into contact with the ego."""

from typing import NamedTuple

import numpy as np

from giveway.geometry.bodies import VehicleShape
from giveway.geometry.overlap import rectangles_overlap
from giveway.run_data.tracks import BackgroundTrack, EgoTrack

_SAME_INSTANT = 1e-6  # [s]


class VehicleContact(NamedTuple):
    """One background vehicle whose rectangle overlapped the ego's."""

    id: str
    first: float  # [s] simulation time of the first instant
    duration: float  # [s] of all contacts with it


def vehicle_contacts(
    ego: EgoTrack, background: BackgroundTrack, shape: VehicleShape
) -> tuple[VehicleContact, ...]:
    """The background vehicles that overlapped the ego, in the order of their first contact.

    Background vehicles are looked at where SUMO has put them, at SUMO's instants; an instant stands
    for the time until the next one of the same vehicle.

    Args:
        ego: the ego's track, T instants.
        background: the background vehicles' rows.
        shape: the ego's rectangle.
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
