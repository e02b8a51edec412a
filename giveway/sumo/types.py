"""The types of egos and pedestrians that giveway adds to a scenario."""

from collections.abc import Mapping
from typing import Final
from xml.sax.saxutils import quoteattr

from giveway.errors import ScenarioError
from giveway.geometry.bodies import VehicleShape

EGO_TYPE = "giveway_ego"
PEDESTRIAN_TYPE = "giveway_pedestrian"

ROAD_CLASSES: Final = (
    *("passenger", "private", "taxi", "hov", "evehicle", "vip", "emergency", "authority", "army"),
    *("bus", "coach", "tram", "delivery", "truck", "trailer"),
    *("motorcycle", "moped", "scooter", "bicycle", "custom1", "custom2"),
)
"""SUMO's vehicle classes that drive on roads where people walk."""


def inserted_type(ego_id: str) -> str:
    """Return the id of the type of an ego that is inserted."""
    return f"giveway_inserted_{ego_id}"


def ego_type(vehicle_class: str) -> str:
    """Return the id of the type for an ego of ``vehicle_class`` that is taken over.

    The vehicle's own length and width have to be set again afterwards, for this vehicle only.

    Raises:
        ScenarioError: a vehicle of this class does not drive on roads.
    """
    if vehicle_class not in ROAD_CLASSES:
        raise ScenarioError(
            f"vehicle class '{vehicle_class}': an ego drives where people walk; expected one of "
            f"{', '.join(ROAD_CLASSES)}; name another vehicle with --ego"
        )
    return f"{EGO_TYPE}_{vehicle_class}"


def all_types(egos: Mapping[str, VehicleShape]) -> str:
    """Return the additional file with every type that giveway may give to a vehicle or person.

    Args:
        egos: Body of each inserted ego, by the id of its type.
    """
    # timeToTeleport: an ego that waits for people must not be removed as stuck. speedDev=0: a drawn
    # speed factor would shift SUMO's random numbers and with them the background traffic.
    never_stuck = 'maxSpeed="100" speedDev="0" timeToTeleport="-1"'
    inserted = [
        f'    <vType id={quoteattr(name)} vClass="passenger" length="{body.length}" '
        f'width="{body.width}" {never_stuck}/>\n'
        for name, body in egos.items()
    ]
    taken_over = [
        f'    <vType id="{ego_type(name)}" vClass="{name}" {never_stuck}/>\n'
        for name in ROAD_CLASSES
    ]
    pedestrian = f'    <vType id="{PEDESTRIAN_TYPE}" vClass="ignoring" speedDev="0"/>\n'
    return "".join(["<additional>\n", *inserted, *taken_over, pedestrian, "</additional>\n"])
