"""The command ``giveway check``: it tries a plug-in on made-up scenes, in another process."""

import multiprocessing
from collections.abc import Sequence
from multiprocessing.connection import Connection
from multiprocessing.resource_tracker import ensure_running
from typing import Any

import typer

from giveway.cli.flags import set_options
from giveway.cli.screen.printing import print_json
from giveway.config import RunConfig
from giveway.config.files.foreign_code import foreign_code, require_code
from giveway.config.files.layers import Layer, build_config
from giveway.config.run_config import PAPER_STEP
from giveway.errors import ConfigError
from giveway.plug_ins.conformance.battery import Begins, Finding
from giveway.plug_ins.sockets import CONTROLLER, METRIC, MODEL, RULE, SENSOR, TABLES, Socket
from giveway.processes.interrupts import DeferredInterrupt, deaf_children, ended_by
from pedestrian_model import JUPEDSIM_MODELS

LIMIT = 60.0  # Time limit [s] of a rule; most take a tenth of a second
_START = 60.0  # Extra time [s] for the first rule: kernels may have to be compiled
_END = 5.0  # Time [s] for a process that has closed its pipe to end


def check_command(
    name: str,
    words: Sequence[str],
    socket: Socket,
    limit: float = LIMIT,
    time_step: float | None = None,
    profile: str = "",
    *,
    as_json: bool = False,
) -> int:
    """Print the findings and return the exit code: 1 if a rule is broken.

    The rules are tried in a process of their own, which may hang or end.

    Args:
        name: Name of the plug-in.
        words: Words of the command line that set its options.
        socket: Socket for which the plug-in is written.
        limit: Time limit [s] for one rule.
        time_step: Time step [s] of the scenes, or None for that of a run which sets none.
        profile: Profile of a controller FMU.
        as_json: True to print the findings as JSON.

    Raises:
        GivewayError: the plug-in cannot be found, imported or given its options.
    """
    config = _configured(name, words, socket, time_step, profile)
    own = [one for one in foreign_code(config) if one.socket is socket]
    if not own and name not in JUPEDSIM_MODELS:
        msg = f"{name}: is giveway's own; expected a {socket.what} of another package"
        raise ConfigError(msg)
    require_code(config, time_step or PAPER_STEP)
    findings = _in_a_process(config, socket, limit)
    broken = sum(bool(problem) for _, problem in findings)
    if as_json:
        told = [{"rule": rule, "problem": problem} for rule, problem in findings]
        print_json({socket.what: name, "broken": broken, "rules": told})
        return 1 if broken else 0
    for rule, problem in findings:
        typer.echo(f"{'broken' if problem else 'kept':7} {rule}")
        if problem:
            typer.echo(f"        {problem}")
    typer.echo(f"{name}: {broken} of {len(findings)} rules broken" if broken else f"{name}: sound")
    return 1 if broken else 0


def _configured(
    name: str, words: Sequence[str], socket: Socket, time_step: float | None, profile: str
) -> RunConfig:
    settings: dict[str, Any] = {socket.options: set_options(words)}
    if socket in TABLES:  # whose keys are the names
        settings = {socket.options: {name: settings[socket.options] or True}}
    if time_step is not None:
        settings["time_step"] = time_step
    if profile:
        settings["controller_profile"] = profile
    if socket not in TABLES:
        node = settings
        for table in socket.location[:-1]:
            node = node.setdefault(table, {})
        node[socket.location[-1]] = name
    return build_config([Layer("command line", settings, from_flags=True)])


def _in_a_process(config: RunConfig, socket: Socket, limit: float) -> list[tuple[str, str]]:
    """Return the rules and the faults found in each.

    The last rule counts as broken if the process hangs or ends in it.
    """
    # a new process, without threads or state of this one
    spawn = multiprocessing.get_context("spawn")
    ours, theirs = spawn.Pipe(duplex=False)
    process = spawn.Process(
        target=_battery, args=(theirs, config.model_dump_json(), socket.what), daemon=True
    )
    begun: list[str] = []
    try:
        # This process alone says that the user has ended it, and not before the other has its task.
        ensure_running()  # else it would be started in between, and let the signals through
        with deaf_children(), DeferredInterrupt() as interrupt:
            process.start()
        if interrupt.requested:
            raise ended_by(DeferredInterrupt.latest)
        theirs.close()
        while ours.poll(limit if begun else limit + _START):
            message = ours.recv()
            if not isinstance(message, str):
                return list(message)
            begun.append(message)
        problem = f"does not come back: ended after {limit:g} s"
    except EOFError:
        process.join(_END)
        problem = f"ends the process (exit code {process.exitcode})"
    finally:
        if process.pid is not None:
            process.kill()
            process.join()
    *kept, broken = begun or ["can be made"]
    return [*((rule, "") for rule in kept), (broken, problem)]


def _battery(connection: Connection, config: str, what: str) -> None:
    """Send each rule's name before it is tried, then all findings.

    This function runs in the other process.
    """
    effective = RunConfig.model_validate_json(config)
    found = _KITS[what](effective, effective.time_step or PAPER_STEP, connection.send)
    connection.send([(finding.rule, finding.problem) for finding in found])


def _controller(config: RunConfig, step: float, begins: Begins) -> list[Finding]:
    from fmus import processes_reused
    from giveway.config.files.controller_fmu import setup_of
    from giveway.ego import plug_in
    from giveway.plug_ins.conformance.controllers import check_controller

    (own,) = config.each_ego()
    with processes_reused():
        return check_controller(plug_in.maker(own), setup_of(own, step), begins)


def _model(config: RunConfig, step: float, begins: Begins) -> list[Finding]:
    from giveway.config.files.presets import crowd_of
    from giveway.crowd import models
    from giveway.plug_ins.conformance.models import check_model

    make = models.maker(config.crowd.model, config)
    return check_model(make, models.setup_of(config, step, crowd_of(config)), begins=begins)


def _rule(config: RunConfig, step: float, begins: Begins) -> list[Finding]:
    from giveway.ego.rules.plug_ins.conformance import check_rule, made_up_route
    from giveway.ego.rules.plug_ins.plug_in import maker

    (own,) = config.each_ego()
    ((name, settings),) = own.rules.plugged_in.items()
    return check_rule(maker(name, settings), made_up_route(own, step), begins)


def _sensor(config: RunConfig, step: float, begins: Begins) -> list[Finding]:
    from giveway.ego.perception import plugged_in_sensor as sensors
    from giveway.ego.perception.conformance import check_sensor

    (own,) = config.each_ego()
    return check_sensor(sensors.maker(own), sensors.setup_of(own, step), begins)


def _metric(config: RunConfig, step: float, begins: Begins) -> list[Finding]:
    from giveway.metrics.plugged_in import declared
    from giveway.results.metric_conformance import check_metric

    return check_metric(lambda: declared(config)[0], config.each_ego()[0], step, begins)


_KITS = {
    CONTROLLER.what: _controller,
    MODEL.what: _model,
    RULE.what: _rule,
    SENSOR.what: _sensor,
    METRIC.what: _metric,
}
"""The kit of each socket: it takes configuration, control step [s] and the listener to rules."""
