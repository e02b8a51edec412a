"""The table `[metrics]`: which metrics of other packages add columns to the summary."""

from typing import ClassVar

from giveway.config.tables.plug_in_table import PlugInTable
from giveway.plug_ins.sockets import METRIC, Socket


class MetricsConfig(PlugInTable):
    """The metrics of other packages that a run has; giveway's own are always there."""

    socket: ClassVar[Socket] = METRIC
