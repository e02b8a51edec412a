"""The assumptions of a run about the checked vehicle."""

from dataclasses import dataclass

from fmus.checking.judgement import Told
from fmus.checking.scale import KnownMass
from fmus.profile.tables import Axis
from fmus.profile.vehicle_profile import FittedModel, VehicleProfile

USUAL = 8.0  # [m/s2] largest force over mass of a car, that of the default vehicle


@dataclass(frozen=True)
class Expected:
    """The assumptions of a run about the vehicle.

    Attributes:
        mass: Mass M of the controller's model [kg].
        friction: Friction alpha of that model [N.s/m].
        horizon: Horizon of the MPC [steps].
        start_speed: Start speed of the run [m/s].
        force: Force of the manoeuvres [N].
        largest_force: Largest force u_max [N].
        profile: Profile of the vehicle, or None for a shipped FMU.
        known: Masses of the vehicle that the user or the profile states.
        told: What is told of the vehicle, for the judgement that a run makes, too.
    """

    mass: float
    friction: float
    horizon: int
    start_speed: float
    force: float
    largest_force: float
    profile: VehicleProfile | None
    known: tuple[KnownMass, ...] = ()
    told: Told | None = None

    @property
    def identified(self) -> FittedModel | None:
        """The model that an earlier identification wrote into the profile, or None."""
        return self.profile.model if self.profile else None

    @property
    def brake_force(self) -> float:
        """The force [N] with which the brakes are judged: that of a car of the identified mass."""
        known = 0.0 if self.identified is None else self.identified.mass
        return max(self.largest_force, USUAL * known)

    @property
    def role(self) -> str:
        """The first input that the profile wires."""
        inputs = self.profile.inputs if self.profile else None
        return next((name for name, axis in inputs or () if isinstance(axis, Axis)), "force")

    @property
    def braking_role(self) -> str:
        """The input that brakes."""
        return {"drive_force": "brake_force", "throttle": "brake"}.get(self.role, self.role)
