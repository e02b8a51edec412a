"""Somebody's SUMO scenario as files: what it names, and how to run it without touching it.

``read_scenario`` says what a .sumocfg names; ``prepare_start`` makes of it a command for SUMO
that writes nothing beside the scenario.
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
