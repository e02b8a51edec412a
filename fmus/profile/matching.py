"""The roles that an FMU's variables may have, judged by name, unit and causality.

A wrong guess could drive a car by its steering angle. Therefore the draft asks a question where two
variables fit equally well or a unit contradicts a name.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from fmus.description import units
from fmus.description.model import Channel, Dimension, Model, Variable


@dataclass(frozen=True)
class Role:
    """The usual names of the variables of a role.

    Attributes:
        dimension: Dimension of its quantity.
        names: Whole names (without separators and fillers), the strongest evidence.
        words: Parts of a name that point at the role.
        never: Parts of a name that exclude the role, besides those of :data:`OTHER_PARTS`.
    """

    dimension: Dimension
    names: frozenset[str]
    words: frozenset[str]
    never: frozenset[str] = frozenset()


def _set(words: str) -> frozenset[str]:
    return frozenset(words.split())


FILLERS: Final = _set(
    "vehicle veh car ego body plant model chassis out output in input actual act current measured "
    "meas cmd command control ctrl longitudinal long lon lng total net value val signal sig x si "
    "mps ms kmh kph mph n kn m km percent pct the of i o real"
)
OTHER_PARTS: Final = _set(
    "wind lateral lat y z vertical normal yaw roll pitch steer steering gear clutch slope grade "
    "inclination angle disturbance disturb noise drag aero rolling resistance gravity error err "
    "rel relative lead leader front rear wheel wheels engine motor angular rot rotational omega "
    "rpm temperature gap headway max min limit lim lower upper bound ambient nominal mean average "
    "spring damper support fixed vy vz ay az fy fz rev reverse reversed backward backwards"
)
WANTED: Final = _set(
    "ref reference set setpoint sp target desired des demand dem request req cruise"
)
AT_START: Final = _set("0 start init initial begin")
SHORT: Final = {"pdl": "pedal", "ped": "pedal", "accl": "accel", "trq": "torque"}
DRIVE: Final = _set(
    "drive driving traction tractive propulsion propulsive thrust engine motor accelerating"
)
BRAKE: Final = _set("brake braking brakes brk decel")

ROLES: Final = {
    "force": Role(
        units.FORCE,
        _set(
            "force f fx u thrust tractiveforce traction tractionforce drivingforce fwheel "
            "wheelforce"
        ),
        _set("force thrust tractive traction propulsion"),
        BRAKE | AT_START,
    ),
    "drive_force": Role(
        units.FORCE,
        _set(
            "driveforce drivingforce fdrive tractiveforce tractionforce traction thrust "
            "propulsionforce forcedrive fd ftrac ftraction engineforce motorforce fengine fmotor"
        ),
        DRIVE,
        BRAKE | AT_START,
    ),
    "brake_force": Role(
        units.FORCE,
        _set("brakeforce brakingforce fbrake forcebrake fb fbrk"),
        BRAKE,
        AT_START,
    ),
    "acceleration": Role(
        units.ACCELERATION,
        _set("acceleration accel acc a ax u aref ades acmd aset areq axref"),
        _set("acceleration accel acc"),
        _set("pedal position") | AT_START,
    ),
    "throttle": Role(
        units.NONE,
        _set(
            "throttle accelerator acceleratorpedal accelpedal pedal gas gaspedal apps "
            "throttleposition pedalposition accel throttlepedal"
        ),
        _set("throttle accelerator apps gas"),
        BRAKE | AT_START,
    ),
    "brake": Role(
        units.NONE,
        _set("brake brakes brakepedal brkpedal brk brakeposition braking bpps"),
        BRAKE | _set("bpps"),
        _set("park parking") | AT_START,
    ),
    "speed_setpoint": Role(
        units.SPEED,
        _set(
            "vref vset vdes vtarget vcmd vdem vsp speedref speedset speedsetpoint setspeed "
            "targetspeed desiredspeed referencespeed cruisespeed speedtarget velocityref "
            "velocitysetpoint targetvelocity desiredvelocity referencevelocity setvelocity "
            "speeddemand v speed velocity"
        ),
        _set("speed velocity v setpoint"),
        AT_START,
    ),
    "speed": Role(
        units.SPEED,
        _set("speed velocity v vx vel spd speedometer xdot sdot dx ds"),
        _set("speed velocity vel spd v vx"),
        WANTED | AT_START,
    ),
    "position": Role(
        units.LENGTH,
        _set("position pos s x distance dist odometer odo station displacement travelled traveled"),
        _set("position pos distance odometer odo travelled traveled displacement s x"),
        WANTED | AT_START | _set("throttle pedal length l base wheelbase"),
    ),
    "measured_acceleration": Role(
        units.ACCELERATION,
        _set("acceleration accel acc a ax vdot dv"),
        _set("acceleration accel acc a ax"),
        WANTED | AT_START,
    ),
    "initial_speed": Role(
        units.SPEED,
        _set(
            "v0 vstart vinit vinitial speed0 speedstart speedinit startspeed initspeed "
            "initialspeed initialvelocity startvelocity velocity0 velocitystart velocityinit vx0 "
            "initvelocity speedinitial velocityinitial initv startv vbegin"
        ),
        frozenset(),
    ),
    "initial_position": Role(
        units.LENGTH,
        _set(
            "s0 x0 sstart xstart sinit xinit position0 pos0 startposition initialposition "
            "initposition positionstart positioninit positioninitial initialdistance sinitial "
            "xinitial startdistance initpos startpos posinit posstart"
        ),
        frozenset(),
    ),
}
GENERIC: Final = (["u"], ["x"], ["s"], ["a"], ["v"], ["f"])  # meaningless without their unit
INTEGRALS: Final = {"speed": "position", "measured_acceleration": "speed"}
FORCES: Final = frozenset({"force", "drive_force", "brake_force"})


@dataclass(frozen=True)
class Guess:
    """A variable that may have a role.

    Attributes:
        name_score: 10 for a name of the role, 9 with fillers, 6 for a part of it, 0 for the unit
            only.
        fits: True if its unit has the role's dimension, or None without a known unit.
    """

    channel: Channel
    name_score: float
    fits: bool | None
    found: Dimension | None  # dimension of its unit

    @property
    def score(self) -> float:
        """Rank of the guess; higher is better."""
        return self.name_score + (5.0 if self.fits else 0.0)


def guesses(model: Model, role: str, variables: Iterable[Variable]) -> list[Guess]:
    """Return the variables that may have a role, the best first.

    Variables whose unit contradicts their name are listed only if no other variable fits.
    """
    found = [
        guess
        for variable in variables
        if variable.is_real or variable.is_integer
        if (guess := _guess(model, role, variable)) is not None
    ]
    fitting = [guess for guess in found if guess.fits is not False]
    torques = FORCES & {role}  # a radius makes forces of them
    contradictory = [
        guess
        for guess in found
        if guess.name_score >= 9 or (torques and guess.name_score and guess.found == units.TORQUE)
    ]
    return sorted(fitting or contradictory, key=lambda guess: -guess.score)


def unambiguous(ranked: list[Guess]) -> bool:
    """Return whether the first guess is better than every other."""
    return len(ranked) == 1 or (len(ranked) > 1 and ranked[0].score > ranked[1].score)


def words_of(name: str) -> list[str]:
    """Return the words of a name's last part: ``vehicle.tractiveForce_x`` -> tractive, force, x."""
    return _words(_parts(name)[-1])


def all_words(name: str) -> list[str]:
    """Return the words of a name with all its parts."""
    return [word for part in _parts(name) for word in _words(part)]


def _parts(name: str) -> list[str]:
    return re.split(r"\.(?![^(]*\))", name)


def _words(text: str) -> list[str]:
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])|(?<=[a-zA-Z])(?=\d)", " ", text)
    return [SHORT.get(word, word) for word in re.findall(r"[^\W_]+", spaced.lower())]


def _guess(model: Model, role: str, variable: Variable) -> Guess | None:
    wanted = ROLES[role]
    unit = model.unit_of(variable)
    found = units.to_si(unit).dimension if unit is not None else None
    fits = None if found is None else found == wanted.dimension
    name_score = _name_score(role, variable.name)
    if name_score is None:
        return None
    if name_score == 0 and not (fits and wanted.dimension != units.NONE and wanted.words):
        return None
    if fits is False and words_of(variable.name) in GENERIC:
        return None
    return Guess(Channel(variable), name_score, fits, found)


def _name_score(of_role: str, name: str) -> float | None:
    """Return how well a name fits a role, or None if it excludes the role."""
    derivative = re.fullmatch(r"der\((.+)\)", name)
    if derivative is not None:  # Modelica's name of a derivative: der(vehicle.s)
        inner = _name_score(INTEGRALS[of_role], derivative[1]) if of_role in INTEGRALS else None
        return inner - 1.0 if inner else None  # a variable of its own is better
    role = ROLES[of_role]
    *parents, last = _parts(name)
    if any(OTHER_PARTS & set(_words(parent)) for parent in parents):
        return None  # a quantity of a part of the vehicle
    words = _words(last)
    plain = [word for word in words if word not in FILLERS]
    shallow = 0.0 if parents else 0.5
    for spelled, score in ((words, 10.0), (plain, 9.0)):
        if "".join(spelled) in role.names:
            return score + shallow
    numbered = [word for word in words if not word.isdecimal()]
    if numbered != ["y"] and set(words) & (OTHER_PARTS | role.never):  # y, y1: any output's name
        return None
    return 6.0 + shallow if set(words) & role.words else 0.0
