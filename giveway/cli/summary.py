"""One screen that says how the run went."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rich.table import Table

if TYPE_CHECKING:
    from giveway.api import RunResult

_SHOWN = (
    ("Time to the goal", "completion_time", "s"),
    ("Longest wait", "longest_wait", "s"),
    ("Stops", "stops", ""),
    ("Mean speed", "mean_speed", "m/s"),
    ("RMS jerk", "rms_jerk", "m/s³"),
    ("Smallest gap in front", "minimum_gap", "m"),
    ("Smallest clearance", "minimum_clearance", "m"),
    ("Pedestrians touched", "overlaps", ""),
    ("Smallest time to collision", "minimum_ttc", "s"),
    ("Smallest post-encroachment time", "minimum_pet", "s"),
    ("Steps below the safe distance", "share_below_safe_distance", "%"),
    ("Steps in which the MPC acted", "mpc_feasibility_rate", "%"),
)


def summary_table(result: RunResult) -> Table:
    """The summary's most asked-for numbers, with units; a dash where there is none."""
    config, summary = result.config, result.summary
    people = config.crowd.pedestrians
    title = (
        f"{result.scenario.name}: {config.controller.upper()}, {people} pedestrians, "
        f"seed {config.seed} - {result.ending}"
    )
    table = Table(title=title, show_header=False, title_justify="left")
    table.add_column()
    table.add_column(justify="right")
    table.add_column()
    for label, name, unit in _SHOWN:
        table.add_row(label, *_formatted(summary[name], unit))
    factor = result.timing_summary["real_time_factor"]
    table.add_row("Real-time factor", *_formatted(factor, "x"))
    return table


def _formatted(value: float | None, unit: str) -> tuple[str, str]:
    if value is None or not math.isfinite(value):
        return "-", ""
    if isinstance(value, int):
        return str(value), unit
    return (f"{100 * value:.1f}", unit) if unit == "%" else (f"{value:.2f}", unit)
