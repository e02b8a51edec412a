"""The planning MPC: a search over manoeuvres, and a QP that smooths the one chosen."""

from controller.planning.parameters import (
    STYLES,
    ManoeuvreParameters,
    PlannerParameters,
    StyleName,
)
from controller.planning.planner import Plan, Planner, PlanningController, Road

__all__ = [
    "STYLES",
    "ManoeuvreParameters",
    "Plan",
    "Planner",
    "PlannerParameters",
    "PlanningController",
    "Road",
    "StyleName",
]
