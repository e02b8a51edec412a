"""The code of other packages that a configuration names."""

from collections.abc import Collection, Mapping
from typing import Any, NamedTuple

from giveway.config.files.controller_fmu import fmu_described, fmu_hash, prepared
from giveway.config.run_config import PAPER_STEP, EgoRunConfig, RunConfig
from giveway.errors import ConfigError, as_request
from giveway.plug_ins.finding import find, is_fmu, load_class, shown
from giveway.plug_ins.options import plain
from giveway.plug_ins.sockets import (
    CONTROLLER,
    METRIC,
    MODEL,
    RULE,
    SENSOR,
    SOCKETS,
    TABLES,
    VEHICLE,
    Socket,
)


class Named(NamedTuple):
    """A plug-in that a run uses.

    Attributes:
        socket: Socket for which it is used.
        whose: The ego's id, "the crowd", or "the run".
        name: Name as the user wrote it; perhaps a path to an FMU.
        options: Options as the user has set them.
        ego: Configuration of the ego that it controls, or None if it is no controller.
    """

    socket: Socket
    whose: str
    name: str
    options: Mapping[str, Any]
    ego: EgoRunConfig | None = None

    @property
    def key(self) -> str:
        """The key of the plug-in in a study's inputs, which does not depend on file paths."""
        return f"{self.socket.what} of {self.whose}: {shown(self.name)}"

    @property
    def sha256(self) -> str:
        """The SHA-256 of the plug-in's package or file.

        Raises:
            ControlError: the package or file is not there.
        """
        if is_fmu(self.name) or self.socket is VEHICLE:
            return fmu_hash(self.name)
        return find(self.name, self.socket).sha256


_PLACES = (
    (CONTROLLER, "in the controller at", "in the controller {} at"),
    (SENSOR, "in the controller at", "in the sensor {} at"),
    (MODEL, "in the crowd's step from", "in the pedestrian model {} at"),
    (METRIC, "while the run's numbers were being worked out", "in the metric {}"),
)
"""Places of a crash in a heartbeat's words, and the same places with the name of the code."""


def foreign_code(config: RunConfig) -> list[Named]:
    """Return all plug-ins of a run: of its egos, their sensors, its crowd, and its metrics."""
    named = [
        Named(CONTROLLER, ego.ego_id, ego.controller, ego.controller_options, ego)
        for ego in config.each_ego()
        if ego.plugged_in
    ]
    for ego in config.each_ego():
        rules = ego.rules.plugged_in.items()
        named += [Named(RULE, ego.ego_id, name, own) for name, own in rules]
    named += [
        Named(SENSOR, ego.ego_id, ego.perception.sensor, ego.sensor_options)
        for ego in config.each_ego()
        if ego.perception.plugged_in_sensor
    ]
    if config.crowd.plugged_in:
        named.append(Named(MODEL, "the crowd", config.crowd.model, config.model_options))
    metrics = config.metrics.plugged_in.items()
    return named + [Named(METRIC, "the run", name, own) for name, own in metrics]


def code_hashes(
    config: RunConfig, sockets: Collection[Socket] = (*SOCKETS, *TABLES)
) -> dict[str, str]:
    """Return the SHA-256 of the package of each plug-in, by :attr:`Named.key`.

    Args:
        config: Configuration of the run.
        sockets: Sockets whose plug-ins count.

    Raises:
        ControlError: a plug-in is not installed.
    """
    code = [one for one in foreign_code(config) if one.socket in sockets]
    return {one.key: one.sha256 for one in code}


def named_in(failure: str, config: RunConfig) -> str:
    """Return a message about a process that died in foreign code, with the name of that code.

    Args:
        failure: Message of the supervisor.
        config: Configuration of the run.
    """
    code = foreign_code(config)
    for socket, place, named in _PLACES:
        names = dict.fromkeys(shown(one.name) for one in code if one.socket is socket)
        if names:
            these = " or ".join(f"'{name}'" for name in names)
            failure = failure.replace(place, named.format(these))
    return failure


@as_request()
def require_code(config: RunConfig, time_step: float = PAPER_STEP) -> None:
    """Make sure, before anything runs, that every plug-in is there and takes its options.

    Args:
        config: Configuration of the run.
        time_step: Time step of the co-simulation [s].

    Raises:
        ConfigError: a plug-in has no such option.
        ControlError: a plug-in is not installed, or cannot be imported or read.
    """
    for one in foreign_code(config):
        if one.ego is not None and is_fmu(one.name):
            prepared(one.ego, time_step)
        else:
            _loaded(one)


def provenance(config: RunConfig) -> dict[str, dict[str, dict[str, Any]]]:
    """Return each plug-in's distribution, version, hash and options, for the manifest."""
    told: dict[str, dict[str, dict[str, Any]]] = {}
    for one in foreign_code(config):
        if one.ego is not None and is_fmu(one.name):
            described = fmu_described(one.ego)
        else:
            _, options = _loaded(one)
            described = find(one.name, one.socket).described() | {"options": plain(options)}
        whose = f"{one.name} of {one.whose}" if one.socket in TABLES else one.whose
        told.setdefault(one.socket.manifest, {})[whose] = described
    return told


def _loaded(one: Named) -> tuple[Any, Any]:
    try:
        return load_class(one.name, one.socket, one.options)
    except ConfigError as error:
        whose = one.whose if one.socket in {MODEL, METRIC} else f"ego '{one.whose}'"
        error.args = (f"{whose}: {error}",)
        raise
