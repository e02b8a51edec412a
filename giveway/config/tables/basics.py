"""The tables of the configuration: every option once, with its unit, bounds, default and source.

Defaults are the reproduction of Yang & Özgüner 2019 (arXiv 1907.05178), their table 1, read as
docs/reproduction.md explains.
"""

from typing import Final, Literal

from giveway.config.option import (
    NameList,
    OptionList,
    Section,
    SumoOutputs,
    SumoSeed,
    TimeOrWindow,
    option,
)
from giveway.config.reasons import FORCE

_SUMO_ID = r"^[^\s|\\'\";,:!<>&*?]+$"  # Pattern of the ids that SUMO accepts
SUMO_TIME = "SUMO counts milliseconds"

EXACT: Final = "-exact"
"""The end of a bundled vehicle's name if its FMU solves exactly."""

BUNDLED_VEHICLES: Final[dict[str, Literal["2.0", "3.0"]]] = {
    "fmi2": "2.0",
    "fmi3": "3.0",
    f"fmi2{EXACT}": "2.0",
    f"fmi3{EXACT}": "3.0",
}
"""The FMI versions of the vehicle FMUs that are named by a word."""

DEFAULT_SPEED = 4.0
"""Speed [m/s] of an inserted ego at its departure (Yang & Özgüner 2019, table 1)."""


class EgoConfig(Section):
    """The ego: a vehicle of the scenario, or one that giveway inserts; and how far it drives."""

    take_over: NameList = option(
        (),
        None,
        "Ids of the scenario's vehicles that are driven from their departure on, comma-separated",
        flag="--ego",
    )
    none: bool = option(
        False,
        None,
        "No vehicle is driven. A route then only places the zone and the encounters",
        flag="--no-ego",
    )
    id: str = option("ego", None, "SUMO id of an inserted ego", pattern=_SUMO_ID)
    route: NameList = option((), None, "Edges that an inserted ego drives along, comma-separated")
    lane: int | None = option(
        None,
        None,
        "Index of the departure lane; 0 is the rightmost lane. By default it is the first lane "
        "for cars",
        ge=0,
        because="0 is the rightmost",
    )
    depart_time: TimeOrWindow = option(
        0.0,
        "s",
        "Simulation time at which an inserted ego enters, but not before the simulation begins. "
        "Of two times, earliest,latest, one in between is drawn from the run's seed",
    )
    depart_position: float = option(
        0.0,
        "m",
        "Distance of the front bumper from the beginning of the first edge at departure",
        ge=0,
        le=1e6,
        because="it is a position on the edge",
    )
    initial_speed: float | None = option(
        None,
        "m/s",
        "Speed at departure. By default it is 4 m/s, and SUMO's speed for a vehicle that is taken"
        " over",
        ge=0,
        le=70,
        because="no car on a road is faster",
    )
    travel_distance: float | None = option(
        None,
        "m",
        "Distance from departure to goal. By default the goal is the end of the route",
        gt=0,
        le=1e6,
        least=0.1,
        because=("it is no drive", "no network is larger"),
    )


IDENTIFIED: Final = ("mass", "friction", "force_limit", "force_rate_limit")
"""The keys of [vehicle] that an identified model gives."""


class VehicleConfig(Section):
    """The vehicle FMU, its body, and the plant parameters that the MPC shares with it."""

    fmu: str = option(
        "fmi2",
        None,
        "Vehicle FMU: a path, or a bundled one: fmi2, fmi3, or fmi2-exact and fmi3-exact, which "
        "solve exactly instead of by the paper's forward Euler",
        flag="--vehicle",
        min_length=1,
    )
    profile: str = option(
        "",
        None,
        "Vehicle profile (TOML) of an FMU of your own. By default it is drafted from the FMU's "
        "names and units",
        flag="--profile",
    )
    isolation: Literal["auto", "process", "none"] = option(
        "auto",
        None,
        "Process in which the FMU runs: one of its own (process), giveway's (none), or one of its"
        " own unless the FMU is bundled (auto)",
    )
    mass: float = option(
        1000.0,
        "kg",
        "Mass M in the controller's model M s'' + alpha s' = u. A profile may know it",
        gt=0,
        le=1e6,
        least=10.0,
        because=("the lightest vehicle is a scooter of some 10 kg", "the heaviest is a train"),
    )
    friction: float = option(
        100.0,
        "N.s/m",
        "Friction alpha in the same model. A profile may know it",
        ge=0,
        le=1e6,
        because=("friction slows a vehicle down", "it would stop within one step"),
    )
    force_limit: float = option(
        8000.0,
        "N",
        "Largest force of the actuator, forwards and backwards",
        gt=0,
        le=1e6,
        least=1.0,
        because=FORCE,
    )
    force_rate_limit: float = option(
        1000.0,
        "N/step",
        "Largest change of the force in one control step",
        gt=0,
        le=1e6,
        least=1.0,
        because=FORCE,
    )
    speed_max: float = option(
        20.0,
        "m/s",
        "Highest speed of the vehicle",
        gt=0,
        le=100,
        least=0.1,
        because=("a slower vehicle hardly moves", "no car is faster"),
    )
    length: float | None = option(
        None,
        "m",
        "Length of the body. By default it is 5 m, and SUMO's length for a vehicle that is taken "
        "over",
        gt=0,
        le=50,
        least=0.1,
        because=("the shortest vehicle is a robot", "the longest is a tram"),
    )
    width: float | None = option(
        None,
        "m",
        "Width of the body. By default it is 2 m, and SUMO's width for a vehicle that is taken "
        "over",
        gt=0,
        le=10,
        least=0.1,
        because=(
            "the narrowest vehicle is a scooter",
            "the widest is a machine on a field",
        ),
    )

    @property
    def told(self) -> dict[str, float]:
        """The values that the user has set among those an identified model gives, by key."""
        return {key: getattr(self, key) for key in IDENTIFIED if key in self.model_fields_set}

    @property
    def acceleration_limit(self) -> float:
        """The largest acceleration [m/s^2] that the largest force gives the vehicle's mass."""
        return self.force_limit / self.mass


class TrafficConfig(Section):
    """The behaviour of SUMO's own vehicles towards the pedestrians that giveway moves."""

    yielding: bool = option(
        True, None, "SUMO's vehicles brake for pedestrians and egos in their way", flag="--yield"
    )


class SumoConfig(Section):
    """The settings of SUMO, and the outputs of its own that are wanted."""

    step_length: float | None = option(
        None,
        "s",
        "SUMO's step. By default it is the scenario's",
        gt=0,
        le=60,
        least=0.001,
        because=SUMO_TIME,
    )
    seed: SumoSeed = option(
        "scenario",
        None,
        "SUMO's seed: a number, 'scenario' (the scenario's own) or 'run' (the run's)",
    )
    outputs: SumoOutputs = option(
        (),
        None,
        "SUMO's own outputs that are written, comma-separated: fcd (floating car data), tripinfo "
        "(trips), ssm (surrogate safety measures), summary (each step)",
    )
    baseline: bool | None = option(
        None,
        None,
        "SUMO's own driver makes the same trip in a process of its own, for its travel time. By "
        "default it does in single runs, but not in studies",
        flag="--baseline",
    )
    options: OptionList = option(
        (), None, "Further options for SUMO, like '--emission-output e.xml'", flag="--sumo-options"
    )


class RecordConfig(Section):
    """The density of recorded trajectories, and the speed that counts as a stop."""

    near: float = option(
        50.0,
        "m",
        "Distance to an ego within which people are recorded at every control step",
        ge=0,
        le=1e6,
        because="no network is larger",
    )
    far_period: float | None = option(
        None,
        "s",
        "Period at which all other people are recorded, and everybody without an ego. By default "
        "it is 1 s, and without an ego every control step",
        gt=0,
        le=1e6,
        least=0.001,
        because=("no step is shorter", "no run is longer"),
    )
    predictions: float | None = option(
        None,
        "s",
        "Distance in look-ahead between predicted positions that are recorded. By default none "
        "are recorded",
        gt=0,
        le=1e3,
        least=0.001,
        because=("no step is shorter", "no run is longer"),
    )
    stop_speed: float = option(
        0.2,
        "m/s",
        "Speed below which an ego counts as stopped",
        gt=0,
        le=5,
        least=0.001,
        because="a faster vehicle does not stand",
    )

    @property
    def longest_period(self) -> float:
        """The longest time [s] from one record of a person to the next."""
        return 1.0 if self.far_period is None else self.far_period

    def steps(self, time_step: float) -> int:
        """Return the control steps of ``time_step`` [s] between records of people far away."""
        return max(1, round(self.longest_period / time_step))
