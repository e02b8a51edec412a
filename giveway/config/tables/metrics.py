"""The table `[metrics]`: which metrics of other packages add columns to the summary."""

from typing import ClassVar

from pydantic import field_validator

from giveway.config.option import Displacement, option
from giveway.config.tables.plug_in_table import PlugInTable
from giveway.plug_ins.sockets import METRIC, Socket

_LARGEST = 3.0  # Largest side [m] of a dummy


class MetricsConfig(PlugInTable):
    """The metrics of other packages that a run has, and giveway's own that are not always there."""

    socket: ClassVar[Socket] = METRIC

    impacts: bool | None = option(
        None,
        None,
        "The summary has the speeds of contacts, and the smallest distance ahead. It does not by "
        "default, but in giveway risk",
    )
    dummy: Displacement | None = option(
        None,
        "m",
        "Length and width of a test's dummy. The summary has the speed at which the front reaches "
        "it, and how the ego braked. It does not by default, but in giveway ncap",
    )

    @field_validator("dummy")
    @classmethod
    def _has_a_box(cls, size: Displacement | None) -> Displacement | None:
        if size is not None and not all(0.0 < side <= _LARGEST for side in size):
            raise ValueError(
                f"{size[0]:g},{size[1]:g}: expected two lengths above 0, up to {_LARGEST:g} m"
            )
        return size
