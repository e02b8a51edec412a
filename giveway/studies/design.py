"""The design of a study: factors and levels become cells, the settings of each combination."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from giveway.config.files.layers import PLUGGED, Layer, merge, options, results_of
from giveway.config.option import problem_of_name
from giveway.config.renamed import RENAMED, advice
from giveway.errors import ConfigError, suggestion
from giveway.metrics.ego_fields import EGO_FIELDS
from giveway.plug_ins.sockets import TABLES
from giveway.studies.definition import StudyDefinition
from giveway.studies.table_columns import (
    COMPARISON_COLUMNS,
    FRONT_COLUMNS,
    LEVEL_COLUMNS,
    PRECISION_COLUMNS,
    SITUATION_COLUMNS,
    TABLE_2_COLUMNS,
)

_RESERVED = frozenset(
    {"run", "cell", "seed", "ego", "ending", "runs", "failed", "seconds", "twin"}
) | {
    column.name
    for columns in (
        EGO_FIELDS,
        COMPARISON_COLUMNS,
        LEVEL_COLUMNS,
        FRONT_COLUMNS,
        SITUATION_COLUMNS,
        PRECISION_COLUMNS,
        TABLE_2_COLUMNS,
    )
    for column in columns
}  # columns of the tables

_NAMED = frozenset(socket.options for socket in TABLES)
"""Tables whose keys are the names of plug-ins."""
_NOTHING = "none"  # Label of an empty text or list


@dataclass(frozen=True)
class Level:
    """One value of a factor.

    Attributes:
        label: Name in tables and pictures.
        value: Value of the option, or the label if the level has a name.
        settings: Options that the level sets.
    """

    label: str
    value: str | bool | int | float
    settings: dict[str, Any]


@dataclass(frozen=True)
class Factor:
    """A factor that the study varies.

    Attributes:
        name: Name of an option, as ``crowd.pedestrians``, or a name of the user's.
        levels: Levels of the factor.
        unit: Unit of an option, or None without a unit.
    """

    name: str
    levels: tuple[Level, ...]
    unit: str | None = None

    def level(self, label: object) -> Level | None:
        """Return the level with the label or value ``label``, or None."""
        wanted = label_of(label)
        return next((level for level in self.levels if level.label == wanted), None)


@dataclass(frozen=True)
class Cell:
    """One combination of levels.

    Attributes:
        number: Number from 1 on, in the order of the design.
        levels: Level of each factor.
    """

    number: int
    levels: dict[str, Level]

    @property
    def label(self) -> str:
        """The levels, factor by factor, as in "crowd.pedestrians = 30, controller = mpc"."""
        return ", ".join(f"{name} = {level.label}" for name, level in self.levels.items())

    def layer(self, origin: str, definition: StudyDefinition) -> Layer:
        """Return the cell's settings, on top of those that all cells share."""
        layers = [Layer(origin, definition.placed(definition.run))]
        layers += [Layer(origin, level.settings) for level in self.levels.values()]
        name = f"{origin}: cell {self.number} ({self.label})"
        return Layer(name, merge(layers), results=results_of(Path(origin)))


@dataclass(frozen=True)
class Design:
    """The factors of a study and the cells that are run."""

    factors: tuple[Factor, ...]
    cells: tuple[Cell, ...]

    def factor(self, name: str) -> Factor:
        """Return the factor of that name.

        Raises:
            ConfigError: there is no such factor.
        """
        for factor in self.factors:
            if factor.name == name:
                return factor
        names = ", ".join(factor.name for factor in self.factors)
        raise ConfigError(f"factor '{name}': not in this study; expected one of {names}")


def design(definition: StudyDefinition, origin: str) -> Design:
    """Return the cells of a study: every combination, or those that it lists.

    Args:
        definition: Definition of the study.
        origin: File of the study, for messages.

    Raises:
        ConfigError: a factor or a cell cannot be used.
    """
    _require_no_seed(definition.run, f"{origin}: [run]")
    factors = tuple(_factors(definition, origin))
    if definition.cells:
        chosen = [
            _listed(entry, factors, f"{origin}: cells[{number}]")
            for number, entry in enumerate(definition.cells)
        ]
    factors = _only(factors, definition.only, origin)
    if definition.cells:
        chosen = [
            levels
            for levels in chosen
            if all(levels[factor.name] in factor.levels for factor in factors)
        ]
    else:
        grid = itertools.product(*(factor.levels for factor in factors))
        names = [factor.name for factor in factors]
        chosen = [dict(zip(names, levels, strict=True)) for levels in grid]
    cells = tuple(Cell(number, levels) for number, levels in enumerate(chosen, start=1))
    for a, b in itertools.combinations(cells, 2):
        if a.label == b.label:
            raise ConfigError(
                f"{origin}: cells {a.number} and {b.number} are the same ({a.label}); drop one"
            )
    return Design(factors, cells)


def label_of(value: object) -> str:
    """Return a value as written in a label.

    An empty value is "none", since tables drop empty texts.
    """
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list | tuple):
        return ",".join(label_of(item) for item in value) or _NOTHING
    return f"{value:.12g}" if isinstance(value, float) else str(value) or _NOTHING


def _require_no_seed(settings: dict[str, Any], place: str) -> None:
    """Make sure that no cell sets a seed of its own: runs are paired by their seeds."""
    if "seed" in settings:
        raise ConfigError(
            f"{place} seed = {settings['seed']!r}: every cell is run with the same seeds; leave it "
            "out, and set replications and first_seed"
        )


def _factors(definition: StudyDefinition, origin: str) -> list[Factor]:
    found: list[Factor] = []
    for name, levels in definition.factors.items():
        place = f"{origin}: [factors] {name}"
        if isinstance(levels, list):
            found.append(_option_factor(name, levels, place, definition))
        elif isinstance(levels, dict) and _all_are(list, levels):
            # crowd.pedestrians = [...] without quotes is a table within a table
            found += [
                _option_factor(f"{name}.{key}", values, f"{place}.{key}", definition)
                for key, values in levels.items()
            ]
        elif isinstance(levels, dict) and _all_are(dict, levels):
            found.append(_named_factor(name, levels, place, definition))
        else:
            raise ConfigError(
                f"{place} = {levels!r}: expected a list of values, or a table of named levels like "
                '{ "few" = { crowd = { pedestrians = 10 } }, ... }'
            )
    names = [factor.name for factor in found]
    for name in names:
        if name in _RESERVED:
            raise ConfigError(
                f"{origin}: [factors] {name}: this name is taken by a column; choose another"
            )
        if names.count(name) > 1:
            raise ConfigError(f"{origin}: [factors] {name}: given twice; merge the two")
    return found


def _all_are(kind: type, levels: dict[str, Any]) -> bool:
    return bool(levels) and all(isinstance(value, kind) for value in levels.values())


def _named_factor(
    name: str, levels: dict[str, Any], place: str, definition: StudyDefinition
) -> Factor:
    named = []
    for called in (name, *levels):
        if problem := problem_of_name(called):
            raise ConfigError(f"{place}: {called!r}: {problem}")
    for label, settings in levels.items():
        _require_no_seed(settings, f"{place}.{label}:")
        if not label.strip():
            raise ConfigError(f"{place}: level {label!r}: expected a name that tables can show")
        named.append(Level(label, label, definition.placed(settings)))
    return _factor(name, named, place)


def _plugged_location(table: str, key: str) -> tuple[str, ...]:
    """Return the location of a plug-in's option; for a rule or metric it is below the name."""
    name, _, own = key.rpartition(".")
    is_option = table in _NAMED and name and ":" not in own
    return (table, name, own) if is_option else (table, key)


def _option_factor(name: str, values: list[Any], place: str, definition: StudyDefinition) -> Factor:
    known = {".".join(option.location): option for option in options()}
    if name == "seed":
        raise ConfigError(f"{place}: seeds are not a factor; set replications and first_seed")
    table, dot, key = name.partition(".")
    plugged_in = bool(dot) and (table in PLUGGED or (table in _NAMED and name not in known))
    gone = RENAMED.get(tuple(name.split(".")))
    if gone is not None:
        raise ConfigError(f"{place}: no longer exists; {advice(gone, as_flag=False)}")
    if name not in known and not plugged_in:
        hint = suggestion(name, known, "giveway config lists the options")
        raise ConfigError(
            f"{place}: no such option; {hint} (a factor of your own has named levels)"
        )
    location = _plugged_location(table, key) if plugged_in else known[name].location
    unit = None if plugged_in else known[name].unit
    levels = []
    for value in values:
        settings: dict[str, Any] = {}
        node = settings
        for table in location[:-1]:
            node = node.setdefault(table, {})
        node[location[-1]] = value
        shown = value if isinstance(value, bool | int | float) else label_of(value)
        levels.append(Level(label_of(value), shown, definition.placed(settings)))
    return _factor(name, levels, place, unit)


def _factor(name: str, levels: list[Level], place: str, unit: str | None = None) -> Factor:
    if not levels:
        raise ConfigError(f"{place}: no levels; expected at least one")
    labels = [level.label for level in levels]
    for label in labels:
        if labels.count(label) > 1:
            raise ConfigError(f"{place}: level '{label}' twice; drop one")
    return Factor(name, tuple(levels), unit)


def _only(
    factors: tuple[Factor, ...], wanted: Mapping[str, Sequence[Any]], origin: str
) -> tuple[Factor, ...]:
    """Return the factors with only the wanted levels, in the study's order.

    Raises:
        ConfigError: there is no such factor or level.
    """
    for name, labels in wanted.items():
        place = f"{origin}: only {name}"
        factor = next((factor for factor in factors if factor.name == name), None)
        if factor is None:
            known = ", ".join(factor.name for factor in factors)
            raise ConfigError(f"{place}: not a factor of this study; expected one of {known}")
        for label in labels:
            if factor.level(label) is None:
                known = "; ".join(level.label for level in factor.levels)
                raise ConfigError(f"{place} = {label_of(label)}: expected one of {known}")
        kept = {label_of(label) for label in labels}
        levels = tuple(level for level in factor.levels if level.label in kept)
        factors = tuple(
            replace(factor, levels=levels) if factor.name == name else factor for factor in factors
        )
    return factors


def _listed(entry: dict[str, Any], factors: tuple[Factor, ...], place: str) -> dict[str, Level]:
    """Return the levels that one entry of ``cells`` names."""
    flat = {
        f"{key}.{inner}" if isinstance(value, dict) else key: item
        for key, value in entry.items()
        for inner, item in (value.items() if isinstance(value, dict) else [("", value)])
    }
    names = [factor.name for factor in factors]
    unknown = [key for key in flat if key not in names]
    missing = [name for name in names if name not in flat]
    if unknown or missing:
        what = f"unknown factor '{unknown[0]}'" if unknown else f"no level of '{missing[0]}'"
        raise ConfigError(f"{place}: {what}; expected one level of each of {', '.join(names)}")
    levels = {}
    for factor in factors:
        level = factor.level(flat[factor.name])
        if level is None:
            known = ", ".join(level.label for level in factor.levels)
            raise ConfigError(
                f"{place}: {factor.name} = {flat[factor.name]!r}: expected one of {known}"
            )
        levels[factor.name] = level
    return levels
