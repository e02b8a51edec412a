"""The priority of people: on a crossing they rely on vehicles that can still stop.

The published force does not consider the law: an approaching car pushes a person on a zebra back to
the kerb, even if its driver is about to stop. Drivers give way (Vienna Convention on Road Traffic,
1968, article 21), and people who see this walk on. Therefore a vehicle has no force on a person
with priority as long as it can stop before that person. It has its full force on people for whom
it cannot stop any more, and on people beside or behind its front. All of this file is giveway's
own.

Most drivers brake with more than 4.5 m/s^2 for something unexpected (AASHTO, A Policy on Geometric
Design of Highways and Streets, 2011, on stopping sight distance; it designs for 3.4 m/s^2), and so
do SUMO's by default. A driver who begins in time needs 2 m/s^2.
"""

from pedestrian_model._jit import inlined

#: Deceleration [m/s^2] that people with priority expect of vehicles.
DECELERATION = 4.5
#: Distance [m] to the front of a stopped vehicle, within which its force acts in full: a body's
#: radius plus the clearance of the contour.
LEAST_GAP = 0.5
#: Further distance [m] over which the force fades to 0.
FADE = 0.5


@inlined
def place_of_full_force(front: float, u: float) -> float:
    """Return the distance [m] ahead of the reference point within which the force acts in full.

    Args:
        front: Distance [m] of the front from the reference point.
        u: Speed [m/s] of the vehicle.
    """
    return front + LEAST_GAP + u * u / (2.0 * DECELERATION)


@inlined
def felt(X: float, full: float, priority: float) -> float:
    """Return the share of f_v that acts on a person.

    Args:
        X: Distance [m] of the person ahead of the reference point.
        full: Distance [m] within which the force acts in full.
        priority: Priority of the person, 0 to 1.
    """
    return 1.0 - priority * min(1.0, max(0.0, (X - full) / FADE))
