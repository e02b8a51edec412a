"""Table 2 of Yang & Özgüner 2019 as measured: beside the paper's numbers, and by readings."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pandas as pd
from tables import Column, Tables, difference_text, header, row

from giveway.studies.statistics.yang2019 import METRIC_OF, PEDESTRIANS, PUBLISHED

FEWEST = 30
"""Pairs below which a reading's difference is left out."""


class _Found:
    """The paired differences of a study's comparison."""

    def __init__(self, folder: Path) -> None:
        self.tables = Tables(folder)
        self._by = self.tables.situations.set_index(
            [*self.tables.context, "situation", "metric"]
        ).sort_index()
        self.shares = pd.read_csv(folder / "situations.csv").set_index(self.tables.context)

    def difference(self, context: tuple[Any, ...], situation: str) -> Any:
        """The row of a situation's difference, or None if there are no pairs."""
        key = (*context, situation, METRIC_OF[situation])
        return self._by.loc[key] if key in self._by.index else None


def table_2(folder: Path) -> list[str]:
    """The differences by pedestrians and situation, and below each row the paper's."""
    found = _Found(folder)
    titles = (f"{name}: {METRIC_OF[name].replace('_', ' ')} [s]" for name in METRIC_OF)
    lines = header(["pedestrians", *(title.capitalize() for title in titles)])
    for pedestrians in PEDESTRIANS:
        texts = []
        for situation in METRIC_OF:
            ours = found.difference((pedestrians,), situation)
            shown = difference_text(ours, Column("", "", 2)) or "-"
            texts.append(shown if ours is None else f"{shown}, n = {int(ours.n)}")
        published = (PUBLISHED[pedestrians, situation] for situation in METRIC_OF)
        theirs = ("N.A." if math.isnan(number) else f"{number:.4f}" for number in published)
        lines += [row([str(pedestrians), *texts]), row(["paper", *theirs])]
    return lines


def readings(folder: Path) -> list[str]:
    """One line for each reading, whose cells have the numbers at 30, 20 and 10 pedestrians."""
    found = _Found(folder)
    titles = ["General, 95 % interval", "Stop-and-Wait", "Non-stop", "both stop", "infeasible"]
    lines = header(["reading", *titles])
    runs = found.tables.runs
    planned = runs[runs["controller"] == "mpc-paper"].groupby(found.tables.context)
    infeasible = 1.0 - planned["mpc_feasibility_rate"].mean()
    for reading in runs["reading"].unique():
        cells = [(reading, pedestrians) for pedestrians in PEDESTRIANS]
        general = [_with_interval(found.difference(cell, "general")) for cell in cells]
        means = [
            " / ".join(_mean(found.difference(cell, situation)) for cell in cells)
            for situation in ("stop-and-wait", "non-stop")
        ]
        shares = [
            " / ".join(f"{100.0 * share.loc[cell]:.0f}" for cell in cells) + " %"
            for share in (found.shares["share_both_stop"], infeasible)
        ]
        lines.append(row([reading, ", ".join(general), *means, *shares]))
    return lines


def _mean(found: Any) -> str:
    return "-" if found is None or found.n < FEWEST else f"{found.mean_difference:.2f}"


def _with_interval(found: Any) -> str:
    if found is None:
        return "-"
    return f"{found.mean_difference:.2f} [{found.ci_low:.2f}, {found.ci_high:.2f}]"
