"""The force by which people keep away from a vehicle, which a fit must not lose."""

from typing import Final

import numpy as np

from pedestrian_model import VciParameters, Vehicles, vehicle_influence

_CAR: Final = Vehicles(np.array([[0.0, 0.0, 0.0, 3.0, 2.25, 2.25, 1.8]]))  # at 3 m/s
_PLACES: Final = np.array([(4.25, 0.5), (0.0, 1.9)])  # 2 m ahead of it, 1 m beside it
_LEAST = 0.5  # Least share of the force that a fit keeps,
_ENOUGH = 100.0  # if it is less than this one [N], by which people of 80 kg gain 1.25 m/s^2


def lost(before: VciParameters, after: VciParameters) -> list[str]:
    """Return a sentence for each place near a car where the force is lost.

    Recorded people hardly exceed 1 m/s^2. So a strong force may fade, but not below what moves
    them.

    Args:
        before: Parameters from which the fit started.
        after: Fitted parameters.
    """
    standing = np.zeros((2, 2))
    forces = [
        np.hypot(*vehicle_influence(_PLACES, standing, _CAR, parameters)[0].T)
        for parameters in (before, after)
    ]
    return [
        f"A car at 3 m/s pushes people {where} with {now:.0f} N, {then:.0f} N before the fit."
        for where, then, now in zip(("2 m ahead of it", "1 m beside it"), *forces, strict=True)
        if now < min(_LEAST * then, _ENOUGH)
    ]
