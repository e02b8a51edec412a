"""The sockets for code of other packages, and their names for users."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Socket:
    """A socket for code of other packages.

    Attributes:
        what: Kind of code, in words.
        setting: Key of a TOML file that names it.
        location: Location of that key.
        options: Table of its options.
        manifest: Key of a run's manifest with its description.
        group: Group of the entry points that declare such code.
        flag: Flag of the command line that names it.
        set_flag: Flag that sets one of its options.
        method: Method that such a class has to have.
    """

    what: str
    setting: str
    location: tuple[str, ...]
    options: str
    manifest: str
    group: str
    flag: str
    set_flag: str
    method: str


CONTROLLER = Socket(
    "controller",
    "controller",
    ("controller",),
    "controller_options",
    "controllers",
    "giveway.controllers",
    "--controller",
    "--set",
    "control",
)
MODEL = Socket(
    "pedestrian model",
    "[crowd] model",
    ("crowd", "model"),
    "model_options",
    "pedestrian_models",
    "giveway.pedestrian_models",
    "--crowd-model",
    "--set-model",
    "step",
)
RULE = Socket(
    "rule",
    "[rules] name",
    ("rules",),
    "rules",
    "rules",
    "giveway.rules",
    "--rule",
    "--rule",
    "demand",
)
METRIC = Socket(
    "metric",
    "[metrics] name",
    ("metrics",),
    "metrics",
    "metrics",
    "giveway.metrics",
    "--metric",
    "--metric",
    "measure",
)
SENSOR = Socket(
    "sensor",
    "[perception] sensor",
    ("perception", "sensor"),
    "sensor_options",
    "sensors",
    "giveway.sensors",
    "--perception-sensor",
    "--set-sensor",
    "observe",
)
VEHICLE = Socket(
    "vehicle",
    "[vehicle] fmu",
    ("vehicle", "fmu"),
    "vehicle",
    "vehicles",
    "",
    "--vehicle",
    "",
    "",
)
"""The vehicle FMU of an ego: a file and no plug-in, but other people's code, too."""
SOCKETS = (CONTROLLER, MODEL, SENSOR)
"""Sockets for which one key names the plug-in."""
TABLES = (RULE, METRIC)
"""Sockets for which the keys of a table name any number of plug-ins."""
