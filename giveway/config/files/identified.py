"""The values of [vehicle] that an identified model gives."""

from fmus.profile.vehicle_profile import FittedModel
from giveway.config.tables.basics import IDENTIFIED, VehicleConfig


def identified_vehicle(model: FittedModel) -> dict[str, float]:
    """Return M, alpha and the limits of the force by key of [vehicle].

    The largest force is that of the stronger side. A side without a limit is as strong as the
    default car of the same mass. Forces change as fast as that car's.

    Args:
        model: Model of the vehicle.
    """
    usual = VehicleConfig()
    limits = [
        side.mass * (usual.acceleration_limit if side.limit is None else side.limit)
        for side in (model.drive, model.brake)
        if side is not None
    ]
    force = max(limits, default=model.mass * usual.acceleration_limit)
    rate = usual.force_rate_limit / usual.mass * model.mass
    return dict(zip(IDENTIFIED, (model.mass, model.friction, force, rate), strict=True))
