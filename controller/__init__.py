"""Longitudinal speed regulation: MPC, PID, and the regulator that falls back from one to the other.

Yang & Özgüner 2019, "Combining Social Force Model with Model Predictive Control for Vehicle's
Longitudinal Speed Regulation in Pedestrian-Dense Scenarios" (arXiv 1907.05178).
"""

from controller.errors import (
    ControllerError,
    ParameterError,
    SolverMissingError,
    SolverSetupError,
)
from controller.model import LongitudinalModel
from controller.mpc import Mpc
from controller.parameters import (
    CONSISTENT_PID,
    PAPER_MPC,
    PRINTED_PID,
    MpcParameters,
    PidParameters,
)
from controller.pid import Pid
from controller.planning import (
    ManoeuvreParameters,
    Planner,
    PlannerParameters,
    PlanningRegulator,
    Situation,
)
from controller.quadratic_program import QuadraticProgram, quadratic_program
from controller.regulator import Decision, Observation, Regulator
from controller.safety import SafeForce, SafetyLayer, SafetyParameters
from controller.solution import MpcSolution, Outcome
from controller.speed_reference import ReferenceParameters, SpeedReference
from controller.tuned_pid import TunedPid, TunedPidParameters

__all__ = [
    "CONSISTENT_PID",
    "PAPER_MPC",
    "PRINTED_PID",
    "ControllerError",
    "Decision",
    "LongitudinalModel",
    "ManoeuvreParameters",
    "Mpc",
    "MpcParameters",
    "MpcSolution",
    "Observation",
    "Outcome",
    "ParameterError",
    "Pid",
    "PidParameters",
    "Planner",
    "PlannerParameters",
    "PlanningRegulator",
    "QuadraticProgram",
    "ReferenceParameters",
    "Regulator",
    "SafeForce",
    "SafetyLayer",
    "SafetyParameters",
    "Situation",
    "SolverMissingError",
    "SolverSetupError",
    "SpeedReference",
    "TunedPid",
    "TunedPidParameters",
    "quadratic_program",
]
