"""The check of a scenario: its files, their contents, and what a run would do."""

import math
from collections import Counter
from pathlib import Path
from typing import Any, Final

from giveway.config.files.layers import read_toml
from giveway.doctor.contents import Contents, read_contents
from giveway.doctor.finding import Finding, error, note, ok, warning
from giveway.doctor.interplay import interplay
from giveway.doctor.opaque_polygons import opaque_polygons
from giveway.doctor.trial import PATIENCE, try_in_sumo
from giveway.errors import GivewayError
from giveway.errors import ScenarioError as UnusableScenario
from giveway.scenario_files import STRIPING, ScenarioFiles, read_scenario
from giveway.scenario_files.outputs import is_file
from sumo_scenarios import ScenarioError, find

# Step of SUMO [s] above which a person may step before a car, which looks once in each step
_BLINK: Final = 0.5
# Largest control step [s]; a run takes the longest up to it that divides SUMO's
_CONTROL_STEP: Final = 0.05
_NETWORK_VERSION: Final = (1, 20)  # version that SUMO 1.28's netconvert writes
# Version before which walkingareas and lefthand have another meaning
_OLDEST_NETWORK: Final = (1, 0)


def examine_scenario(scenario: str | Path, patience: float = PATIENCE) -> list[Finding]:
    """Check a scenario as a run would use it; SUMO tries it in a process of its own.

    Args:
        scenario: Bundled name, folder, or .sumocfg.
        patience: Time limit [s] for loading the scenario.
    """
    try:
        files = read_scenario(find(scenario).config_file)
    except (ScenarioError, GivewayError) as problem:
        return [error("scenario", str(problem), "correct the .sumocfg or its path")]
    findings = [ok("scenario", str(files.config_file))]
    missing = _missing(files)
    if missing:
        return findings + missing
    network, demand = Contents(), Contents()
    for contents, paths in (
        (network, (files.net_file,)),
        (demand, (*files.route_files, *files.additional_files)),
    ):
        for path in paths:
            try:
                read_contents(path, contents)
            except (OSError, EOFError) as problem:
                text = f"{path} cannot be read ({problem})"
                findings.append(error("files", text, "replace it by a whole one"))
    findings += [*_network(files, network, demand), *_demand(network, demand), *_time(files)]
    findings += [*_settings(files), *_remote(files, network, demand)]
    if not any(finding.level == "error" for finding in findings):
        findings += [*interplay(files), *opaque_polygons(files, demand, _perception(files))]
    people = demand.persons > 0
    return findings + try_in_sumo(
        files.config_file, patience, people=people, net_file=files.net_file
    )


def _perception(files: ScenarioFiles) -> dict[str, Any]:
    """Return the table [perception] of the scenario's own settings."""
    settings = find(files.config_file).settings_file
    own = {} if settings is None else read_toml(settings).values.get("perception", {})
    return own if isinstance(own, dict) else {}


def _missing(files: ScenarioFiles) -> list[Finding]:
    findings = [
        error(
            "files", f"{option} names {path}, which does not exist", "put it there, or correct it"
        )
        for option, path in files.missing
    ]
    if findings:
        return findings
    try:
        files.require_inputs()
    except UnusableScenario as problem:
        return [error("files", str(problem), "correct the .sumocfg or the permissions")]
    return []


def _network(files: ScenarioFiles, network: Contents, demand: Contents) -> list[Finding]:
    subject = "network"
    if not network.network:
        text = f"{files.net_file} is not a road network (no <net>)"
        return [error(subject, text, "name a .net.xml made by netconvert or netgenerate")]
    version = network.network.get("version", "0")
    findings = [ok(subject, f"{files.net_file.name}, version {version}")]
    if _numbers(version) > _NETWORK_VERSION:
        text = f"version {version} is later than SUMO 1.28's 1.20"
        findings.append(warning(subject, text, "rebuild it with netconvert 1.28"))
    elif _numbers(version) < _OLDEST_NETWORK:
        remedy = f"netconvert -s {files.net_file.name} -o NEW.net.xml"
        findings.append(warning(subject, f"version {version} is older than SUMO 1.0", remedy))
    if network.network.get("lefthand") in ("true", "1"):
        findings.append(note(subject, "left-hand traffic"))
    return [*findings, _walkways(network.elements, demand)]


def _walkways(network: Counter[str], demand: Contents) -> Finding:
    """Report where SUMO's own persons can walk; giveway's pedestrians need no infrastructure."""
    subject = "walkways"
    if network["walkingarea"] and network["sidewalk"]:
        text = (
            f"{network['sidewalk']} sidewalks, {network['crossing']} crossings, "
            f"{network['walkingarea']} walkingareas"
        )
        return ok(subject, text)
    lack = "no sidewalks" if not network["sidewalk"] else "no walkingareas at its junctions"
    text = f"the network has {lack}"
    if not demand.persons:
        return note(subject, text, "none are needed for pedestrians of your own (--pedestrians)")
    remedy = "netconvert -s NET --sidewalks.guess --crossings.guess --walkingareas -o NEW"
    return warning(subject, f"{text}, but there are persons", remedy)


def _numbers(version: str) -> tuple[int, ...]:
    parts = version.split(".")
    return tuple(int(part) for part in parts if part.isdecimal())


def _demand(network: Contents, demand: Contents) -> list[Finding]:
    elements = demand.elements
    text = (
        f"{demand.vehicles} vehicles and {elements['flow']} flows, {elements['person']} persons "
        f"and {elements['personFlow']} flows of persons"
    )
    lights = network.elements["tlLogic"] + elements["tlLogic"]
    findings = [ok("demand", text), ok("traffic lights", f"{lights} programs")]
    if not demand.persons:
        remedy = "add pedestrians with --pedestrians N"
        findings.append(note("demand", "the scenario has no persons of its own", remedy))
    return findings


def _time(files: ScenarioFiles) -> list[Finding]:
    step = files.step_length
    substeps = max(1, math.ceil(step / _CONTROL_STEP - 1e-9))
    text = f"{step:g} s"
    if abs(step * 1000.0 - round(step * 1000.0)) > 1e-6:
        remedy = "SUMO cuts it off; use whole milliseconds"
        findings = [warning("step length", f"{text} is not a whole number of ms", remedy)]
    else:
        text = f"{text}, {substeps} control step(s) of {step / substeps:.4g} s"
        findings = [ok("step length", text)]
        if step > _BLINK:
            remedy = "--sumo-step-length 0.1 lets its vehicles brake for people in time"
            findings = [note("step length", f"{text}; SUMO's vehicles look once in each", remedy)]
    if files.end is None:
        text = f"from {files.begin:.12g} s, with no end"
        findings.append(note("time", text, "a run ends with its own --time-limit"))
    elif files.end <= files.begin:
        text = f"from {files.begin:.12g} s to {files.end:.12g} s: nothing is simulated"
        findings.append(error("time", text, "let <end> come after <begin>"))
    else:
        findings.append(ok("time", f"from {files.begin:.12g} s to {files.end:.12g} s"))
    return findings


def _settings(files: ScenarioFiles) -> list[Finding]:
    findings = []
    if files.pedestrian_model != STRIPING:
        text = f"{files.pedestrian_model}; a run takes striping, the only one that can be moved"
        findings.append(warning("pedestrian model", text, "SUMO's own walkers will differ"))
    else:
        findings.append(ok("pedestrian model", STRIPING))
    if files.random:
        remedy = "a run takes its own; choose it with --seed"
        findings.append(note("seed", "the scenario seeds itself by the clock", remedy))
    else:
        findings.append(ok("seed", "SUMO's own" if files.seed is None else str(files.seed)))
    settings = ", ".join(f"{name} {value}" for name, value in files.teleport_settings.items())
    findings.append(ok("teleporting", f"{settings or 'as SUMO has it'}; never of an ego"))
    lateral = files.options.get("lateral-resolution", "0")
    if lateral not in ("", "0", "-1"):
        findings.append(note("lanes", f"sublane model, {lateral} m"))
    if "load-state" in files.options:
        text = "the scenario starts from a saved state"
        findings.append(note("state", text, "make sure that SUMO 1.28 has saved it"))
    return findings


def _remote(files: ScenarioFiles, network: Contents, demand: Contents) -> list[Finding]:
    remote = [*network.remote, *demand.remote]
    remote += [value for value in files.options.values() if value.startswith("http")]
    sockets = [
        name
        for names in files.outputs.values()
        for name in names
        if not is_file(name) and ":" in name
    ]
    findings = [
        warning(
            "remote files", f"{address}; nothing is fetched at run time", "keep a copy beside it"
        )
        for address in dict.fromkeys(remote)
    ]
    findings += [
        warning("remote outputs", f"{name} is a network address", "somebody must listen there")
        for name in sockets
    ]
    return findings or [ok("remote files", "none; nothing is fetched at run time")]
