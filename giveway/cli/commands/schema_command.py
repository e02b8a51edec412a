"""The command ``giveway schema``: JSON schemas, by which editors complete and check TOML files."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from rich.console import Console

from fmus import VehicleProfile
from giveway.cli.screen.printing import print_place, writing
from giveway.config.files.presets import NAMES
from giveway.config.files.schema_names import DATASET, PRESET, PROFILE, RUN, STUDY
from giveway.config.run_config import EGO_TABLES, RunConfig
from giveway.plug_ins.finding import declared_names
from giveway.plug_ins.sockets import CONTROLLER, MODEL, SENSOR
from giveway.recordings import Dataset
from giveway.results.json_text import json_text
from giveway.studies.definition import StudyDefinition
from pedestrian_model import PRESETS

_DIALECT = "https://json-schema.org/draft/2020-12/schema"
_OURS = frozenset({"unit", "flag", "least", "because"})  # keys beside those of JSON schema


def schema_command(folder: Path) -> None:
    """Write the schemas of run, study, profile, preset and data set files into ``folder``.

    Raises:
        ResultsError: a schema cannot be written.
    """
    for name, schema in schemas().items():
        with writing(folder / name, "name another folder with --out"):
            (folder / name).write_text(json_text(schema), encoding="utf-8", newline="\n")
    print_place(Console(), "Schemas", folder)


def schemas() -> dict[str, dict[str, Any]]:
    """Return the schemas by the names of their files."""
    makers: dict[str, Callable[[], dict[str, Any]]] = {
        RUN: _run_schema,
        STUDY: _study_schema,
        PROFILE: VehicleProfile.model_json_schema,
        PRESET: _preset_schema,
        DATASET: Dataset.model_json_schema,
    }
    return {name: {"$schema": _DIALECT, **_tidy(make())} for name, make in makers.items()}


def _run_schema() -> dict[str, Any]:
    schema = RunConfig.model_json_schema()
    defined = schema["$defs"]
    places = [(CONTROLLER, schema["properties"])]
    places += [(MODEL, defined[name]["properties"]) for name in ("CrowdConfig", "PerceptionConfig")]
    places.append((SENSOR, defined["PerceptionConfig"]["properties"]))
    for socket, properties in places:
        declared = [{"enum": names}] if (names := declared_names(socket)) else []
        properties[socket.location[-1]]["anyOf"] += declared
    own = {name: schema["properties"][name] for name in EGO_TABLES}
    schema["properties"]["egos"]["items"] = {
        "type": "object",
        "additionalProperties": False,
        "properties": own,
    }
    return schema


def _study_schema() -> dict[str, Any]:
    """Return the schema of a study file, whose settings are tables or dotted keys."""
    schema, run = StudyDefinition.model_json_schema(), _run_schema()
    schema["$defs"] |= run.pop("$defs") | {"RunConfig": run}
    settings = schema["properties"]["run"]
    settings |= {"properties": run["properties"], "additionalProperties": False}
    settings["patternProperties"] = {r"\.": {}}
    return schema


def _preset_schema() -> dict[str, Any]:
    return {
        "type": "object",
        "additionalProperties": False,
        "properties": {
            "name": {"type": "string", "description": "of the preset"},
            "base": {
                "enum": list(PRESETS),
                "description": "the preset that has the parameters which are left out",
            },
            "parameters": {
                "type": "object",
                "additionalProperties": False,
                "properties": {name: {"type": "number"} for name in NAMES},
            },
            "provenance": {"type": "object", "description": "where the numbers come from"},
        },
    }


def _tidy(schema: dict[str, Any]) -> dict[str, Any]:
    """Return the schema with units in its descriptions, and without keys that no editor knows."""
    unit, description = schema.get("unit"), schema.get("description")
    tidied: dict[str, Any] = {}
    for key, value in schema.items():
        if key in _OURS or key == "title" or (key == "default" and value is None):
            continue
        if key in {"properties", "$defs"}:
            tidied[key] = {name: _tidy(one) for name, one in value.items()}
        elif isinstance(value, dict):
            tidied[key] = _tidy(value)
        elif key in {"anyOf", "prefixItems"}:
            tidied[key] = [_tidy(one) for one in value]
        else:
            tidied[key] = value
    if unit and description:
        tidied["description"] = f"{description} [{unit}]"
    return tidied
