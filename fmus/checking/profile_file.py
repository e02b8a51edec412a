"""The identified model in a profile's file, whose comments and order are kept."""

from typing import Any

import tomlkit
from tomlkit.items import Table

from fmus.profile.vehicle_profile import FittedModel, VehicleProfile

DIGITS = 10  # Number of significant digits, more than a fit determines
ROUNDING = 1e-12  # largest magnitude that counts as 0
_COMMENTS = {
    "mass": "M [kg]",
    "friction": "alpha [N.s/m]",
    "lag": "[s] of the actuator",
    "delay": "[s] dead time",
    "sensor_lag": "[s] of the speed output",
    "limit": "[m/s2] largest force over M",
    "power_from": "[m/s] speed above which the power is constant",
    "rate": "[m/s3] largest change of force over M",
    "r_squared": "of the speed's change per step, in a drive that was not fitted",
    "speed_error": "[m/s] of the MPC's prediction, one step ahead",
    "position_error": "[m] of it at the horizon: 95 % are smaller",
    "sides_error": "[m] the same of the prediction by [model.drive] and [model.brake]",
    "horizon": "[s]",
    "time_step": "[s] of the controller",
}


def with_model(text: str, model: FittedModel) -> str:
    """Return the text of a profile with [model] added or replaced, otherwise unchanged.

    Args:
        text: Profile as valid TOML.
        model: Identified model.
    """
    document = tomlkit.parse(text)
    table = _commented(model.model_dump(exclude_none=True))
    if "model" in document:
        document["model"] = table
    else:
        if text.strip() and not text.endswith("\n\n"):
            document.add(tomlkit.nl())
        document.add("model", table)
    return tomlkit.dumps(document)


def _commented(values: dict[str, Any]) -> Table:
    """Return a table of numbers, each with its meaning, and of such tables at its end."""
    table = tomlkit.table()
    for key, value in values.items():
        if isinstance(value, dict):
            table.add(tomlkit.nl())
            table.add(key, _commented(value))
            continue
        number = tomlkit.item(0.0 if abs(value) < ROUNDING else float(f"{value:.{DIGITS}g}"))
        number.comment(_COMMENTS[key])
        number.trivia.comment_ws = "  "
        table.add(key, number)
    return table


def profile_text(profile: VehicleProfile, comment: str) -> str:
    """Return a profile as TOML, without the keys that have their default value.

    Args:
        profile: Profile to write.
        comment: First line of the text.
    """
    document = tomlkit.document()
    document.add(tomlkit.comment(comment))
    document.update(profile.model_dump(mode="json", exclude_none=True, exclude_defaults=True))
    return tomlkit.dumps(document)
