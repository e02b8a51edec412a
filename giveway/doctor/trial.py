"""The trial of a scenario in a child process, for a report even if SUMO crashes or hangs."""

import json
import shlex
import subprocess
from pathlib import Path
from typing import Any, Final

import numpy as np

from giveway.doctor.finding import Finding, error, note, ok, warning
from giveway.doctor.meetings import meetings
from giveway.errors import GivewayError
from giveway.processes import interpreter
from giveway.processes.causes import cause_of_end
from giveway.walkways import WalkNetwork, beside

PATIENCE: Final = 120.0  # [s] time limit for loading and a short run
_CHILD: Final = "from giveway.sumo.probe import main; main(*arguments)"
_SHOWN: Final = 12  # largest number of edges shown of a route


def try_in_sumo(
    config_file: Path,
    patience: float = PATIENCE,
    *,
    people: bool = False,
    net_file: Path | None = None,
) -> list[Finding]:
    """Let SUMO load the scenario and run it for a moment, in a process of its own.

    Args:
        config_file: Path of the .sumocfg.
        patience: Time limit [s].
        people: True if the scenario has people of its own, to find encounters with them.
        net_file: Network of the scenario, or None to search no place for added people.
    """
    try:
        result = subprocess.run(
            interpreter.command(_CHILD, [str(config_file), people]),
            capture_output=True,
            text=True,
            errors="replace",
            check=False,
            timeout=patience,
            stdin=subprocess.DEVNULL,
        )
    except subprocess.TimeoutExpired:
        text = f"SUMO was still busy after {patience:g} s"
        return [error("SUMO", text, f"see where it waits: sumo -c {config_file}")]
    except OSError as problem:
        return [error("SUMO", f"no process can be started ({problem})", "free some memory")]
    return judged(config_file, result, people=people, net_file=net_file)


def judged(
    config_file: Path,
    result: subprocess.CompletedProcess[str],
    *,
    people: bool = False,
    net_file: Path | None = None,
) -> list[Finding]:
    """Return the findings from the probe's exit code, JSON and messages of SUMO."""
    if result.returncode < 0:
        name = cause_of_end(result.returncode)
        remedy = f"look at it alone: sumo -c {config_file}; report it to the authors of SUMO"
        return [error("SUMO", f"SUMO crashed ({name})", remedy)]
    if result.returncode != 0:
        last = (result.stderr.strip().splitlines() or [f"exit code {result.returncode}"])[-1]
        return [
            error("SUMO", f"the trial failed: {last}", f"look at it alone: sumo -c {config_file}")
        ]
    seen: dict[str, Any] = json.loads(result.stdout.strip().splitlines()[-1])
    if "refused" in seen:
        text = f"SUMO refuses the scenario: {_reasons(result.stderr, seen['refused'])}"
        return [error("SUMO", text, f"correct it; sumo -c {config_file} says the same")]
    findings = [*_loaded(seen), *_warnings(result.stderr, seen["copies"]), *_outputs(seen)]
    findings += [*_remarks(seen), *_egos(config_file, seen)]
    if people:
        return findings + meetings(config_file, seen)
    return findings + _people_of_your_own(config_file, seen, net_file)


def _reasons(stderr: str, refused: str) -> str:
    """Return all of SUMO's reasons: those on stderr, and that of the exception."""
    lines = [line.strip() for line in stderr.splitlines()]
    said = [line.removeprefix("Error:").strip() for line in lines if line.startswith("Error:")]
    return "; ".join(dict.fromkeys([*said, *([] if refused == "Process Error" else [refused])]))


def _loaded(seen: dict[str, Any]) -> list[Finding]:
    text = f"loads in {seen['loaded_in']:.1f} s ({seen['edges']} edges) and runs"
    return [ok("SUMO", f"{text} to {seen['time']:g} s")]


def _warnings(stderr: str, copies: dict[str, str]) -> list[Finding]:
    """Return SUMO's warnings."""
    for copy, original in copies.items():
        stderr = stderr.replace(copy, original)
    findings = []
    for kind, report in (("error", warning), ("warning", note)):
        mark = f"{kind.capitalize()}:"
        lines = [line for line in stderr.splitlines() if line.startswith(mark)]
        if not lines:
            continue
        first = lines[0].removeprefix(mark).strip()
        number = f"{len(lines)} {kind}s, the first" if len(lines) > 1 else f"one {kind}"
        remedy = "they are the scenario's, not a run's"
        if kind == "error":
            remedy = "SUMO goes on without; correct the scenario"
        findings.append(report(f"SUMO's {kind}s", f"{number}: {first}", remedy))
    return findings


def _outputs(seen: dict[str, Any]) -> list[Finding]:
    """Report the outputs of the scenario: of options, additional files and devices."""
    if not seen["outputs"]:
        return [ok("outputs", "the scenario writes none")]
    names = ", ".join(seen["outputs"][:_SHOWN])
    more = len(seen["outputs"]) - _SHOWN
    names += f" and {more} more" if more > 0 else ""
    return [note("outputs", f"{names}: written into RESULTS/sumo, not beside the scenario")]


def _remarks(seen: dict[str, Any]) -> list[Finding]:
    """Return the changes by a run that the findings on the scenario do not report already."""
    said = ("outputs", "pedestrian.model", "random")
    parted = [remark.partition(": ") for remark in seen["remarks"]]
    return [note(option, text) for option, _, text in parted if option not in said]


def _egos(config_file: Path, seen: dict[str, Any]) -> list[Finding]:
    """Return the vehicles that can be taken over, and a route for an inserted ego."""
    vehicles: dict[str, list[str]] = seen["vehicles"]
    if not vehicles:
        text = f"no road vehicle departs before {seen['time']:g} s"
        return [warning("ego", text, _run(config_file, seen) or "no edges for cars are connected")]
    named = ", ".join(f"{name} ({facts[0]})" for name, facts in vehicles.items())
    first, (_, *edges) = next(iter(vehicles.items()))
    route = ",".join(edges[:_SHOWN])
    return [
        note("ego", f"first to depart: {named}", f"--ego={first}, or --ego-route={route}"),
    ]


def _run(config_file: Path, seen: dict[str, Any]) -> str:
    """Return the command that drives the first vehicle, or along the proposed edges."""
    run = f"giveway run {shlex.quote(str(config_file))}"
    if seen["vehicles"]:
        return f"{run} --ego={shlex.quote(next(iter(seen['vehicles'])))}"
    route = ",".join(seen["route"])
    return f"{run} --ego-route={shlex.quote(route)}" if route else ""


def _people_of_your_own(
    config_file: Path, seen: dict[str, Any], net_file: Path | None
) -> list[Finding]:
    """Report a place where added pedestrians would cross the first vehicle's path."""
    if net_file is None or len(seen["way"]) < 2:
        return []
    try:
        place = beside(np.array(seen["way"]), WalkNetwork.read(net_file))
    except GivewayError:
        return []  # the finding on the network reports the fault
    text = f"added pedestrians can cross the way of {next(iter(seen['vehicles']), 'this route')}"
    remedy = f"{_run(config_file, seen)} --pedestrians 20 {place.flags}"
    return [note("spawn area", text, remedy)]
