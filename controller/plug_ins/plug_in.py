"""The protocol of controllers of other packages.

A class of an installed package is a controller if it can be made from a :class:`Setup` (and its
options, if it has any) and has the method ``control``. docs/plugins.md is the guide.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol, TypeAlias, runtime_checkable

from controller.observation import Observation


class Setup(NamedTuple):
    """The facts of a drive that do not change; a controller is told once, when it is made."""

    time_step: float  # h [s] between two answers
    mass: float  # M [kg] of the model M s'' + alpha s' = u
    friction: float  # alpha [N.s/m] of it
    reference_speed: float  # v_r [m/s] where nothing is in the way
    safe_distance: float  # d_safe [m] to be kept to obstacles
    force_limit: float  # [N] the actuator gives no more, forwards or backwards
    comfortable_deceleration: float  # [m/s^2]


class Defaults(NamedTuple):
    """The declaration of a controller: values of settings that the user leaves out.

    A plug-in has them as the attribute ``defaults`` of its class. The last three describe what
    giveway asks of its own controllers only.
    """

    reference_speed: float | None = None  # v_r [m/s]; None: as the lanes say
    heeds_priority: bool = True  # the law of the road holds
    tracker: bool = True  # noisy positions are filtered
    safety_layer: bool = True  # the safety layer watches over its forces
    optimises: bool = False  # it has a model and a horizon, and its plans may be infeasible
    smooths: bool = False  # it follows a smooth reference speed, and brakes for a distance late
    buffered: bool = False  # its reference speed rises linearly over a buffer beyond d_safe


class Force(NamedTuple):
    """The force that is to act in [t_k, t_k+1]."""

    value: float  # u [N], forwards positive
    reason: str = ""  # a word or two for the tables


class Acceleration(NamedTuple):
    """The acceleration that the vehicle is to have; u = M a + alpha v."""

    value: float  # a [m/s^2]
    reason: str = ""  # a word or two for the tables


class Speed(NamedTuple):
    """The speed that the vehicle is to approach: a = (v_set - v) / T, then as an acceleration."""

    value: float  # v_set [m/s]
    lead: float = 0.0  # T [s]; 0: one control step
    reason: str = ""  # a word or two for the tables


Answer: TypeAlias = Force | Acceleration | Speed | float
"""What ``control`` returns; a mere number is a force [N]."""


@runtime_checkable
class PlugIn(Protocol):
    """Somebody else's controller, made by ``Class(setup)`` or ``Class(setup, options)``.

    It may have, and has to have none of:

    * ``Options``, of the class: a dataclass or pydantic model of what users may set;
    * ``defaults``, of the class: a :class:`Defaults`, what holds where users say nothing;
    * ``horizon``, N: the steps of prediction that it wants in ``obstacle_positions``; 0: none;
    * ``foresees``: it tries manoeuvres on ``Observation.foresight``, and wants no prediction else;
    * ``reset()``: forget the past;
    * ``applied(force)``: told when the safety layer lets another force [N] act than it wanted.

    It is made before the run and perhaps more than once, and so starts nothing when it is made.
    """

    def control(self, observation: Observation, /) -> Answer:
        """Return what is to act in [t_k, t_k+1]; the observation's arrays cannot be written."""
