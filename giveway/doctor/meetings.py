"""Egos, routes and zones, ranked by the number of people that they meet, with command lines."""

import shlex
from pathlib import Path
from typing import Any

from giveway.config.files.layers import read_toml
from giveway.doctor.finding import Finding, note
from sumo_scenarios import find

_RADIUS = 50  # [m] default radius of the zone round an ego
_WITHIN = "within 10 m of the moving vehicle"


def meetings(config_file: Path, seen: dict[str, Any]) -> list[Finding]:
    """Return the findings on encounters with people, from the counts of the probe.

    Args:
        config_file: File .sumocfg of the scenario.
        seen: Output of the probe.
    """
    found = seen["meetings"]
    span = f"from {found['from']:.12g} to {seen['time']:.12g} s"
    if not found["egos"]:
        text = f"{span} nobody on foot comes {_WITHIN}"
        return [note("people met", text, "add pedestrians with --pedestrians N --spawn-area ...")]
    run = f"giveway run {shlex.quote(str(config_file))}{_seed(config_file)}"
    findings = [note("people met", f"counted {span}: people {_WITHIN}; the most first")]
    for name, departure, people in found["egos"]:
        text = f"{name} meets {people}, departs at {departure:.12g} s"
        findings.append(
            note("best egos", text, f"{run} --ego={shlex.quote(name)} --zone={_RADIUS}")
        )
    for edges, departure, people in found["routes"]:
        route = ",".join(edges)
        text = f"{edges[0]} ... {edges[-1]}: {people:.3g} per vehicle"
        flags = f"--ego-route={shlex.quote(route)} --ego-depart-time={departure:.12g}"
        findings.append(note("best routes", text, f"{run} {flags} --zone={_RADIUS}"))
    for x_min, y_min, x_max, y_max, people, name in found["zones"]:
        corners = [(x_min, y_min), (x_max, y_min), (x_max, y_max), (x_min, y_max)]
        zone = " ".join(f"{x:g},{y:g}" for x, y in corners)
        text = f"{people} meetings in the square from {x_min:g},{y_min:g} to {x_max:g},{y_max:g}"
        command = f"{run} --ego={shlex.quote(name)} --zone={shlex.quote(zone)}"
        findings.append(note("best zones", text, command))
    return findings


def _seed(config_file: Path) -> str:
    """Return the flag for a run with the trial's traffic, if the settings draw a seed."""
    settings = find(config_file).settings_file
    drawn = settings is not None and read_toml(settings).values.get("sumo", {}).get("seed") == "run"
    return " --sumo-seed=scenario" if drawn else ""
