"""The planning MPC: a search over manoeuvres, and a QP that smooths the one chosen."""

from controller.planning.parameters import ManoeuvreParameters, PlannerParameters
from controller.planning.planner import Plan, Planner, PlanningController

__all__ = ["ManoeuvreParameters", "Plan", "Planner", "PlannerParameters", "PlanningController"]
