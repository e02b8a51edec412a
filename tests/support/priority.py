"""The rules of priority, all at once."""

from __future__ import annotations

OF_PRIORITY = ("crossings", "right_of_way", "merging")
NO_PRIORITY = dict.fromkeys(OF_PRIORITY, False)
"""The table `[rules]` of an ego that gives way to nobody, as on the paper's open space."""


def rules_of(priority: str) -> dict[str, bool]:
    """The table ``[rules]`` for "road" or "none"."""
    return dict.fromkeys(OF_PRIORITY, priority == "road")
