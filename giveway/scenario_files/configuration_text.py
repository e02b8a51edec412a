"""The configuration (.sumocfg) of a scenario that giveway writes."""

from collections.abc import Sequence
from typing import Final

_CONFIGURATION: Final = """<?xml version="1.0" encoding="UTF-8"?>
<configuration>
    <input>
        <net-file value="{name}.net.xml"/>
{routes}    </input>
    <time>
        <begin value="0"/>
        <end value="{end:g}"/>
        <step-length value="{step:g}"/>
    </time>
    <processing>
        <pedestrian.model value="striping"/>
    </processing>
</configuration>
"""


def configuration_of(
    name: str, end: float, *, step: float = 0.05, routes: Sequence[str] = ()
) -> str:
    """Return the text of the configuration ``NAME.sumocfg``.

    Args:
        name: Name of the scenario.
        end: Time [s] at which it ends.
        step: Time step [s] of SUMO.
        routes: Files of routes, if there are any.
    """
    files = f'        <route-files value="{",".join(routes)}"/>\n' if routes else ""
    return _CONFIGURATION.format(name=name, end=end, step=step, routes=files)
