"""The checks of a network that SUMO loads although no run could use it."""

from pathlib import Path
from typing import Any, Final

from giveway.errors import ScenarioError

_WIDEST_NETWORK: Final = 5e6  # Largest extent [m] of a network, that of a continent
_LONGEST_LANE: Final = 1e5  # Largest length [m] of a lane
_WIDEST_LANE: Final = 50.0  # Largest width [m] of a lane, that of a square for people


def require_sound(sumo: Any, config_file: Path) -> None:
    """Make sure that the loaded network is in metres, and that its lanes have SUMO's names.

    Args:
        sumo: The libsumo module, in which the network is loaded.
        config_file: Scenario, for messages.

    Raises:
        ScenarioError: the network is not sound.
    """
    low, high = sumo.simulation.getNetBoundary()
    extent = max(high[0] - low[0], high[1] - low[1])
    if not extent <= _WIDEST_NETWORK:
        raise _not_metres(config_file, f"is {extent:.3g} m wide", _WIDEST_NETWORK)
    for lane in sumo.lane.getIDList():
        edge, length, width = sumo.lane.getEdgeID(lane), sumo.lane.getLength, sumo.lane.getWidth
        if lane.rpartition("_")[0] != edge or not lane[len(edge) + 1 :].isdecimal():
            raise ScenarioError(
                f"{config_file}: lane '{lane}' of edge '{edge}': expected the name '{edge}_INDEX'; "
                "write the network with netconvert, which names lanes so"
            )
        for size, what, largest in (
            (length(lane), "long", _LONGEST_LANE),
            (width(lane), "wide", _WIDEST_LANE),
        ):
            if not size <= largest:
                raise _not_metres(config_file, f"has lane '{lane}', {size:.3g} m {what}", largest)


def _not_metres(config_file: Path, said: str, largest: float) -> ScenarioError:
    return ScenarioError(
        f"{config_file}: its network {said}; expected at most {largest:g} m; a network is in "
        "metres: write it again in metres"
    )
