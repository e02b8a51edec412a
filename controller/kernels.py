"""Compiled parts of the controllers that giveway builds into its own kernels, and their types.

The types belong to the search over manoeuvres, which a compiled foresight performs itself.
"""

from controller.foresight import Batches, SearchResult, Trials
from controller.planning.costs import add_cost_of_others, later_cost, own_cost
from controller.planning.motions import branch_off
from controller.planning.parameters import Weights
from controller.safety.layer import largest_safe_force
from controller.safety.stopping import towards_kerb
from controller.safety.vehicle_layer import needed_behind, safe_speed_behind

__all__ = [
    "Batches",
    "SearchResult",
    "Trials",
    "Weights",
    "add_cost_of_others",
    "branch_off",
    "largest_safe_force",
    "later_cost",
    "needed_behind",
    "own_cost",
    "safe_speed_behind",
    "towards_kerb",
]
