"""The documentation says what the program does."""

import re
import tomllib
from pathlib import Path
from typing import get_args

import pandas as pd
import pytest

from fmus import VehicleProfile, make_profile
from giveway.config.files.layers import options
from giveway.config.option import declared
from giveway.config.tables.recorded import RecordedConfig, RecordedOptions
from giveway.config.tables.scripted import ScriptedConfig
from giveway.metrics import (
    DELAY_FIELDS,
    DELAY_SUMMARY_FIELDS,
    PEDESTRIAN_FIELDS,
    SUMMARY_FIELDS,
    WALK_SUMMARY_FIELDS,
)
from giveway.metrics.baseline import BASELINE_FIELDS
from giveway.metrics.law import LAW_FIELDS
from giveway.metrics.travel import SIGNAL_DELAY_FIELDS, TRAVEL_FIELDS
from giveway.metrics.waiting import WAITING_FIELDS
from giveway.ncap.table import COLUMNS as NCAP_COLUMNS
from giveway.recordings import KNOWN
from giveway.recordings.describing import RECORDING_FIELDS
from giveway.recordings.measuring import DRIVE_FIELDS, PERSON_FIELDS
from giveway.run_data.columns import (
    LEDGER_COLUMNS,
    PEOPLE_COLUMNS,
    PREDICTION_COLUMNS,
    SIGNAL_COLUMNS,
    TIMING_COLUMNS,
    TRAJECTORY_COLUMNS,
)
from giveway.run_data.tracks import EGO_COLUMNS

DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.parametrize(
    "columns",
    [
        EGO_COLUMNS,
        TRAJECTORY_COLUMNS,
        PREDICTION_COLUMNS,
        TIMING_COLUMNS,
        PEDESTRIAN_FIELDS,
        DELAY_FIELDS,
        DELAY_SUMMARY_FIELDS,
        SUMMARY_FIELDS,
        WALK_SUMMARY_FIELDS,
        LAW_FIELDS,
        BASELINE_FIELDS,
        TRAVEL_FIELDS,
        SIGNAL_DELAY_FIELDS,
        WAITING_FIELDS,
        LEDGER_COLUMNS,
        PEOPLE_COLUMNS,
        SIGNAL_COLUMNS,
    ],
)
def test_every_column_is_documented_as_it_is_declared(columns: tuple) -> None:
    text = (DOCS / "results.md").read_text(encoding="utf-8")
    for column in columns:
        row = f"| `{column.name}` | {column.type} | {column.unit or ''} | {column.description} |"
        assert row in text


def test_the_printed_call_keeps_every_id(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    call = re.search(r"`(pd\.read_csv\(\"traj.*\))`", (DOCS / "results.md").read_text("utf-8"))
    ids = ["NaN", "None", "1695568738601786.12", "-E3", "007", "null"]
    (tmp_path / "trajectories.csv").write_text("id,x\n" + "".join(f"{i},\n{i},1.5\n" for i in ids))
    monkeypatch.chdir(tmp_path)
    table = eval(call[1], {"pd": pd}) if call else pd.DataFrame()  # our own docs
    assert list(table["id"]) == [name for name in ids for _ in range(2)]
    assert table["x"].isna().tolist() == [True, False] * len(ids)


@pytest.mark.parametrize("columns", [RECORDING_FIELDS, DRIVE_FIELDS, PERSON_FIELDS])
def test_every_column_of_recordings_is_documented(columns: tuple) -> None:
    text = (DOCS / "recordings.md").read_text(encoding="utf-8")
    for column in columns:
        row = f"| `{column.name}` | {column.type} | {column.unit or ''} | {column.description} |"
        assert row in text


def test_every_column_of_ncap_is_documented() -> None:
    text = (DOCS / "ncap.md").read_text(encoding="utf-8")
    for column in NCAP_COLUMNS:
        row = f"| `{column.name}` | {column.type} | {column.unit or ''} | {column.description} |"
        assert row in text


def test_every_data_set_is_documented() -> None:
    text = (DOCS / "recordings.md").read_text(encoding="utf-8")
    for name in KNOWN:
        assert f"\n| `{name}` |" in text


def test_every_option_is_documented_with_flag_unit_and_meaning() -> None:
    text = (DOCS / "options.md").read_text(encoding="utf-8")
    for option in options():
        if option.location == ("scenario",):
            continue
        description = str(option.field.description).replace("|", "/")
        assert f"| `{option.location[-1]}` | `{option.flag}` | {option.unit or ''} |" in text
        assert description in text


def test_every_key_of_recorded_and_scripted_people_is_documented() -> None:
    whole = (DOCS / "options.md").read_text(encoding="utf-8")
    for heading, config in (("recorded", RecordedConfig), ("scripted", ScriptedConfig)):
        text = whole.partition(f"[[crowd.{heading}]]\n")[2].partition("\n#")[0]
        require_keys(text, config)
    page = (DOCS / "recordings.md").read_text(encoding="utf-8")
    for name, field in RecordedOptions.model_fields.items():
        value = f'"{field.default}"' if isinstance(field.default, str) else field.default
        assert f"\n{name} = {value} " in page


def require_keys(text: str, config: type) -> None:
    for name, field in config.model_fields.items():
        meaning = re.escape(str(field.description))
        (row,) = re.findall(rf"^\| `{name}` \| .* \| {meaning} \|$", text, re.MULTILINE)
        assert row.startswith(f"| `{name}` | {declared(field).get('unit') or ''} |")


def toml_blocks(page: str) -> list[str]:
    text = (DOCS / page).read_text(encoding="utf-8")
    return re.findall(r"```toml\n(.*?)```", text, flags=re.DOTALL)


@pytest.mark.parametrize("block", toml_blocks("vehicles.md"))
def test_every_profile_in_the_guide_is_one(block: str) -> None:
    """A block is a whole profile, or a part of one that the rest is given to."""
    values = tomllib.loads(block)
    inputs, outputs = values.get("inputs", {}), values.get("outputs", {})
    if set(inputs) == {"force", "brake_force"}:  # two examples of odd axes
        inputs["drive_force"] = inputs.pop("force")
    inputs = inputs or {"force": {"variable": "F"}}
    outputs = {"speed": {"variable": "v"}} | outputs
    make_profile(values | {"inputs": inputs, "outputs": outputs}, "vehicles.md")


def test_the_guide_names_every_key_of_a_profile() -> None:
    text = (DOCS / "vehicles.md").read_text(encoding="utf-8")
    for table in VehicleProfile.model_fields.values():
        for kind in (table.annotation, *get_args(table.annotation)):
            fields = getattr(kind, "model_fields", {})
            missing = [name for name in fields if name not in text]
            assert not missing, kind
