"""The benchmark's table in a terminal: whole numbers at any width, rivals below the controller."""

from __future__ import annotations

import io

import pytest
from rich.console import Console

from giveway.cli.screen.benchmark_table import print_benchmark
from giveway.studies.benchmark import RECORDED, rivals


def printed(table, kept, width):
    text = io.StringIO()
    print_benchmark(Console(file=text, width=width), table, kept)
    return text.getvalue()


@pytest.mark.parametrize("width", [60, 80, 200])
def test_each_number_is_whole_at_any_width(width):
    kept = rivals()
    mine = kept[(kept["controller"] == "idm") & (kept["scene"] == "stream, 30")]
    row = mine[mine["people"] == "MIXED"].iloc[0]
    text = printed(mine, kept, width)
    assert f"{row.time:.1f} [{row.time_low:.1f}, {row.time_high:.1f}]" in text
    share = [100.0 * row[f"close_pass_share{end}"] for end in ("", "_low", "_high")]
    assert "{:.1f} [{:.1f}, {:.1f}]".format(*share) in text


def test_each_block_has_the_controller_above_the_rivals():
    kept = rivals()
    mine = kept[kept["scene"] == "stream, 30"].head(1).assign(controller="mine")
    lines = printed(mine, kept, 250).splitlines()
    begin = next(i for i, line in enumerate(lines) if "stream, 30" in line)
    others = [f"{name} (kept)" for name in kept["controller"].unique() if name != RECORDED]
    end = begin + 2 + len(others)
    names = [line.strip().split("  ")[0] for line in lines[begin + 1 : end]]
    assert names == ["mine", *others]
    assert any(line.strip().startswith(RECORDED) for line in lines[end:])
