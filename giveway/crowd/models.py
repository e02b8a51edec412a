"""Makes the pedestrian model of a run, and that of an ego's prediction, from the configuration."""

import importlib.util
from collections.abc import Callable
from typing import cast

import numpy as np
from numpy.typing import NDArray

from giveway.config import EgoRunConfig, RunConfig
from giveway.config.files.presets import crowd_of
from giveway.config.tables.recorded import RECORDED
from giveway.crowd.motion.as_recorded import AsRecorded
from giveway.crowd.motion.attention import Inattentive
from giveway.crowd.motion.cohesion import BY_FORCES, Cohesive
from giveway.crowd.roster import Roster
from giveway.errors import CrowdError, retold
from giveway.plug_ins.finding import load_maker
from giveway.plug_ins.plugged_in_model import PluggedInModel
from giveway.plug_ins.sockets import MODEL
from pedestrian_model import (
    JUPEDSIM_MODELS,
    CrowdModel,
    JuPedSimPeople,
    ModelSetup,
    PedestrianModel,
    PlainModel,
    PlainName,
    PlugInError,
    VciParameters,
)


def model_of(
    config: RunConfig, time_step: float, roster: Roster, *, threads: int = 1
) -> PedestrianModel:
    """Return the pedestrian model that moves the crowd of a run.

    Args:
        config: Configuration of the run.
        time_step: Time step of the co-simulation [s].
        roster: Crowd that is moved.
        threads: Number of threads that step a large crowd by VCI.

    Raises:
        ConfigError: the preset or an option of the model cannot be used.
        ControlError: the model is not installed.
        CrowdError: another package's model cannot be made.
    """
    crowd = config.crowd
    if crowd.model == RECORDED:
        return _as_recorded(config, time_step, roster, threads)
    model = _plain_model_of(config, time_step, roster, threads)
    if crowd.has_distracted and not crowd.plugged_in:
        model = Inattentive(model, lambda: roster.distracted)
    if crowd.has_groups and crowd.model in BY_FORCES:
        model = Cohesive(model, lambda: roster.groups)
    return model


def _as_recorded(
    config: RunConfig, time_step: float, roster: Roster, threads: int
) -> PedestrianModel:
    """Return the model that moves people as recorded, and hands them over to another one."""
    options = config.recorded_options
    crowd = config.crowd.model_copy(update={"model": options.then})
    then = config.model_copy(update={"crowd": crowd, "model_options": {}})
    return AsRecorded(
        model_of(then, time_step, roster, threads=threads),
        roster.written,
        lambda: roster.names,
        time=options.time,
        distance=options.distance,
    )


def _plain_model_of(
    config: RunConfig, time_step: float, roster: Roster, threads: int
) -> PedestrianModel:
    """Return the model without distracted people and groups."""
    crowd = config.crowd
    parameters = crowd_of(config)
    if crowd.plugged_in or crowd.model in JUPEDSIM_MODELS:
        return _hosted(crowd.model, config, time_step, parameters, lambda: roster.keys)
    if crowd.model == "vci":
        return CrowdModel(parameters, time_step, threads=threads, **dict(config.vci_options))
    return PlainModel(cast(PlainName, crowd.model), parameters, time_step)


def believed_model(
    config: EgoRunConfig, time_step: float, parameters: VciParameters
) -> PedestrianModel:
    """Return the model by which an ego's controller predicts people, unless it is VCI.

    Args:
        config: Configuration of the ego.
        time_step: Time step of the prediction [s].
        parameters: Bodies and limits that the ego assumes of people.

    Raises:
        ConfigError: an option of another package's model cannot be used.
        ControlError: it is not installed.
        CrowdError: it cannot be made.
    """
    believed = config.perception.model
    if config.perception.plugged_in or believed in JUPEDSIM_MODELS:
        return _hosted(believed, config, time_step, parameters)
    return PlainModel(cast(PlainName, believed), parameters, time_step)


def _hosted(
    name: str,
    config: RunConfig,
    time_step: float,
    parameters: VciParameters,
    person_keys: Callable[[], NDArray[np.int64]] | None = None,
) -> PluggedInModel:
    make, setup = maker(name, config), setup_of(config, time_step, parameters)
    with retold(PlugInError, CrowdError):
        return PluggedInModel(f"'{name}'", lambda: make(setup), setup, parameters, person_keys)


def maker(name: str, config: RunConfig) -> Callable[[ModelSetup], object]:
    """Return the factory of a plugged-in model, with its options, or of one of JuPedSim's.

    Args:
        name: Name of the model.
        config: Configuration of the run.

    Raises:
        ConfigError: its options cannot be used.
        ControlError: it is not installed, or cannot be imported.
        CrowdError: JuPedSim is not installed.
    """
    if name in JUPEDSIM_MODELS:
        require_jupedsim(name)
        return lambda setup: JuPedSimPeople(name, setup)
    return load_maker(name, MODEL, config.model_options)


def require_jupedsim(name: str) -> None:
    """Make sure that JuPedSim can be imported, for one of its models.

    Raises:
        CrowdError: it is not installed.
    """
    if importlib.util.find_spec("jupedsim") is None:
        raise CrowdError(
            f"model '{name}': JuPedSim is not installed; install it with: "
            "pip install 'giveway[jupedsim]'"
        )


def setup_of(config: RunConfig, time_step: float, parameters: VciParameters) -> ModelSetup:
    """Return the facts about the run that a model is given.

    Args:
        config: Configuration of the run.
        time_step: Time step of the co-simulation [s].
        parameters: Bodies and limits of people.
    """
    return ModelSetup(
        time_step=time_step,
        body_radius=parameters.body_radius,
        max_acceleration=parameters.max_acceleration,
        max_speed=parameters.max_speed,
        seed=config.seed,
    )
