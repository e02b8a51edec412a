"""The coarse identification of a vehicle whose profile has no [model]: less than a second of CPU.

A lorry must not be driven as a car of 1,000 kg. A few drives from rest show the mass that drives
and the mass that brakes, how late each side acts, and the largest forces that arrive.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np

from fmus.checking.manoeuvres import Opener, Phase, drive
from fmus.checking.model_fit.fitting import SETTLING, STANDSTILL
from fmus.errors import FmuOutputError
from fmus.isolation import processes_reused
from fmus.profile.vehicle_profile import FittedModel

FIRST_FORCE: Final = 200.0  # [N] smallest force that is tried
STRONGEST: Final = 1e7  # [N] largest force that is tried
MOVING: Final = 1.0  # [m/s] speed at which a vehicle has driven off
HORIZON: Final = 15  # [steps] horizon of the position error, the MPC's default
LEVELS: Final = (2.0, 5.0, 9.0)  # [m/s2] accelerations that the drives command
TOP: Final = 14.0  # [m/s] speed at which a drive ends its acceleration


@processes_reused()
def coarse(opener: Opener, *, path: Path) -> FittedModel:
    """Return a model of a vehicle from four short drives.

    Args:
        opener: Function that opens the vehicle.
        path: Path of the FMU, for messages.

    Raises:
        FmuOutputError: the vehicle does not drive off, or does not respond like a vehicle.
        FmuError: the FMU fails.
    """
    from fmus.checking.identification import modelled

    mass = apparent_mass(opener, path)
    tests = [[drive(opener, _test(level * mass))] for level in LEVELS]
    return modelled(tests, tests[1][0], HORIZON, path).model


def apparent_mass(opener: Opener, path: Path) -> float:
    """Return the force over the acceleration [kg] once the vehicle has driven off.

    Args:
        opener: Function that opens the vehicle.
        path: Path of the FMU, for messages.

    Raises:
        FmuOutputError: no force drives it forwards.
    """
    forces = FIRST_FORCE * 2.0 ** np.arange(round(np.log2(STRONGEST / FIRST_FORCE)) + 1)
    phases = [Phase(float(force), 1.0, below=MOVING, above=-MOVING) for force in forces]
    trace = drive(opener, [Phase(0.0, 1.0), *phases])
    force, gained = float(trace.force[-1]), float(trace.speed[-1] - trace.speed[0])
    if gained < 0.5 * MOVING:
        raise FmuOutputError(
            f"{path}: forces of up to {force:.4g} N, each for 1 s, change its speed by "
            f"{gained:.2g} m/s; expected a vehicle that drives off; 'giveway fmu check' shows what "
            "is wrong"
        )
    first = int(np.flatnonzero(trace.force == force)[0])
    last = trace.speed[first:]
    # The force before this one was too weak to drive off: half of this one may be resistance.
    seconds = (last.size - 1) * trace.step_size
    return force * seconds / max(float(last[-1] - last[0]), 1e-3)


def _test(force: float) -> list[Phase]:
    """Return the phases of a drive from rest that coasts and brakes."""
    return [
        Phase(0.0, SETTLING),
        Phase(force, 4.0, below=TOP),
        Phase(0.0, 2.0, above=STANDSTILL),
        Phase(-force, 4.0, above=STANDSTILL),
    ]
