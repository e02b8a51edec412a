"""The assumptions of a run about the checked vehicle."""

from __future__ import annotations

from dataclasses import dataclass, replace

from fmus.checking.judgement import Told
from fmus.profile.vehicle_profile import FittedModel, VehicleProfile

GENTLE = 3.0  # [m/s2] acceleration of the manoeuvres, by the controller's model
USUAL = 8.0  # [m/s2] largest force over mass of a car, that of the default vehicle


@dataclass(frozen=True)
class Expected:
    """The assumptions of a run about the vehicle.

    Attributes:
        mass: Mass M of the controller's model [kg].
        friction: Friction alpha of that model [N.s/m].
        start_speed: Start speed of the run [m/s].
        force: Force of the manoeuvres [N].
        largest_force: Largest force u_max [N].
        profile: Profile of the vehicle, or None for a shipped FMU.
        told: What is told of the vehicle, for the judgement that a run makes, too.
        assumed: True if neither a flag nor the profile tells M.
        found: Model of a quick identification, with which a run drives if M is not told.
    """

    mass: float
    friction: float
    start_speed: float
    force: float
    largest_force: float
    profile: VehicleProfile | None
    told: Told
    assumed: bool = False
    found: FittedModel | None = None

    @property
    def identified(self) -> FittedModel | None:
        """The model that an earlier identification wrote into the profile, or None."""
        return self.profile.model if self.profile else None

    @property
    def brake_force(self) -> float:
        """The force [N] with which the brakes are judged: that of a car of the known mass."""
        known = self.identified or self.found
        return max(self.largest_force, 0.0 if known is None else USUAL * known.mass)

    def with_model(self, model: FittedModel, *, right: bool) -> Expected:
        """Return the assumptions after a quick identification.

        Args:
            model: Model that was found.
            right: True if it is that of a vehicle; a run then drives with it if M is not told.
        """
        force = GENTLE * model.mass
        if not (right and self.assumed):
            return replace(self, force=min(self.force, force))
        return replace(self, mass=model.mass, friction=model.friction, force=force, found=model)
