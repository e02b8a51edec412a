"""The model that moves a run's people, from the configuration."""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

from giveway.config import RunConfig
from giveway.config.presets import parameters_of
from giveway.crowd.attention import Inattentive
from giveway.crowd.cohesion import BY_FORCES, Cohesive
from giveway.crowd.roster import Roster
from giveway.errors import CrowdError
from giveway.plug_ins.finding import load_class
from giveway.plug_ins.sockets import MODEL
from pedestrian_model import (
    CrowdModel,
    ModelSetup,
    PedestrianModel,
    PlainModel,
    PlainName,
    PluggedInModel,
    PlugInError,
)


def model_of(
    config: RunConfig, time_step: float, roster: Roster, *, threads: int = 1
) -> PedestrianModel:
    """What moves the crowd of a run.

    Args:
        config: the run's.
        time_step: of the co-simulation [s].
        roster: who is in the crowd.
        threads: that step a large crowd by VCI.

    Raises:
        ConfigError: the preset or an option of the model cannot be used.
        ControlError: the model is not installed.
        CrowdError: somebody else's model cannot be made.
    """
    crowd = config.crowd
    model = _plain_model_of(config, time_step, roster, threads)
    if crowd.has_distracted and not crowd.plugged_in:
        model = Inattentive(model, lambda: roster.distracted)
    if crowd.has_groups and crowd.model in BY_FORCES:
        model = Cohesive(model, lambda: roster.groups)
    return model


def _plain_model_of(
    config: RunConfig, time_step: float, roster: Roster, threads: int
) -> PedestrianModel:
    """The model itself, in which all people are alike."""
    crowd = config.crowd
    parameters = parameters_of(crowd.preset)
    if crowd.plugged_in:
        make, setup = maker(config), setup_of(config, time_step)
        try:
            return PluggedInModel(
                f"'{crowd.model}'", lambda: make(setup), setup, parameters, lambda: roster.keys
            )
        except PlugInError as error:
            raise CrowdError(str(error)) from error
    if crowd.model == "vci":
        return CrowdModel(
            parameters, time_step, detour=crowd.detour, creep=crowd.creep, threads=threads
        )
    return PlainModel(cast(PlainName, crowd.model), parameters, time_step)


def maker(config: RunConfig) -> Callable[[ModelSetup], object]:
    """What makes somebody else's model, with its options.

    Raises:
        ConfigError: its options cannot be used.
        ControlError: it is not installed, or cannot be imported.
    """
    kind, options = load_class(config.crowd.model, MODEL, config.model_options)
    return lambda setup: kind(setup) if options is None else kind(setup, options)


def setup_of(config: RunConfig, time_step: float) -> ModelSetup:
    """What a model is told of its run.

    Args:
        config: the run's.
        time_step: of the co-simulation [s].
    """
    parameters = parameters_of(config.crowd.preset)
    return ModelSetup(
        time_step=time_step,
        body_radius=parameters.body_radius,
        max_acceleration=parameters.max_acceleration,
        max_speed=parameters.max_speed,
        seed=config.seed,
    )
