"""The declarations of giveway's own controllers, by their public names."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from controller.defaults import REFERENCE_SPEED
from controller.plug_in import Defaults

# Yang & Özgüner 2019: one speed, an open space without rules, exact positions, no safety layer,
# people who walk by their own parameters.
_PAPER: Final = Defaults(REFERENCE_SPEED, False, False, False, buffered=True, crowd_preset="SIM")

DECLARED: Final[Mapping[str, Defaults]] = MappingProxyType(
    {
        "mpc": Defaults(optimises=True),
        "pid-tuned": Defaults(smooths=True),
        "mpc-paper": _PAPER._replace(optimises=True),
        "pid-paper": _PAPER,
    }
)
