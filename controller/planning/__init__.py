"""The planning MPC: a search over manoeuvres, and a QP that smooths the one chosen."""

from controller.planning.manoeuvre import Manoeuvre, Prospect
from controller.planning.parameters import ManoeuvreParameters, PlannerParameters
from controller.planning.planner import Plan, Planner
from controller.planning.regulator import PlanningRegulator, Situation
from controller.planning.search import Foresight

__all__ = [
    "Foresight",
    "Manoeuvre",
    "ManoeuvreParameters",
    "Plan",
    "Planner",
    "PlannerParameters",
    "PlanningRegulator",
    "Prospect",
    "Situation",
]
