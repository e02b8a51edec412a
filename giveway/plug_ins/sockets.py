"""Where code of other packages can be plugged in, and what its users call that."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Socket:
    """A place where code of other packages can be plugged in.

    Attributes:
        what: is plugged in there.
        setting: the key that names it, as a TOML file has it.
        location: of that key.
        options: the table of its options.
        manifest: the key of a run's manifest that tells of it.
        group: of the entry points that declare such code.
        flag: of the command line that names it.
        set_flag: that sets one of its options.
        method: that such a class has to have.
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
SOCKETS = (CONTROLLER, MODEL, SENSOR)
