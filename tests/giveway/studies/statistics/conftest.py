"""Studies made by hand: a design, and the rows of runs that nobody had to simulate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import pytest

from giveway.studies.definition import StudyDefinition
from giveway.studies.design import design
from giveway.studies.statistics import METRICS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from giveway.studies.definition import Comparison
    from giveway.studies.design import Design


class Study:
    """Rows of runs.csv under construction.

    >>> study = Study({"controller": ["mpc", "pid"]})
    >>> study.add("mpc", completion_time=[10.0, 11.0])   # seeds 1, 2
    """

    def __init__(self, factors: dict[str, Any], **more: Any) -> None:
        comparison = {"resamples": 199, "minimum_pairs": 3} | more.pop("comparison", {})
        settings = {"name": "s", "factors": factors, "comparison": comparison}
        definition = StudyDefinition.model_validate(settings | more)
        self.design: Design = design(definition, "s.toml")
        self.comparison: Comparison = definition.comparison
        self.rows: list[dict[str, Any]] = []

    def cell(self, *labels: object) -> int:
        wanted = [str(label) for label in labels]
        return next(
            cell.number
            for cell in self.design.cells
            if [level.label for level in cell.levels.values()] == wanted
        )

    def add(
        self,
        *labels: object,
        seeds: Iterable[int] | None = None,
        ego: str = "ego",
        ending: str = "completed",
        **metrics: Iterable[float],
    ) -> Study:
        """Runs of one cell, one per number of each metric; the others are 0."""
        columns = {name: np.asarray(values, dtype=float) for name, values in metrics.items()}
        count = len(next(iter(columns.values())))
        zeros = {metric.name: np.zeros(count) for metric in METRICS}
        cell = self.cell(*labels)
        levels = self.design.cells[cell - 1].levels
        for i, seed in enumerate(seeds if seeds is not None else range(1, count + 1)):
            numbers = {name: values[i] for name, values in (zeros | columns).items()}
            head = {"run": f"c{cell}-s{seed}", "cell": cell, "seed": seed}
            head |= {name: level.value for name, level in levels.items()}
            self.rows.append(head | {"ego": ego, "ending": ending} | numbers)
        return self

    def lose(self, *labels: object, seeds: Iterable[int], ending: str = "crashed") -> Study:
        """Runs without a result: a row without ego and numbers."""
        for seed in seeds:
            cell = self.cell(*labels)
            self.rows.append({"run": "", "cell": cell, "seed": seed, "ego": "", "ending": ending})
        return self

    @property
    def runs(self) -> pd.DataFrame:
        columns = ["run", "cell", "seed", "ego", "ending", *(metric.name for metric in METRICS)]
        return pd.DataFrame(self.rows, columns=columns if not self.rows else None)


@pytest.fixture(scope="session")
def new_study() -> type[Study]:
    """Study(factors, comparison={...}, cells=[...])."""
    return Study


@pytest.fixture(scope="session")
def two_controllers() -> Any:
    """A study of two controllers whose metrics are the arrays given, a seed per number."""

    def make(
        treated: Mapping[str, Iterable[float]],
        based: Mapping[str, Iterable[float]],
        **comparison: Any,
    ) -> Study:
        study = Study({"controller": ["mpc", "pid"]}, comparison=comparison)
        return study.add("mpc", **treated).add("pid", **based)

    return make
