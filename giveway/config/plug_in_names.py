"""The names of controllers, pedestrian models and sensors: giveway's, a package's, module:Class."""

from typing import Annotated, Any, Literal, get_args

from pydantic import BeforeValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from giveway.plug_ins.finding import declared_names, is_fmu, is_reference
from giveway.plug_ins.sockets import CONTROLLER, MODEL, SENSOR, Socket

BundledController = Literal["mpc", "pid-tuned", "mpc-paper", "pid-paper"]
BundledModel = Literal[
    "vci",
    "social-force",
    "gap-acceptance",
    "constant-velocity",
    "orca",
    "jupedsim:CollisionFreeSpeedModel",
    "jupedsim:SocialForceModel",
]
BundledCrowdModel = Literal[BundledModel, "recorded"]
BundledBelief = Literal[BundledModel, "drift"]
BundledSensor = Literal["all"]
_JUPEDSIM = "jupedsim:"
BUNDLED: frozenset[str] = frozenset(get_args(BundledController))
BUNDLED_MODELS: frozenset[str] = frozenset(get_args(BundledModel))
BUNDLED_CROWD_MODELS: frozenset[str] = frozenset(get_args(BundledCrowdModel))
BUNDLED_BELIEFS: frozenset[str] = frozenset(get_args(BundledBelief))
BUNDLED_SENSORS: frozenset[str] = frozenset(get_args(BundledSensor))


def _controller(value: Any) -> Any:
    """Return a controller's name; ``pid`` is the former name of the paper's PID."""
    if isinstance(value, str) and is_fmu(value):
        return value
    return _known("pid-paper" if value == "pid" else value, get_args(BundledController), CONTROLLER)


def _belief(value: Any) -> Any:
    return _known(value, get_args(BundledBelief), MODEL)


def _crowd_model(value: Any) -> Any:
    return _known(value, get_args(BundledCrowdModel), MODEL)


def _sensor(value: Any) -> Any:
    return _known(value, get_args(BundledSensor), SENSOR)


def _known(name: Any, bundled: tuple[str, ...], socket: Socket) -> Any:
    """Return a name after a check that it is known."""
    # a variant of JuPedSim's model, not a module
    ours = isinstance(name, str) and name.startswith(_JUPEDSIM)
    if isinstance(name, str) and (name in bundled or (is_reference(name) and not ours)):
        return name
    declared = declared_names(socket)
    if name in declared:
        return name
    known = ", ".join(f"'{one}'" for one in [*bundled, *declared])
    fmu = " or a controller FMU" if socket is CONTROLLER else ""
    msg = f"expected {known}, or module:Class of an installed package{fmu}"
    raise PydanticCustomError("plug_in", "{expected}", {"expected": msg})


_Other = Annotated[str, WithJsonSchema({"type": "string", "pattern": r"^[\w.]+:[\w.]+$"})]
_Fmu = Annotated[str, WithJsonSchema({"type": "string", "pattern": r"\.[Ff][Mm][Uu]$"})]
ControllerName = Annotated[BundledController | _Other | _Fmu, BeforeValidator(_controller)]
BeliefName = Annotated[BundledBelief | _Other, BeforeValidator(_belief)]
CrowdModelName = Annotated[BundledCrowdModel | _Other, BeforeValidator(_crowd_model)]
SensorName = Annotated[BundledSensor | _Other, BeforeValidator(_sensor)]
