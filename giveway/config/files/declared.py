"""The declarations of controllers of other packages, written into the configuration."""

from collections.abc import Mapping
from typing import Any

from giveway.config.plug_in_names import BUNDLED
from giveway.config.run_config import RunConfig
from giveway.config.tables.rules import OF_PRIORITY
from giveway.errors import ControlError
from giveway.plug_ins.finding import find, is_fmu, load

Settings = dict[tuple[str, str], Any]


def with_declared(config: RunConfig) -> RunConfig:
    """Return the configuration with each plug-in's ``defaults`` where the user set nothing.

    Args:
        config: Configuration of the run; its plug-ins may be imported.

    Raises:
        ControlError: A plug-in's ``defaults`` are no :class:`Defaults`.
    """
    if config.egos:
        entries = tuple(_entry(config, entry) for entry in config.egos)
        return config.model_copy(update={"egos": entries})
    tables: dict[str, Any] = {}
    for (table, key), value in _declared(config.controller).items():
        section = tables.get(table, getattr(config, table))
        if getattr(section, key) is None:
            tables[table] = section.model_copy(update={key: value})
    return config.model_copy(update=tables) if tables else config


def _entry(config: RunConfig, entry: dict[str, Any]) -> dict[str, Any]:
    """Return the table of one ego with the declarations of its controller."""
    for (table, key), value in _declared(entry.get("controller", config.controller)).items():
        own = entry.get(table, {})
        if own.get(key) is None and getattr(getattr(config, table), key) is None:
            entry = {**entry, table: {**own, key: value}}
    return entry


def _declared(name: Any) -> Settings:
    """Return the settings in which a plug-in's ``defaults`` differ from :class:`Defaults`."""
    if not isinstance(name, str) or name in {*BUNDLED, "pid"} or is_fmu(name):
        return {}
    try:
        kind = load(find(name))
    except ControlError:
        return {}  # the check before the run reports the error
    from controller import Defaults

    declared = getattr(kind, "defaults", Defaults())
    if not isinstance(declared, Defaults):
        raise ControlError(
            f"controller = '{name}': defaults = {declared!r}: expected controller.Defaults(...)"
        )
    settings: Mapping[tuple[str, str], Any] = {
        ("regulation", "reference_speed"): declared.reference_speed,
        **{("rules", rule): None if declared.heeds_priority else False for rule in OF_PRIORITY},
        ("perception", "tracker"): None if declared.tracker else False,
        ("safety", "enabled"): None if declared.safety_layer else False,
    }
    return {place: value for place, value in settings.items() if value is not None}
