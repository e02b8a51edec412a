"""The behaviour of simulated and recorded people near moving vehicles, compared."""

from giveway.validation.behaviour.comparison import Comparison, compare

__all__ = ["Comparison", "compare"]
