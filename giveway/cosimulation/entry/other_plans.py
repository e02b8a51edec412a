"""The plans of SUMO for a vehicle that an ego does not follow: refused, or told.

An ego follows the route and the stops that its vehicle has as it departs.
"""

from collections.abc import Iterable, Sequence

from giveway.errors import ScenarioError
from giveway.scenario_files.rerouters import Rerouter
from giveway.sumo.devices import Devices
from giveway.sumo.vehicles import PlannedStop


def require_own_plan(
    name: str, devices: Devices, stops: Iterable[PlannedStop], *, serves: bool
) -> None:
    """Make sure that a vehicle's plan does not depend on what happens in SUMO.

    Args:
        name: Id of the vehicle.
        devices: Devices of vehicles.
        stops: Stops ahead of it.
        serves: Whether the ego serves stops.

    Raises:
        ScenarioError: it is a taxi, or waits for passengers at a stop that it serves.
    """
    if devices.is_taxi(name):
        raise ScenarioError(
            f"--ego {name}: the vehicle has SUMO's taxi device, which sends it to its customers; "
            "an ego keeps the route of its departure; name another vehicle, or remove "
            "has.taxi.device from it or its type"
        )
    for stop in stops:
        if stop.triggered and serves:
            raise ScenarioError(
                f"--ego {name}: its stop on lane '{stop.lane}' waits for passengers or containers "
                "(triggered), who cannot board an ego; give the stop a duration or an until "
                "instead, name another vehicle, or leave its stops out (--no-rules-stops)"
            )


def remarks_on_route(
    name: str, edges: Sequence[str], devices: Devices, rerouters: Iterable[Rerouter]
) -> list[str]:
    """Return remarks on what would change a vehicle's route, and keep SUMO from changing it.

    Args:
        name: Id of the vehicle.
        edges: Edges of its route.
        devices: Devices of vehicles.
        rerouters: Rerouters of the scenario.
    """
    remarks = []
    for rerouter in rerouters:
        shared = [edge for edge in edges if edge in rerouter.edges]
        if shared:
            remarks.append(
                f"ego '{name}': rerouter '{rerouter.id}' on its edge '{shared[0]}' does not change "
                'its route; give the vehicle the other route, or switch the rerouter off (off="1")'
            )
    if devices.reroutes(name):
        devices.keep_route(name)
        remarks.append(
            f"ego '{name}': it keeps the route of its departure, although it has SUMO's rerouting "
            'device; has.rerouting.device="false" on the vehicle removes it'
        )
    return remarks
