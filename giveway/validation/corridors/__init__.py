"""Recorded and simulated people in corridors with walls, compared."""

from giveway.validation.corridors.comparison import BAR, InCorridors, compare_in_corridors

__all__ = ["BAR", "InCorridors", "compare_in_corridors"]
