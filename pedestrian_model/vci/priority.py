"""People with priority: on a crossing that is theirs, they rely on vehicles that can still stop.

The published force does not know the law: an approaching car pushes somebody on a zebra back to
the kerb, whatever its driver is about to do. Drivers give way (Vienna Convention on Road Traffic,
1968, article 21), and people who see that they can walk on. So a vehicle's force on somebody with
priority is left out as long as the vehicle can stop before that person, and acts in full on whom
it cannot stop for any more, and on whoever is beside or behind its front. All of this file is ours.

Most drivers brake with more than 4.5 m/s^2 for something unexpected (AASHTO, A Policy on Geometric
Design of Highways and Streets, 2011, on stopping sight distance; it designs for 3.4 m/s^2), and so
do SUMO's by default; who begins in time needs 2 m/s^2.
"""

from pedestrian_model._jit import inlined

#: [m/s^2] people with priority take vehicles to brake with this, if need be.
DECELERATION = 4.5
#: [m] before the front of a vehicle that has stopped: nearer, it acts in full; a body's radius and
#: the clearance of the contour come to this.
LEAST_GAP = 0.5
#: [m] more than that, over which the force fades.
FADE = 0.5


@inlined
def place_of_full_force(front: float, u: float) -> float:
    """Return how far [m] before its reference point a vehicle of speed ``u`` acts in full."""
    return front + LEAST_GAP + u * u / (2.0 * DECELERATION)


@inlined
def felt(X: float, full: float, priority: float) -> float:
    """Return the share of f_v felt with ``priority`` (0 to 1), X [m] before the reference point."""
    return 1.0 - priority * min(1.0, max(0.0, (X - full) / FADE))
