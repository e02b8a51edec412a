"""Keys and flags of the configuration that are gone, and what to write instead."""

from __future__ import annotations

_PRIORITY = "crossings, right_of_way and merging, each true or false"

OLD_KEYS: dict[tuple[str, ...], str] = {
    ("regulation", "traffic_lights"): "[rules] traffic_lights (--rules-traffic-lights)",
    ("regulation", "vehicles"): "[rules] following (--rules-following)",
    ("regulation", "priority"): f"[rules] {_PRIORITY} (--no-rules-crossings, ...)",
    ("ego", "keep_stops"): "[rules] stops (--rules-stops)",
    ("perception", "signal_plans"): "[rules] signal_advice (--rules-signal-advice)",
}
"""Advice by the location of a key that is gone."""

OLD_FLAGS: dict[str, str] = {
    "--obey-lights": "--rules-traffic-lights",
    "--no-obey-lights": "--no-rules-traffic-lights",
    "--respect-vehicles": "--rules-following",
    "--no-respect-vehicles": "--no-rules-following",
    "--priority": "--rules-crossings, --rules-right-of-way and --rules-merging, or --no-rules-...",
    "--ego-keep-stops": "--rules-stops",
    "--no-ego-keep-stops": "--no-rules-stops",
    "--signal-plans": "--rules-signal-advice",
    "--no-signal-plans": "--no-rules-signal-advice",
}
"""Advice by a flag that is gone."""


def advice_on(location: tuple[str, ...]) -> str | None:
    """What to write instead of the key at a location; None if there was no such key.

    Args:
        location: Tables and key, like ("regulation", "priority").
    """
    instead = OLD_KEYS.get(location)
    return None if instead is None else f"this key is gone; write {instead}"
