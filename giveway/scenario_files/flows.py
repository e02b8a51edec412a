"""The flows of a scenario with a vehicle that is due.

SUMO knows a single vehicle before it departs, but a flow's vehicle only when it is on the road. An
ego that is to enter the road in the same step has to know about it before.
"""

import math
import re
from collections.abc import Iterable
from html import unescape
from pathlib import Path
from typing import NamedTuple

from giveway.scenario_files.configuration import seconds
from giveway.scenario_files.reading import pieces

_FLOW = re.compile(rb"<flow\s([^>]*)>(?:(?:\s|<!--.*?-->)*<route\s([^>]*)>)?", re.DOTALL)
_ATTRIBUTE = re.compile(rb"([\w:.]+)\s*=\s*(?:\"([^\"]*)\"|'([^']*)')")
_HOUR = 3600.0  # Seconds of an hour
_ROUNDING = 0.001  # Resolution [s] of SUMO's clock


class FlowStart(NamedTuple):
    """The place where a flow's vehicles enter the road; both texts are empty if it is unknown."""

    edge: str
    route: str  # SUMO's id of a route


def flows_due(files: Iterable[Path], after: float, until: float, begin: float) -> list[FlowStart]:
    """Return the places of flows that may depart after ``after`` and up to ``until`` [s].

    Flows with random departures count as due as long as they last.

    Args:
        files: Files that SUMO reads, compressed or not.
        after: Beginning of the period [s].
        until: End of the period [s].
        begin: Start of the simulation [s], for flows without their own.
    """
    due = []
    try:
        for file in files:
            for text in pieces(file):
                for flow, route in _FLOW.findall(text):
                    attributes = _attributes(flow)
                    if _is_due(attributes, after, until, begin):
                        inside = b"" if flow.endswith(b"/") else route
                        due.append(_start(attributes, _attributes(inside)))
    except (OSError, EOFError):
        return due  # SUMO reports the fault in the file
    return due


def _attributes(text: bytes) -> dict[str, str]:
    return {
        name.decode(): unescape((one or other).decode("utf-8", "replace"))
        for name, one, other in _ATTRIBUTE.findall(text)
    }


def _start(flow: dict[str, str], route: dict[str, str]) -> FlowStart:
    edge = flow.get("from") or next(iter(route.get("edges", "").split()), "")
    return FlowStart(edge, "" if edge else flow.get("route", ""))


def _is_due(flow: dict[str, str], after: float, until: float, begin: float) -> bool:
    try:
        first = seconds(flow["begin"]) if "begin" in flow else begin
        last = seconds(flow["end"]) if "end" in flow else math.inf
        if until < first - _ROUNDING or after >= last:
            return False
        period = _period(flow, last - first)
    except ValueError:
        return True  # a vehicle may depart at any time, for example if "triggered"
    if not period > 0.0:
        return True
    number = max(0, math.ceil((after + _ROUNDING - first) / period))  # number of the next vehicle
    if number >= float(flow.get("number", math.inf)):
        return False
    return first + number * period <= min(until, last) + _ROUNDING


def _period(flow: dict[str, str], duration: float) -> float:
    """Return the time [s] between two departures, or 0 for random departures."""
    if "period" in flow:
        return seconds(flow["period"])
    for name in ("vehsPerHour", "perHour"):
        if name in flow:
            return round(_HOUR / float(flow[name]), 3)
    if "number" in flow and "probability" not in flow:
        return duration / float(flow["number"]) if duration < math.inf else 1.0
    return 0.0
