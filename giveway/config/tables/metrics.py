"""The table `[metrics]`: which metrics of other packages add columns to the summary."""

from typing import ClassVar

from giveway.config.option import Displacement, option
from giveway.config.tables.plug_in_table import PlugInTable
from giveway.plug_ins.sockets import METRIC, Socket


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
