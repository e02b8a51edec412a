"""The documentation says what the program does."""

from pathlib import Path

import pytest

from giveway.configfile import options
from giveway.metrics import PEDESTRIAN_FIELDS, SUMMARY_FIELDS
from giveway.schema import EGO_COLUMNS, TIMING_COLUMNS, TRAJECTORY_COLUMNS

DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.parametrize(
    "columns",
    [EGO_COLUMNS, TRAJECTORY_COLUMNS, TIMING_COLUMNS, PEDESTRIAN_FIELDS, SUMMARY_FIELDS],
)
def test_every_column_is_documented_as_it_is_declared(columns: tuple) -> None:
    text = (DOCS / "results.md").read_text(encoding="utf-8")
    for column in columns:
        row = f"| `{column.name}` | {column.type} | {column.unit or ''} | {column.description} |"
        assert row in text


def test_every_option_is_documented_with_flag_unit_and_meaning() -> None:
    text = (DOCS / "options.md").read_text(encoding="utf-8")
    for option in options():
        if option.location == ("scenario",):
            continue
        description = str(option.field.description).replace("|", "/")
        assert f"| `{option.location[-1]}` | `{option.flag}` | {option.unit or ''} |" in text
        assert description in text
