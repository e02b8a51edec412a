"""The configuration of a run: all its settings, checked, and the settings of each of its egos."""

from __future__ import annotations

from typing import Any

from pydantic import Field, ValidationError, model_validator
from pydantic.fields import FieldInfo

from fmus.profile.vehicle_profile import FittedModel
from giveway.config.option import LANE, Section, expectation
from giveway.config.plug_in_names import BUNDLED, BUNDLED_BELIEFS
from giveway.config.run_settings import Own, RunSettings
from giveway.config.tables.basics import IDENTIFIED
from giveway.config.tables.controllers import (
    OWN_OPTIONS,
    NoOptions,
    PaperMpcOptions,
    PaperPidOptions,
    TunedPidOptions,
)
from giveway.config.tables.crowd import VCI, CrowdConfig
from giveway.config.tables.recorded import RECORDED
from giveway.plug_ins.finding import is_fmu
from giveway.plug_ins.options import read_options

PAPER_STEP = 0.05
"""Default control step [s] (Yang & Özgüner 2019, table 1)."""

EGO_TABLES = (
    "controller",
    "controller_profile",
    "controller_options",
    "ego",
    "vehicle",
    "regulation",
    "rules",
    "safety",
    "perception",
    "sensor_options",
)
"""The settings that may differ from ego to ego."""

OWN_FMU = frozenset({"fmu", "profile"})
"""The keys of [vehicle] that name another FMU than the run's."""


def _field_at(location: tuple[int | str, ...]) -> FieldInfo | None:
    """Return the option at ``location``, which may end inside its value, or None."""
    model: type[Section] = RunConfig
    for part in location:
        field = model.model_fields.get(str(part))
        kind = None if field is None else field.annotation
        if not (isinstance(kind, type) and issubclass(kind, Section)):
            return field
        model = kind
    return None


class RunConfig(RunSettings):
    """One run: a scenario, a seed, a controller, and everything that shapes them."""

    @model_validator(mode="after")
    def _check_egos(self) -> RunConfig:
        egos = self.each_ego()
        for ego in egos:
            ego.require_sound()
        if self.measure and not egos and self.record.far_period is not None:
            raise ValueError(
                f"[record] far_period = {self.record.far_period:g}: a [[measure]] needs people at "
                "every control step; leave far_period out, or the measures"
            )
        self._meet_people({ego.defaults.crowd_preset for ego in egos or (self,)})
        # they are read, and refused if they cannot be used
        self.vci_options, self.recorded_options  # noqa: B018
        has_options = self.crowd.plugged_in or self.crowd.model in {VCI, RECORDED}
        if self.model_options and not has_options:
            key = next(iter(self.model_options))
            raise ValueError(
                f"[model_options] {key}: '{self.crowd.model}' has no options there; the "
                "parameters of people are a preset (docs/pedestrian_model.md)"
            )
        return self

    def _meet_people(self, declared: set[str]) -> None:
        """Take the crowd's preset that all controllers declare, unless the user has set one.

        Args:
            declared: Preset that each controller declares, or "" for giveway's default.
        """
        (preset, *others) = declared
        if not preset or others or "preset" in self.crowd.model_fields_set:
            return
        values = {**dict(self.crowd), "preset": preset}
        own = CrowdConfig.model_construct(_fields_set=self.crowd.model_fields_set, **values)
        object.__setattr__(self, "crowd", own)  # the key does not count as set by the user

    def as_json(self) -> str:
        """Return the configuration as JSON, without the vehicle's keys that nobody has set.

        A vehicle is identified if its mass is not told; a default that is written would tell it.
        """
        unset = set(type(self.vehicle).model_fields) - self.vehicle.model_fields_set
        return self.model_dump_json(exclude={"vehicle": unset})

    def each_ego(self) -> tuple[EgoRunConfig, ...]:
        """Return the configuration of each ego, complete and without ``egos``.

        Raises:
            ValueError: an entry of ``egos`` holds an unknown key or a value out of range.
        """
        if self.ego.none:
            return ()
        entries = [self._with(*entry) for entry in enumerate(self.egos)] or [self]
        return tuple(own for entry in entries for own in entry._one_per_vehicle())

    def _with(self, number: int, entry: dict[str, Any]) -> RunConfig:
        """Return this configuration with the keys of one entry of ``egos``, without ``egos``."""
        unknown = sorted(set(entry) - set(EGO_TABLES))
        if unknown:
            expected = ", ".join(EGO_TABLES)
            raise ValueError(
                f"egos[{number}]: unknown key '{unknown[0]}'; expected one of {expected}"
            )
        values = self.model_dump(exclude={"egos"})
        vehicle = entry.get("vehicle")
        another = isinstance(vehicle, dict) and OWN_FMU & set(vehicle)
        others = set(IDENTIFIED) if another else set()
        # what is not set is not told; M of one FMU does not hold for another one
        values["vehicle"] = self.vehicle.model_dump(exclude_unset=True, exclude=others)
        if entry.get("controller", self.controller) != self.controller:
            # these belong to another controller
            values["controller_options"], values["controller_profile"] = {}, ""
        own = entry.get("perception")
        if isinstance(own, dict) and own.get("sensor", self.perception.sensor) != (
            self.perception.sensor
        ):
            values["sensor_options"] = {}
        for key, value in entry.items():
            values[key] = {**values[key], **value} if isinstance(value, dict) else value
        try:
            return RunConfig.model_validate(values)
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            if not first["loc"]:  # the settings do not fit each other
                said = first["msg"].removeprefix("Value error, ")
                raise ValueError(f"egos[{number}]: {said}") from None
            # the rest says which part of the value is wrong
            key = ".".join(map(str, first["loc"][:2]))
            field = _field_at(first["loc"])
            expected = expectation(first, field) if field is not None else first["msg"]
            raise ValueError(f"egos[{number}]: {key} = {first['input']!r}: {expected}") from None

    def _one_per_vehicle(self) -> list[EgoRunConfig]:
        """Return one configuration per vehicle that is taken over, or that of the inserted ego."""
        taken = [{"take_over": (name,)} for name in self.ego.take_over] or [{}]
        return [
            EgoRunConfig.model_construct(
                _fields_set=self.model_fields_set,
                **{**dict(self), "ego": self.ego.model_copy(update=own), "egos": ()},
            )
            for own in taken
        ]


class EgoRunConfig(RunConfig):
    """The configuration of a run for one of its egos; ``egos`` is empty.

    Attributes:
        found: Model of the vehicle that was found before the run, or None.
    """

    found: FittedModel | None = Field(default=None, exclude=True)

    @model_validator(mode="after")
    def _check_egos(self) -> EgoRunConfig:
        self.require_sound()
        self._meet_people({self.defaults.crowd_preset})
        return self

    def require_sound(self) -> None:
        """Make sure that the settings fit each other.

        Raises:
            ValueError: they do not fit.
        """
        self.require_speeds_in_reach()
        self.require_rolling()
        self.require_known_belief()
        if self.reference_speed == LANE and not self.heeds("speed_limits"):
            raise ValueError(
                "[rules] speed_limits = false: [regulation] reference_speed is 'lane', which is "
                "what they say; give a speed [m/s], like reference_speed = 13.9"
            )
        if self.sensor_options and not self.perception.plugged_in_sensor:
            key = next(iter(self.sensor_options))
            raise ValueError(
                f"[sensor_options] {key}: '{self.perception.sensor}' has no options there; name a "
                "sensor that has it as [perception] sensor, or leave it out"
            )
        self.own_options  # reading them raises an error if they cannot be used  # noqa: B018
        if self.controller_profile and not is_fmu(self.controller):
            raise ValueError(
                f"controller_profile = '{self.controller_profile}': '{self.controller}' is no "
                "controller FMU; leave it out, or name the FMU as controller"
            )

    @property
    def ego_id(self) -> str:
        """The id of the ego in SUMO."""
        return self.ego.take_over[0] if self.ego.take_over else self.ego.id

    @property
    def plugged_in(self) -> bool:
        """True if the controller is a plug-in."""
        return self.controller not in BUNDLED

    @property
    def own_options(self) -> Section:
        """The options of one of giveway's own controllers; sockets read those of plug-ins.

        Raises:
            ConfigError: an option is unknown, or its value cannot be used.
        """
        if self.plugged_in:
            return NoOptions()
        kind = OWN_OPTIONS.get(self.controller)
        own = read_options(self.controller, kind, self.controller_options)
        return own if isinstance(own, Section) else NoOptions()

    def own(self, kind: type[Own]) -> Own:
        """Return the controller's own options, or the defaults of ``kind`` if it has others."""
        own = self.own_options
        return own if isinstance(own, kind) else kind()

    @property
    def model_steps(self) -> int:
        """The number of steps over which the error of the vehicle's model counts."""
        return self.own(PaperMpcOptions).horizon

    @property
    def optimises(self) -> bool:
        """True if the controller is a model predictive one, which has a model and a horizon."""
        return self.defaults.optimises

    @property
    def safety_layer(self) -> bool:
        """True if the safety layer watches over the controller."""
        enabled = self.safety.enabled
        return self.defaults.safety_layer if enabled is None else enabled

    @property
    def vehicle_layer(self) -> bool:
        """True if the safety layer keeps a safe distance to vehicles ahead, too."""
        return self.safety_layer and self.safety.vehicles and self.heeds("following")

    @property
    def buffer_distance(self) -> float:
        """The distance [m] beyond d_safe over which the reference speed rises to v_r, or 0."""
        if self.defaults.buffered:
            return self.own(PaperPidOptions).buffer_distance
        own = self.own(TunedPidOptions)
        return own.buffer_distance if own.profile == "linear" else 0.0

    def require_speeds_in_reach(self) -> None:
        """Make sure that the MPC may drive at the configured speeds.

        Raises:
            ValueError: it may not.
        """
        high = self.vehicle.speed_max
        for key, speed in (
            ("[regulation] reference_speed", self.reference_speed),
            ("[ego] initial_speed", self.ego.initial_speed),
        ):
            if speed is None or isinstance(speed, str):
                continue
            if self.optimises and speed > high:
                msg = f"{key} = {speed:g}: expected at most [vehicle] speed_max, {high:g} [m/s]"
                raise ValueError(msg)

    def require_known_belief(self) -> None:
        """Make sure that a plug-in is the predicting model only if it also moves the people.

        Its options, and the permission to import it, are those of the crowd's model.

        Raises:
            ValueError: it does not move the people.
        """
        believed, moving = self.perception.model, self.crowd.model
        if self.perception.plugged_in and believed != moving:
            raise ValueError(
                f"[perception] model = '{believed}': the people walk by '{moving}'; expected "
                f"{', '.join(sorted(BUNDLED_BELIEFS))}, or the same as [crowd] model"
            )

    def require_rolling(self) -> None:
        """Make sure that friction slows the vehicle down and does not reverse it within a step.

        The forward Euler step h of M s'' + alpha s' = u, the model of the paper's plant and
        controllers, multiplies the speed by 1 - alpha h / M.

        Raises:
            ValueError: it would reverse the vehicle.
        """
        step = self.time_step or PAPER_STEP
        share = self.vehicle.friction * step / self.vehicle.mass
        if share > 1.0:
            raise ValueError(
                f"[vehicle] friction = {self.vehicle.friction:g} and mass = {self.vehicle.mass:g}: "
                f"expected friction * {step:g} s <= mass [kg]: friction alone would turn the "
                "vehicle round within one step"
            )
