"""docs/statistics.md says what the tables hold."""

import tomllib
from pathlib import Path

import pytest

from giveway.studies.definition import Comparison, Precision
from giveway.studies.statistics import (
    COMPARISON_COLUMNS,
    LEVEL_COLUMNS,
    METRICS,
    SITUATION_COLUMNS,
)

PAGE = (Path(__file__).parents[2] / "docs" / "statistics.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "column", [*COMPARISON_COLUMNS, *LEVEL_COLUMNS, *SITUATION_COLUMNS], ids=lambda c: c.name
)
def test_every_column_is_documented_as_it_is_declared(column) -> None:
    row = f"| `{column.name}` | {column.type} | {column.unit or ''} | {column.description} |"
    assert row in PAGE


@pytest.mark.parametrize("metric", METRICS, ids=lambda metric: metric.name)
def test_every_metric_is_documented_with_its_better_side(metric) -> None:
    assert f"| `{metric.name}` | {metric.unit} | {metric.better} | {metric.label} |" in PAGE


def test_settings_shown_exist_and_the_first_ones_are_defaults() -> None:
    blocks = [tomllib.loads(block.split("```")[0]) for block in PAGE.split("```toml\n")[1:]]
    shown = Comparison.model_validate(blocks[0]["comparison"])
    assert shown == Comparison(baseline="pid-tuned")
    Precision.model_validate(blocks[1]["precision"])
