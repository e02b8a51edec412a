"""Generates flows of people: arrival times, entries and routes.

A group, which may be a single person, is drawn from its own random stream, by the run's seed, the
flow and the group's number. Arrivals and destinations therefore do not depend on egos,
controllers, pedestrian models or other flows.
"""

import math
from collections import deque
from collections.abc import Sequence
from typing import NamedTuple, Self

import numpy as np

from giveway.config import RunConfig
from giveway.crowd.generation.groups import facing, of_parties, parties_per_person, party_size
from giveway.crowd.generation.kinds import desired_speeds, draw_kinds
from giveway.crowd.generation.spawn import has_room
from giveway.crowd.roster import ARRIVAL_RADIUS, Roster, Trait
from giveway.crowd.ways import Gate, LitCrossing, gates_of, longest_way, somewhere, with_lights
from giveway.geometry.kernel import Array
from pedestrian_model import Crowd

_STREAM = 0xF70  # key of the random streams of flows, which differs from all others
_TRIES = 20  # largest number of places that are tried for a group at an instant
_HOUR = 3600.0  # [s]


class Party(NamedTuple):
    """A group of people who arrive together, or a single person."""

    due: float  # arrival time [s] after the run's start
    names: tuple[str, ...]  # ids of the people
    kinds: tuple[str, ...]  # kinds of the people
    speed: float  # desired speed [m/s] of the group
    random: np.random.Generator  # generator of its places


class Walk(NamedTuple):
    """The positions of a group's members when they appear, and their routes."""

    position: Array  # positions (k, 2) [m]
    velocity: Array  # velocities (k, 2) [m/s]
    destination: Array  # destinations (k, 2) [m]
    gates: tuple[Gate, ...]  # gates that are still ahead


class Flow:
    """One flow of people.

    Args:
        config: Configuration of the run.
        number: Index of the flow in the configuration.
        prefix: Prefix of the ids of its people; a number follows.
        lit: Crossings at which people wait for their light.
    """

    def __init__(
        self, config: RunConfig, number: int, prefix: str, lit: Sequence[LitCrossing]
    ) -> None:
        flow, crowd = config.crowd.flow[number], config.crowd
        self._flow, self._crowd = flow, crowd
        self._seed = (config.seed, _STREAM, number)
        self._prefix = prefix
        self._people = crowd.people if flow.people is None else flow.people
        self._groups = crowd.groups if flow.groups is None else flow.groups
        parties = flow.rate * crowd.flow_scale * parties_per_person(self._groups)  # per hour
        self._headway = _HOUR / parties
        self._random = np.random.default_rng(self._seed)
        # People who are due earlier have arrived already. A Poisson process may begin at any time.
        begin = max(flow.begin, -longest_way(flow) / crowd.desired_speed_bounds[0])
        self._next = begin + self._random.exponential(self._headway)
        self._parties = self._persons = 0
        self._gates, self._lit = gates_of(flow), lit
        self.waiting: deque[Party] = deque()

    def come(self, until: float) -> None:
        """Add to ``waiting`` all groups that are due by ``until`` [s] after the run's start."""
        end = math.inf if self._flow.end is None else self._flow.end
        while self._next <= min(until, end):
            self.waiting.append(self._party(self._next))
            self._next += self._random.exponential(self._headway)

    def _party(self, due: float) -> Party:
        random = np.random.default_rng((*self._seed, self._parties))
        size = party_size(self._groups, random)
        names = tuple(f"{self._prefix}{self._persons + i}" for i in range(size))
        self._parties += 1
        self._persons += size
        kinds = draw_kinds(self._people, size, random)
        speed = float(desired_speeds(self._crowd, kinds, random).min())
        return Party(due, names, kinds, speed, random)

    def walk(self, party: Party, ahead: float) -> Walk | None:
        """Return the walk of a group that has walked ``ahead`` [m], or None if it has arrived."""
        place = somewhere(self._flow.start, party.random)
        end = somewhere(self._flow.to, party.random)
        gates = list(with_lights(place, self._gates, end, self._lit))
        while True:
            goal = gates[0].aim(place) if gates else end
            way = goal - place
            length = math.hypot(*way)
            if ahead < length or not gates:
                break
            ahead -= length
            place = goal
            del gates[0]
        if ahead > max(length - ARRIVAL_RADIUS, 0.0):
            return None
        direction = way / length if length > 0.0 else np.zeros(2)
        shape = facing(len(party.names), way)
        return Walk(
            position=place + ahead * direction + shape,
            velocity=np.tile(party.speed * direction, (len(shape), 1)),
            destination=end + shape,
            gates=tuple(gates),
        )


class Flows:
    """All flows of a run, and the crowd that their people join.

    Args:
        config: Configuration of the run.
        roster: Crowd that people join.
        prefixes: Prefix of the ids of each flow's people.
        time_step: Time step of the co-simulation [s].
        lit: Crossings at which people wait for their light.
    """

    def __init__(
        self,
        config: RunConfig,
        roster: Roster,
        prefixes: Sequence[str],
        time_step: float,
        lit: Sequence[LitCrossing] = (),
    ) -> None:
        self._config = config
        self._roster = roster
        self._prefixes = tuple(prefixes)
        self._time_step = time_step
        self._lit = tuple(lit)
        self._flows = [Flow(config, i, prefix, lit) for i, prefix in enumerate(prefixes)]
        self._step = -1
        self._longest = [0.0] * len(prefixes)  # longest wait [s] for room in each flow

    def afresh(self, roster: Roster) -> Self:
        """Return the same flows from their beginning, for another crowd."""
        return type(self)(self._config, roster, self._prefixes, self._time_step, self._lit)

    def enter(self, step: int) -> list[list[str]]:
        """Let people in at the control step ``step`` and return their names for each flow.

        A second call for the same step lets nobody in.
        """
        names: list[list[str]] = [[] for _ in self._flows]
        if step <= self._step:
            return names
        first, self._step = self._step < 0, step
        time = step * self._time_step
        for number, flow in enumerate(self._flows):
            flow.come(time)
            while flow.waiting:
                party = flow.waiting[0]
                early = max(-party.due, 0.0) if first else 0.0  # time [s] that it has walked
                entered = self._enter(flow, party, party.speed * early)
                if entered is None and not early:
                    self._longest[number] = max(self._longest[number], time - party.due)
                    break
                flow.waiting.popleft()
                names[number] += entered or ()
        return names

    def _enter(self, flow: Flow, party: Party, ahead: float) -> tuple[str, ...] | None:
        """Let a group in that has walked ``ahead`` [m]; return its ids, or None without room."""
        roster, spacing = self._roster, self._config.crowd.minimum_spacing
        for _ in range(_TRIES):
            walk = flow.walk(party, ahead)
            if walk is None:
                return ()
            if has_room(walk.position, roster.crowd.position, spacing):
                groups = of_parties([len(party.names)], party.names)
                told = zip(party.names, party.kinds, groups, strict=True)
                traits = {name: Trait(kind, group) for name, kind, group in told if kind or group}
                roster.add(party.names, _crowd(walk, party.speed), traits)
                return party.names
        return None

    @property
    def identity(self) -> bytes:
        """No bytes, since configuration and seed decide who comes."""
        return b""

    @property
    def keeps_coming(self) -> bool:
        """Return whether a flow with an end still runs or somebody waits for room."""
        time = self._step * self._time_step
        ends = [flow.end for flow in self._config.crowd.flow if flow.end is not None]
        return any(time < end for end in ends) or any(flow.waiting for flow in self._flows)

    @property
    def remarks(self) -> list[str]:
        """The remarks on flows whose people waited for room at their entry."""
        found = []
        for config, flow, longest in zip(
            self._config.crowd.flow, self._flows, self._longest, strict=True
        ):
            if longest > 1.0:
                waiting = sum(len(party.names) for party in flow.waiting)
                found.append(
                    f"flow '{config.name}': it backed up where it enters: somebody waited "
                    f"{longest:.0f} s for room, and {waiting} still do; a larger 'from' has more"
                )
        return found


def _crowd(walk: Walk, speed: float) -> Crowd:
    """Return a group as a crowd."""
    count = len(walk.position)
    through = np.array([gate.middle for gate in walk.gates]).reshape(-1, 2)
    lines = np.array([(*gate.across, gate.half_width) for gate in walk.gates]).reshape(-1, 3)
    return Crowd.create(
        walk.position,
        walk.velocity,
        np.full(count, speed),
        [np.vstack([through, end]) for end in walk.destination],
        passages=[np.vstack([lines, np.zeros(3)])] * count,
        signals=[np.array([*(gate.signal for gate in walk.gates), -1])] * count,
    )
