"""The settings of a run: its tables, and what follows from them.

The TOML file, the flags of the command line and the Python API are derived from these fields.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeVar

from pydantic import BeforeValidator, Field, JsonValue

from giveway.config.option import LANE, Section, option
from giveway.config.plug_in_names import BUNDLED, ControllerName
from giveway.config.tables.basics import (
    EgoConfig,
    RecordConfig,
    SumoConfig,
    TrafficConfig,
    VehicleConfig,
)
from giveway.config.tables.controllers import SafetyConfig
from giveway.config.tables.crowd import VCI, CrowdConfig, VciOptions
from giveway.config.tables.measures import MeasureConfig, read_measures
from giveway.config.tables.metrics import MetricsConfig
from giveway.config.tables.perception import PerceptionConfig
from giveway.config.tables.recorded import RECORDED, RecordedOptions
from giveway.config.tables.regulation import RegulationConfig
from giveway.config.tables.rules import OF_PRIORITY, RulesConfig
from giveway.plug_ins.finding import shown
from giveway.plug_ins.options import read_options
from giveway.plug_ins.sockets import MODEL

if TYPE_CHECKING:
    from controller import Defaults

Own = TypeVar("Own", bound=Section)


class RunSettings(Section):
    """The settings of a run: a scenario, a seed, a controller, and all that shapes them."""

    scenario: str = option(
        "shared_space",
        None,
        "Scenario: the name of a bundled one, a folder, or a .sumocfg",
        min_length=1,
    )
    seed: int = option(
        1,
        None,
        "Seed of the crowd that giveway adds",
        ge=0,
        le=2**31 - 1,
        because="SUMO's seeds have 31 bits",
    )
    controller: ControllerName = option(
        "mpc",
        None,
        "Controller: mpc (plans ahead), pid-tuned, the paper's mpc-paper and pid-paper, or "
        "another package's, by its declared name, as module:Class, or as a path to an FMU",
    )
    controller_profile: str = option(
        "",
        None,
        "Controller profile (TOML) of a controller FMU. By default it is drafted from the FMU's "
        "names",
    )
    time_step: float | None = option(
        None,
        "s",
        "Step of vehicle, controller and crowd. By default it is 0.05 s, or a step that divides "
        "SUMO's",
        flag="--time-step",
        ge=0.001,
        le=0.5,
        because=("SUMO counts milliseconds", "in more than 0.5 s people walk too far"),
    )
    time_limit: float | None = option(
        None,
        "s",
        "Time after the first departure at which the run ends. By default it ends with the "
        "scenario",
        gt=0,
        le=1e7,
        least=0.001,
        because=("no step is shorter", "no run is longer"),
    )
    twin: bool = option(
        False,
        None,
        "The run is made twice, the second time with people who do not feel the egos, to tell "
        "what these cost the people",
        flag="--twin",
    )
    ego: EgoConfig = EgoConfig()
    vehicle: VehicleConfig = VehicleConfig()
    crowd: CrowdConfig = CrowdConfig()
    regulation: RegulationConfig = RegulationConfig()
    rules: RulesConfig = RulesConfig()
    controller_options: dict[str, JsonValue] = Field(
        default_factory=dict, description="Options of the controller"
    )
    model_options: dict[str, JsonValue] = Field(
        default_factory=dict, description="Options of the pedestrian model"
    )
    sensor_options: dict[str, JsonValue] = Field(
        default_factory=dict, description="Options of the sensor"
    )
    safety: SafetyConfig = SafetyConfig()
    perception: PerceptionConfig = PerceptionConfig()
    traffic: TrafficConfig = TrafficConfig()
    sumo: SumoConfig = SumoConfig()
    record: RecordConfig = RecordConfig()
    metrics: MetricsConfig = MetricsConfig()
    egos: tuple[dict[str, Any], ...] = Field(
        default=(),
        description="One table for each ego. What it leaves out is as in the run's own tables",
    )
    measure: Annotated[tuple[MeasureConfig, ...], BeforeValidator(read_measures)] = Field(
        default=(), description="Lines and areas on which people are measured"
    )

    @property
    def defaults(self) -> Defaults:
        """The declaration of one of giveway's controllers.

        The declaration of a plug-in is in the configuration already, see
        :func:`giveway.config.files.loading.load`: no code of another package is imported to read a
        configuration.
        """
        from controller import DECLARED, Defaults  # imported here, since numba comes with it

        return DECLARED.get(self.controller, Defaults())

    @property
    def vci_options(self) -> VciOptions:
        """The options of the VCI model; its defaults if another model moves the people.

        Raises:
            ConfigError: One is unknown, or its value cannot be used.
        """
        return self._options_of_model(VCI, VciOptions)

    @property
    def recorded_options(self) -> RecordedOptions:
        """The options of the model ``recorded``; its defaults if another model moves the people.

        Raises:
            ConfigError: One is unknown, or its value cannot be used.
        """
        return self._options_of_model(RECORDED, RecordedOptions)

    def _options_of_model(self, name: str, kind: type[Own]) -> Own:
        read: Own = read_options(
            name, kind, self.model_options if self.crowd.model == name else {}, MODEL
        )
        return read

    @property
    def reference_speed(self) -> float | Literal["lane"]:
        """The speed [m/s] on a free road, or "lane" for the lanes' speed limits."""
        wanted = self.regulation.reference_speed
        if wanted is not None:
            return wanted
        own = self.defaults.reference_speed
        return LANE if own is None else own

    def heeds(self, rule: str) -> bool:
        """Return whether an ego heeds one of giveway's rules.

        Args:
            rule: Key of the rule in ``[rules]``, like "crossings".
        """
        said: bool | None = getattr(self.rules, rule)
        if said is not None:
            return said
        if rule == "speed_limits":
            return self.reference_speed == LANE
        return rule not in OF_PRIORITY or self.defaults.heeds_priority

    @property
    def tracks_people(self) -> bool:
        """True if controllers are shown tracked positions where perception is noisy."""
        tracker = self.perception.tracker
        return self.defaults.tracker if tracker is None else tracker

    @property
    def driver(self) -> str:
        """The controller's name for titles: "MPC", or a plug-in's name as it is written."""
        name = self.controller_name
        return name.upper() if name in BUNDLED else name

    @property
    def described_controller(self) -> str:
        """The controller's name and its options that are set, as in "mpc style=assertive"."""
        own = (f" {key}={value}" for key, value in self.controller_options.items())
        return self.controller_name + "".join(own)

    @property
    def controller_name(self) -> str:
        """The controller's name for tables; for an FMU it is the file's name."""
        return shown(self.controller)
