"""The table of the configuration about what is seen of the people, and believed of them."""

from typing import Literal

from giveway.config.option import Preset, Section, option
from giveway.config.plug_in_names import (
    BUNDLED_MODELS,
    BUNDLED_SENSORS,
    ModelName,
    SensorName,
)


class PerceptionConfig(Section):
    """The controllers' knowledge of the pedestrians, as far as it is not the truth."""

    sensor: SensorName = option(
        "all",
        None,
        "what perceives the people: all (everybody); or somebody else's sensor, by the name that a "
        "package declares, or as module:Class",
    )
    position_noise: float = option(
        0.0,
        "m",
        "people are seen this far off (standard deviation per axis, cut off at twice that)",
        ge=0,
        le=5,
        because="whom one looks for a lane off is not seen",
    )
    tracker: bool | None = option(
        None,
        None,
        "positions are filtered, and bounded for the safety layer; unknown desired speeds are "
        "learnt. Left out: yes, but not for the paper's controllers",
        flag="--tracker",
    )
    desired_speeds: Literal["known", "typical"] = option(
        "known",
        None,
        "of each person, or no more than [crowd] desired_speed_mean, until a pace is seen: typical",
    )
    goals: Literal["known", "heading"] = option(
        "known",
        None,
        "where each person goes, or no more than that everybody walks on as now: heading",
        flag="--goals",
    )
    model: ModelName = option(
        "vci",
        None,
        "what mpc and mpc-paper take to move people, whatever does: the names of [crowd] model; "
        "somebody else's only if it is what moves them",
    )
    preset: Preset = option(
        "", None, "parameters the pedestrians are predicted with, as [crowd] preset; none: the same"
    )

    @property
    def plugged_in_sensor(self) -> bool:
        """True if the sensor is a plug-in."""
        return self.sensor not in BUNDLED_SENSORS

    @property
    def plugged_in(self) -> bool:
        """True if the predicting pedestrian model is a plug-in."""
        return self.model not in BUNDLED_MODELS
