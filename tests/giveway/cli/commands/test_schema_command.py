"""The JSON schemas accept every TOML file that giveway writes or ships, and flag wrong keys."""

from __future__ import annotations

import json
import tomllib
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import pytest
from jsonschema import Draft202012Validator

from fmus import bundled_fmu
from giveway.config.files.presets import preset_text
from giveway.studies.definition import dump_definition, read_definition
from giveway.studies.study_files import find_study
from pedestrian_model import SIM
from sumo_scenarios import available, find

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
    from subprocess import CompletedProcess

    Type = Callable[..., CompletedProcess[str]]
    Validators = dict[str, Draft202012Validator]


@pytest.fixture
def validators(type_here: Type, tmp_path: Path) -> Validators:
    """By the kind of the file."""
    assert type_here("schema", "--out", "schemas").returncode == 0
    found = {}
    for file in (tmp_path / "schemas").iterdir():
        schema = json.loads(file.read_text())
        Draft202012Validator.check_schema(schema)
        found[file.name] = Draft202012Validator(schema)
    assert len(found) == 5
    return found


def problems(validators: Validators, text: str) -> list[str]:
    """What the schema that a text names says of it."""
    directive, name = text.splitlines()[0].split()
    assert directive == "#:schema"
    return [error.message for error in validators[name].iter_errors(tomllib.loads(text))]


def test_what_giveway_writes_fits(type_here: Type, validators: Validators, tmp_path: Path) -> None:
    texts = [type_here("config", name, "--two-sided").stdout for name in available()]
    texts += [dump_definition(read_definition(find_study(name))) for name in ("law", "controllers")]
    texts.append(preset_text("mine", SIM, {"data": "none", "ade": [0.1, 0.2]}))
    assert type_here("fmu", "inspect", bundled_fmu(), "--draft", "car.toml").returncode == 0
    texts.append((tmp_path / "car.toml").read_text())
    for text in texts:
        assert problems(validators, text) == []


def test_what_giveway_ships_fits(validators: Validators) -> None:
    studies = (files("giveway.studies") / "bundled").iterdir()
    for study in studies:
        if study.name.endswith(".toml"):
            text = "#:schema giveway-study.schema.json\n" + study.read_text(encoding="utf-8")
            assert problems(validators, text) == [], study.name
    for dataset in (files("giveway.recordings") / "datasets").iterdir():
        text = "#:schema giveway-dataset.schema.json\n" + dataset.read_text(encoding="utf-8")
        assert problems(validators, text) == [], dataset.name
    for name in available():
        for file in find(name).config_file.parent.glob("*.toml"):
            values = tomllib.loads(file.read_text(encoding="utf-8"))
            if "frame_rate" in values:  # the description of a recording
                assert validators["giveway-dataset.schema.json"].is_valid(values), file
                continue
            values.pop("description", None)
            settings = values.get("settings", values)
            assert validators["giveway-run.schema.json"].is_valid(settings), file


@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        ("#:schema giveway-run.schema.json\n[crowd]\npedestrans = 3", "pedestrans"),
        ("#:schema giveway-run.schema.json\ncontroller = 'mcp'", "mcp"),
        ("#:schema giveway-dataset.schema.json\nframe_rat = 25", "frame_rat"),
        ("#:schema giveway-run.schema.json\n[crowd]\npedestrians = -3", "-3"),
        ("#:schema giveway-run.schema.json\n[[egos]]\nvehicel = {}", "vehicel"),
        (
            "#:schema giveway-study.schema.json\nname = 'a'\n[factors]\nseed = [1]\n[run]\nsed = 1",
            "sed",
        ),
        ("#:schema giveway-preset.schema.json\n[parameters]\nmas = 3.0", "mas"),
        (
            "#:schema giveway-profile.schema.json\n[inputs]\n[outputs.speeed]\nvariable = 'v'",
            "speeed",
        ),
    ],
)
def test_what_is_wrong_is_flagged(validators: Validators, text: str, wrong: str) -> None:
    found: Any = problems(validators, text)
    assert any(wrong in message for message in found), found
