"""The table of the configuration about what is seen of the people, and believed of them."""

from math import isfinite
from typing import Literal

from pydantic import field_validator
from pydantic_core import PydanticCustomError

from giveway.config.option import Preset, Section, option
from giveway.config.plug_in_names import (
    BUNDLED_BELIEFS,
    BUNDLED_SENSORS,
    BeliefName,
    SensorName,
)


class PerceptionConfig(Section):
    """The controllers' knowledge of the pedestrians, as far as it is not the truth."""

    sensor: SensorName = option(
        "all",
        None,
        "Sensor that perceives people: all (everybody), sight (cameras, from which things hide "
        "people), or another package's, by its declared name or as module:Class",
    )
    opaque: str = option(
        "building 10, wall 2, hedge 1.5",
        None,
        "Types of SUMO's polygons that hide people from sensors, each with a height [m]; the "
        "parameter 'height' of a polygon comes before it",
    )
    position_noise: float = option(
        0.0,
        "m",
        "Standard deviation per axis of the error of perceived positions. It is cut off at twice "
        "that",
        ge=0,
        le=5,
        because="with a larger error, a person is seen in another lane",
    )
    tracker: bool | None = option(
        None,
        None,
        "A tracker filters positions, bounds them for the safety layer, and learns unknown "
        "desired speeds. By default there is one, but not for the paper's controllers",
        flag="--tracker",
    )
    desired_speeds: Literal["known", "typical"] = option(
        "known",
        None,
        "Knowledge of desired speeds: that of each person (known), or [crowd] desired_speed_mean "
        "until the person's pace is seen (typical)",
    )
    goals: Literal["known", "heading"] = option(
        "known",
        None,
        "Knowledge of destinations: that of each person (known), or none, so that people are "
        "expected to walk on as now (heading)",
        flag="--goals",
    )
    model: BeliefName = option(
        "vci",
        None,
        "Model by which mpc and mpc-paper predict people: one of [crowd] model but recorded, or "
        "drift (constant velocity, corrected as recorded people deviate from it). Another "
        "package's model must be the one that moves people",
    )
    preset: Preset = option(
        "",
        None,
        "Parameters by which people are predicted, as [crowd] preset. By default MIXED, whatever "
        "people walk by; the paper's controllers know those of the crowd",
    )

    @field_validator("opaque")
    @classmethod
    def _have_heights(cls, text: str) -> str:
        """Return the text after a check that each type has a height."""
        _heights(text)
        return text

    @property
    def heights(self) -> dict[str, float]:
        """The height [m] of each type of polygon that hides people."""
        return _heights(self.opaque)

    @property
    def plugged_in_sensor(self) -> bool:
        """True if the sensor is a plug-in."""
        return self.sensor not in BUNDLED_SENSORS

    @property
    def plugged_in(self) -> bool:
        """True if the predicting pedestrian model is a plug-in."""
        return self.model not in BUNDLED_BELIEFS


def _heights(text: str) -> dict[str, float]:
    """Read types of polygons with their heights, as in ``building 10, wall 2``."""
    found: dict[str, float] = {}
    for part in filter(None, map(str.strip, text.split(","))):
        kind, _, number = part.rpartition(" ")
        try:
            height = float(number)
        except ValueError:
            height = 0.0
        if not kind.strip() or not isfinite(height) or height <= 0.0:
            msg = f"'{part}': expected a type and a height [m], like 'building 10'"
            raise PydanticCustomError("opaque", "{expected}", {"expected": msg})
        found[kind.strip()] = height
    return found
