"""Is everything there that a run needs? Environment and scenario, each finding with its remedy."""

from giveway.doctor.environment import examine_environment
from giveway.doctor.finding import Finding
from giveway.doctor.scenario import examine_scenario

__all__ = ["Finding", "examine_environment", "examine_scenario"]
