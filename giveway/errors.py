"""The errors of giveway, one class per thing that a user can do something about.

Every message is one line: the file, key or id, the value, what was expected, what to do next.
``exit_code`` is the command line's: 2 for a request that cannot be run, 1 for a run that failed.
"""

from typing import Any


class GivewayError(Exception):
    """Root of all errors that giveway raises on purpose.

    Attributes:
        result: the :class:`giveway.RunResult` recorded until the failure; None before the start.
    """

    exit_code = 1
    result: Any = None  # not typed: errors are the ground floor and import nothing


class InstallationError(GivewayError):
    """The installation is not the one giveway was built for; reinstall as the message says."""


class ConfigError(GivewayError):
    """A configuration key, flag or value cannot be used."""

    exit_code = 2


class ScenarioError(GivewayError):
    """A scenario cannot be found, or does not fit what was asked of it."""

    exit_code = 2


class SumoError(GivewayError):
    """SUMO refused something. The message carries SUMO's own reason."""


class VehicleError(GivewayError):
    """The vehicle FMU cannot be loaded or failed in a step."""


class ControlError(GivewayError):
    """The controller cannot be set up as asked, or produced an unusable command."""


class RuleError(GivewayError):
    """A rule of the road of another package cannot be made, or demanded something unusable."""


class MetricError(GivewayError):
    """A metric of another package declares unusable columns, or returned something unusable."""


class SensorError(GivewayError):
    """A sensor cannot be made, or its answer cannot be used."""


class CrowdError(GivewayError):
    """The pedestrians cannot be placed or moved as asked."""


class CrashError(GivewayError):
    """Native code (SUMO, an FMU, a solver) ended or hung the run's process; rows are kept."""


class DatasetError(GivewayError):
    """Recorded trajectories cannot be read, or there are too few for what was asked."""

    exit_code = 2


class ResultsError(GivewayError):
    """The results cannot be written, or would overwrite something."""

    exit_code = 2
