"""The names of runs: what differs from the settings of their scenario, in few words."""

from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any, Final

from giveway.config.files.layers import PLUGGED, Layer, Location, dump_toml, options
from giveway.config.files.loading import load
from giveway.config.run_config import RunConfig
from giveway.errors import GivewayError

_NAMED_APART: Final = frozenset(
    {
        ("scenario",),
        ("seed",),
        ("controller",),
        ("crowd", "pedestrians"),
        ("ego", "take_over"),
        ("ego", "none"),
    }
)
_SPEAKING: Final = frozenset(
    {
        ("controller_options", "style"),
        ("crowd", "model"),
        ("vehicle", "fmu"),
        ("perception", "sensor"),
    }
)
_FMU: Final = ("vehicle", "fmu")
_OF_FILES: Final = frozenset({"record", "metrics"})  # They change no drive
_MOST: Final = 3  # Number of differences that a name tells
_LONGEST_VALUE: Final = 24  # Number of letters of a value
_LONGEST: Final = 60  # Number of letters of each part of a folder's name


def title(config: RunConfig, scenario: str, people: str = "", ego: str = "") -> str:
    """Return the title of a run: scenario, who drives, what differs, people and seed.

    Args:
        config: Configuration of the run, or of one of its egos.
        scenario: Name of the scenario.
        people: Number of people in words, or empty.
        ego: Words that stand for the controller's name, or empty.
    """
    driver = "no ego" if config.ego.none else config.driver
    units = {option.location: option.unit for option in options()}
    words = _words(_telling(_differing(config)), units)
    parts = [ego or driver, *words, people, f"seed {config.seed}"]
    return f"{scenario}: {', '.join(part for part in parts if part)}"


def default_folder(config: RunConfig, scenario: str) -> Path:
    """Return ``results/<scenario>_<controller>_<differences>_<persons>ped_seed<seed>``.

    The ids of egos that are taken over follow the controller. The number of persons is left out if
    giveway adds none: the scenario may bring its own. If these words do not tell all that differs
    from the scenario's settings and the defaults, six digits of a hash over the whole
    configuration follow, so that different runs have different folders.
    """
    egos = config.each_ego()
    controllers = _safe("_".join(dict.fromkeys(ego.controller_name for ego in egos))) or "no_ego"
    taken = "".join(f"_{name}" for ego in egos for name in ego.ego.take_over)
    differing = _differing(config)
    telling = _telling(differing)
    words = _safe("".join(f"_{word}" for word in _words(telling, {})))
    added = f"_{config.crowd.pedestrians}ped" if config.crowd.pedestrians else ""
    name = f"{scenario}_{controllers}{_safe(taken)[:_LONGEST]}{words[:_LONGEST]}{added}"
    name += f"_seed{config.seed}"
    whole = len(differing) == len(telling) <= _MOST and not any(map(_is_long, telling.values()))
    if not (whole and len(words) <= _LONGEST and _are_all(differing, config)):
        name += f"_{sha256(dump_toml(config).encode()).hexdigest()[:6]}"
    return Path("results") / name


def _safe(name: str) -> str:
    """Return a part of a folder's name that is valid on every system."""
    return "".join(letter if letter.isalnum() or letter in "._-" else "-" for letter in name)


def _plain(config: RunConfig) -> dict[str, Any]:
    """Return the settings that a name tells apart from the differences."""
    ego = {key: value for key in ("take_over", "none") if (value := getattr(config.ego, key))}
    return {
        "scenario": config.scenario,
        "controller": config.controller,
        "seed": config.seed,
        "crowd": {"pedestrians": config.crowd.pedestrians},
        "ego": ego,
    }


def _differing(config: RunConfig) -> dict[Location, Any]:
    """Return the settings that differ from those of the scenario; none if it cannot be read."""
    try:
        plain, _ = load([Layer("", _plain(config))])
    except GivewayError:
        return {}
    ours, theirs = _flat(config), _flat(plain)
    return {
        location: ours.get(location)
        for location in dict.fromkeys((*ours, *theirs))
        if ours.get(location) != theirs.get(location)
        and location not in _NAMED_APART
        and location[0] not in _OF_FILES
    }


def _telling(differing: dict[Location, Any]) -> dict[Location, Any]:
    """Return the differences without those that belong to an FMU that is named."""
    return {
        location: value
        for location, value in differing.items()
        if location != ("controller_profile",)
        and not (location[0] == "vehicle" and location != _FMU and _FMU in differing)
    }


def _flat(config: RunConfig) -> dict[Location, Any]:
    """Return each setting by its tables and key; the options of plug-ins are among them."""
    settings = {}
    for option in options():
        value: Any = config
        for name in option.location:
            value = getattr(value, name)
        settings[option.location] = value
    for table in PLUGGED:
        settings |= {(table, key): value for key, value in getattr(config, table).items()}
    return settings


def _words(differing: dict[Location, Any], units: Mapping[Location, str | None]) -> list[str]:
    """Return the first differences in words; a number is followed by its unit, if there is one."""
    told = sorted(differing.items(), key=lambda item: item[0] not in _SPEAKING)
    words = [f"{_word(*item)} {units.get(item[0]) or ''}".rstrip() for item in told[:_MOST]]
    return [*words, f"{len(told) - _MOST} more"] if len(told) > _MOST else words


def _word(location: Location, value: Any) -> str:
    """Return ``assertive``, ``mine.fmu``, ``no twin`` or ``initial speed 6``."""
    *tables, key = location
    name = (tables[0] if key == "enabled" else key).replace("_", " ")
    if value is None or isinstance(value, bool):
        return name if value else f"no {name}"
    if location in _SPEAKING and isinstance(value, str):
        return Path(value).name if value.endswith(".fmu") else value
    if _is_long(value):
        return f"own {name}"
    if isinstance(value, list | tuple):
        value = ",".join(f"{one:g}" if isinstance(one, float) else str(one) for one in value)
    return f"{name} {value:g}" if isinstance(value, float) else f"{name} {value}"


def _is_long(value: Any) -> bool:
    """Return whether a value has no room in a name, as a route of many edges."""
    return len(str(value)) > _LONGEST_VALUE


def _are_all(differing: dict[Location, Any], config: RunConfig) -> bool:
    """Return whether a configuration differs from its scenario in nothing else."""
    told: dict[str, Any] = _plain(config)
    for (*tables, key), value in differing.items():
        node = told
        for table in tables:
            node = node.setdefault(table, {})
        node[key] = value
    try:
        again, _ = load([Layer("", told)])
    except GivewayError:
        return False
    return dump_toml(again) == dump_toml(config)
