"""The parameters of the pedestrian model, by name or from a preset file (TOML) of the user."""

import difflib
import functools
from collections.abc import Mapping
from dataclasses import asdict, fields, replace
from pathlib import Path
from typing import Any, Final

import tomlkit

from giveway.config.files.schema_names import PRESET, with_schema
from giveway.config.files.toml import read_toml_file
from giveway.config.option import DEFAULT_PRESET
from giveway.config.run_config import EgoRunConfig, RunConfig
from giveway.config.tables.crowd import VCI
from giveway.config.tables.recorded import RECORDED
from giveway.errors import ConfigError, suggestion
from pedestrian_model import PRESETS, SIM, ParameterError, VciParameters, require_steady

SUFFIX = ".toml"
NAMES = tuple(field.name for field in fields(VciParameters))
"""The names of the model's parameters, in the order of declaration."""

_ADDED: Final = {name: getattr(VciParameters, name) for name in ("sway", "sway_time")}
"""Parameters that preset files of earlier versions do not name, with the values of these files."""
_TABLES = frozenset({"name", "base", "parameters", "provenance"})


def parameters_of(preset: str) -> VciParameters:
    """Return the parameters of a preset: a built-in one, or a preset file.

    Args:
        preset: Name (SIM, TABLE2) or path of a ``.toml`` file.

    Raises:
        ConfigError: the preset cannot be used; the message names preset or file, key, value and
            what was expected.
    """
    if preset in PRESETS:
        return PRESETS[preset]
    require_preset_name(preset)
    path = Path(preset)
    try:
        status = path.stat()
    except OSError as error:
        raise ConfigError(
            f"{path}: no preset file can be read there ({error.strerror}); see giveway calibrate"
        ) from error
    return _read(path, (status.st_mtime_ns, status.st_size))


def bodies_of(model: str, preset: str) -> VciParameters:
    """Return the parameters of people whom a model moves.

    The largest acceleration of a fitted preset belongs to the forces of VCI. Other models were not
    fitted with it: whatever the preset is, they have the largest acceleration of ``SIM``.

    Args:
        model: Name of the model.
        preset: Name or file, as for :func:`parameters_of`.

    Raises:
        ConfigError: the preset cannot be used.
    """
    parameters = parameters_of(preset)
    if model == VCI:
        return parameters
    return replace(parameters, max_acceleration=SIM.max_acceleration)


def crowd_of(config: RunConfig) -> VciParameters:
    """Return the parameters of the people of a run.

    Args:
        config: Configuration of the run.

    Raises:
        ConfigError: the preset cannot be used.
    """
    model = config.crowd.model
    moving = config.recorded_options.then if model == RECORDED else model
    return bodies_of(moving, config.crowd.preset)


def expected_of(config: EgoRunConfig) -> VciParameters:
    """Return the parameters by which an ego's controller predicts people.

    By default they are those of ``MIXED``, whatever the people walk by. A controller that declares
    the people whom it meets, as the paper's do, predicts by the crowd's own.

    Args:
        config: Configuration of the ego.

    Raises:
        ConfigError: the preset cannot be used.
    """
    declared = config.crowd.preset if config.defaults.crowd_preset else DEFAULT_PRESET
    return bodies_of(config.perception.model, config.perception.preset or declared)


def require_steady_preset(preset: str, time_step: float, where: str) -> None:
    """Make sure that people do not tremble with the parameters of ``preset``.

    Args:
        preset: Name or file, as for :func:`parameters_of`.
        time_step: Time step of the crowd [s].
        where: Option that names the preset; the message begins with it.

    Raises:
        ConfigError: people would tremble, or the preset cannot be read.
    """
    try:
        require_steady(parameters_of(preset), time_step)
    except ParameterError as error:
        raise ConfigError(
            f"{where} {preset}: {error}; correct the preset, or fit it again with giveway calibrate"
        ) from error


def require_preset_name(preset: str) -> None:
    """Make sure that ``preset`` may name a preset; the file need not exist yet.

    Raises:
        ConfigError: it may not.
    """
    if preset in PRESETS or preset.endswith(SUFFIX):
        return
    close = difflib.get_close_matches(preset.upper(), PRESETS, n=1)
    hint = f"; did you mean '{close[0]}'?" if close else ""
    expected = ", ".join(PRESETS)
    raise ConfigError(
        f"preset '{preset}': expected one of {expected}, or a preset file ({SUFFIX}){hint}"
    )


def require_parameter(name: str, where: str) -> None:
    """Make sure that ``name`` is a parameter of the model.

    Raises:
        ConfigError: it is none; the message begins with ``where``.
    """
    if name not in NAMES:
        hint = suggestion(name, NAMES, cutoff=0.6)
        raise ConfigError(f"{where} {name}: unknown parameter; {hint}")


def is_preset_file(preset: str) -> bool:
    """Return whether ``preset`` names a file and not a built-in preset."""
    return preset not in PRESETS and preset.endswith(SUFFIX)


def preset_text(name: str, parameters: VciParameters, provenance: Mapping[str, Any]) -> str:
    """Return the text of a preset file: every parameter, and where the numbers come from.

    Args:
        name: Name of the preset.
        parameters: Parameters, which are all written to the last digit.
        provenance: What was fitted, to which data, and how well: texts, numbers, or lists of them.
    """
    document = tomlkit.document()
    document.add(tomlkit.comment("Parameters of the VCI pedestrian model; giveway's docs tell"))
    document.add(tomlkit.comment("their meaning: [crowd] preset and [perception] preset take it."))
    document["name"] = name
    document["parameters"] = asdict(parameters)
    document["provenance"] = dict(provenance)
    return with_schema(tomlkit.dumps(document), PRESET)


@functools.lru_cache(maxsize=64)
def _read(path: Path, _stamp: object) -> VciParameters:
    values = read_toml_file(path, "a preset file")
    unknown = sorted(set(values) - _TABLES)
    if unknown:
        raise ConfigError(
            f"{path}: unknown key '{unknown[0]}'; expected {', '.join(sorted(_TABLES))}"
        )
    given = values.get("parameters", {})
    if not isinstance(given, dict):
        raise ConfigError(f"{path}: parameters = {given!r}: expected a table [parameters]")
    known = {**_ADDED, **_base(path, values.get("base")), **given}
    _require_names(path, known)
    try:
        return VciParameters(**known)
    except ParameterError as error:
        raise ConfigError(f"{path}: [parameters] {error}") from error


def _base(path: Path, base: object) -> dict[str, float]:
    """Return the values of the ``base`` of a file, which the file need not repeat."""
    if base is None:
        return {}
    if not isinstance(base, str) or base not in PRESETS:
        raise ConfigError(
            f"{path}: base = {base!r}: expected one of {', '.join(PRESETS)}, or no such key"
        )
    return asdict(PRESETS[base])


def _require_names(path: Path, given: Mapping[str, object]) -> None:
    for name in given:
        require_parameter(name, f"{path}: [parameters]")
    missing = [name for name in NAMES if name not in given]
    if missing:
        raise ConfigError(
            f"{path}: [parameters] {missing[0]} is missing; give all {len(NAMES)} parameters, or "
            'take the others from a preset: base = "SIM"'
        )
