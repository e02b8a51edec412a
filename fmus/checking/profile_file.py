"""The identified model in a profile's file, whose comments and order are kept."""

import tomlkit

from fmus.profile.vehicle_profile import FittedModel, VehicleProfile

DIGITS = 10  # Number of significant digits, more than a fit determines
ROUNDING = 1e-12  # largest magnitude that counts as 0
_COMMENTS = {
    "mass": "M [kg]",
    "friction": "alpha [N.s/m]",
    "lag": "[s] of the actuator",
    "delay": "[s] dead time",
    "r_squared": "of the speed's change per step, in a drive that was not fitted",
    "speed_error": "[m/s] of the MPC's prediction, one step ahead",
    "position_error": "[m] of it at the horizon: 95 % are smaller",
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
    table = tomlkit.table()
    for key, value in model.model_dump().items():
        rounded = 0.0 if abs(value) < ROUNDING else float(f"{value:.{DIGITS}g}")
        number = tomlkit.item(rounded)
        number.comment(_COMMENTS[key])
        number.trivia.comment_ws = "  "
        table.add(key, number)
    if "model" in document:
        document["model"] = table
    else:
        if text.strip() and not text.endswith("\n\n"):
            document.add(tomlkit.nl())
        document.add("model", table)
    return tomlkit.dumps(document)


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
