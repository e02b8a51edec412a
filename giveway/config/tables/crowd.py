"""The crowd's table of the configuration.

Defaults are the reproduction of Yang & Özgüner 2019 (arXiv 1907.05178), their table 1, read as
docs/reproduction.md explains.
"""

from __future__ import annotations

import math
from typing import Annotated, Final, Literal

from pydantic import BeforeValidator, Field, model_validator

from giveway.config.option import (
    DEFAULT_PRESET,
    Displacement,
    Preset,
    Rectangle,
    Section,
    TextOrNumber,
    option,
)
from giveway.config.plug_in_names import BUNDLED_CROWD_MODELS, CrowdModelName
from giveway.config.reasons import GAP, MILLIMETRE
from giveway.config.tables.flows import FlowConfig, read_flows
from giveway.config.tables.people import DISTRACTED, SHARE, PeopleConfig
from giveway.config.tables.recorded import RECORDED, RecordedConfig, read_recorded
from giveway.config.tables.scripted import ScriptedConfig, read_scripted

DESIRED_SPEEDS: Final = (0.5, 2.2)
"""Bounds [m/s] of desired speeds by default (reading of Yang & Özgüner 2019; reproduction.md)."""

ENCOUNTERS: Final = "encounters"
DRAWS_PER_PERSON: Final = 3
"""Number of standard normal numbers that make one added person: place x, place y, speed."""
VCI: Final = "vci"
_SLOWEST, _FASTEST = 0.1, 2.5  # Widest bounds [m/s] of desired speeds; 2.5 m/s: v_max of VCI
_NEAREST = 0.01  # Smallest side of an area, and smallest walk [m]
_UNLIKELY = 38.0  # Largest standard normal number whose probability is not rounded to 0
_FARTHEST = 1e7  # Largest coordinate [m]; beyond it a millimetre is lost in rounding


class VciOptions(Section):
    """Options of the VCI model of people, in [model_options]; docs/pedestrian_model.md."""

    detour: bool = True
    creep: bool = True


class CrowdConfig(Section):
    """The pedestrians that giveway adds: how many, where, where to and how fast."""

    pedestrians: int = option(
        0,
        "persons",
        "Number of pedestrians that giveway adds",
        flag="--pedestrians",
        ge=0,
        le=20_000,
        because="more people do not fit around one vehicle",
    )
    sampler: Literal["area", "encounters"] = option(
        "area",
        None,
        "Placement of the added people. area: they start anywhere in spawn_area. encounters: they"
        " start in groups that meet the ego's free drive from both sides, and spawn_area, walk "
        "and two_sided have no effect",
        flag="--sampler",
    )
    spawn_area: Rectangle = option(
        (23.3, -23.4, 33.2, -12.0),
        "m",
        "Rectangle x_min,y_min,x_max,y_max in which people start",
        flag="--spawn-area",
    )
    walk: Displacement = option(
        (0.0, 30.0),
        "m",
        "Displacement dx,dy from each person's start to the destination",
        flag="--walk",
    )
    two_sided: bool = option(
        False, None, "Every second pedestrian comes from the other side", flag="--two-sided"
    )
    desired_speed_mean: float = option(
        1.394,
        "m/s",
        "Mean desired speed",
        ge=_SLOWEST,
        le=_FASTEST,
        because=("nobody walks so slowly on and on", "nobody walks faster"),
    )
    desired_speed_sd: float = option(
        0.26,
        "m/s",
        "Standard deviation of the desired speed",
        ge=0,
        le=2,
        because="people's walking speeds differ by less",
    )
    desired_speed_bounds: Displacement = option(
        DESIRED_SPEEDS,
        "m/s",
        "Smallest and largest desired speed. Speeds beyond them are drawn again",
    )
    groups: float = option(
        0.0,
        None,
        "Share of the added people who walk in groups of two to five. The sampler encounters "
        "makes groups of its own",
        flag="--groups",
        ge=0,
        le=1,
        because=SHARE,
    )
    minimum_spacing: float = option(
        0.5,
        "m",
        "Least distance between the starts of any two people",
        ge=0,
        le=10,
        least=MILLIMETRE,
        because=GAP,
    )
    host_edge: str = option(
        "",
        None,
        "Edge that hosts the added people inside SUMO. By default it is the nearest edge for "
        "pedestrians",
    )
    model: CrowdModelName = option(
        "vci",
        None,
        "Model that moves people: vci; social-force (Helbing and Molnar 1995); gap-acceptance "
        "(they stop for vehicles that come too soon); orca (van den Berg et al. 2011); "
        "constant-velocity; recorded (people of [[crowd.recorded]] as they walked); two of "
        "JuPedSim's, jupedsim:...; or another package's, by its declared name or as module:Class. "
        "Controllers predict by [perception] model",
        flag="--crowd-model",
    )
    preset: Preset = option(
        DEFAULT_PRESET,
        None,
        "Parameters of the VCI model: MIXED, CITR or DUT (fitted to recorded people), SIM or "
        "TABLE2 (published), or a preset file (TOML). It is SIM by default if the paper's "
        "controllers alone drive",
        min_length=1,
    )
    zone: TextOrNumber = option(
        "50",
        None,
        "Zone in which the scenario's own pedestrians follow the VCI model: metres round each "
        "ego, 'everywhere', 'none', or a polygon 'x,y x,y x,y ...' [m]",
        flag="--zone",
    )
    walls: bool | None = option(
        None,
        None,
        "The edges of sidewalks, crossings and walkingareas hold people back. By default they hold "
        "the scenario's own people where the network has sidewalks, and not those who are added",
        flag="--walls",
    )
    threads: int = option(
        1,
        None,
        "Number of threads that step a crowd of 1,000 or more. The results do not depend on it",
        flag="--threads",
        ge=1,
        le=256,
        because="more threads than processors make a run slower",
    )

    flow_scale: float = option(
        1.0,
        None,
        "Factor by which the rate of every flow is multiplied",
        flag="--flow-scale",
        ge=0,
        le=10,
        least=1e-3,
        because="rates are at most 50,000 persons per hour",
    )
    people: PeopleConfig = PeopleConfig()
    flow: Annotated[tuple[FlowConfig, ...], BeforeValidator(read_flows)] = Field(
        default=(), description="Streams of people, so many an hour from here to there"
    )

    recorded: Annotated[tuple[RecordedConfig, ...], BeforeValidator(read_recorded)] = Field(
        default=(), description="Recordings whose people enter as they were recorded"
    )

    scripted: Annotated[tuple[ScriptedConfig, ...], BeforeValidator(read_scripted)] = Field(
        default=(), description="People who walk straight on by a script, whatever vehicles do"
    )

    draws: tuple[Annotated[float, Field(ge=-_UNLIKELY, le=_UNLIKELY)], ...] = Field(
        default=(),
        description="Standard normal numbers, three for each added person, that place people and "
        "set their desired speeds. By default the seed does",
    )

    @property
    def adds_people(self) -> bool:
        """True if giveway adds people."""
        return self.pedestrians > 0 or self.expects_people

    @property
    def expects_people(self) -> bool:
        """True if people come in during the run."""
        return bool(self.flow and self.flow_scale) or bool(self.recorded or self.scripted)

    @property
    def has_distracted(self) -> bool:
        """True if a person may be distracted."""
        each = (self.people, *(flow.people for flow in self.flow if flow.people is not None))
        return any(people.shares[DISTRACTED] for people in each)

    @property
    def has_groups(self) -> bool:
        """True if a person may walk in a group that stays together."""
        return self.groups > 0.0 or any(flow.groups for flow in self.flow)

    @property
    def plugged_in(self) -> bool:
        """True if the pedestrian model is a plug-in."""
        return self.model not in BUNDLED_CROWD_MODELS

    @model_validator(mode="after")
    def _ordered(self) -> CrowdConfig:
        if max(map(abs, (*self.spawn_area, *self.walk))) > _FARTHEST:
            raise ValueError(f"spawn_area and walk: expected numbers within +-{_FARTHEST:g} [m]")
        x_min, y_min, x_max, y_max = self.spawn_area
        if not (x_min < x_max and y_min < y_max):
            raise ValueError("spawn_area: expected x_min < x_max and y_min < y_max [m]")
        if min(x_max - x_min, y_max - y_min) < _NEAREST:
            raise ValueError(
                f"spawn_area: {x_max - x_min:g} by {y_max - y_min:g} m: expected sides of at least "
                f"{_NEAREST:g} m: a body has to fit"
            )
        self._require_speeds()
        if 0.0 < math.hypot(*self.walk) < _NEAREST:
            raise ValueError(
                f"walk = {self.walk}: expected at least {_NEAREST:g} m, or 0,0 for people who "
                "stand: a shorter way is not a walk"
            )
        self._require_recorded()
        if self.draws:
            self._require_draws()
        return self

    def _require_speeds(self) -> None:
        low, high = self.desired_speed_bounds
        if not _SLOWEST <= low < high <= _FASTEST:
            raise ValueError(
                f"desired_speed_bounds = {low:g},{high:g}: expected two speeds, the smaller one "
                f"first, from {_SLOWEST:g} to {_FASTEST:g} [m/s]"
            )
        if not low <= self.desired_speed_mean <= high:
            raise ValueError(
                f"desired_speed_mean = {self.desired_speed_mean:g}: expected {low:g} to {high:g} "
                "[m/s]; or other desired_speed_bounds"
            )

    def _require_draws(self) -> None:
        if self.sampler == ENCOUNTERS:
            raise ValueError(
                f"draws: sampler = '{ENCOUNTERS}' needs a varying number of draws; expected "
                "sampler = 'area', or no draws, so that the seed places people"
            )
        if len(self.draws) != DRAWS_PER_PERSON * self.pedestrians:
            raise ValueError(
                f"draws: {len(self.draws)} numbers for pedestrians = {self.pedestrians}: expected "
                f"{DRAWS_PER_PERSON} for each"
            )

    def _require_recorded(self) -> None:
        if self.model == RECORDED and not (self.recorded or self.scripted):
            raise ValueError(
                f"model = '{RECORDED}': nobody is recorded; name a recording in "
                "[[crowd.recorded]] (path, dataset), or another model"
            )
        if self.scripted and self.model != RECORDED:
            raise ValueError(
                f"scripted '{self.scripted[0].name}': model = '{self.model}' does not know "
                f"scripts; expected model = '{RECORDED}'"
            )
