"""The identified model in a profile's file, whose comments and order stay as they are."""

import tomlkit

from fmus.profile.vehicle_profile import FittedModel, VehicleProfile

DIGITS = 10  # significant ones: more than any fit knows
ROUNDING = 1e-12  # what no fit can tell from 0
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
    """The text of a profile with [model] added or replaced; all else as it was.

    Args:
        text: valid TOML.
        model: as identified.
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
    """A profile as TOML, without what is at its default.

    Args:
        profile: Profile to write.
        comment: its first line.
    """
    document = tomlkit.document()
    document.add(tomlkit.comment(comment))
    document.update(profile.model_dump(mode="json", exclude_none=True, exclude_defaults=True))
    return tomlkit.dumps(document)
