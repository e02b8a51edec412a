"""Background vehicles let egos with priority go first at junctions.

SUMO's drivers look for vehicles that approach a junction on a lane. They do not reliably find an
ego that is moved from outside (SUMO issues 6140, 6152, 10952), so that a car from a side road would
drive into its path. Therefore the vehicles that have to yield to an ego, by the network's
``request`` rows and the current signal state, stop at their line until it has gone. A vehicle that
is in the junction already stops before the two paths cross. A vehicle that stands does not start
into the way of an ego that drives off or through the junction, whichever has priority.
"""

from collections.abc import Mapping

from controller.driving_constants import (
    FIRM,
    PULL_AWAY,
    PULL_AWAY_USUAL,
    SAFE_TIME,
    SAFE_TIME_BEHIND,
    STANDING,
    UNHURRIED,
)
from giveway.ego.ego import Ego
from giveway.ego.rules.gap_acceptance import travel_time
from giveway.ego.rules.junctions import RED, SIGHT, Approach, PathJunction, Traffic, letter_of
from giveway.ego.rules.yielding import USUAL_SPEED, needed_braking
from giveway.geometry.conflict import Conflict

# Distance [m] before the ego's path at which a vehicle in the junction stops
_BEFORE_CONFLICT = 1.0
_SETS_OFF = 2.0  # Distance [m] before its line within which an ego that moves drives off


def rooms_before(ego: Ego, states: Mapping[str, str], traffic: Traffic) -> dict[str, float]:
    """The room [m] to stop for each vehicle that has to wait for an ego, by the vehicle's id.

    Args:
        ego: Ego on the road.
        states: State of each traffic light system, one of SUMO's letters per movement.
        traffic: Vehicles that approach each junction.
    """
    found: dict[str, float] = {}
    for place in ego.rules.junctions:
        ahead = place.entry - ego.front
        if ahead > SIGHT or ego.front > place.exit:
            continue
        letter = letter_of(place.movement, states)
        inside = ahead <= 0.0
        if not inside and (ego.rules.stop <= place.entry or letter in RED):
            continue  # the ego itself waits
        for other in traffic.get(place.movement.junction, ()):
            where = place.conflicts.get(other.number)
            if other.name == ego.id or where is None or (inside and ego.rules.stop <= where.enter):
                continue
            room = other.distance
            if room <= 0.0:  # the other vehicle is in the junction
                room += where.other_enter - _BEFORE_CONFLICT
            if room <= 0.0 or needed_braking(other.speed, room) > FIRM:
                continue
            if _gives_way(place, where, other, inside, states, ego):
                found[other.name] = min(room, found.get(other.name, room))
    return found


def _gives_way(
    place: PathJunction,
    where: Conflict,
    other: Approach,
    inside: bool,
    states: Mapping[str, str],
    ego: Ego,
) -> bool:
    """Return whether a vehicle has to let the ego go first, and the two would meet otherwise."""
    movement = place.movements[other.number]
    if ego.front - ego.shape.length > where.leave:
        return False
    its = letter_of(movement, states)
    named = place.movement.number in movement.yields_to
    mutual = other.number in place.movement.yields_to
    speed, front = ego.vehicle.speed, ego.front
    comes = travel_time(where.enter - front, speed, PULL_AWAY, max(USUAL_SPEED, speed))
    goes = travel_time(where.leave + ego.shape.length - front, speed, UNHURRIED, max(speed, 4.0))
    owes = its != "G" and named and (inside or not mutual)
    sets_off = place.entry - front <= _SETS_OFF and speed >= STANDING
    lets = sets_off and other.standing > 0.0
    if its in RED or not (owes or lets):
        return False
    fastest = max(USUAL_SPEED, other.speed)
    enters, clears = (
        travel_time(other.distance + station, other.speed, PULL_AWAY_USUAL, fastest)
        for station in (where.other_enter, where.other_leave + other.length)
    )
    return clears + SAFE_TIME > comes and goes + SAFE_TIME_BEHIND > enters
