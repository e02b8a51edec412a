"""The protocol of controllers of other packages.

A class of an installed package is a controller if it can be made from a :class:`Setup` (and its
options, if it has any) and has the method ``control``. docs/plugins.md is the guide.
"""

from typing import NamedTuple, Protocol, TypeAlias, runtime_checkable

from controller.observation import Observation


class Setup(NamedTuple):
    """The constant facts of a drive, which a controller gets when it is made."""

    time_step: float  # control step h [s]
    mass: float  # mass M [kg] of the model M s'' + alpha s' = u
    friction: float  # friction alpha [N.s/m] of this model
    reference_speed: float  # reference speed v_r [m/s] on a free road
    safe_distance: float  # distance d_safe [m] to be kept to obstacles
    force_limit: float  # largest force [N] of the actuator, forwards and backwards
    comfortable_deceleration: float  # comfortable deceleration [m/s^2]


class Defaults(NamedTuple):
    """The declaration of a controller: values of settings that the user leaves out.

    A plug-in has them as the attribute ``defaults`` of its class. The last four concern giveway's
    own controllers only.
    """

    reference_speed: float | None = None  # v_r [m/s], or None for the speed limits of the lanes
    heeds_priority: bool = True  # whether the rules of the road hold
    tracker: bool = True  # whether noisy positions are filtered
    safety_layer: bool = True  # whether the safety layer checks its forces
    optimises: bool = False  # whether it has a model and a horizon; plans may be infeasible
    smooths: bool = False  # whether it follows a smooth reference speed and brakes late
    buffered: bool = False  # whether its reference speed rises linearly over d_buffer beyond d_safe
    crowd_preset: str = ""  # parameters of the people whom it meets, or "" for giveway's default


class Force(NamedTuple):
    """The force that is to act in [t_k, t_k+1]."""

    value: float  # force u [N], positive forwards
    reason: str = ""  # a word or two for the tables


class Acceleration(NamedTuple):
    """The acceleration that the vehicle is to have; u = M a + alpha v."""

    value: float  # a [m/s^2]
    reason: str = ""  # a word or two for the tables


class Speed(NamedTuple):
    """The speed that the vehicle is to approach, with the acceleration a = (v_set - v) / T."""

    value: float  # target speed v_set [m/s]
    lead: float = 0.0  # time constant T [s]; at least one control step is used
    reason: str = ""  # a word or two for the tables


Answer: TypeAlias = Force | Acceleration | Speed | float
"""The type that ``control`` returns; a plain number is a force [N]."""


@runtime_checkable
class PlugIn(Protocol):
    """A controller of another package, made by ``Class(setup)`` or ``Class(setup, options)``.

    It may have these optional members:

    * ``Options`` of the class: a dataclass or pydantic model of the options that users may set;
    * ``defaults`` of the class: a :class:`Defaults` with the values of settings left out;
    * ``horizon``: number N of predicted steps that it needs in ``obstacle_positions``; 0 for none;
    * ``foresees``: whether it evaluates manoeuvres by ``Observation.foresight`` instead;
    * ``reset()``: forget the past;
    * ``applied(force)``: called when the safety layer applied another force [N] than the answer.

    It is made before the run, perhaps more than once. Its constructor must not start anything.
    """

    def control(self, observation: Observation, /) -> Answer:
        """Return what is to act in [t_k, t_k+1]. The observation's arrays are read-only."""
