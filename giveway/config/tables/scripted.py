"""``[[crowd.scripted]]``: people who walk straight on by a script, whatever vehicles do."""

from __future__ import annotations

from typing import Any, Final

from pydantic import model_validator

from giveway.config.option import Name, Section, option, read_tables, reader_of_named
from giveway.config.tables.people import ADULT, Kind

SCRIPTED: Final = "scripted"
_FARTHEST = 1e7  # Largest coordinate [m]; beyond it a millimetre is lost in rounding
_MOST = 20  # Largest number of scripted people
_LONGEST = 1000.0  # Longest walk [m]


class ScriptedConfig(Section):
    """One person who walks by a script."""

    name: Name = option(
        "",
        None,
        "Name of the entry, of letters and digits. Its person has this id",
        pattern=r"^[A-Za-z0-9_.-]{1,60}$",
    )
    x: float = option(
        ..., "m", "Place x at which the person stands first", ge=-_FARTHEST, le=_FARTHEST
    )
    y: float = option(..., "m", "Place y of the same point", ge=-_FARTHEST, le=_FARTHEST)
    heading: float = option(
        0.0,
        "deg",
        "Direction of the walk, counter-clockwise from the x axis",
        ge=-360,
        le=360,
    )
    speed: float = option(
        ...,
        "m/s",
        "Speed of the person after the acceleration",
        gt=0,
        le=3.3,
        least=0.1,
        because="nobody walks faster in giveway",
    )
    acceleration_distance: float = option(
        1.0,
        "m",
        "Distance over which the person accelerates evenly",
        gt=0,
        le=100,
        least=0.1,
        because="a person is not at full speed at once",
    )
    distance: float = option(
        20.0,
        "m",
        "Length of the walk. The person stands at its end",
        gt=0,
        le=_LONGEST,
        least=0.1,
        because="a walk is at least 0.1 m long",
    )
    begin: float = option(
        0.0,
        "s",
        "Time after the run's start at which the person sets out, without a meeting",
        ge=0,
        le=1e5,
        because="no run is longer",
    )
    meet_after: float | None = option(
        None,
        "m",
        "Distance after which the person meets a vehicle: the person sets out when the front of a "
        "vehicle, at its speed, will be at meet_x, meet_y at this moment",
        gt=0,
        le=_LONGEST,
        because="it is a distance on the walk",
    )
    meet_x: float = option(
        0.0, "m", "Place x of the vehicle's front at the meeting", ge=-_FARTHEST, le=_FARTHEST
    )
    meet_y: float = option(0.0, "m", "Place y of the same point", ge=-_FARTHEST, le=_FARTHEST)
    kind: Kind = option(
        ADULT, None, "Kind of the person, as in [crowd.people]. Children are smaller, for sensors"
    )

    @model_validator(mode="after")
    def _meets_on_the_way(self) -> ScriptedConfig:
        if self.meet_after is not None and self.meet_after > self.distance:
            raise ValueError(
                f"meet_after = {self.meet_after:g}: expected at most the distance of the walk, "
                f"{self.distance:g} m"
            )
        return self

    def settings(self) -> dict[str, Any]:
        """Return the entries for a table of a TOML file."""
        values: dict[str, Any] = self.model_dump(mode="json", exclude_defaults=True)
        return values


def read_scripted(value: Any) -> tuple[ScriptedConfig, ...]:
    """Read the scripted people in a TOML file or a dictionary.

    Raises:
        ValueError: an entry is not valid; the message names it.
    """
    if isinstance(value, list | tuple) and len(value) > _MOST:
        raise ValueError(f"{len(value)} scripted people: expected {_MOST} at most")
    return read_tables(
        value,
        ScriptedConfig,
        SCRIPTED,
        "[[crowd.scripted]]",
        reader_of_named(ScriptedConfig, SCRIPTED),
    )
