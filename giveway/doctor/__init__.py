"""Checks of the environment and of scenarios before a run; each finding names its remedy."""

from giveway.doctor.environment import examine_environment
from giveway.doctor.finding import Finding
from giveway.doctor.scenario import examine_scenario

__all__ = ["Finding", "examine_environment", "examine_scenario"]
