"""The planning MPC: a search over manoeuvres, and a QP that smooths the one chosen."""

from controller.planning.controller import PlanningController
from controller.planning.parameters import ManoeuvreParameters, PlannerParameters
from controller.planning.planner import Plan, Planner

__all__ = ["ManoeuvreParameters", "Plan", "Planner", "PlannerParameters", "PlanningController"]
