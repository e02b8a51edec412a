"""The parameters of the vehicle-crowd interaction (VCI) model.

The decomposition of the total force and the role of the vehicle are those of Yang & Özgüner 2019
(arXiv 1907.05178), which takes its sub-forces from Yang, Özgüner & Redmill, "Social Force Based
Microscopic Modeling of Vehicle-Crowd Interaction" (IEEE Intelligent Vehicles Symposium, IV 2018).
The calibrated numbers are those of the same authors' "A Social Force Based Pedestrian Motion Model
Considering Multi-Pedestrian Interaction with a Vehicle" (ACM Transactions on Spatial Algorithms
and Systems, TSAS 2020), with the same five sub-forces and the same beta. "ours" marks values that
no publication states.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from types import MappingProxyType

from pedestrian_model.errors import ParameterError

_LENGTH = "a part of a body or a gap between bodies is between a millimetre and some metres"
_FORCE = "people are moved by some hundred newtons, and 400 N are a_max for 80 kg already"
_SHARE = "it is a share"


@dataclass(frozen=True)
class _Range:
    """The range of a parameter, with its reason.

    Attributes:
        low, high: Bounds in the parameter's unit; both are allowed.
        reason: Reason of the two bounds.
        zero: Whether 0 is allowed as well, for a force or distance that is left out.
    """

    low: float
    high: float
    reason: str
    zero: bool = False


_RANGES: Mapping[str, _Range] = MappingProxyType(
    {
        "mass": _Range(10.0, 500.0, "it is a person's"),
        "body_radius": _Range(0.05, 1.0, "it is a person's, seen from above"),
        "desired_speed": _Range(0.01, 12.5, "nobody runs faster than that"),
        "repulsion_distance": _Range(0.01, 20.0, _LENGTH),
        "repulsion_smoothing": _Range(0.001, 20.0, _LENGTH),
        "repulsion_anisotropy": _Range(0.0, 1.0, _SHARE),
        "repulsion_strength": _Range(0.01, 10_000.0, _FORCE, zero=True),
        "navigation_distance": _Range(0.01, 20.0, _LENGTH),
        "navigation_smoothing": _Range(0.001, 20.0, _LENGTH),
        # The kernel's polynomial is exact to 1e-12 up to 4.
        "navigation_anisotropy": _Range(0.0, 4.0, "a steeper decay is not resolved"),
        "navigation_strength": _Range(0.01, 10_000.0, _FORCE, zero=True),
        "collision_stiffness": _Range(
            0.1, 100_000.0, "a body is softer than that: 100 kN/m are 1 cm under 1000 N", zero=True
        ),
        "interaction_radius": _Range(0.001, 100.0, "it holds the people whom somebody reacts to"),
        "vehicle_clearance": _Range(0.001, 10.0, _LENGTH, zero=True),
        "vehicle_nose": _Range(0.001, 20.0, _LENGTH, zero=True),
        "vehicle_lookahead": _Range(0.001, 30.0, "people look some seconds ahead", zero=True),
        "vehicle_strength": _Range(0.01, 20_000.0, _FORCE, zero=True),
        "vehicle_decay": _Range(0.01, 100.0, "a force fades over a centimetre to 100 m"),
        "vehicle_anisotropy": _Range(0.0, 1.0, _SHARE),
        "vehicle_exponent_cap": _Range(0.1, 20.0, "exp(20) is 5e8 already"),
        "static_speed": _Range(0.001, 5.0, "a faster vehicle does not stand", zero=True),
        "wall_strength": _Range(0.01, 50_000.0, _FORCE, zero=True),
        "wall_decay": _Range(0.01, 1000.0, "a force fades over a millimetre to 100 m"),
        "destination_gain": _Range(
            0.1, 1e5, "m/k_des is the time in which people take up their pace"
        ),
        "destination_smoothing": _Range(0.001, 100.0, _LENGTH),
        "influence_low": _Range(0.01, 50_000.0, _FORCE, zero=True),
        "influence_high": _Range(0.01, 50_000.0, _FORCE),
        "waypoint_radius": _Range(0.001, 20.0, _LENGTH, zero=True),
        "detour_margin": _Range(0.001, 10.0, _LENGTH, zero=True),
        "max_acceleration": _Range(0.1, 50.0, "a sprinter starts with 10 m/s^2"),
        "max_speed": _Range(0.1, 12.5, "nobody runs faster than that"),
        "sway": _Range(0.001, 10.0, "it is less than a sprinter's acceleration", zero=True),
        "sway_time": _Range(0.01, 60.0, "people do not shiver, and change within a minute"),
    }
)


@dataclass(frozen=True)
class VciParameters:
    """The parameters of the VCI model. The defaults are the simulation preset ``SIM``.

    Raises:
        ParameterError: if a value is not finite or out of its range.
    """

    # The body.
    mass: float = 80.0  # m [kg], TSAS 2020
    body_radius: float = 0.27  # R [m], TSAS 2020
    desired_speed: float = 1.394293  # v0 [m/s], TSAS 2020; default of a new crowd

    # Between pedestrians, TSAS 2020.
    repulsion_distance: float = 0.7801  # d_rep [m]
    repulsion_smoothing: float = 0.45971243  # s_rep [m]
    repulsion_anisotropy: float = 0.1  # l_rep [-]
    repulsion_strength: float = 301.028  # M_rep [N]
    navigation_distance: float = 1.5892008  # d_nav [m]
    navigation_smoothing: float = 0.41745  # s_nav [m]
    navigation_anisotropy: float = 1.0  # l_nav [1/rad]
    navigation_strength: float = 410.875  # M_nav [N]
    collision_stiffness: float = 9825.125  # k_col [N/m]
    interaction_radius: float = 8.0  # largest distance [m] of centres in the set Q(i) (ours)

    # From a vehicle: the contour and the force, TSAS 2020.
    vehicle_clearance: float = 0.2151011  # le [m] around the body
    vehicle_nose: float = 0.510985  # additional length dx0 [m] in front of a moving car
    vehicle_lookahead: float = 1.394358  # alpha_x [s]: the nose grows by alpha_x |u|
    vehicle_strength: float = 777.5852  # A [N]
    vehicle_decay: float = 2.613755  # b [1/m]
    vehicle_anisotropy: float = 0.3119132  # l_v [-]
    vehicle_exponent_cap: float = 4.0  # largest exponent [-] deep inside a contour (ours)
    # speed [m/s] below which a vehicle's contour is a rectangle (Yang & Özgüner 2019)
    static_speed: float = 0.2

    # From a wall: the form of Helbing, Farkas & Vicsek (Nature 2000), the values ours. People
    # decelerate by at most a_max, so the force must begin 0.2 m before contact. A person who walks
    # into a wall at v0 overlaps it by 6 cm for a moment and then stands 8 cm away. At half a metre
    # from the centre the force is 63 N, compared with the 760 N that drive a walker. With a
    # stronger force, people who walk at 2 m/s oscillate in front of the wall in steps of 0.05 s.
    wall_strength: float = 2500.0  # A_w [N] at contact with the wall
    wall_decay: float = 16.0  # b_w [1/m]

    # To the destination, TSAS 2020.
    destination_gain: float = 545.3125  # k_des [N s/m]
    destination_smoothing: float = 1.0  # s_des [m]
    influence_low: float = 199.7455  # vehicle force F_1 [N] up to which beta = 1
    influence_high: float = 672.6487  # vehicle force F_2 [N] from which on beta = 0
    waypoint_radius: float = 0.5  # distance [m] within which a way-point is passed (ours)
    detour_margin: float = 0.3  # distance [m] to a standing car in addition to le and R (ours)

    # Limits, TSAS 2020.
    max_acceleration: float = 5.0  # a_max [m/s^2]
    max_speed: float = 2.5  # v_max [m/s]

    # The sway, a random acceleration that giveway adds to the model's (ours; giveway's docs).
    sway: float = 0.0  # standard deviation [m/s^2] on each axis
    sway_time: float = 0.5  # correlation time [s]

    def __post_init__(self) -> None:
        for field in fields(self):
            _require(field.name, getattr(self, field.name), _RANGES[field.name])
        if self.influence_low >= self.influence_high:
            raise ParameterError(
                f"influence_low = {self.influence_low} N, expected less than "
                f"influence_high = {self.influence_high} N"
            )


def _require(name: str, value: object, expected: _Range) -> None:
    """Make sure that ``value`` is in the range of the parameter ``name``.

    Raises:
        ParameterError: the value is out of its range; the message has the range and its reason.
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ParameterError(f"{name} = {value!r}, expected a number")
    zero = expected.zero or expected.low == 0.0
    if (zero and value == 0.0) or expected.low <= value <= expected.high:
        return
    if not value > 0.0:
        wanted = f"a number {'>=' if zero else '>'} 0 and <= {expected.high:g}"
    else:
        none = "0 or " if expected.zero else ""
        wanted = f"{none}a number >= {expected.low:g} and <= {expected.high:g}"
    raise ParameterError(f"{name} = {value}, expected {wanted}: {expected.reason}")


#: The preset for simulations, in which pedestrians who meet head-on never overlap.
SIM = VciParameters()

#: Acceleration [m/s^2] up to which walls and closed signals hold people who do not accelerate as
#: much of themselves (ours): that of SIM, for which the wall's force was chosen.
HELD = SIM.max_acceleration

#: A second published version of the same table, in which each strength has one digit less. It
#: predicts free walking a little better, but pedestrians who meet head-on pass through each other.
TABLE2 = replace(
    SIM, repulsion_strength=30.028, navigation_strength=41.875, collision_stiffness=982.125
)
