"""Controllers of the ego's speed: two model predictive ones, two PIDs, and the safety layer.

Yang & Özgüner 2019, "Combining Social Force Model with Model Predictive Control for Vehicle's
Longitudinal Speed Regulation in Pedestrian-Dense Scenarios" (arXiv 1907.05178).
"""

from controller.actuator import Actuator, ActuatorSide
from controller.declarations import DECLARED
from controller.errors import (
    ControllerError,
    ParameterError,
    PlugInError,
    SolverSetupError,
)
from controller.foresight import Evaluation, Foresight, Manoeuvre
from controller.model import LongitudinalModel
from controller.observation import (
    EgoState,
    Limits,
    Observation,
    PathAhead,
    People,
    RoadAhead,
    SeenPeople,
    Traffic,
)
from controller.paper_mpc.mpc import Mpc
from controller.paper_mpc.solution import MpcSolution
from controller.parameters import PRINTED_PID, MpcParameters, PidParameters
from controller.pid.pid import Pid
from controller.pid.speed_reference import ReferenceParameters, SpeedReference
from controller.pid.tuned_pid import TunedPid, TunedPidParameters
from controller.planning import (
    STYLES,
    ManoeuvreParameters,
    Planner,
    PlannerParameters,
    PlanningController,
    StyleName,
)
from controller.plug_in import Acceleration, Answer, Defaults, Force, PlugIn, Setup, Speed
from controller.protocol import Controller, Decision
from controller.qp.least_squares import Outcome
from controller.safety.late_speed import LateSpeed
from controller.safety.layer import SafeForce, SafetyLayer, SafetyParameters
from controller.safety.vehicle_layer import VehicleAhead, VehicleLayer, VehicleLimits
from controller.safety.worst_motion import PeopleName, WorstMotion, worst_motion
from controller.speed_controller import SpeedController

__all__ = [
    "DECLARED",
    "PRINTED_PID",
    "STYLES",
    "Acceleration",
    "Actuator",
    "ActuatorSide",
    "Answer",
    "Controller",
    "ControllerError",
    "Decision",
    "Defaults",
    "EgoState",
    "Evaluation",
    "Force",
    "Foresight",
    "LateSpeed",
    "Limits",
    "LongitudinalModel",
    "Manoeuvre",
    "ManoeuvreParameters",
    "Mpc",
    "MpcParameters",
    "MpcSolution",
    "Observation",
    "Outcome",
    "ParameterError",
    "PathAhead",
    "People",
    "PeopleName",
    "Pid",
    "PidParameters",
    "Planner",
    "PlannerParameters",
    "PlanningController",
    "PlugIn",
    "PlugInError",
    "ReferenceParameters",
    "RoadAhead",
    "SafeForce",
    "SafetyLayer",
    "SafetyParameters",
    "SeenPeople",
    "Setup",
    "SolverSetupError",
    "Speed",
    "SpeedController",
    "SpeedReference",
    "StyleName",
    "Traffic",
    "TunedPid",
    "TunedPidParameters",
    "VehicleAhead",
    "VehicleLayer",
    "VehicleLimits",
    "WorstMotion",
    "worst_motion",
]
