"""The scenario folders that giveway drives through, and finding them.

A scenario is a folder with a .sumocfg, the files it names, and ``<stem>.giveway.toml``: where the
ego enters and where the crowd starts. README.md says how to add one.
"""

from sumo_scenarios.catalogue import Scenario, available, find
from sumo_scenarios.errors import BuildError, ScenarioError

__all__ = ["BuildError", "Scenario", "ScenarioError", "available", "find"]
