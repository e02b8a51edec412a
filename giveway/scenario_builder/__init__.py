"""New scenarios: a drawn street or a map becomes a folder that ``giveway run`` drives through."""

from giveway.scenario_builder.city import Demand
from giveway.scenario_builder.description import EXAMPLE
from giveway.scenario_builder.writing import write_scenario

__all__ = ["EXAMPLE", "Demand", "write_scenario"]
