"""A SUMO scenario as files: its contents, and how to run it without changing it.

``read_scenario`` returns the contents of a .sumocfg. ``prepare_start`` turns them into a command
for SUMO that writes nothing beside the scenario.
"""

from giveway.scenario_files.configuration import STRIPING, SUMO_SEED, ScenarioFiles, read_scenario
from giveway.scenario_files.declared_ids import declares, free_prefix, undeclared
from giveway.scenario_files.flows import FlowStart, flows_due
from giveway.scenario_files.included import with_included
from giveway.scenario_files.starting import Start, StartOptions, prepare_start

__all__ = [
    "STRIPING",
    "SUMO_SEED",
    "FlowStart",
    "ScenarioFiles",
    "Start",
    "StartOptions",
    "declares",
    "flows_due",
    "free_prefix",
    "prepare_start",
    "read_scenario",
    "undeclared",
    "with_included",
]
