"""The coarse identification of a vehicle whose profile has no [model]: less than a second of CPU.

A lorry must not be driven as a car of 1,000 kg. A few drives from rest show the mass that drives
and the mass that brakes, how late each side acts, and the largest forces that arrive.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

from fmus.checking.identification import apparent_mass, modelled
from fmus.checking.manoeuvres import Opener, Phase, drive
from fmus.checking.model_fit.measurements import SETTLING, STANDSTILL
from fmus.isolation import processes_reused
from fmus.profile.vehicle_profile import FittedModel, VehicleProfile

HORIZON: Final = 15  # [steps] horizon of the position error, the MPC's default
LEVELS: Final = (0.8, 2.0, 4.0, 8.0)  # [m/s2] accelerations that the drives command
TOP: Final = 14.0  # [m/s] speed at which a drive ends its acceleration


@processes_reused()
def coarse(opener: Opener, *, path: Path, profile: VehicleProfile | None = None) -> FittedModel:
    """Return a model of a vehicle from six short drives.

    Args:
        opener: Function that opens the vehicle.
        path: Path of the FMU, for messages.
        profile: Profile of the vehicle, with its inverse map.

    Raises:
        FmuOutputError: the vehicle does not drive off, or does not respond like a vehicle.
        FmuError: the FMU fails.
    """
    mass = apparent_mass(opener, path, profile)
    tests = [drive(opener, _test(level * mass)) for level in LEVELS]
    return modelled(tests, tests[2], HORIZON, path, profile, coarse=True).model


def _test(force: float) -> list[Phase]:
    """Return the phases of a drive from rest that coasts and brakes."""
    return [
        Phase(0.0, SETTLING),
        Phase(force, 4.0, below=TOP),
        Phase(0.0, 2.0, above=STANDSTILL),
        Phase(-force, 4.0, above=STANDSTILL),
    ]
