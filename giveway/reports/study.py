"""What a report reads of a study: the tables and settings of its folder."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from giveway.studies.design import label_of

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import pandas as pd

    from giveway.studies.definition import StudyDefinition
    from giveway.studies.design import Design


class Study(Protocol):
    """A study's folder, read; ``giveway.studies.folder.StudyFolder`` is one.

    Attributes:
        path: its folder.
        definition: the study file as it was used.
        design: factors and cells.
        manifest: software, input files, the cells' digests.
    """

    path: Path
    definition: StudyDefinition
    design: Design
    manifest: dict[str, Any]

    @property
    def runs(self) -> pd.DataFrame:
        """One row per run and ego."""

    @property
    def comparison(self) -> pd.DataFrame:
        """One row per context, ego, treatment, situation and metric."""

    @property
    def levels(self) -> pd.DataFrame:
        """One row per cell, ego and metric."""

    @property
    def computing(self) -> pd.DataFrame:
        """One row per cell: what runs and control steps took."""

    @property
    def situations(self) -> pd.DataFrame:
        """One row per context, ego and treatment."""

    @property
    def failures(self) -> pd.DataFrame:
        """One row per run without a result."""

    @property
    def execution(self) -> pd.DataFrame:
        """One row per run: what may differ between equal studies."""


@dataclass(frozen=True)
class Context:
    """One combination of the levels of the factors that are not compared.

    Attributes:
        levels: label of the level, by factor; empty where nothing but one factor is varied.
        cells: number of the cell, by the label of the compared level.
    """

    levels: dict[str, str]
    cells: dict[str, int]

    @property
    def label(self) -> str:
        """Factor by factor, as in "crowd.pedestrians = 30"."""
        return ", ".join(f"{name} = {level}" for name, level in self.levels.items())

    @property
    def short(self) -> str:
        """The same without the names of options' tables: "pedestrians = 30"."""
        parts = ((short_name(name), level) for name, level in self.levels.items())
        return ", ".join(f"{name} = {level}" for name, level in parts)

    @property
    def key(self) -> tuple[str, ...]:
        """The levels' labels alone."""
        return tuple(self.levels.values())


def contexts(study: Study) -> list[Context]:
    """The contexts of a study in the order of its design."""
    compared = study.definition.comparison.factor
    found: dict[tuple[str, ...], Context] = {}
    for cell in study.design.cells:
        levels = {name: level.label for name, level in cell.levels.items() if name != compared}
        context = found.setdefault(tuple(levels.values()), Context(levels, {}))
        context.cells[cell.levels[compared].label] = cell.number
    return list(found.values())


def compared_labels(study: Study) -> list[str]:
    """The labels of the compared factor's levels, the baseline's among them."""
    return [level.label for level in study.design.factor(study.definition.comparison.factor).levels]


def baseline_label(study: Study) -> str:
    """The label of the level that is subtracted: the one named, or the factor's last."""
    comparison = study.definition.comparison
    factor = study.design.factor(comparison.factor)
    named = None if comparison.baseline is None else factor.level(comparison.baseline)
    return (named or factor.levels[-1]).label


def treatment_labels(study: Study) -> list[str]:
    """The labels of the levels that are compared with the baseline."""
    baseline = baseline_label(study)
    return [label for label in compared_labels(study) if label != baseline]


def short_name(factor: str) -> str:
    """An option's name without its table's: "pedestrians" of "crowd.pedestrians".

    SUMO's seed keeps its table's name: "seed" is that of the crowd.
    """
    table, dot, key = factor.partition(".")
    plain = dot and table.isidentifier() and key.isidentifier() and key != "seed"
    return key if plain else factor


def level_label(value: object) -> str:
    """A factor's value in a frame, however it was read, as its level is labelled."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return ""
    if isinstance(value, str):
        return value.lower() if value in {"True", "False"} else value
    return label_of(value)


def context_key(study: Study, row: Mapping[Any, Any]) -> tuple[str, ...]:
    """The ``Context.key`` of a row of a table."""
    compared = study.definition.comparison.factor
    names = [factor.name for factor in study.design.factors if factor.name != compared]
    return tuple(level_label(row[name]) for name in names)
