"""The configuration of a run: every option once, with its unit, bounds, default and source.

The TOML file, the command line's flags and the Python API are all derived from these classes.
Defaults are the reproduction of Yang & Özgüner 2019 (arXiv 1907.05178), their table 1, read as
docs/reproduction.md explains.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, JsonValue, model_validator

ControllerName = Literal["mpc", "pid"]


def option(
    default: Any, unit: str | None, description: str, *, flag: str | None = None, **bounds: Any
) -> Any:
    """A documented option: its unit, what it means, its flag where the derived one is clumsy."""
    extra: dict[str, JsonValue] = {"unit": unit, "flag": flag}
    return Field(default, description=description, json_schema_extra=extra, **bounds)


def _split(value: Any) -> Any:
    """A comma-separated flag value as the list that a TOML file would hold."""
    return [part.strip() for part in value.split(",")] if isinstance(value, str) else value


Rectangle = Annotated[tuple[float, float, float, float], BeforeValidator(_split)]
Displacement = Annotated[tuple[float, float], BeforeValidator(_split)]
EdgeList = Annotated[tuple[str, ...], BeforeValidator(_split)]


_FARTHEST = 1e7  # [m] beyond it a millimetre is lost in rounding


class Section(BaseModel):
    """A table of the configuration: frozen, finite numbers only, unknown keys refused."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, validate_default=True
    )


class EgoConfig(Section):
    """Where the ego enters the network and how far it drives."""

    id: str = option("ego", None, "SUMO id of the ego", min_length=1)
    route: EdgeList = option((), None, "edges that the ego drives along, comma-separated")
    lane: int = option(0, None, "index of the departure lane, 0 is the rightmost", ge=0)
    depart_time: float = option(
        0.0, "s", "simulation time at which the ego enters; at begin if that is later", ge=0, le=1e6
    )
    depart_position: float = option(
        0.0, "m", "front bumper's place on the first edge at departure", ge=0, le=1e6
    )
    initial_speed: float = option(4.0, "m/s", "speed at departure", ge=0, le=70)
    travel_distance: float = option(
        40.0, "m", "the run is complete when the ego has driven this far", gt=0, le=1e5
    )


class VehicleConfig(Section):
    """The vehicle FMU, its body, and the plant parameters that the MPC shares with it."""

    fmu: str = option(
        "fmi2", None, "vehicle FMU: 'fmi2' or 'fmi3' (bundled), or a path", flag="--vehicle"
    )
    mass: float = option(1000.0, "kg", "M of M s'' + alpha s' = u", gt=0, le=1e6)
    friction: float = option(100.0, "N.s/m", "alpha of M s'' + alpha s' = u", ge=0, le=1e6)
    exact: bool = option(False, None, "exact discretisation instead of the paper's forward Euler")
    length: float = option(5.0, "m", "body length", gt=0, le=50)
    width: float = option(2.0, "m", "body width", gt=0, le=10)


class CrowdConfig(Section):
    """The pedestrians that giveway adds: how many, where, where to and how fast."""

    pedestrians: int = option(
        30, "persons", "pedestrians to add", flag="--pedestrians", ge=0, le=20_000
    )
    spawn_area: Rectangle = option(
        (23.3, -23.4, 33.2, -12.0),
        "m",
        "x_min,y_min,x_max,y_max of the rectangle they start in",
        flag="--spawn-area",
    )
    walk: Displacement = option(
        (0.0, 30.0), "m", "dx,dy from each one's start to the destination", flag="--walk"
    )
    two_sided: bool = option(
        False, None, "every second pedestrian comes from the other side", flag="--two-sided"
    )
    desired_speed_mean: float = option(1.394, "m/s", "mean desired speed", gt=0, le=2.5)
    desired_speed_sd: float = option(0.26, "m/s", "its standard deviation", ge=0, le=2)
    desired_speed_min: float = option(0.5, "m/s", "its lower truncation", gt=0, le=2.5)
    desired_speed_max: float = option(2.2, "m/s", "its upper truncation", gt=0, le=2.5)
    minimum_spacing: float = option(0.5, "m", "no two start closer than this", ge=0, le=10)
    host_edge: str = option("", None, "edge that hosts the added persons inside SUMO")
    preset: Literal["SIM", "TABLE2"] = option("SIM", None, "parameter set of the VCI model")

    @model_validator(mode="after")
    def _ordered(self) -> CrowdConfig:
        if max(map(abs, (*self.spawn_area, *self.walk))) > _FARTHEST:
            msg = f"spawn_area and walk: expected numbers within +-{_FARTHEST:g} [m]"
            raise ValueError(msg)
        x_min, y_min, x_max, y_max = self.spawn_area
        if not (x_min < x_max and y_min < y_max):
            msg = "spawn_area: expected x_min < x_max and y_min < y_max [m]"
            raise ValueError(msg)
        if not self.desired_speed_min <= self.desired_speed_mean <= self.desired_speed_max:
            msg = "desired_speed_mean: expected between desired_speed_min and _max [m/s]"
            raise ValueError(msg)
        return self


class RegulationConfig(Section):
    """What both controllers aim at, and who counts as being in front."""

    reference_speed: float = option(4.0, "m/s", "desired speed v_r", gt=0, le=60)
    safe_distance: float = option(
        8.0, "m", "distance d_safe to keep to who is in front", ge=0, le=1e4
    )
    corridor_half_width: float | None = option(
        None,
        "m",
        "in front: the body centre is this close to the ego's path; none: half its width + 0.25",
        gt=0,
        le=20,
    )
    gap_from: Literal["bumper", "centre"] = option(
        "bumper", None, "where the distance to who is in front starts"
    )


class MpcConfig(Section):
    """The model predictive controller (Yang & Özgüner 2019, section 3, table 1)."""

    horizon: int = option(15, "steps", "prediction horizon N", ge=2, le=200)
    force_limit: float = option(8000.0, "N", "u_max, of the PID's output too", gt=0, le=1e6)
    force_rate_limit: float = option(1000.0, "N/step", "du_max", gt=0, le=1e6)
    speed_min: float = option(0.0, "m/s", "v_min", ge=0, le=60)
    speed_max: float = option(20.0, "m/s", "v_max", gt=0, le=100)
    solver: Literal["osqp", "daqp"] = option("osqp", None, "QP solver")


class PidConfig(Section):
    """The PID controller, fallback and rival (Yang & Özgüner 2019, section 3.4, table 1)."""

    proportional_gain: float = option(
        2400.0, "N.s/m", "K_p; the printed 300 contradicts the printed error", ge=0, le=1e6
    )
    integral_gain: float = option(10.0, "N/m", "K_i", ge=0, le=1e6)
    derivative_gain: float = option(100.0, "N.s^2/m", "K_d", ge=0, le=1e6)
    buffer_distance: float = option(
        10.0, "m", "d_buffer over which the reference speed rises to v_r", gt=0, le=1e4
    )


class SumoConfig(Section):
    """How SUMO is run."""

    step_length: float | None = option(
        None, "s", "SUMO's step; none: the scenario's own", gt=0, le=60
    )


class RunConfig(Section):
    """One run: a scenario, a seed, a controller, and everything that shapes them."""

    scenario: str = option("shared_space", None, "bundled name, folder or .sumocfg", min_length=1)
    seed: int = option(1, None, "seed of the crowd and of SUMO", ge=0, le=2**31 - 1)
    controller: ControllerName = option("mpc", None, "who drives: mpc (PID as fallback) or pid")
    time_step: float = option(
        0.05, "s", "step of vehicle, controller and crowd", flag="--time-step", ge=0.001, le=0.5
    )
    time_limit: float = option(
        120.0, "s", "the run ends this long after the ego's departure", gt=0, le=86_400
    )
    ego: EgoConfig = EgoConfig()
    vehicle: VehicleConfig = VehicleConfig()
    crowd: CrowdConfig = CrowdConfig()
    regulation: RegulationConfig = RegulationConfig()
    mpc: MpcConfig = MpcConfig()
    pid: PidConfig = PidConfig()
    sumo: SumoConfig = SumoConfig()

    @property
    def corridor_half_width(self) -> float:
        """The corridor's half width [m]: 1.25 for the paper's car of 2 m."""
        chosen = self.regulation.corridor_half_width
        return self.vehicle.width / 2 + 0.25 if chosen is None else chosen

    @model_validator(mode="after")
    def _reachable(self) -> RunConfig:
        low, high = self.mpc.speed_min, self.mpc.speed_max
        for key, speed in (
            ("[regulation] reference_speed", self.regulation.reference_speed),
            ("[ego] initial_speed", self.ego.initial_speed),
        ):
            if self.controller == "mpc" and not low <= speed <= high:
                msg = f"{key} = {speed:g}: expected within [mpc] speed_min and speed_max"
                msg += f", {low:g} to {high:g} [m/s]"
                raise ValueError(msg)
        return self
