"""The coarse identification of a vehicle whose profile has no [model]: less than a second of CPU.

A lorry must not be driven as a car of 1,000 kg. A few drives from rest show the mass that drives
and the mass that brakes, how late each side acts, and the largest forces that arrive.
"""

from __future__ import annotations

from hashlib import sha256
from math import inf
from pathlib import Path
from typing import Final

from fmus.checking.identification import apparent_mass, modelled
from fmus.checking.judgement import ROAD
from fmus.checking.manoeuvres import Opener, Phase, drive, opener_of, without_guards
from fmus.checking.model_fit.measurements import SETTLING, STANDSTILL
from fmus.isolation import processes_reused
from fmus.profile.vehicle_profile import FittedModel, VehicleProfile

HORIZON: Final = 15  # [steps] horizon of the position error, the MPC's default
LEVELS: Final = (0.8, 2.0, 4.0, 8.0)  # [m/s2] accelerations that the drives command
TOP: Final = 14.0  # [m/s] speed at which a drive ends its acceleration
WEAKEST: Final = 0.3  # [m/s2] limit of driving or braking below which a model is none of a vehicle
FITS: Final = 0.5  # share of the variation that a model explains, from which on it is driven with
# Models by hash of the FMU, profile and step, which determine them
_models: dict[tuple[str, str, float], FittedModel] = {}


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


def quick_model(path: Path, profile: VehicleProfile, *, step_size: float) -> FittedModel:
    """Return the coarse model of an FMU, which is driven once per process.

    Args:
        path: Path of the FMU.
        profile: Profile of the vehicle.
        step_size: Step size for which a force is held [s].

    Raises:
        FmuError: as for :func:`coarse`.
    """
    key = (sha256(path.read_bytes()).hexdigest(), profile.model_dump_json(), step_size)
    if key not in _models:
        opener = opener_of(path, step_size=step_size, profile=without_guards(profile))
        _models[key] = coarse(opener, path=path, profile=profile)
    return _models[key]


def is_vehicle(model: FittedModel) -> bool:
    """Return whether a model describes a vehicle; others are judged as what the flags tell."""
    sides = [side for side in (model, model.drive, model.brake) if side is not None]
    limits = [side.limit for side in (model.drive, model.brake) if side and side.limit]
    strong = min(limits, default=inf) >= WEAKEST
    right = all(ROAD.excess(side.mass) == 1.0 for side in sides)
    return model.r_squared >= FITS and right and strong


def _test(force: float) -> list[Phase]:
    """Return the phases of a drive from rest that coasts and brakes."""
    return [
        Phase(0.0, SETTLING),
        Phase(force, 4.0, below=TOP),
        Phase(0.0, 2.0, above=STANDSTILL),
        Phase(-force, 4.0, above=STANDSTILL),
    ]
