"""A small world to plant violations in: a lane along x, crossed at 20 to 24 m by a crossing.

y = 3.5   kerb ------+----+------
          <- oncoming|    |
y = 0     -----------|    |------
          ego -> 1.75 m below the middle
y = -3.5  kerb ------+----+------
                     20  24  x [m]

The ego is 5 m by 2 m: it sweeps over y = -2.75 to -0.75. A body's radius is 0.27 m, so somebody who
comes from the south is on its way from y = -3.02 on and has left it at y = -0.48.
"""

from __future__ import annotations

import numpy as np

from giveway.geometry.bodies import VehicleShape
from giveway.metrics.law import Drive
from giveway.run_data.tracks import (
    BackgroundTrack,
    CrowdTrack,
    EgoTrack,
    PeopleTrack,
    SignalTrack,
)
from giveway.run_data.way import CrossingOnWay, EgoWay

DT = 0.05
LANE = -1.75
SHAPE = VehicleShape(length=5.0, width=2.0)
R = 0.27
ENTRY = 20.0  # [m] where the ego's front comes onto the crossing
SOUTH, NORTH = -3.5, 3.5
ZEBRA = CrossingOnWay(":j_c0_0", ((22.0, NORTH), (22.0, SOUTH)), 4.0, True, "", -1)
SIGNALLED = ZEBRA._replace(system="tls", link=0)
UNMARKED = ZEBRA._replace(zebra=False)


def ego(*parts, front=0.0, speed=4.0, turn=0.0):
    """An ego along +x; each part: duration [s], acceleration [m/s^2], no lower than standing."""
    accelerations = np.concatenate([np.full(round(span / DT), a) for span, a in parts])
    speeds = [speed]
    for a in accelerations:
        speeds.append(max(0.0, speeds[-1] + a * DT))
    v = np.array(speeds)
    position = np.append(0.0, np.cumsum((v[:-1] + v[1:]) / 2 * DT))
    count = len(v)
    x, y = turned(front + position, np.full(count, LANE), turn)
    none = np.full(count, "")
    far = np.full(count, np.inf)
    return EgoTrack(
        time=DT * np.arange(count),
        position=position,
        front_x=x,
        front_y=y,
        heading=np.full(count, turn),
        speed=v,
        acceleration=np.append(0.0, accelerations),
        force=np.zeros(count),
        gap=far,
        reference_speed=np.full(count, 4.0),
        vehicle_gap=far,
        stop_gap=far,
        controller=none,
        reason=none,
        solver_status=none,
        waits_for=none,
        solver_iterations=np.zeros(count, dtype=np.int64),
    )


def to_a_stand(line, *after, front=0.0, speed=4.0, braking=2.0):
    """An ego that brakes to stand at ``line`` [m]; ``after``: as for ``ego``."""
    room = speed * speed / (2 * braking)
    before = (line - room - front) / speed
    return ego((before, 0.0), (speed / braking, -braking), *after, front=front, speed=speed)


def turned(x, y, turn):
    """Points turned about the origin by an angle [rad]."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    return x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)


class Person:
    """Somebody on foot; ``places`` (m, 2) at the control instants from ``since`` [s] on."""

    def __init__(self, places, since=0.0, desired=1.4, way=((22.0, 20.0),)):
        self.places = np.asarray(places, dtype=float).reshape(-1, 2)
        self.first = round(since / DT)
        self.desired = desired
        self.way = way


def walker(y, speed=1.4, since=0.0, until=60.0, x=22.0, way=None, desired=None):
    """Somebody who walks over the crossing from ``y`` on at ``since`` [s]; speed < 0: to the south.

    Standing (speed 0) people head north unless their ``way`` says otherwise.
    """
    count = round((until - since) / DT) + 1
    places = np.column_stack([np.full(count, x), y + speed * DT * np.arange(count)])
    way = way or ((x, -20.0 if speed < 0.0 else 20.0),)
    return Person(places, since, abs(speed) or 1.4 if desired is None else desired, way)


def drive(track, *people, crossings=(ZEBRA,), lights=(), vehicles=(), turn=0.0, **way):
    """A drive to be judged.

    Args:
        track: the ego's.
        people: on foot.
        crossings: on the way.
        lights: time [s] and state of the light "tls", which every place of the way obeys.
        vehicles: id, times (n,), x (n,), y (n,), heading of each other vehicle, 4 m by 2 m.
        turn: [rad] by which the world is turned; the track already is.
        way: further fields of the way, or of the drive; ``points``: another path.
    """
    own = {name: way.pop(name) for name in ("goal", "comfortable", "shape") if name in way}
    points = way.pop("points", ((0.0, LANE), (90.0, LANE)))
    front = way.pop("front", 0.0)
    instants = len(track.time)
    records = [
        (person.first + k, who, *place)
        for who, person in enumerate(people)
        for k, place in enumerate(person.places)
        if person.first + k < instants
    ]
    rows = np.array(sorted(records), dtype=float).reshape(-1, 4)
    x, y = turned(rows[:, 2], rows[:, 3], turn)
    v_x, v_y = np.zeros(len(x)), np.zeros(len(x))
    for who in range(len(people)):
        mine = np.flatnonzero(rows[:, 1] == who)
        if len(mine) > 1:
            v_x[mine], v_y[mine] = np.gradient(x[mine], DT), np.gradient(y[mine], DT)
    ways = [
        (person.first, who, person.desired, *turned(*place, turn))
        for who, person in enumerate(people)
        for place in (person.places[0], *person.way)
    ]
    walked = np.array(ways, dtype=float).reshape(-1, 5)
    return Drive(
        ego=track,
        shape=own.pop("shape", SHAPE),
        body_radius=R,
        way=EgoWay(
            "ego",
            tuple(tuple(map(float, turned(*place, turn))) for place in points),
            front,
            tuple(
                crossing._replace(
                    ends=tuple(tuple(map(float, turned(*end, turn))) for end in crossing.ends)
                )
                for crossing in crossings
            ),
            **way,
        ),
        crowd=CrowdTrack(
            rows[:, 0].astype(np.int64),
            rows[:, 1].astype(np.int64),
            x,
            y,
            v_x,
            v_y,
            tuple(f"ped{i}" for i in range(len(people))),
        ),
        people=PeopleTrack(
            walked[:, 0].astype(np.int64), walked[:, 1].astype(np.int64), *walked[:, 2:].T.copy()
        ),
        signals=SignalTrack(
            np.array([time for time, _ in lights], dtype=float),
            np.full(len(lights), "tls"),
            np.array([state for _, state in lights], dtype=np.str_),
        ),
        vehicles=traffic(vehicles, turn),
        **own,
    )


def traffic(vehicles, turn=0.0):
    """The rows of other vehicles."""
    rows = sorted(
        (float(t), name, float(x), float(y), heading, float(speed))
        for name, times, xs, ys, heading in vehicles
        for t, x, y, speed in zip(times, *driven(times, xs, ys), strict=True)
    )
    time = np.array([row[0] for row in rows])
    x, y = turned([row[2] for row in rows], [row[3] for row in rows], turn)
    heading = np.array([row[4] for row in rows], dtype=float) + turn
    count = len(rows)
    return BackgroundTrack(
        time,
        np.array([row[1] for row in rows], dtype=np.str_),
        np.full(count, "car"),
        x,
        y,
        heading,
        np.array([row[5] for row in rows], dtype=float),
        np.full(count, 4.0),
        np.full(count, 2.0),
    )


def driven(times, xs, ys):
    """Places and speeds of one vehicle."""
    _, x, y = np.broadcast_arrays(times, xs, ys)
    if len(x) < 2:
        return x, y, np.full(len(x), 4.0)
    return x, y, np.hypot(np.gradient(x, times), np.gradient(y, times))
