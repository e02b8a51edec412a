"""The table of the configuration about what is seen of the people, and believed of them."""

from typing import Literal

from giveway.config.option import Preset, Section, option
from giveway.config.plug_in_names import BUNDLED_MODELS, ModelName


class PerceptionConfig(Section):
    """What the controllers know of the pedestrians, as far as it is not the truth."""

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

    signal_plans: bool = option(
        True,
        None,
        "lights tell the ego their plan (SPaT): it waits for nobody who will find theirs red, and "
        "mpc arrives when its own is green",
        flag="--signal-plans",
    )

    @property
    def plugged_in(self) -> bool:
        """Whether the model of people that is believed in is somebody else's."""
        return self.model not in BUNDLED_MODELS
