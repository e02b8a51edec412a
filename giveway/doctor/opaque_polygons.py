"""The polygons of a scenario, by type: those that hide people from cameras, and the others."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

from giveway.config.tables.perception import PerceptionConfig
from giveway.doctor.contents import Contents
from giveway.doctor.finding import Finding, note, ok
from giveway.scenario_files import ScenarioFiles
from giveway.scenario_files.reading import pieces
from giveway.sumo.opaque_bodies import NOTHING_OPAQUE, height_of

_POLYGON = re.compile(rb"<poly(?:gon)?\s([^>]*)>")
_TYPE = re.compile(rb"\btype\s*=\s*[\"']([^\"']*)[\"']")
_SHOWN = 6  # number of types in one line
_SUBJECT = "opaque polygons"


def opaque_polygons(
    files: ScenarioFiles, demand: Contents, settings: Mapping[str, Any]
) -> list[Finding]:
    """Count the polygons that hide people from sensors, by type, and those of other types.

    Args:
        files: Files of the scenario, all of which can be read.
        demand: Contents of its demand.
        settings: Table ``[perception]`` of the scenario's own settings.
    """
    opaque = settings.get("opaque", PerceptionConfig.model_fields["opaque"].default)
    heights = PerceptionConfig(opaque=opaque).heights
    found = Counter(_types(files))
    taken = {kind: top for kind in found if (top := height_of(kind, heights)) is not None}
    findings = []
    if taken:
        told = [f"{found[kind]} {kind} ({top:g} m)" for kind, top in taken.items()]
        findings.append(ok(_SUBJECT, f"{_some(told)}; a polygon's own height comes before it"))
    if left := [
        f"{number} {kind or 'without a type'}"
        for kind, number in found.items()
        if kind not in taken
    ]:
        remedy = f'to take one: --perception-opaque "{opaque}, TYPE HEIGHT"'
        findings.append(note(_SUBJECT, f"hide nobody: {_some(left)}", remedy))
    if settings.get("sensor") == "sight" and not (
        taken or demand.vehicles or demand.elements["flow"]
    ):
        findings.append(note(_SUBJECT, NOTHING_OPAQUE))
    return findings


def _types(files: ScenarioFiles) -> Iterator[str]:
    for file in (*files.route_files, *files.additional_files):
        for text in pieces(file):
            for attributes in _POLYGON.findall(text):
                kind = _TYPE.search(attributes)
                yield kind[1].decode("utf-8", "replace") if kind else ""


def _some(parts: list[str]) -> str:
    more = len(parts) - _SHOWN
    return ", ".join(parts[:_SHOWN]) + (f" and {more} more types" if more > 0 else "")
