"""The event whose probability is estimated, and the criticality of a run.

The criticality is at least 0 if the event happened, and then says how bad it was. Otherwise it is
negative, and larger the closer the run came to the event.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from giveway.errors import ConfigError
from giveway.risk.severity import injury_at_contact
from giveway.studies.record import RunRecord

Measure = Literal["deceleration", "clearance", "ttc"]
MEASURES: tuple[Measure, ...] = ("deceleration", "clearance", "ttc")
MAIS3 = "mais3"
EVENTS = ("frontal", "side", "contact", "impact>SPEED", MAIS3, "red-light")
_IMPACT = re.compile(r"impact\s*>\s*([0-9]+(?:\.[0-9]+)?)")
_KMH = 3.6  # km/h in a m/s
_NEVER = -1e3  # Criticality of a run in which nobody came near
_NEARLY = -1e-9  # Largest criticality without the event
_COLUMNS: dict[Measure, str] = {
    "deceleration": "maximum_drac",
    "clearance": "clearance_ahead",
    "ttc": "minimum_ttc_moving",
}
"""Column of the summary that each measure needs."""


@dataclass(frozen=True)
class Event:
    """An event of a run.

    Attributes:
        name: Name of the event.
        speed: Impact speed [m/s] that is exceeded; 0 for every impact.
    """

    name: str
    speed: float = 0.0

    @property
    def is_graded(self) -> bool:
        """True if runs without the event have different criticality."""
        return self.name != "red-light"

    def criticality(
        self, record: RunRecord, measure: Measure, injury_draw: float = math.nan
    ) -> float:
        """Return the criticality of a run: the largest of its egos, or nan without a result.

        Args:
            record: Record of the run.
            measure: Measure of how close a run without the event came to it.
            injury_draw: Uniform number that draws whether the contact injures.
        """
        if record.failed:
            return math.nan
        if self.name == MAIS3:
            each = [_of_injury(row, measure, injury_draw) for row in record.rows]
        else:
            each = [self._of_ego(row, measure) for row in record.rows]
        return float(np.max(each)) if each else _NEVER  # nan if that of one ego is

    def _of_ego(self, row: Mapping[str, Any], measure: Measure) -> float:
        if self.name == "red-light":
            run = _number(row, "red_lights_run")
            return run if run > 0.0 else -1.0
        clearance = _number(row, "minimum_clearance")
        if self.name == "contact":
            return _NEVER if math.isnan(clearance) else -clearance
        if self.name == "side":
            speed = _number(row, "side_impact_speed")
            return speed if not math.isnan(speed) else min(_NEARLY, -abs(_or_far(clearance)))
        speed = _number(row, "frontal_impact_speed")
        if not math.isnan(speed):
            return speed - self.speed
        return min(_NEARLY, _distance_from(row, measure)) - self.speed


def _of_injury(row: Mapping[str, Any], measure: Measure, draw: float) -> float:
    """Return by how much the probability of an injury exceeds its draw, or nan if not known.

    It is in (-1, 1) with a frontal contact, and less than -1 without one.
    """
    if math.isnan(_number(row, "frontal_impact_speed")):
        return min(_NEARLY, _distance_from(row, measure)) - 1.0
    return injury_at_contact(row) - draw


def _distance_from(row: Mapping[str, Any], measure: Measure) -> float:
    """Return the criticality [-1, 0) of an ego whose way somebody crossed, and less otherwise."""
    value = _number(row, _COLUMNS[measure])
    if math.isnan(value) or (measure == "deceleration" and value <= 0.0):
        return max(_NEVER, -1.0 - abs(_or_far(_number(row, "minimum_clearance"))))
    near = 1.0 / (1.0 + value)  # 1 is the event by time or distance, and 0 by deceleration
    return -near if measure == "deceleration" else near - 1.0


def _or_far(clearance: float) -> float:
    return -_NEVER if math.isnan(clearance) else clearance


def _number(row: Mapping[str, Any], name: str) -> float:
    value = row.get(name)
    return math.nan if value is None else float(value)


def read_event(text: str, origin: str) -> Event:
    """Return the event of a text like ``frontal`` or ``impact>20``, a speed in km/h.

    Raises:
        ConfigError: there is no such event.
    """
    match = _IMPACT.fullmatch(text.strip())
    if match is not None:
        return Event("impact", float(match[1]) / _KMH)
    if text not in EVENTS or text == "impact>SPEED":
        raise ConfigError(
            f"{origin}: event = '{text}': expected one of {', '.join(EVENTS)}, with the speed in "
            "km/h, like impact>20"
        )
    return Event(text)
