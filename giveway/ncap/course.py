"""The road of the tests: one straight lane, and, for obstructed people, the parked cars beside it.

The scenario is written for each table, since the distance to the parked cars is told from the
side of the car, whose width differs. No netconvert is needed.
"""

from pathlib import Path
from typing import Final

import numpy as np

from giveway.geometry.path import EgoPath
from giveway.ncap.protocol import ParkedCars
from giveway.scenario_files.configuration_text import configuration_of
from giveway.studies.folder.atomic_files import write_atomically

LENGTH: Final = 1000.0
"""Length [m] of the road, which begins at x = 0 and lies on y = 0."""
LINE: Final = 600.0
"""Place x [m] at which the middle of the dummy's box is to be hit."""
DRIVE, GATE = "drive", "gate"
"""Ids of the edge of the road, and of the edge at which SUMO registers people."""
_PARKING = "parking"
_FASTEST = 40.0  # Speed limit [m/s]
_GATE = -60.0  # Place y [m] of the edge for people
_WIDTH = 3.5  # Width [m] of a lane
_NET = """<?xml version="1.0" encoding="UTF-8"?>
<net version="1.20" junctionCornerDetail="5" limitTurnSpeed="5.50">
    <location netOffset="0.00,0.00" convBoundary="{bounds}" \
origBoundary="{bounds}" projParameter="!"/>
{edges}{junctions}</net>
"""
_EDGE = """    <edge id="{name}" from="{name}_west" to="{name}_east" priority="-1" \
spreadType="center">
        <lane id="{name}_0" index="0" {who} speed="{limit:.2f}" length="{length:.2f}" \
width="{width:.2f}" shape="{shape}"/>
    </edge>
"""
_JUNCTION = """    <junction id="{name}_{end}" type="dead_end" x="{x:.2f}" y="{y:.4f}" \
incLanes="{lanes}" intLanes="" shape="{x:.2f},{y:.4f} {x:.2f},{above:.4f}"/>
"""
_PARKED = """    <vType id="parked{n}" vClass="passenger" length="{length}" width="{width}" \
height="{height}"/>
    <vehicle id="parked.{n}" type="parked{n}" depart="0" departPos="{front:.4f}" departSpeed="0">
        <route edges="parking"/>
        <stop lane="parking_0" endPos="{front:.4f}" startPos="{rear:.4f}" duration="1000"/>
    </vehicle>
"""


def write_course(
    folder: Path,
    name: str,
    width: float,
    parked: ParkedCars | None = None,
    half: float = 0.0,
    path: EgoPath | None = None,
) -> Path:
    """Write the scenario of the tests, and return its configuration file.

    Args:
        folder: Folder for the files.
        name: Name of the scenario.
        width: Width [m] of the car that is tested.
        parked: Parked cars, or None without any.
        half: Half the width [m] of the dummy's box, from which they are told.
        path: Path of the car, or None if it is straight.
    """
    beside = -(width / 2.0 + (0.0 if parked is None else parked.gap + parked.width / 2.0))
    straight = EgoPath.through([[0.0, 0.0], [LENGTH, 0.0]])
    cars_only = 'disallow="pedestrian"'
    roads = {
        DRIVE: (path or straight, cars_only),
        GATE: (_moved(straight, _GATE), 'allow="pedestrian"'),
    }
    if parked is not None:
        roads[_PARKING] = (_moved(straight, beside), cars_only)
    points = np.concatenate([way.vertices for way, _ in roads.values()])
    bounds = ",".join(f"{value:.2f}" for value in (*points.min(axis=0), *points.max(axis=0)))
    edges = "".join(
        _EDGE.format(
            name=edge,
            who=who,
            limit=_FASTEST,
            length=way.length,
            width=_WIDTH,
            shape=" ".join(f"{x:.5f},{y:.5f}" for x, y in way.vertices),
        )
        for edge, (way, who) in roads.items()
    )
    junctions = "".join(
        _JUNCTION.format(
            name=edge,
            end=end,
            x=x,
            y=y,
            above=y + 1.0,
            lanes=f"{edge}_0" if end == "east" else "",
        )
        for edge, (way, _) in roads.items()
        for end, (x, y) in (("west", way.vertices[0]), ("east", way.vertices[-1]))
    )
    front, cars = LINE - half, []
    for number, length in enumerate(() if parked is None else parked.lengths):
        assert parked is not None
        front -= parked.gap
        cars.append(
            _PARKED.format(
                n=number,
                length=length,
                width=parked.width,
                height=parked.height,
                front=front,
                rear=front - length,
            )
        )
        front -= length
    written = {
        f"{name}.net.xml": _NET.format(bounds=bounds, edges=edges, junctions=junctions),
        f"{name}.rou.xml": f"<routes>\n{''.join(reversed(cars))}</routes>\n",
        f"{name}.sumocfg": configuration_of(name, 200.0, routes=[f"{name}.rou.xml"]),
    }
    for file, text in written.items():
        write_atomically(folder / file, text)
    return folder / f"{name}.sumocfg"


def _moved(path: EgoPath, y: float) -> EgoPath:
    """Return a path aside by ``y`` [m]."""
    return EgoPath.through(path.vertices + np.array([0.0, y]))
