"""How SUMO is started: our vehicle types, its flags, the scenario's additional files."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING

from giveway.errors import ScenarioError, SumoError

if TYPE_CHECKING:
    from pathlib import Path

    from giveway.tracks import VehicleShape

EGO_TYPE = "giveway_ego"
PEDESTRIAN_TYPE = "giveway_pedestrian"


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


def sumo_command(
    config_file: Path, types: Path, *, seed: int, step_length: float | None
) -> list[str]:
    """The command line for libsumo.

    Args:
        config_file: the scenario's configuration.
        types: the file with our types.
        seed: SUMO's seed.
        step_length: SUMO's step [s]; None keeps the scenario's.

    Raises:
        ScenarioError: there is no such configuration.
        SumoError: it is not readable.
    """
    additional = [str(types), *_additional_files(config_file)]
    command = ["sumo", "-c", str(config_file)]
    command += ["--additional-files", ",".join(additional)]
    command += ["--pedestrian.model", "striping", "--gui-settings-file", ""]
    command += ["--collision.action", "warn", "--collision.check-junctions", "true"]
    command += ["--random", "false", "--seed", str(seed)]
    command += ["--no-step-log", "true", "--duration-log.disable", "true"]
    if step_length is not None:
        command += ["--step-length", f"{step_length:.6f}"]
    return command


def _additional_files(config_file: Path) -> list[str]:
    """The configuration's own additional files, absolute: naming ours replaces its list."""
    try:
        root = ET.parse(config_file).getroot()
    except FileNotFoundError:
        msg = f"{config_file}: no such file; expected a SUMO configuration (.sumocfg)"
        raise ScenarioError(msg) from None
    except (ET.ParseError, OSError) as error:
        msg = f"{config_file}: not readable as a SUMO configuration: {error}"
        raise SumoError(msg) from None
    names: list[str] = []
    for tag in ("additional-files", "additional", "a"):
        for element in root.iter(tag):
            value = element.get("value", element.get("v", ""))
            names += [name.strip() for name in value.split(",") if name.strip()]
    return [str((config_file.parent / name).resolve()) for name in names]
