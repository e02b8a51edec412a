"""The vehicle-crowd interaction (VCI) model: a social force model of pedestrians near vehicles."""

from pedestrian_model.crowd import Crowd
from pedestrian_model.errors import (
    CrowdError,
    DivergenceError,
    ParameterError,
    PedestrianModelError,
    PlugInError,
    SurroundingsError,
    VehicleError,
)
from pedestrian_model.other_models.jupedsim import JUPEDSIM_MODELS, JuPedSimName, JuPedSimPeople
from pedestrian_model.other_models.simple import PLAIN_MODELS, PlainModel, PlainName, unmoved
from pedestrian_model.other_models.stepwise_prediction import StepwisePredictor
from pedestrian_model.parameters import HELD, SIM, TABLE2, VciParameters
from pedestrian_model.plug_in import (
    Accelerations,
    Goals,
    ModelPlugIn,
    ModelSetup,
    Velocities,
    Walkers,
    WallsAround,
)
from pedestrian_model.presets import PRESETS
from pedestrian_model.protocol import CrowdPredictor, PedestrianModel
from pedestrian_model.routes import OFF_WALKWAYS
from pedestrian_model.stepping import LONGEST_STEP
from pedestrian_model.surroundings import OPEN_GROUND, Surroundings, Walls
from pedestrian_model.targets import any_arrived, arrived, remaining_distance, targets
from pedestrian_model.vci.influence import vehicle_influence
from pedestrian_model.vci.model import CrowdModel, require_steady
from pedestrian_model.vci.prediction import Predictor
from pedestrian_model.vehicles import Vehicles

__all__ = [
    "HELD",
    "JUPEDSIM_MODELS",
    "LONGEST_STEP",
    "OFF_WALKWAYS",
    "OPEN_GROUND",
    "PLAIN_MODELS",
    "PRESETS",
    "SIM",
    "TABLE2",
    "Accelerations",
    "Crowd",
    "CrowdError",
    "CrowdModel",
    "CrowdPredictor",
    "DivergenceError",
    "Goals",
    "JuPedSimName",
    "JuPedSimPeople",
    "ModelPlugIn",
    "ModelSetup",
    "ParameterError",
    "PedestrianModel",
    "PedestrianModelError",
    "PlainModel",
    "PlainName",
    "PlugInError",
    "Predictor",
    "StepwisePredictor",
    "Surroundings",
    "SurroundingsError",
    "VciParameters",
    "VehicleError",
    "Vehicles",
    "Velocities",
    "Walkers",
    "Walls",
    "WallsAround",
    "any_arrived",
    "arrived",
    "remaining_distance",
    "require_steady",
    "targets",
    "unmoved",
    "vehicle_influence",
]
