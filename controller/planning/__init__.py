"""The planning MPC: a search over manoeuvres, and a QP that smooths the one chosen."""

from controller.planning.costs import add_cost_of_others, later_cost, own_cost
from controller.planning.motions import branch_off
from controller.planning.parameters import (
    STYLES,
    ManoeuvreParameters,
    PlannerParameters,
    StyleName,
)
from controller.planning.planner import Plan, Planner, PlanningController

__all__ = [
    "STYLES",
    "ManoeuvreParameters",
    "Plan",
    "Planner",
    "PlannerParameters",
    "PlanningController",
    "StyleName",
    "add_cost_of_others",
    "branch_off",
    "later_cost",
    "own_cost",
]
