"""Gap acceptance of people at crossings where vehicles have priority.

A person at the kerb crosses if every vehicle arrives later than the critical headway, as in the
Highway Capacity Manual (2010, equation 19-69): t_c = L / v + t_s. L is the way from the person to
the far side of the strip that the vehicle sweeps, and v the walking speed. The time t_s is 3 s in
the manual, and SUMO's ``pedestrian.timegap-crossing`` + ``jmTimegapMinor`` = 2 s + 1 s here. It
differs from person to person.

Waiting makes bolder. As in SUMO, impatience grows to 1 in 120 s of waiting, and people expect a
vehicle to brake for them that can stop with the share ``impatience`` of a comfortable deceleration.
The floor of the critical headway is thus the time in which a vehicle can stop. The same is expected
at once of a vehicle that turns and has to give way to them, by the junction's right of way.

A vehicle that stands or creeps gives way, unless it waits for people on the crossing: who comes
later lets it go first then, as in SUMO, unless they have waited for long.
A vehicle that passes before the person has come to the kerb does not count. People on the crossing
go on.

Each kerb of such a crossing is a signal of ``Surroundings.closed``, so that all models of people
wait there as at a red light. Each crossing has two signals, one closed and one open, and the
person's way-point gets the one that the decision demands.
"""

from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from giveway.crowd.crossings import ASIDE, place_on
from giveway.crowd.roster import Roster
from giveway.geometry.kernel import Array
from giveway.sumo.network.pedestrian_crossings import Crossing
from giveway.sumo.persons.gap_habits import GapHabit
from pedestrian_model import targets

PATIENCE: Final = 120.0  # waiting time [s] after which impatience is 1 (SUMO's MAX_WAIT_TOLERANCE)
_REACTION: Final = 1.0  # reaction time [s] of drivers (SUMO's default tau)
_BRAKING: Final = 3.4  # comfortable deceleration [m/s^2] of drivers (AASHTO 2011, section 3.2)
_CREEPS: Final = 0.5  # speed [m/s] up to which a vehicle gives way: it stands or creeps
_AT_LINE: Final = 4.0  # distance [m] to a crossing within which the first vehicle stands
_STARTS: Final = 4.0  # speed [m/s] of a vehicle that is about to start, as people expect it
_BOLD: Final = 10.0  # time [s] waited, beyond which people go before a standing vehicle; own choice
_SPREAD: Final = 0.5  # largest relative deviation of a person's t_s from the mean; own choice
_STANDS: Final = 0.3  # speed [m/s] below which a person counts as standing; people in a jam sway
_QUEUE: Final = 10.0  # distance [m] to the kerb up to which people who stand wait for a gap
_AT_KERB: Final = 3.0  # distance [m] to the kerb at which people decide at the latest; own choice
_DECIDES: Final = 1.0  # walking time [s] to the kerb at which people decide; own choice
_SLOWEST: Final = 0.1  # least walking speed [m/s] in a quotient
_BEGUN: Final = 0.2  # distance [m] from the kerb at which people have begun to cross; own choice
_STREAM: Final = 0x6A9  # number of the stream of random numbers


class Approaches(NamedTuple):
    """The c vehicles that approach a crossing or are on it."""

    entry: Array  # distance (c,) [m] of each front to the crossing; negative on it
    exit: Array  # distance (c,) [m] that each has to go until its rear has left the crossing
    speed: Array  # speed (c,) [m/s]
    yields: Array  # 1 (c,) if each has to give way to people on the crossing, else 0
    low: Array  # distance (c,) [m] from the crossing's first kerb to the near side of its strip
    high: Array  # distance (c,) [m] from that kerb to the far side of its strip


class Waiting(NamedTuple):
    """Marks of the people who wait for a gap."""

    held: NDArray[np.bool_]  # marks (n,) of all of them
    stays: NDArray[np.bool_]  # marks (n,) of those of them who are on the sidewalk, and stay there


Traffic = Callable[[Crossing], Approaches]
"""A function that returns the vehicles that approach a crossing."""


def accepts(
    to_kerb: Array,
    to_clear: Array,
    pace: Array,
    margin: Array,
    impatience: Array,
    vehicles: Approaches,
) -> NDArray[np.bool_]:
    """Return whether each of p people accepts the gap before each of c vehicles (p, c).

    Args:
        to_kerb: Distance (p,) [m] to the kerb.
        to_clear: Distance (p, c) [m] to the far side of each vehicle's strip.
        pace: Walking speed (p,) [m/s].
        margin: Time (p,) [s] t_s to start, and to be off the strip before a vehicle arrives.
        impatience: Impatience (p,) from 0 to 1.
        vehicles: Vehicles that approach.
    """
    speed, slow = vehicles.speed, np.maximum(pace, _SLOWEST)[:, None]
    trust = 2.0 * _BRAKING * np.maximum(np.maximum(impatience[:, None], vehicles.yields), 1e-9)
    critical = np.minimum(to_clear / slow + margin[:, None], _REACTION + speed / trust)
    gone = vehicles.exit <= np.maximum(to_kerb[:, None] / slow * speed, 0.0)
    return np.asarray((vehicles.entry > speed * critical) | gone)


def _with_intent(vehicles: Approaches, *, used: bool) -> Approaches:
    """Return the vehicles at the speeds that people at the kerb expect of them.

    A vehicle that stands gives way. If it stands before a crossing that is used, it waits for the
    people on it, and is about to start.
    """
    speed, slow = vehicles.speed, vehicles.speed <= _CREEPS
    starts = slow & used & (vehicles.yields == 0.0) & (np.abs(vehicles.entry) <= _AT_LINE)
    speed = np.where(starts, _STARTS, np.where(slow, 0.0, speed))
    return vehicles._replace(speed=speed, entry=np.where(slow & ~starts, np.inf, vehicles.entry))


class GapAcceptance:
    """Lets people wait for a gap, and opens the crossing to each who has found one.

    Args:
        roster: Crowd.
        crossings: Crossings where vehicles have priority; None for one that nobody waits at.
        first: Signal of the first crossing. The closed signals come first, then the open ones.
        step_length: SUMO's step [s], after which people decide anew.
        seed: Seed of the differences between people.

    Attributes:
        held: Marks (n,) of the people whose next way-point is a kerb at which they wait.
        free: Place that those who wait do not leave.
    """

    def __init__(
        self,
        roster: Roster,
        crossings: Sequence[Crossing | None],
        first: int,
        step_length: float,
        seed: int,
    ) -> None:
        self._roster, self._crossings, self._first = roster, crossings, first
        self._step_length, self._seed = step_length, seed
        self.held = np.zeros(0, dtype=np.bool_)
        self.free: shapely.Geometry = shapely.Polygon()
        # For each person who ever was in the crowd: t_s [s], impatience, time waited [s]
        self._traits = np.zeros((0, 3))
        self._at = np.zeros(0, dtype=np.int64)  # crossing at which each has waited; -1 without one
        self._ignoring: dict[int, tuple[float, float, np.random.Generator]] = {}

    @property
    def ends(self) -> Array:
        """The middles (n, 2) [m] of the kerbs at which people wait."""
        ends = [crossing.ends for crossing in self._crossings if crossing is not None]
        return np.concatenate([np.empty((0, 2)), *ends])

    @property
    def kerbs(self) -> shapely.Geometry:
        """The places around the kerbs at which people wait."""
        return shapely.MultiPoint(self.ends).buffer(_QUEUE)

    @property
    def areas(self) -> shapely.Geometry:
        """The crossings with margins at their sides and ends."""
        return shapely.union_all(
            [
                shapely.LineString(crossing.ends).buffer(
                    crossing.width / 2.0 + ASIDE, cap_style="square"
                )
                for crossing in self._crossings
                if crossing is not None
            ]
        )

    @property
    def waiting(self) -> Waiting:
        """The people who wait for a gap."""
        stays = self.held.copy()
        stays[stays] = shapely.contains_xy(self.free, self._roster.crowd.position[stays])
        return Waiting(self.held, stays)

    def meet(self, name: str, habit: GapHabit) -> None:
        """Learn how a person who joins the crowd accepts gaps."""
        roster, i = self._roster, self._roster.index(name)
        if i >= len(self._at):
            more = 2 * len(roster.ids) - len(self._at)
            self._traits = np.concatenate([self._traits, np.zeros((more, 3))])
            self._at = np.concatenate([self._at, np.full(more, -1)])
        random = np.random.default_rng((self._seed, _STREAM, *name.encode()))
        margin = habit.margin * (1.0 + _SPREAD * random.uniform(-1.0, 1.0))
        self._traits[i] = margin, habit.impatience, habit.waited
        self._at[i] = -1
        if habit.ignore_probability > 0.0:
            self._ignoring[i] = habit.ignore_probability, habit.ignore_speed, random

    def update(self, traffic: Traffic) -> None:
        """Open and close the kerbs before which people are, once after each SUMO step."""
        crowd, count = self._roster.crowd, len(self._crossings)
        at = crowd.waypoint_start[:-1] + crowd.waypoint_index
        self.held = np.zeros(len(crowd), dtype=np.bool_)
        number = crowd.waypoint_signal[at] - self._first
        rows = np.flatnonzero((number >= 0) & (number < 2 * count))
        if not len(rows):
            return
        which = number[rows] % count
        people = self._roster.person_ids[rows]
        way = targets(crowd, rows) - crowd.position[rows]
        to_kerb = np.hypot(way[:, 0], way[:, 1])
        self._wait(rows, people, which, to_kerb)
        self.held[rows] = True
        time = self._step_length + _DECIDES
        decides = to_kerb <= np.maximum(_AT_KERB, time * crowd.desired_speed[rows])
        goes = np.zeros(len(rows), dtype=np.bool_)
        for number in np.unique(which[decides]).tolist():
            crossing = self._crossings[number]
            some = np.flatnonzero(decides & (which == number))
            if crossing is None:
                goes[some] = True
                continue
            goes[some] = self._goes(
                rows[some], people[some], to_kerb[some], crossing, traffic(crossing)
            )
        self.held[rows] = ~goes
        crowd.waypoint_signal[at[rows]] = self._first + which + np.where(goes, count, 0)

    def _wait(
        self,
        rows: NDArray[np.intp],
        people: NDArray[np.int64],
        which: NDArray[np.int64],
        to_kerb: Array,
    ) -> None:
        """Count the time for which people wait, from 0 on at each crossing."""
        waited, before = self._traits[:, 2], self._at[people]
        waited[people[(before >= 0) & (before != which)]] = 0.0
        self._at[people] = which
        speed = np.hypot(*self._roster.crowd.velocity[rows].T)
        waits = (to_kerb <= _AT_KERB) | ((speed < _STANDS) & (to_kerb <= _QUEUE))
        waited[people[waits]] += self._step_length

    def _goes(
        self,
        rows: NDArray[np.intp],
        people: NDArray[np.int64],
        to_kerb: Array,
        crossing: Crossing,
        vehicles: Approaches,
    ) -> NDArray[np.bool_]:
        """Return whether each of the people (k,) at one crossing crosses now.

        Those who are on it already have passed the kerb, even beside the way-point.
        """
        crowd = self._roster.crowd
        kerb, other = crossing.ends
        length = float(np.hypot(*(other - kerb)))
        u, w = place_on(crowd.position, kerb, (other - kerb) / length)
        inside = (np.minimum(u, length - u) >= _BEGUN) & (np.abs(w) <= crossing.width / 2.0 + ASIDE)
        begun = inside[rows]
        crowd.waypoint_index[rows[begun]] += 1
        self.held[rows[begun]] = False
        used = bool((inside & ~self.held).any())
        u = u[rows, None]
        to_clear = np.where(u < length / 2.0, vehicles.high - u, u - vehicles.low)
        margin, impatience, waited = self._traits[people].T
        impatience = np.clip(impatience + waited / PATIENCE, 0.0, 1.0)
        pace = crowd.desired_speed[rows]
        fine = np.zeros(to_clear.shape, dtype=np.bool_)
        bold = waited > _BOLD
        for some, heeded in ((~bold, used), (bold, False)):
            expected = _with_intent(vehicles, used=heeded)
            who = to_kerb[some], to_clear[some], pace[some], margin[some], impatience[some]
            fine[some] = accepts(*who, expected)
        for row, person in enumerate(people.tolist()):
            if person in self._ignoring:
                probability, slow, random = self._ignoring[person]
                lucky = random.random(len(vehicles.speed)) <= probability
                fine[row] |= lucky & (vehicles.speed <= slow)
        return np.asarray(fine.all(axis=1) | begun)
