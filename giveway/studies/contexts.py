"""Contexts: groups of a study's cells that differ only in the level of the compared factor."""

from dataclasses import dataclass

from giveway.errors import ConfigError
from giveway.studies.definition import Comparison
from giveway.studies.design import Design, Level


@dataclass(frozen=True)
class Context:
    """One combination of the levels of the factors that are not compared.

    Attributes:
        levels: Level of each other factor; empty if only one factor is varied.
        cells: Number of the cell, by the label of the compared level.
    """

    levels: dict[str, Level]
    cells: dict[str, int]

    @property
    def label(self) -> str:
        """The levels, factor by factor, as in "crowd.pedestrians = 30"."""
        return ", ".join(f"{name} = {level.label}" for name, level in self.levels.items())

    @property
    def short(self) -> str:
        """The same without the names of options' tables: "pedestrians = 30"."""
        parts = ((short_name(name), level.label) for name, level in self.levels.items())
        return ", ".join(f"{name} = {label}" for name, label in parts)

    @property
    def key(self) -> tuple[str, ...]:
        """The labels of the levels, which identify the context."""
        return tuple(level.label for level in self.levels.values())


def contexts(design: Design, comparison: Comparison) -> list[Context]:
    """Return the contexts of a study, in the order of its design.

    Raises:
        ConfigError: the study has no such factor.
    """
    compared = design.factor(comparison.factor).name
    found: dict[tuple[str, ...], Context] = {}
    for cell in design.cells:
        levels = {name: level for name, level in cell.levels.items() if name != compared}
        context = Context(levels, {})
        context = found.setdefault(context.key, context)
        context.cells[cell.levels[compared].label] = cell.number
    return list(found.values())


def other_factors(design: Design, comparison: Comparison) -> list[str]:
    """Return the names of the factors that make the context."""
    return [factor.name for factor in design.factors if factor.name != comparison.factor]


def baseline_level(design: Design, comparison: Comparison) -> Level:
    """Return the baseline level: the one that is named, or the factor's last.

    Raises:
        ConfigError: the study has no such factor, or the factor no such level.
    """
    factor = design.factor(comparison.factor)
    if comparison.baseline is None:
        return factor.levels[-1]
    level = factor.level(comparison.baseline)
    if level is None:
        known = ", ".join(level.label for level in factor.levels)
        raise ConfigError(
            f"comparison.baseline = '{comparison.baseline}': no level of {factor.name}; "
            f"expected one of {known}"
        )
    return level


def short_name(factor: str) -> str:
    """Return an option's name without its table's: "pedestrians" for "crowd.pedestrians".

    SUMO's seed keeps its table's name, since "seed" is the crowd's.
    """
    table, dot, key = factor.partition(".")
    plain = dot and table.isidentifier() and key.isidentifier() and key != "seed"
    return key if plain else factor
