"""What giveway adds to a scenario: the types of its egos and pedestrians."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final
from xml.sax.saxutils import quoteattr

from giveway.errors import ScenarioError, SumoError
from giveway.scenario_files import read_scenario

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from giveway.tracks import VehicleShape

EGO_TYPE = "giveway_ego"
PEDESTRIAN_TYPE = "giveway_pedestrian"

ROAD_CLASSES: Final = (
    *("passenger", "private", "taxi", "hov", "evehicle", "vip", "emergency", "authority", "army"),
    *("bus", "coach", "tram", "delivery", "truck", "trailer"),
    *("motorcycle", "moped", "scooter", "bicycle", "custom1", "custom2"),
)
"""SUMO's vehicle classes that drive where people walk."""


def own_types(ego: VehicleShape) -> str:
    """The additional file with the types of the ego and of the added pedestrians."""
    # timeToTeleport: an ego that waits for a crowd is not stuck. speedDev=0: a drawn speed factor
    # would shift SUMO's random stream and with it the background traffic.
    return f"""<additional>
    <vType id="{EGO_TYPE}" vClass="passenger" length="{ego.length}" width="{ego.width}"
           maxSpeed="100" speedDev="0" timeToTeleport="-1"/>
    <vType id="{PEDESTRIAN_TYPE}" vClass="ignoring" speedDev="0"/>
</additional>
"""


def inserted_type(ego_id: str) -> str:
    """The type of an ego that is inserted."""
    return f"giveway_inserted_{ego_id}"


def ego_type(vehicle_class: str) -> str:
    """The type for an ego of ``vehicle_class`` that is taken over from the scenario.

    The vehicle's own length and width are to be set again afterwards, for it alone.

    Raises:
        ScenarioError: a vehicle of this class does not drive on roads.
    """
    if vehicle_class not in ROAD_CLASSES:
        msg = (
            f"vehicle class '{vehicle_class}': an ego drives where people walk; expected one of "
            f"{', '.join(ROAD_CLASSES)}; name another vehicle with --ego"
        )
        raise ScenarioError(msg)
    return f"{EGO_TYPE}_{vehicle_class}"


def all_types(egos: Mapping[str, VehicleShape]) -> str:
    """The additional file with every type that giveway may give to a vehicle or person.

    Args:
        egos: the type's id of each inserted ego, to its body.
    """
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
    walker = f'    <vType id="{PEDESTRIAN_TYPE}" vClass="ignoring" speedDev="0"/>\n'
    return "".join(["<additional>\n", *inserted, *taken_over, walker, "</additional>\n"])


def sumo_command(
    config_file: Path, types: Path, *, seed: int, step_length: float | None
) -> list[str]:
    """The command line for libsumo, without regard to outputs; :func:`prepare_start` is better.

    Args:
        config_file: the scenario's configuration.
        types: the file with our types.
        seed: SUMO's seed.
        step_length: SUMO's step [s]; None keeps the scenario's.

    Raises:
        ScenarioError: there is no such configuration.
        SumoError: it is not readable.
    """
    try:
        scenario = read_scenario(config_file)
    except ScenarioError as error:
        if not config_file.exists():
            raise
        raise SumoError(str(error)) from error
    additional = [str(types), *map(str, scenario.additional_files)]
    command = ["sumo", "-c", str(config_file)]
    command += ["--additional-files", ",".join(additional)]
    command += ["--pedestrian.model", "striping", "--gui-settings-file", ""]
    command += ["--collision.action", "warn", "--collision.check-junctions", "true"]
    command += ["--random", "false", "--seed", str(seed)]
    command += ["--no-step-log", "true", "--duration-log.disable", "true"]
    if step_length is not None:
        command += ["--step-length", f"{step_length:.6f}"]
    return command
