"""Layers of settings (scenario, TOML file, flags), merged into one validated configuration."""

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomlkit
from pydantic import ValidationError
from pydantic.fields import FieldInfo

from giveway.config.files.schema_names import RUN, with_schema
from giveway.config.files.toml import parse_toml, read_toml_file
from giveway.config.option import Section, declared, expectation
from giveway.config.renamed import advice, renamed_in
from giveway.config.run_config import RunConfig
from giveway.config.tables.basics import BUNDLED_VEHICLES, IDENTIFIED
from giveway.config.tables.controllers import OWN_OPTIONS
from giveway.errors import ConfigError, suggestion
from giveway.gate import DEFINITIONS, read_text
from giveway.plug_ins.finding import same_name
from giveway.plug_ins.sockets import CONTROLLER, SOCKETS, TABLES

Location = tuple[str, ...]


PLUGGED = {socket.options: socket for socket in SOCKETS}
"""The tables whose keys are the options of plug-ins (--set)."""

NO_FLAGS = frozenset({"draws", "egos", "measure", "flow", "recorded", "scripted", *PLUGGED})
"""Keys without flags: lists of numbers or tables, and the tables of plug-ins' options."""


@dataclass(frozen=True)
class Layer:
    """The settings from one origin; a later layer overrides an earlier one key by key."""

    origin: str
    values: Mapping[str, Any]
    from_flags: bool = False
    results: Path | None = None  # results folder of the file, or None if the file is the user's

    def holds(self, location: Location) -> bool:
        """Return whether this layer sets the key at ``location``."""
        node: Any = self.values
        for key in location:
            if not isinstance(node, Mapping) or key not in node:
                return False
            node = node[key]
        return True

    def name(self, location: Location) -> str:
        """Return the name by which the user knows the key at ``location`` in this layer."""
        if self.from_flags:
            if len(location) > 1 and location[0] in PLUGGED:
                return f"{PLUGGED[location[0]].set_flag} {location[1]}"
            return flag_of(location)
        *table, key = location
        heading = f"[{'.'.join(table)}] " if table else ""
        return f"{self.origin}: {heading}{key}"


@dataclass(frozen=True)
class Option:
    """One option of the configuration, as the command line and the documentation present it."""

    location: Location
    field: FieldInfo

    @property
    def extra(self) -> dict[str, Any]:
        """The unit, flag and limits that are declared beside the field."""
        return declared(self.field)

    @property
    def unit(self) -> str | None:
        """The unit, or None for a name, a choice or a switch."""
        return self.extra.get("unit")

    @property
    def flag(self) -> str:
        """The flag of this option on the command line."""
        return self.extra.get("flag") or "--" + "-".join(self.location).replace("_", "-")


def options(model: type[Section] = RunConfig, prefix: Location = ()) -> Iterator[Option]:
    """Yield every option of the configuration, in the order of declaration."""
    for name, field in model.model_fields.items():
        if name in NO_FLAGS:
            continue
        annotation = field.annotation
        if isinstance(annotation, type) and issubclass(annotation, Section):
            yield from options(annotation, (*prefix, name))
        else:
            yield Option((*prefix, name), field)


def own_flags() -> Iterator[Option]:
    """Every option of our own controllers that has a flag of its own."""
    for kind in OWN_OPTIONS.values():
        for name, field in kind.model_fields.items():
            if declared(field).get("flag"):
                yield Option((CONTROLLER.options, name), field)


def flag_of(location: Location) -> str:
    """Return the flag of the option at ``location``."""
    known = {option.location: option.flag for option in options()}
    return known.get(location, "--" + "-".join(location).replace("_", "-"))


def read_toml(path: Path) -> Layer:
    """Read the settings in a TOML file; relative paths in it count from its folder.

    Raises:
        ConfigError: the file is missing, unreadable or not TOML.
    """
    results = results_of(path)
    if results is None:
        values = read_toml_file(path, "a giveway configuration")
    else:
        values = _written_settings(path)
    return Layer(str(path), anchored(values, path.parent.absolute()), results=results)


def _written_settings(path: Path) -> dict[str, Any]:
    """Return the settings in a file of a results folder.

    Raises:
        ConfigError: the file cannot be read, or is not TOML.
        RefusedFileError: it is a link, a pipe or a device, or too large.
    """
    try:
        return parse_toml(read_text(path), str(path))
    except OSError as error:
        raise ConfigError(
            f"{path}: cannot be read ({error.strerror}); expected a giveway configuration (TOML)"
        ) from error


def results_of(path: Path) -> Path | None:
    """Return the results folder that holds a file of settings, or None if it is a user's."""
    written = path.name in {"config.toml", *DEFINITIONS.values()}
    return path.parent if written and path.with_name("manifest.json").is_file() else None


def read_toml_text(text: str, origin: str) -> Layer:
    """Read the settings in a TOML text that giveway itself has written."""
    return Layer(origin, parse_toml(text, origin))


def anchored(values: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return ``values``, in which files that exist relative to ``folder`` have absolute paths."""
    tables = [values]
    if isinstance(values.get("egos"), list):
        tables += [ego for ego in values["egos"] if isinstance(ego, dict)]
    places: list[tuple[Any, str]] = [(values, "scenario"), (values.get("crowd"), "preset")]
    places += [(table, key) for table in tables for key in ("controller", "controller_profile")]
    places += [(table.get("perception"), "preset") for table in tables]
    places += [(table.get("vehicle"), key) for table in tables for key in ("fmu", "profile")]
    recorded = _recorded_in(values)
    places += [(table, key) for table in recorded for key in ("path", "dataset")]
    for table, key in places:
        if isinstance(table, dict) and isinstance(table.get(key), str):
            named = Path(table[key])
            # a word without a folder or suffix is a bundled name
            is_path = len(named.parts) > 1 or named.suffix or key == "path"
            # the name may be too long for Path
            if is_path and os.path.exists(folder / named):  # noqa: PTH110
                table[key] = str(folder / named)
    return values


def _recorded_in(values: Mapping[str, Any]) -> list[Any]:
    """Return the tables of recordings in ``values``, as they stand there."""
    crowd = values.get("crowd")
    recorded = crowd.get("recorded") if isinstance(crowd, Mapping) else None
    return recorded if isinstance(recorded, list) else []


def merge(layers: Sequence[Layer]) -> dict[str, Any]:
    """Merge the layers into one nested dictionary; the last layer that sets a key counts."""
    merged: dict[str, Any] = {}
    for layer in layers:
        for table, socket in PLUGGED.items():
            before = same_name(_at(merged, socket.location))
            named = same_name(_at(layer.values, socket.location))
            if before is not None and named is not None and named != before:
                merged.pop(table, None)  # these options belong to another plug-in
                if socket is CONTROLLER:
                    merged.pop("controller_profile", None)
        _merge_into(merged, layer.values)
    return merged


def _at(values: Any, location: Location) -> Any:
    """Return the value at ``location``, or None if there is none."""
    for key in location:
        values = values.get(key) if isinstance(values, Mapping) else None
    return values


def undotted(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings as tables: ``{"a.b": p}`` becomes ``{"a": {"b": p}}``."""
    tables: dict[str, Any] = {}
    for name, value in settings.items():
        nested: Any = value
        for key in reversed(str(name).split(".")):
            nested = {key: nested}
        _merge_into(tables, nested)
    return tables


def _merge_into(target: dict[str, Any], values: Mapping[str, Any]) -> None:
    for key, value in values.items():
        if isinstance(value, Mapping) and isinstance(target.get(key), dict):
            _merge_into(target[key], value)
        else:
            target[key] = dict(value) if isinstance(value, Mapping) else value


def build_config(layers: Sequence[Layer]) -> RunConfig:
    """Merge the layers and return the validated configuration.

    Raises:
        ConfigError: a setting is wrong. The message is one line with origin, key, value, what was
            expected and, for an unknown key, the key that was probably meant.
    """
    for layer in layers:
        for old, new in renamed_in(layer.values):
            instead = advice(new, as_flag=layer.from_flags)
            raise ConfigError(f"{layer.name(old)}: no longer exists; {instead}")
    merged = merge(layers)
    try:
        return RunConfig.model_validate(merged)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        raise ConfigError(_explain(first, layers)) from None


def _explain(error: Any, layers: Sequence[Layer]) -> str:
    location = _known_part(tuple(str(part) for part in error["loc"]))
    if len(location) > 1 and location[0] in PLUGGED:
        location = location[:2]
    holders = [layer for layer in layers if location and layer.holds(location)]
    name = holders[-1].name(location) if holders else ".".join(location) or "configuration"
    if error["type"] == "extra_forbidden":
        return f"{name}: unknown key; {_did_you_mean(location)}"
    if error["type"] == "value_error":
        origin = f"{holders[-1].origin}: " if holders and not holders[-1].from_flags else ""
        table = f"[{'.'.join(location)}] " if location else ""
        return f"{origin}{table}{error['ctx']['error']}"  # the error concerns several keys
    if len(location) > 1 and location[0] in PLUGGED:
        return f"{name} = {error['input']!r}: expected a finite number, a word, a list or a table"
    option = next((o for o in options() if o.location == location), None)
    if option is None:
        return f"{name} = {error['input']!r}: expected a table of options"
    return f"{name} = {error['input']!r}: {expectation(error, option.field)}"


def _known_part(location: Location) -> Location:
    """Return ``location`` without pydantic's additions: positions in tuples, branches of unions."""
    known = {option.location for option in options()}
    for end in range(len(location), 0, -1):
        if location[:end] in known:
            return location[:end]
    return location


def _did_you_mean(location: Location) -> str:
    siblings = sorted(
        {o.location[len(location) - 1] for o in options() if o.location[:-1] == location[:-1]}
        | ({o.location[0] for o in options()} if len(location) == 1 else set())
    )
    return suggestion(location[-1], siblings)


def dump_toml(config: RunConfig) -> str:
    """Return the whole configuration as TOML, each key followed by its unit and meaning."""
    document = tomlkit.document()
    foreign = any(ego.vehicle.fmu not in BUNDLED_VEHICLES for ego in config.each_ego())
    # Values that are not told of a foreign vehicle are found before the run.
    untold = set(IDENTIFIED) - set(config.vehicle.told) if foreign else set()
    for entry in options():
        *tables, key = entry.location
        value: Any = config
        for name in entry.location:
            value = getattr(value, name)
        if value is None or (tables == ["vehicle"] and key in untold):
            continue  # TOML has no null: an absent key means the default
        node: Any = document
        for table in tables:
            node = node.setdefault(table, tomlkit.table())
        item = tomlkit.item(list(value) if isinstance(value, tuple) else value)
        unit = f"[{entry.unit}] " if entry.unit else ""
        node.add(key, item.comment(f"{unit}{entry.field.description}"))
    for table in PLUGGED:
        if own := getattr(config, table):
            document.add(table, tomlkit.item(own))
    for table in (socket.options for socket in TABLES):
        for name, own in getattr(config, table).plugged_in.items():
            named: Any = document.setdefault(table, tomlkit.table())
            named.add(name, tomlkit.item(dict(own) or True))
    crowd: Any = document["crowd"]
    if config.crowd.draws:
        crowd.add("draws", list(config.crowd.draws))
    for where, key, entries in (
        (crowd, "flow", [flow.settings() for flow in config.crowd.flow]),
        (crowd, "recorded", [entry.settings() for entry in config.crowd.recorded]),
        (crowd, "scripted", [entry.settings() for entry in config.crowd.scripted]),
        (document, "egos", list(config.egos)),
        (document, "measure", [measure.settings() for measure in config.measure]),
    ):
        if entries:
            array = tomlkit.aot()
            for settings in entries:
                array.append(tomlkit.item(settings))
            where.add(key, array)
    return with_schema(tomlkit.dumps(document), RUN)
